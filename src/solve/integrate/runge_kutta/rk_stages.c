/* What the stages of a diagonally implicit Runge-Kutta method know of the inside of a step.

   Hermite's polynomial through u, v and M^-1 r at both ends is as accurate as the method while the
   step resolves a mode, w h < 1 or so. In a faster mode v and M^-1 r are useless: what is left
   there of a transient or of Newton's iteration, e in u, is w e in v and w^2 e in M^-1 r, and the
   polynomial multiplies it by w h and (w h)^2. The displacements of the stages are right there:
   each is the solution of a system (M + ... + g^2 K) u = ... that holds K u in balance with the
   load, to e. In a mode that the step resolves they are right to the stage order only, 1 or 2.

   So both are used, each where it is right. E, the difference of their slopes at the ends of the
   step, is split by the matrix of the step itself, S = M + g D + g^2 K,

     E_fast = (I - S^-1 M)^3 E:  a factor (g w)^6 where g w is small, 1 where it is large,

   and the interpolant is Hermite's polynomial through slopes less E_fast. Where a bound shows that
   E_fast is below the tolerance anyway, which is so while the step resolves all that moves, nothing
   is split. S is the pencil's, of the
   latest set-up: that it is a little old, or g not quite that of the step, moves the seam between
   slow and fast and no more. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "runge_kutta.h"

/* --- The polynomial through stages ----------------------------------------------------------- */

enum { MOST_DATA = RK_MOST_NODES + 2 };

/* Solves A x = b by elimination with pivots; A [n][MOST_DATA] and b are overwritten. */
static void solve_small(int n, double A[][MOST_DATA], double *b) {
  for (int k = 0; k < n; k++) {
    int p = k;
    for (int i = k + 1; i < n; i++)
      if (fabs(A[i][k]) > fabs(A[p][k])) p = i;
    for (int j = 0; j < n; j++) {
      double a = A[k][j];
      A[k][j] = A[p][j], A[p][j] = a;
    }
    double a = b[k];
    b[k] = b[p], b[p] = a;
    for (int i = 0; i < n; i++) {
      double f = i == k ? 0 : A[i][k] / A[k][k];
      for (int j = k; j < n; j++) A[i][j] -= f * A[k][j];
      b[i] -= f * b[k];
    }
  }
  for (int k = 0; k < n; k++) b[k] /= A[k][k];
}

/* Stages between the ends, each as far as can be from the nodes before it (Leja's order, in which
   interpolation is well conditioned), until those left are too near to one. */
static void choose_nodes(rk_stages *s) {
  for (s->nnode = 0; s->nnode < RK_MOST_NODES; s->nnode++) {
    double best = 0;
    for (int i = 0; i < s->n; i++) {
      double c = s->c[i], apart = c * (1 - c), nearest = fmin(c, 1 - c);
      for (int k = 0; k < s->nnode; k++) {
        double d = fabs(c - s->c[s->node[k]]);
        apart *= d;
        nearest = fmin(nearest, d);
      }
      if (!(nearest > 0.05 && apart > best)) continue;
      best = apart;
      s->node[s->nnode] = i;
    }
    if (best == 0) break;
  }
}

/* Weights of the displacements at 0, 1 and the nodes in a derivative of order 0 to 2, at x, of the
   polynomial through them. */
static void find_weights(const rk_stages *s, int derivative, double x, double *weight) {
  double A[MOST_DATA][MOST_DATA], at[MOST_DATA] = {0, 1};
  int n = 2 + s->nnode;
  for (int k = 0; k < s->nnode; k++) at[2 + k] = s->c[s->node[k]];
  for (int j = 0; j < n; j++) { /* exact for the monomial x^j */
    for (int i = 0; i < n; i++) A[j][i] = pow(at[i], j);
    double factor = derivative == 2 ? j * (j - 1) : derivative == 1 ? j : 1;
    weight[j] = j < derivative ? 0 : factor * pow(x, j - derivative);
  }
  solve_small(n, A, weight);
}

/* --- Stages ---------------------------------------------------------------------------------- */

