/* Preconditioner by one V-cycle, with a direct solve on level 0. */
#include <stdlib.h>
#include <string.h>

#include "linsol_blocks.h"
#include "linsol_coarse.h"
#include "linsol_multilevel.h"

/* A_l x = b on one level, with fourth components that are zero. */
typedef struct grid {
  double (*inverse)[9];             /* [n + 1] of the diagonal blocks; NULL on level 0 */
  double (*b)[4], (*x)[4], (*r)[4]; /* [n + 1] r: residual; the last node stands for all that are
                                       wholly held */
} grid;

typedef struct multigrid {
  const corot_csc *csc;
  const node_matrix *A;
  galerkin levels;
  coarse_level coarse;
  grid *grid;     /* [nlevel + 1] */
  double (*v)[3]; /* [nodes of level 0] */
} multigrid;

static void multigrid_destroy(void *self) {
  multigrid *m = self;
  if (!m) return;
  for (int l = 0; l <= m->levels.nlevel && m->grid; l++) {
    free(m->grid[l].inverse);
    free(m->grid[l].b);
  }
  corot_galerkin_clear(&m->levels);
  corot_coarse_clear(&m->coarse);
  free(m->grid);
  free(m->v);
  free(m);
}

static corot_status make_grids(multigrid *m) {
  const galerkin *g = &m->levels;
  m->v = malloc((g->level[0].n + 1) * sizeof *m->v);
  m->grid = calloc(g->nlevel + 1, sizeof *m->grid);
  bool enough = m->v && m->grid;
  for (int l = 0; l <= g->nlevel && enough; l++) {
    grid *of = &m->grid[l];
    size_t n = g->level[l].n + 1;
    if (l > 0) of->inverse = calloc(n, sizeof *of->inverse);
    of->b = calloc(3 * n, sizeof *of->b);
    of->x = of->b + n, of->r = of->x + n;
    enough = of->b && (l == 0 || of->inverse);
  }
  return enough ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for the grids of %d nodes", g->n);
}

static corot_status fill(const linsol_plan *plan, multigrid *m) {
  COROT_TRY(corot_galerkin_create(m->csc, m->A, plan->def.refinement, &m->levels));
  COROT_TRY(make_grids(m));
  return corot_coarse_create(m->csc, m->A, &m->levels.level[0], plan, &m->coarse);
}

static corot_status multigrid_create(const corot_csc *csc, const node_matrix *A,
                                     const linsol_plan *plan, void **self) {
  multigrid *m = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for multigrid");
  m->csc = csc, m->A = A;
  corot_status status = fill(plan, m);
  if (status) {
    multigrid_destroy(m);
    return status;
  }
  *self = m;
  return COROT_OK;
}

static corot_status multigrid_factor(void *self) {
  multigrid *m = self;
  corot_galerkin_load(&m->levels);
  for (int l = 1; l <= m->levels.nlevel; l++) {
    int at = corot_galerkin_invert(&m->levels, l, 0, m->grid[l].inverse);
    if (at >= 0) return corot_nodes_indefinite(m->A, m->csc, at);
  }
  return corot_coarse_factor(&m->coarse);
}

/* --- sweeps --- */

COROT_INLINE block_column column(const galerkin_level *A, int j) {
  return block_column_of(A->n, A->colptr, A->row, A->value, j);
}

/* D^-1 r */
COROT_INLINE vd4 relax(const double *inverse, vd4 r) {
  vd4 x = block_times(inverse, r);
  x[3] = 0;
  return x;
}

/* From x = 0: x = (D + L)^-1 b, which leaves r = b - A x = -L' x. */
static COROT_CLONES void sweep_forward(const galerkin_level *A, const grid *g) {
  memcpy(g->r, g->b, A->n * sizeof *g->r);
  for (int j = 0; j < A->n; j++) {
    vd4 x = relax(g->inverse[j], vd4_load(g->r[j]));
    vd4_store(g->x[j], x);
    add_column(column(A, j), -x, g->r);
  }
  for (int j = 0; j < A->n; j++)
    vd4_store(g->r[j], -column_product(column(A, j), (const double(*)[4])g->x));
}

