/* From elements to nodes: the kernels chunk by chunk, range by range, and the sums of what they
   make. */
#include <math.h>

#include "kernel.h"

corot_status corot_solid_check(solid_state *s, int tet) {
  s->inverted = tet;
  if (tet < 0) return COROT_OK;
  return corot_fail(COROT_RETRY, "tet %d is inverted", tet);
}

/* --- Ranges ----------------------------------------------------------------------------------- */

/* What the ranges have in common. */
typedef struct shared_out {
  const solid *body;
  solid_state *s;
  chunk_work *work;
  const void *of;
  force_sum *sum; /* or NULL: no forces are summed up */
} shared_out;

/* Adds a node's force to the sum, and to `check`. */
static inline void add_force(const force_sum *sum, int n, const double f[3], double *check) {
  for (int c = 0; c < 3; c++) {
    int i = sum->row ? sum->row[n][c] : 4 * n + c;
    if (i >= 0) *check += sum->r[i] += sum->sign * f[c];
  }
}

/* A chunk's element forces: adds those of the nodes that are complete now, each node's own in the
   order of the elements, and sets those of seams aside. */
static void collect(const solid *body, const solid_state *own, int chunk, force_sum *sum) {
  const double *force = (const double *)own->force;
  const range_plan *plan = &own->ranges.plan;
  const int *begin = body->pattern.first, *slot = body->pattern.slot, *due = plan->due;
  double check = 0;
  for (int at = due[chunk]; at < due[chunk + 1]; at++) {
    int n = plan->turn[at];
    if (n < sum->from) continue;
    double f[3] = {0, 0, 0};
    for (int k = begin[n]; k < begin[n + 1]; k++)
      for (int c = 0; c < 3; c++) f[c] += force[slot[k] + c * W];
    add_force(sum, n, f, &check);
  }
  sum->check += check;
  if (plan->nseam == 0) return;
  for (int k = plan->copy_first[chunk]; k < plan->copy_first[chunk + 1]; k++)
    for (int c = 0; c < 3; c++)
      own->ranges.aside[plan->copy[k].to][c] = force[plan->copy[k].from + c * W];
}

static void do_range(void *work, int k) {
  const shared_out *j = work;
  const range_plan *plan = &j->s->ranges.plan;
  solid_state own = *j->s;
  force_sum sum = {0};
  int tet = -1;
  own.force = j->s->ranges.force[k];
  if (j->sum) sum = *j->sum;
  for (int c = plan->chunk[k]; c < plan->chunk[k + 1] && tet < 0; c++) {
    tet = j->work(j->of, &own, c);
    if (j->sum && tet < 0) collect(j->body, &own, c, &sum);
  }
  j->s->ranges.told[k] = (range_result){tet, sum.check};
}

/* The first inverted tet; -1: none. */
static int run_ranges(shared_out *j) {
  const solid_ranges *r = &j->s->ranges;
  corot_team_run(j->s->team, r->plan.n, do_range, j);
  for (int k = 0; k < r->plan.n; k++)
    if (r->told[k].tet >= 0) return r->told[k].tet;
  return -1;
}

corot_status corot_solid_each(const solid *body, solid_state *s, chunk_work *work, const void *of) {
  shared_out j = {body, s, work, of, NULL};
  return corot_solid_check(s, run_ranges(&j));
}

/* What was set aside of the forces on part k of the seams' nodes. */
static void add_seams(void *work, int k) {
  const shared_out *j = work;
  const solid_ranges *ranges = &j->s->ranges;
  const range_plan *plan = &ranges->plan;
  double check = 0;
  int end = team_share(plan->nseam, plan->n, k + 1);
  for (int s = team_share(plan->nseam, plan->n, k); s < end; s++) {
    int n = plan->seam[s];
    if (n < j->sum->from) continue;
    double f[3] = {0, 0, 0};
    for (int at = plan->force_first[s]; at < plan->force_first[s + 1]; at++)
      for (int c = 0; c < 3; c++) f[c] += ranges->aside[at][c];
    add_force(j->sum, n, f, &check);
  }
  ranges->told[k].check += check;
}

