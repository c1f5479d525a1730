/* Preconditioner by one V-cycle of smoothed aggregation, with a direct solve of the coarsest level:
   algebraic multigrid, which needs the matrix and where its nodes are.

   All levels are scaled so that the blocks on the diagonal of their matrix are the identity; what
   smooths is a polynomial of Chebyshev in it. Sums go along rows, in one order.

   Libraries have this, too: PETSc (GAMG) and hypre (BoomerAMG), both with MPI. A process that
   begins MPI by itself takes 0.3 s, two threads and a daemon for it, and a copy of the process that
   ends does not come back from MPI. On a cube of 105 000 unknowns, to 1e-8, they take 23 and 16
   iterations; 1.9 and 2.2 s to set up, 1.7 and 7.8 s to solve. This takes 18, and 0.4 and 0.7 s. On
   a bar with holes GAMG takes 43 iterations, BoomerAMG 124, and this 22.

   Aggregates do not see how flat tets are: with cells ten times as wide as high it takes 184. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/lanes/simd.h"
#include "linsol_aggregate.h"
#include "linsol_bottom.h"
#include "linsol_multilevel.h"
#include "linsol_project.h"

/* Products of a smoother with the matrix; the part of the spectrum that it smooths; steps to find
   the largest eigenvalue, and how much larger it is taken to be. A polynomial of even degree keeps
   the preconditioner positive up to 1 + 1 / PART times what it is made for. */
enum { DEGREE = 2, STEPS = 10 };
static const double part = 10, margin = 1.1;

/* Up to so many unknowns are solved for directly, unless the plan says otherwise. With 300 instead
   of 1000, a bar with holes of 60 000 unknowns takes 31 iterations instead of 23, with 3000 as
   many; but KLU is slow with what has hardly any zeros. */
#ifdef COROT_HAVE_CHOLMOD
enum { FEW = 1000 };
#else
enum { FEW = 400 };
#endif
enum { MOST_LEVELS = 20 };

/* Fewer rows take less time than threads do to begin together. */
enum { LEAST_ROWS = 500 };

typedef struct amg_level {
  block_rows A;
  prolongator P; /* from the next level; none on the last one */
  projection project;
  double largest;        /* eigenvalue, taken for the smoother's */
  double *b, *x, *r, *d; /* [n][size] right-hand side, solution, residual, direction */
} amg_level;

typedef struct amg {
  const corot_csc *csc;
  const node_matrix *A;
  const double (*x)[3]; /* [nodes of the mesh] where they are; NULL: not known */
  int *node;            /* [A->n] of the mesh */
  int nlevel;
  amg_level level[MOST_LEVELS]; /* the finest comes first */
  bottom bottom;
  int few; /* unknowns that are solved for directly */
} amg;

/* Who shares the loops over a level's rows out: nobody where they are few. */
static team *team_of(const amg *m, const amg_level *l) {
  return l->A.n < LEAST_ROWS ? NULL : m->A->team;
}

static void level_clear(amg_level *l) {
  corot_rows_clear(&l->A);
  corot_prolong_clear(&l->P);
  corot_project_clear(&l->project);
  free(l->b), free(l->x), free(l->r), free(l->d);
}

static void amg_destroy(void *self) {
  amg *m = self;
  if (!m) return;
  for (int l = 0; l < MOST_LEVELS; l++) level_clear(&m->level[l]);
  corot_bottom_clear(&m->bottom);
  free(m->node);
  free(m);
}

/* --- levels --- */

static corot_status make_vectors(amg_level *l) {
  int n = l->A.n, size = l->A.size;
  l->b = corot_rows_vector(n, size), l->x = corot_rows_vector(n, size);
  l->r = corot_rows_vector(n, size), l->d = corot_rows_vector(n, size);
  if (l->b && l->x && l->r && l->d) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a level of %d nodes", n);
}

/* The next level's graph: aggregates are neighbours where nodes of theirs are, which makes fewer of
   them than P' A P has blocks in a row, and aggregates of the same size on all levels. */
typedef struct level_graph {
  graph_rows rows;
  int *rowptr, *col; /* what `rows` is of, if it is not a matrix */
} level_graph;