/* Of an attempt that fails, the stages are overwritten by those of the next. */
static int keep_stage(sunrealtype t, N_Vector z, void *user_data) {
  (void)t;
  rk_stages *s = &((runge_kutta *)user_data)->stages;
  N_VScale(1, z, s->z[s->count++ % s->n]);
  return 0;
}

static bool closes(ARKodeButcherTable table) {
  int s = table->stages;
  for (int j = 0; j < s; j++)
    if (table->A[s - 1][j] != table->b[j]) return false;
  return true;
}

/* Coefficients of the implicit stages apart from those of a first stage that is the start. */
static void copy_table(rk_stages *s, ARKodeButcherTable table) {
  int first = table->A[0][0] == 0;
  s->n = table->stages - first;
  if (first) s->b_start = table->b[0];
  for (int i = 0; i < s->n; i++) {
    const double *row = table->A[first + i];
    if (first) s->a_start[i] = row[0];
    memcpy(s->a[i], row + first, s->n * sizeof *row);
    s->b[i] = table->b[first + i];
    s->c[i] = table->c[first + i];
  }
  s->closing = closes(table);
}

corot_status corot_rk_keep_stages(runge_kutta *m, ARKodeButcherTable table) {
  rk_stages *s = &m->stages;
  copy_table(s, table);
  bool short_of_memory = !(s->start = N_VClone(m->driver.y));
  for (int i = 0; i < s->n && !short_of_memory; i++)
    short_of_memory = !(s->z[i] = N_VClone(m->driver.y));
  if (short_of_memory)
    return corot_fail(COROT_ENOMEM, "no memory for the stages of %s",
                      m->driver.self->ops->kind.name);
  choose_nodes(s);
  for (int k = 0; k < 4; k++) find_weights(s, 1 + k % 2, k / 2, s->weight[k]);
  for (int k = 0; k < 2; k++) find_weights(s, k, RK_SAMPLE, s->weight[4 + k]);
  if (m->api->observe_stages(m->memory, keep_stage))
    return corot_driver_refuse(&m->driver, "stages");
  return COROT_OK;
}

void corot_rk_release_stages(rk_stages *s) {
  if (s->start) N_VDestroy(s->start);
  for (int k = 0; k < s->n; k++)
    if (s->z[k]) N_VDestroy(s->z[k]);
}

N_Vector corot_rk_stage(const rk_stages *s, int k) { return s->z[(s->count + k) % s->n]; }

/* The rates k_i with z_i = u_0 + h sum a_ij k_j: they are what makes the step, and equal the
   velocities of the stages but for what Newton's iteration left. With a matrix of another gamma it
   leaves far more in v than in u / h. Where the last stage of a step is the first of the next, so
   is its rate: ARKODE shows it, in start.rate, at an order above 2; else `start` has kept it. */
void corot_rk_find_rates(runge_kutta *m) {
  rk_stages *s = &m->stages;
  int n = corot_model_ndof(m->driver.self->model);
  size_t bytes = n * sizeof(double);
  double h = m->end.t - m->start.t, *k0 = N_VGetArrayPointer(s->start) + n;
  const double *u0 = N_VGetArrayPointer(m->start.y);
  if (m->order > 2)
    memcpy(k0, N_VGetArrayPointer(m->start.rate), bytes);
  else if (m->fresh || !s->closing)
    memcpy(k0, u0 + n, bytes);
  memcpy(k0 - n, u0, bytes);
  for (int i = 0; i < s->n; i++) {
    double *u = N_VGetArrayPointer(corot_rk_stage(s, i)), *k = u + n;
    for (int l = 0; l < n; l++) k[l] = (u[l] - u0[l]) / h - s->a_start[i] * k0[l];
    for (int j = 0; j < i; j++) {
      const double *kj = N_VGetArrayPointer(corot_rk_stage(s, j)) + n;
      for (int l = 0; l < n; l++) k[l] -= s->a[i][j] * kj[l];
    }
    for (int l = 0; l < n; l++) k[l] /= s->a[i][i];
  }
}

/* --- Slow and fast --------------------------------------------------------------------------- */