/* x = (D + L')^-1 (b - L x) */
static COROT_CLONES void sweep_backward(const galerkin_level *A, const grid *g) {
  memcpy(g->r, g->b, A->n * sizeof *g->r);
  for (int j = 0; j < A->n; j++) add_column(column(A, j), -vd4_load(g->x[j]), g->r);
  for (int j = A->n - 1; j >= 0; j--) {
    vd4 above = column_product(column(A, j), (const double(*)[4])g->x);
    vd4_store(g->x[j], relax(g->inverse[j], vd4_load(g->r[j]) - above));
  }
}

/* --- from level to level --- */

static void clear_held(int held, double v[4]) {
  for (int c = 0; c < 3; c++)
    if (held >> c & 1) v[c] = 0;
}

/* Parent k of node i of level l, as a node of level l - 1. */
COROT_INLINE int parent_of(const galerkin *g, int l, int i, int k) {
  int parent = g->parent[i - g->level[0].n][k];
  return parent < g->n ? parent : g->level[l - 1].n;
}

/* b of the coarse level = P' r */
static COROT_CLONES void restrict_residual(const galerkin *g, int l, const grid *fine,
                                           const grid *coarse) {
  int ncoarse = g->level[l - 1].n;
  memcpy(coarse->b, fine->r, ncoarse * sizeof *coarse->b);
  for (int i = ncoarse; i < g->level[l].n; i++) {
    vd4 half = 0.5 * vd4_load(fine->r[i]);
    for (int k = 0; k < 2; k++) {
      double *b = coarse->b[parent_of(g, l, i, k)];
      vd4_store(b, vd4_load(b) + half);
    }
  }
  for (int i = 0; i < ncoarse; i++)
    if (g->held[i]) clear_held(g->held[i], coarse->b[i]);
}

/* x += P x of the coarse level, whose last node stays zero */
static COROT_CLONES void add_correction(const galerkin *g, int l, const grid *coarse,
                                        const grid *fine) {
  int ncoarse = g->level[l - 1].n;
  for (int i = 0; i < ncoarse; i++)
    vd4_store(fine->x[i], vd4_load(fine->x[i]) + vd4_load(coarse->x[i]));
  for (int i = ncoarse; i < g->level[l].n; i++) {
    vd4 sum =
        vd4_load(coarse->x[parent_of(g, l, i, 0)]) + vd4_load(coarse->x[parent_of(g, l, i, 1)]);
    vd4_store(fine->x[i], vd4_load(fine->x[i]) + 0.5 * sum);
    if (g->held[i]) clear_held(g->held[i], fine->x[i]);
  }
}

static corot_status solve_coarse(multigrid *m) {
  int n = m->levels.level[0].n;
  const grid *g = &m->grid[0];
  for (int i = 0; i < n; i++) memcpy(m->v[i], g->b[i], sizeof *m->v);
  COROT_TRY(corot_coarse_solve(&m->coarse, m->v));
  for (int i = 0; i < n; i++) memcpy(g->x[i], m->v[i], sizeof *m->v);
  return COROT_OK;
}

static corot_status multigrid_apply(void *self, const double *r, double *z) {
  multigrid *m = self;
  const galerkin *g = &m->levels;
  int last = g->nlevel;
  for (int i = 0; i < g->n; i++) memcpy(m->grid[last].b[i], r + 3 * i, 3 * sizeof *r);
  for (int l = last; l > 0; l--) {
    sweep_forward(&g->level[l], &m->grid[l]);
    restrict_residual(g, l, &m->grid[l], &m->grid[l - 1]);
  }
  COROT_TRY(solve_coarse(m));
  for (int l = 1; l <= last; l++) {
    add_correction(g, l, &m->grid[l - 1], &m->grid[l]);
    sweep_backward(&g->level[l], &m->grid[l]);
  }
  for (int i = 0; i < g->n; i++) memcpy(z + 3 * i, m->grid[last].x[i], 3 * sizeof *z);
  return COROT_OK;
}

const multilevel_ops corot_multigrid = {
    .name = "multigrid",
    .refined = true,
    .create = multigrid_create,
    .factor = multigrid_factor,
    .apply = multigrid_apply,
    .destroy = multigrid_destroy,
};