corot_status corot_solid_sum(const solid *body, solid_state *s, chunk_work *work, const void *of,
                             force_sum *sum) {
  const range_plan *plan = &s->ranges.plan;
  shared_out j = {body, s, work, of, sum};
  double check = 0;
  COROT_TRY(corot_solid_check(s, run_ranges(&j)));
  if (plan->nseam > 0) corot_team_run(s->team, plan->n, add_seams, &j);
  for (int k = 0; k < plan->n; k++) check += s->ranges.told[k].check;
  if (isfinite(check)) return COROT_OK;
  return corot_fail(COROT_RETRY, "the forces exceed double precision");
}

/* --- What is evaluated ------------------------------------------------------------------------ */

/* All that the kernels take, of which each takes a part. */
typedef struct evaluation {
  const solid *body;
  nodal_field u, v, du, dv;
  bool exact; /* with the change of the frames */
  int strain; /* of another measure */
  double lambda_part, mu_part;
  corot_tangent tangent;
  double (*K)[9], (*D)[9];
  block_vd *theta; /* to be averaged */
} evaluation;

/* --- Averages --------------------------------------------------------------------------------- */

static int own_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  corot_kernel_dilatation(e->body, s, e->u, chunk, e->theta);
  return -1;
}

static int change_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  corot_kernel_dilatation_change(e->body, s, e->u, e->du, e->exact, chunk, e->theta);
  return -1;
}

static int own_internal_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  (void)s;
  corot_kernel_internal_dilatation(e->body, e->u, e->strain, chunk, e->theta);
  return -1;
}

static int unpool_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  corot_kernel_unpool(e->body, s->pool, chunk, e->theta);
  return -1;
}

/* What there is to be averaged, and where to. */
typedef struct averaging {
  const solid *body;
  const block_vd *theta;
  solid_state *s;
} averaging;

static void pool_part(void *work, int from, int end) {
  const averaging *a = work;
  corot_kernel_pool(a->body, a->theta, from, end, a->s->pool);
}

/* theta [points] = the means that stand in for what `find` finds. */
static void average(solid_state *s, evaluation *e, chunk_work *find, block_vd *theta) {
  if (!e->body->dilatation.npool) return;
  averaging a = {e->body, theta, s};
  e->theta = theta;
  corot_solid_each(e->body, s, find, e);
  corot_team_loop(s->team, e->body->dilatation.npool, pool_part, &a);
  corot_solid_each(e->body, s, unpool_chunk, e);
}

void corot_solid_average(const solid *body, solid_state *s, nodal_field u) {
  evaluation e = {.body = body, .u = u};
  average(s, &e, own_chunk, s->dilatation);
}

/* --- Forces ----------------------------------------------------------------------------------- */

static int force_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  return corot_kernel_force(e->body, s, e->u, e->v, chunk);
}

corot_status corot_solid_force(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                               force_sum *sum) {
  evaluation e = {.body = body, .u = u, .v = v};
  average(s, &e, own_chunk, s->dilatation);
  return corot_solid_sum(body, s, force_chunk, &e, sum);
}

static int derivative_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  return corot_kernel_derivative(e->body, s, e->u, e->v, e->du, e->dv, e->exact, chunk);
}

corot_status corot_solid_derivative(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                                    nodal_field du, nodal_field dv, bool exact, force_sum *sum) {
  evaluation e = {.body = body, .u = u, .v = v, .du = du, .dv = dv, .exact = exact};
  average(s, &e, own_chunk, s->dilatation);
  average(s, &e, change_chunk, s->dilatation_change);
  return corot_solid_sum(body, s, derivative_chunk, &e, sum);
}

static int internal_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  return corot_kernel_internal(e->body, s, e->u, e->strain, e->lambda_part, e->mu_part, chunk);
}

corot_status corot_solid_internal(const solid *body, solid_state *s, nodal_field u, int strain,
                                  double lambda_part, double mu_part, force_sum *sum) {
  evaluation e = {
      .body = body, .u = u, .strain = strain, .lambda_part = lambda_part, .mu_part = mu_part};
  average(s, &e, own_internal_chunk, s->dilatation);
  return corot_solid_sum(body, s, internal_chunk, &e, sum);
}

/* --- Matrices --------------------------------------------------------------------------------- */

static void complete_diagonals(const evaluation *e, const int *node, int n) {
  if (e->K) corot_kernel_diagonals(e->body, node, n, e->K);
  if (e->D) corot_kernel_diagonals(e->body, node, n, e->D);
}