/* Whether a next level was made: not if it would be hardly smaller. */
static corot_status coarsen(amg *m, level_graph *g, bool *made) {
  amg_level *l = &m->level[m->nlevel - 1];
  int count, *aggregate = malloc(((size_t)l->A.n + 1) * sizeof *aggregate);
  *made = false;
  if (!aggregate) return corot_fail(COROT_ENOMEM, "no memory for %d aggregates", l->A.n);
  corot_status status = corot_aggregate(&g->rows, aggregate, &count);
  if (status || count == 0 || 2.0 * count * ROWS_MODES > (double)l->A.n * l->A.size) {
    free(aggregate);
    return status;
  }
  level_graph next = {0};
  status = corot_aggregate_graph(&g->rows, aggregate, count, &next.rowptr, &next.col);
  free(g->rowptr), free(g->col);
  *g = next;
  g->rows = (graph_rows){.n = count, .rowptr = g->rowptr, .col = g->col};
  if (status) {
    free(aggregate);
    return status;
  }
  COROT_TRY(corot_prolong_create(&l->A, aggregate, count, &l->P));
  COROT_TRY(corot_project_create(&l->A, &l->P, &l->project, &m->level[m->nlevel].A));
  *made = true;
  return make_vectors(&m->level[m->nlevel++]);
}

static corot_status make_levels(amg *m) {
  amg_level *first = &m->level[0];
  COROT_TRY(corot_rows_create(m->A, &first->A));
  COROT_TRY(make_vectors(first));
  m->nlevel = 1;
  level_graph g = {.rows = {first->A.n, first->A.rowptr, first->A.col}};
  corot_status status = COROT_OK;
  for (bool more = true; more && !status && m->nlevel < MOST_LEVELS;) {
    const block_rows *last = &m->level[m->nlevel - 1].A;
    if ((double)last->n * last->size <= m->few) break;
    status = coarsen(m, &g, &more);
  }
  free(g.rowptr), free(g.col);
  return status;
}

/* Where entry (r, c) of the block below the diagonal stands that mirrors block e. */
static int source_of(const block_rows *A, int e, int r, int c) {
  int s = A->size;
  return A->nodes ? 9 * (A->n + (A->source[e] >> 1)) + 3 * c + r : s * s * e + s * r + c;
}

/* That of a one: on the diagonal, or behind the values. */
static int source_of_one(const block_rows *A, int j) {
  return A->nodes ? 9 * (j / 3) + 4 * (j % 3) : A->rowptr[A->n] * A->size * A->size;
}

/* The lower triangle of I + O in columns. Counts only if there is no room yet. */
static int list_entries(const block_rows *A, corot_csc *csc) {
  int nnz = 0, s = A->size;
  for (int j = 0; j < csc->n; j++) {
    csc->colptr[j] = csc->diagonal[j] = nnz;
    csc->node[j] = j / s;
    if (csc->row) csc->row[nnz] = j, csc->source[nnz] = source_of_one(A, j);
    nnz++;
    for (int e = A->rowptr[j / s]; e < A->rowptr[j / s + 1]; e++) {
      if (A->col[e] < j / s) continue;
      for (int r = 0; r < s; r++, nnz++)
        if (csc->row) {
          csc->row[nnz] = s * A->col[e] + r;
          csc->source[nnz] = source_of(A, e, r, j % s);
        }
    }
  }
  return csc->colptr[csc->n] = csc->nnz = nnz;
}

static corot_status make_bottom(amg *m) {
  const block_rows *A = &m->level[m->nlevel - 1].A;
  corot_csc *lower = NULL;
  corot_status status = corot_bottom_allocate(A->n * A->size, &lower);
  if (!status) status = corot_bottom_allocate_entries(list_entries(A, lower), lower);
  if (status) {
    corot_csc_destroy(lower);
    return status;
  }
  list_entries(A, lower);
  return corot_bottom_create(lower, &m->bottom);
}