/* E [n] = what `value` has above the k-th functional of the polynomial through the stages. */
static void difference(const runge_kutta *m, int k, double scale, const double *value, double *E) {
  const rk_stages *s = &m->stages;
  int n = corot_model_ndof(m->driver.self->model);
  const double *w = s->weight[k], *u0 = N_VGetArrayPointer(m->start.y);
  const double *u1 = N_VGetArrayPointer(m->end.y);
  for (int i = 0; i < n; i++) E[i] = value[i] - scale * (w[0] * u0[i] + w[1] * u1[i]);
  for (int j = 0; j < s->nnode; j++) {
    const double *z = N_VGetArrayPointer(corot_rk_stage(s, s->node[j]));
    for (int i = 0; i < n; i++) E[i] -= scale * w[2 + j] * z[i];
  }
}

/* x [n] becomes M^-1 (g D + g^2 K) x: its part in each mode times (g w)^2, or more if it is damped.
 */
static corot_status amplify(const corot_integrator *self, double *x, double *Kx) {
  const corot_pencil *p = self->pencil;
  int n = p->n;
  double g = p->gamma;
  corot_block_multiply(p->model, (const double(*)[9])p->K, x, Kx);
  corot_block_multiply(p->model, (const double(*)[9])p->D, x, p->work);
  for (int i = 0; i < n; i++) Kx[i] = g * p->work[i] + g * g * Kx[i];
  return corot_mass_solve(self->mass, Kx, x);
}

static double norm(int n, const double *x) {
  double square = 0;
  for (int i = 0; i < n; i++) square += x[i] * x[i];
  return sqrt(square);
}

/* Whether E's part in modes too fast for the step has a norm below `most`. In modes of g w > 1 it
   is no larger than the product of E. What the step resolves is small there, too, and the smaller
   the more often; three times is where the test costs as much as what it may save. */
static corot_status is_small(const corot_integrator *self, double most, double *E, double *room,
                             bool *small) {
  int n = corot_model_ndof(self->model);
  for (int pass = 0; pass < 3; pass++) {
    *small = norm(n, E) <= most;
    if (*small) return COROT_OK;
    corot_status status = amplify(self, E, room);
    if (status) return sun_is_fatal(status) ? status : COROT_OK;
  }
  *small = norm(n, E) <= most;
  return COROT_OK;
}

/* Of the displacements and, as these may hide what Newton's iteration left in M^-1 r, of the
   velocities. The absolute tolerance does not count: it may be far above all displacements, which
   are right nevertheless at the ends of the steps. */
corot_status corot_rk_resolves(runge_kutta *m, bool *resolved) {
  const corot_integrator *self = m->driver.self;
  int n = corot_model_ndof(self->model);
  double h = m->end.t - m->start.t, rtol = self->def.rtol;
  double *E = N_VGetArrayPointer(m->error), *room = E + n;
  const double *y0 = N_VGetArrayPointer(m->start.y), *y1 = N_VGetArrayPointer(m->end.y);
  for (int k = 0; k < 2; k++) {
    corot_rk_interpolate(m, RK_SAMPLE, k ? NULL : room, k ? room : NULL);
    difference(m, 4 + k, k ? 1 / h : 1, room, E);
    double most = rtol * fmax(norm(n, y0 + k * n), norm(n, y1 + k * n));
    COROT_TRY(is_small(self, most, E, room, resolved));
    if (!*resolved) break;
  }
  return COROT_OK;
}

corot_status corot_rk_clear_slopes(runge_kutta *m) {
  const corot_integrator *self = m->driver.self;
  int n = corot_model_ndof(self->model);
  double h = m->end.t - m->start.t, *E = N_VGetArrayPointer(m->error), *x = E + n;
  for (int k = 0; k < 4; k++) {
    double *slope = N_VGetArrayPointer(m->slope[k / 2]) + k % 2 * n;
    difference(m, k, k % 2 ? 1 / (h * h) : 1 / h, slope, E);
    for (int pass = 0; pass < 3; pass++) {
      corot_status status = corot_pencil_slow_part(self->pencil, E, x);
      if (sun_is_fatal(status)) return status;
      if (status) break; /* all of it, then */
      for (int i = 0; i < n; i++) E[i] -= x[i];
    }
    for (int i = 0; i < n; i++) slope[i] -= E[i];
  }
  return COROT_OK;
}