static int tangent_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  const range_plan *plan = &s->ranges.plan;
  int tet = corot_kernel_tangent(e->body, s, e->u, e->tangent, chunk, e->K, e->D);
  if (tet < 0)
    complete_diagonals(e, plan->turn + plan->due[chunk], plan->due[chunk + 1] - plan->due[chunk]);
  return tet;
}

/* Matrices with what ranges have set aside of them. */
typedef struct seam_work {
  const evaluation *e;
  const solid_ranges *ranges;
} seam_work;

static void add_parts(const range_plan *plan, int from, int end, const double (*aside)[9],
                      double (*A)[9]) {
  for (int s = from; s < end; s++)
    for (int at = plan->part_first[s]; at < plan->part_first[s + 1]; at++)
      for (int i = 0; i < 9; i++) A[plan->shared[s]][i] += aside[at][i];
}

static void add_shared(void *work, int from, int end) {
  const seam_work *w = work;
  const solid_ranges *r = w->ranges;
  if (w->e->K) add_parts(&r->plan, from, end, (const double(*)[9])r->aside_K, w->e->K);
  if (w->e->D) add_parts(&r->plan, from, end, (const double(*)[9])r->aside_D, w->e->D);
}

static void complete_seams(void *work, int from, int end) {
  const seam_work *w = work;
  complete_diagonals(w->e, w->ranges->plan.seam + from, end - from);
}

/* The batches of one colour, by parts. */
typedef struct batch_work {
  const evaluation *e;
  const solid_state *s;
  int colour;
} batch_work;

static void add_batches(void *work, int k) {
  const batch_work *w = work;
  const dilatation *d = &w->e->body->dilatation;
  int first = d->first[w->colour], n = d->first[w->colour + 1] - first;
  int nparts = w->s->ranges.plan.n;
  for (int b = team_share(n, nparts, k); b < team_share(n, nparts, k + 1); b++)
    corot_kernel_dilatation_tangent(w->e->body, w->s, d->batch[first + b], w->s->ranges.gathered[k],
                                    w->e->K);
}

/* What the averages add to K. */
static void add_averages(const evaluation *e, const solid_state *s) {
  const dilatation *d = &e->body->dilatation;
  if (!d->npool) return;
  for (int c = 0; c < d->ncolour; c++) {
    batch_work w = {e, s, c};
    corot_team_run(s->team, s->ranges.plan.n, add_batches, &w);
  }
  for (int b = d->first[d->ncolour]; b < d->first[d->ncolour + 1]; b++)
    corot_kernel_dilatation_tangent(e->body, s, d->batch[b], s->ranges.gathered[0], e->K);
}

corot_status corot_solid_matrices(const solid *body, solid_state *s, nodal_field u,
                                  corot_tangent tangent, double (*K)[9], double (*D)[9]) {
  evaluation e = {.body = body, .u = u, .tangent = tangent, .K = K, .D = D};
  seam_work seams = {&e, &s->ranges};
  average(s, &e, own_chunk, s->dilatation);
  COROT_TRY(corot_solid_each(body, s, tangent_chunk, &e));
  corot_team_loop(s->team, s->ranges.plan.nshared, add_shared, &seams);
  corot_team_loop(s->team, s->ranges.plan.nseam, complete_seams, &seams);
  if (K) add_averages(&e, s);
  return COROT_OK;
}

/* --- Energy ----------------------------------------------------------------------------------- */

static int energy_chunk(const void *of, solid_state *s, int chunk) {
  const evaluation *e = of;
  double *sum = s->chunk_sum[chunk];
  return corot_kernel_energy(e->body, s, e->u, e->v, chunk, &sum[0], &sum[1]);
}

corot_status corot_solid_energy(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                                double *elastic, double *power) {
  evaluation e = {.body = body, .u = u, .v = v};
  average(s, &e, own_chunk, s->dilatation);
  COROT_TRY(corot_solid_each(body, s, energy_chunk, &e));
  *elastic = *power = 0;
  for (int c = 0; c < body->pattern.nchunk; c++) {
    *elastic += s->chunk_sum[c][0];
    *power += s->chunk_sum[c][1];
  }
  return COROT_OK;
}