static corot_status amg_create(const corot_csc *csc, const node_matrix *A, const linsol_plan *plan,
                               void **self) {
  amg *m = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for algebraic multigrid");
  m->csc = csc, m->A = A, m->x = plan->x;
  m->few = plan->most_direct > 0 ? plan->most_direct : FEW;
  m->node = malloc(((size_t)A->n + 1) * sizeof *m->node);
  corot_status status = COROT_OK;
  if (!m->node) status = corot_fail(COROT_ENOMEM, "no memory for %d nodes", A->n);
  for (int i = 0; i < csc->n && !status; i++) m->node[A->slot[i] / 3] = csc->node[i];
  if (!status) status = make_levels(m);
  if (!status) status = make_bottom(m);
  if (status) {
    amg_destroy(m);
    return status;
  }
  *self = m;
  return COROT_OK;
}

/* --- values --- */

/* The centre of the nodes that are free, about which the body turns. */
static void find_centre(const amg *m, double centre[3]) {
  int n = m->A->n;
  for (int c = 0; c < 3; c++) centre[c] = 0;
  for (int i = 0; i < n && m->x; i++)
    for (int c = 0; c < 3; c++) centre[c] += m->x[m->node[i]][c] / n;
}

/* B = C' of the three translations and, where positions are known, the three rotations of the
   components that are free. */
static void list_motions(const amg *m, double (*B)[ROWS_MODES]) {
  double centre[3];
  find_centre(m, centre);
  memset(B, 0, 3 * (size_t)m->A->n * sizeof *B);
  for (int k = 0; k < m->csc->n; k++) {
    int i = m->A->slot[k] / 3, c = m->A->slot[k] % 3, a = (c + 1) % 3, b = (c + 2) % 3;
    double *row = B[m->A->slot[k]];
    row[c] = 1;
    if (!m->x) continue;
    const double *x = m->x[m->node[i]];
    row[3 + a] = x[b] - centre[b]; /* e_a times x has the component e_c (x_b) */
    row[3 + b] = -(x[a] - centre[a]);
  }
  for (int i = 0; i < m->A->n; i++) {
    const double *C = m->A->C + 9 * (size_t)i;
    double(*row)[ROWS_MODES] = B + 3 * (size_t)i;
    for (int r = 0; r < 3; r++)
      for (int k = 0; k < ROWS_MODES; k++) {
        double s = 0;
        for (int q = r; q < 3; q++) s += C[3 * q + r] * row[q][k];
        row[r][k] = s;
      }
  }
}

static corot_status amg_factor(void *self) {
  amg *m = self;
  corot_rows_load(&m->level[0].A);
  for (int k = 0; k < m->nlevel - 1; k++) {
    amg_level *l = &m->level[k];
    double *const work[3] = {l->x, l->r, l->d};
    if (k == 0)
      list_motions(m, (double(*)[ROWS_MODES])l->P.T);
    else
      memcpy(l->P.T, l[-1].P.R, (size_t)l->P.n * ROWS_MODES * ROWS_MODES * sizeof *l->P.T);
    l->largest = margin * corot_rows_largest(&l->A, team_of(m, l), STEPS, work);
    if (!(l->largest > 0))
      return corot_fail(COROT_RETRY, "pcg: the matrix is not positive definite (eigenvalue %.3g)",
                        l->largest);
    corot_prolong_split(&l->P);
    corot_prolong_smooth(&l->A, l->largest, &l->P);
    int at = corot_project_load(&l->A, &l->project, &l->P, &l[1].A);
    if (at >= 0)
      return corot_fail(COROT_RETRY,
                        "pcg: the matrix is not positive definite (aggregate %d of level %d)", at,
                        k + 1);
  }
  const block_rows *last = &m->level[m->nlevel - 1].A;
  corot_status status =
      corot_bottom_factor(&m->bottom, last->nodes ? last->nodes->value : last->value);
  return status ? corot_fail(status, "pcg, level %d: %s", m->nlevel - 1, corot_error()) : COROT_OK;
}

/* --- cycle --- */

/* What a loop over the rows of a level takes. */
typedef struct level_work {
  const amg_level *l;
  double rho, factor;
} level_work;

static size_t entry(const amg_level *l, int row) { return (size_t)row * l->A.size; }

/* d = factor r */
static COROT_CLONES void begin_rows(void *of, int from, int end) {
  const level_work *w = of;
  double *d = w->l->d, *r = w->l->r;
  for (size_t i = entry(w->l, from); i < entry(w->l, end); i++) d[i] = w->factor * r[i];
}

/* d = rho d + factor r */
static COROT_CLONES void go_on_rows(void *of, int from, int end) {
  const level_work *w = of;
  double *d = w->l->d, *r = w->l->r;
  for (size_t i = entry(w->l, from); i < entry(w->l, end); i++)
    d[i] = w->rho * d[i] + w->factor * r[i];
}

/* x += d */
static COROT_CLONES void add_rows(void *of, int from, int end) {
  const level_work *w = of;
  double *d = w->l->d, *x = w->l->x;
  for (size_t i = entry(w->l, from); i < entry(w->l, end); i++) x[i] += d[i];
}

/* x += d, r -= (I + O) d */
static void step_rows(void *of, int from, int end) {
  const level_work *w = of;
  add_rows(of, from, end);
  corot_rows_subtract(&w->l->A, from, end, w->l->d, w->l->r);
}

/* Chebyshev's iteration for r = b - A x; `whole`: r is needed afterwards. */
static void smooth(const amg *m, const amg_level *l, bool whole) {
  double high = l->largest, low = high / part;
  double centre = (high + low) / 2, half = (high - low) / 2, rho = half / centre;
  level_work w = {l, 0, 1 / centre};
  corot_team_loop(team_of(m, l), l->A.n, begin_rows, &w);
  for (int k = 1; k < DEGREE; k++) {
    double next = 1 / (2 * centre / half - rho);
    corot_team_loop(team_of(m, l), l->A.n, step_rows, &w);
    w.rho = next * rho, w.factor = next * 2 / half;
    corot_team_loop(team_of(m, l), l->A.n, go_on_rows, &w);
    rho = next;
  }
  corot_team_loop(team_of(m, l), l->A.n, whole ? step_rows : add_rows, &w);
}

static void restrict_rows(void *of, int from, int end) {
  const amg_level *l = of;
  corot_prolong_restrict(&l->P, from, end, l->r, l[1].b);
}

/* d = P of what the next level has found. */
static void prolong_rows(void *of, int from, int end) {
  const amg_level *l = of;
  memset(l->d + entry(l, from), 0, (entry(l, end) - entry(l, from)) * sizeof *l->d);
  corot_prolong_add(&l->P, from, end, l[1].x, l->d);
}

static corot_status solve_bottom(amg *m) {
  const amg_level *l = &m->level[m->nlevel - 1];
  size_t bytes = (size_t)l->A.n * l->A.size * sizeof *l->x;
  memcpy(m->bottom.x, l->b, bytes);
  COROT_TRY(corot_bottom_solve(&m->bottom));
  memcpy(l->x, m->bottom.x, bytes);
  return COROT_OK;
}

static corot_status amg_apply(void *self, const double *r, double *z) {
  amg *m = self;
  size_t bytes = 3 * (size_t)m->A->n * sizeof *r;
  memcpy(m->level[0].b, r, bytes);
  /* down */
  for (int k = 0; k < m->nlevel - 1; k++) {
    amg_level *l = &m->level[k];
    size_t n = (size_t)l->A.n * l->A.size;
    memset(l->x, 0, n * sizeof *l->x);
    memcpy(l->r, l->b, n * sizeof *l->r);
    smooth(m, l, true);
    corot_team_loop(team_of(m, l), l->P.ncoarse, restrict_rows, l);
  }
  COROT_TRY(solve_bottom(m));
  /* up: d is the correction */
  for (int k = m->nlevel - 2; k >= 0; k--) {
    amg_level *l = &m->level[k];
    const level_work w = {.l = l};
    corot_team_loop(team_of(m, l), l->A.n, prolong_rows, l);
    corot_team_loop(team_of(m, l), l->A.n, step_rows, (void *)&w);
    smooth(m, l, false);
  }
  memcpy(z, m->level[0].x, bytes);
  return COROT_OK;
}

const multilevel_ops corot_amg = {
    .name = "amg",
    .scaled = true,
    .by_domains = true,
    .create = amg_create,
    .factor = amg_factor,
    .apply = amg_apply,
    .destroy = amg_destroy,
};
