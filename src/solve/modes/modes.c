/* Modes by searches beside what is known: rigid motions, then what ARPACK finds, until a search
   finds nothing lower. */
#include <corot/modes.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "core/model/model.h"
#include "eigenproblem.h"
#include "solve/pencil/wall_clock.h"
#include "solve/statics/rigid.h"

struct corot_modes {
  corot_modes_def def;
  eigen e;
  corot_state *state;
  double *u;    /* [n] */
  double *work; /* [3 n] */
  double t;
  bool rest;
};

void corot_modes_set_defaults(corot_modes_def *def, size_t bytes) {
  const corot_modes_def ours = {
      .count = 10, .linear = corot_linear_defaults(), .tolerance = 1e-12, .max_restarts = 300};
  corot_sized_fill(def, bytes, &ours, sizeof ours);
}

bool corot_modes_available(void) {
#ifdef COROT_HAVE_ARPACK
  return true;
#else
  return false;
#endif
}

#ifndef COROT_HAVE_ARPACK
corot_status corot_arpack_search(eigen *e, int count) {
  (void)e;
  return corot_fail(COROT_EINVAL, "no ARPACK for %d modes", count);
}
#endif

/* --- What is refused --- */

static corot_status check_count(int count, const corot_model *model) {
  int n = corot_model_ndof(model);
  if (count < 1) return corot_fail(COROT_EINVAL, "modes: %d modes are asked for", count);
  if (count < n) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "modes: %d modes are asked for, of a model with %d degrees of freedom: at "
                    "most %d can be found",
                    count, n, n - 1);
}

/* What K lacks away from rest vanishes with the stress there. */
static corot_status check_stiffness(const corot_model *model, bool rest) {
  const char *strain = corot_model_strain(model);
  const corot_strain_kind *kind = corot_strain_find(strain);
  if (model->body_nnode < model->mesh->nnode)
    return corot_fail(COROT_EINVAL,
                      "modes: a hierarchy coupled one way (%s) has no modes: its "
                      "coarse level does not feel the fine one",
                      strain);
  if (rest) return COROT_OK;
  if (corot_model_approximate_stiffness(model))
    return corot_fail(COROT_EINVAL,
                      "modes: the stiffness matrix of a hierarchy (%s) is not all "
                      "there under loads: only modes about rest can be found",
                      strain);
  if (kind && kind->frames && !kind->polar)
    return corot_fail(COROT_EINVAL,
                      "modes: the stiffness matrix of %s lacks the turning of its "
                      "frames, which counts under loads: only modes about rest can "
                      "be found; polar has all of it",
                      strain);
  return COROT_OK;
}

corot_status corot_modes_check(const corot_modes_def *d, const corot_model *model, double t,
                               bool rest) {
  COROT_TRY(COROT_DEFINED(d, corot_modes_def));
  COROT_TRY(COROT_GIVEN(model));
  if (!corot_modes_available())
    return corot_fail(COROT_EINVAL,
                      "modes: this corot was built without ARPACK, which finds "
                      "them (Debian: libarpack2-dev; option COROT_ARPACK)");
  COROT_TRY(check_count(d->count, model));
  if (!(d->tolerance > 0 && d->tolerance < 1))
    return corot_fail(COROT_EINVAL, "modes: tolerance = %g is not between 0 and 1", d->tolerance);
  if (d->max_restarts < 1)
    return corot_fail(COROT_EINVAL, "modes: max_restarts = %d is not positive", d->max_restarts);
  if (!isfinite(t)) return corot_fail(COROT_EINVAL, "modes: t = %g is not finite", t);
  return check_stiffness(model, rest);
}

/* The body at rest is where the mesh is, and so must its supports be. */
static corot_status check_supports(corot_modes *m) {
  const corot_model *model = m->e.model;
  int nnode = corot_model_mesh(model)->nnode;
  double(*x)[3] = malloc((size_t)nnode * sizeof *x);
  if (!x) return corot_fail(COROT_ENOMEM, "no memory for %d nodes", nnode);
  corot_nodal(model, m->t, m->u, m->u, x, NULL);
  int moved = -1;
  for (int k = 0; k < nnode && moved < 0; k++)
    if (x[k][0] != 0 || x[k][1] != 0 || x[k][2] != 0) moved = k;
  free(x);
  if (moved < 0) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "modes: at t = %g a support has taken node %d away from rest: "
                    "only modes about an equilibrium can be found there",
                    m->t, moved);
}

/* --- The search --- */

static corot_status open_all(corot_modes *m, const corot_model *model, int capacity,
                             const double *u) {
  size_t n = (size_t)corot_model_ndof(model);
  COROT_TRY(corot_eigen_create(&m->def, model, capacity, &m->e));
  m->u = calloc(n, sizeof *m->u);
  m->work = calloc(3 * n, sizeof *m->work);
  if (!m->u || !m->work) return corot_fail(COROT_ENOMEM, "no memory for modes");
  for (size_t i = 0; u && i < n; i++) {
    if (!isfinite(u[i]))
      return corot_fail(COROT_EINVAL, "modes: u[%zu] = %g is not finite", i, u[i]);
    m->u[i] = u[i];
  }
  COROT_TRY(corot_state_create(model, &m->state));
  corot_state_stand_still(m->state, m->t, m->rest ? 0 : 1);
  return m->rest ? check_supports(m) : COROT_OK;
}

static corot_status assemble(corot_modes *m) {
  double start = clock_wall(), *zero = m->work;
  COROT_TRY(
      corot_jacobian(m->e.model, m->state, m->t, m->u, zero, COROT_TANGENT_EXACT, m->e.K, NULL));
  corot_load_stiffness(m->e.model, m->state, m->t, m->u, m->e.K);
  m->e.facts.assembly_s = clock_wall() - start;
  return COROT_OK;
}

/* Of what was found, the highest eigenvalue's place. */
static int highest(const eigen *e) {
  int at = 0;
  for (int k = 1; k < e->nfound; k++)
    if (e->eigenvalue[k] > e->eigenvalue[at]) at = k;
  return at;
}

/* Each last search is for one more. If it is lower than one that was found, that was one of several
   with equal eigenvalues, of which a Krylov space knows one: it takes the highest one's place. */
static corot_status search(eigen *e) {
  if (e->nfound < e->def->count) COROT_TRY(corot_arpack_search(e, e->def->count - e->nfound));
  for (bool lower = true; lower && e->nfound < e->n;) {
    int top = highest(e), last = e->nfound;
    double limit = e->eigenvalue[top] - 1e-9 * fabs(e->eigenvalue[top]) - e->zero;
    COROT_TRY(corot_arpack_search(e, 1));
    lower = e->eigenvalue[last] < limit;
    if (lower) corot_eigen_swap(e, top, last);
    e->nfound--;
  }
  return COROT_OK;
}

/* By ascending eigenvalue; the largest component positive, the first one of equal size. */
static void put_in_order(eigen *e) {
  for (int i = 0; i < e->nfound; i++) {
    int least = i;
    for (int k = i + 1; k < e->nfound; k++)
      if (e->eigenvalue[k] < e->eigenvalue[least]) least = k;
    corot_eigen_swap(e, i, least);
  }
  for (int k = 0; k < e->nfound; k++) {
    double *x = e->x + (size_t)k * e->n, *Mx = e->Mx + (size_t)k * e->n, most = 0;
    for (int i = 0; i < e->n; i++) most = fmax(most, fabs(x[i]));
    int first = 0;
    while (fabs(x[first]) < (1 - 1e-6) * most) first++;
    for (int i = 0; x[first] < 0 && i < e->n; i++) Mx[i] = -Mx[i];
    for (int i = e->n - 1; x[first] < 0 && i >= 0; i--)
      if (i != first) x[i] = -x[i];
    x[first] = fabs(x[first]);
  }
}

/* -dr/du between modes, less K: the largest over their eigenvalues. */
static corot_status measure_asymmetry(corot_modes *m) {
  eigen *e = &m->e;
  double *jv = m->work, *Kx = jv + e->n, *zero = Kx + e->n;
  for (int k = 0; k < e->nfound; k++) {
    const double *x = e->x + (size_t)k * e->n;
    COROT_TRY(corot_jvp(e->model, m->state, m->t, m->u, zero, COROT_TANGENT_EXACT, x, zero, jv));
    corot_block_multiply(e->model, (const double(*)[9])e->K, x, Kx);
    for (int i = 0; i < e->n; i++) jv[i] = -jv[i] - Kx[i];
    for (int i = 0; i < e->nfound; i++) {
      double size = fmax(fabs(e->eigenvalue[i]), fabs(e->eigenvalue[k]));
      double left = fabs(dot(e->n, e->x + (size_t)i * e->n, jv));
      if (size > 0) e->facts.asymmetry = fmax(e->facts.asymmetry, left / size);
    }
  }
  return COROT_OK;
}

static corot_status find_all(corot_modes *m, int nrigid, const double *rigid) {
  eigen *e = &m->e;
  COROT_TRY(assemble(m));
  for (int k = 0; k < nrigid; k++) corot_eigen_add_rigid(e, rigid + (size_t)k * e->n);
  e->facts.nrigid = e->nfound;
  if (e->nfound > e->def->count) e->nfound = e->def->count; /* no other is lower at rest */
  COROT_TRY(corot_eigen_factor(e));
  if (e->facts.nrigid < e->def->count) COROT_TRY(search(e));
  put_in_order(e);
  e->facts.zero = e->zero, e->facts.shift = e->shift, e->facts.solver = e->solver.name;
  return measure_asymmetry(m);
}

corot_status corot_modes_find(const corot_modes_def *def, const corot_model *model, double t,
                              const double *u, corot_modes **modes) {
  double start = clock_wall(), *rigid = NULL;
  int nrigid = 0;
  COROT_TRY(COROT_GIVEN(modes));
  COROT_TRY(corot_modes_check(def, model, t, !u));
  corot_modes *m = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for modes");
  m->def = *def, m->t = t, m->rest = !u;
  /* rigid motions are modes at rest; under loads K may stiffen them, or make them fall over */
  corot_status status = m->rest ? corot_rigid_motions(model, &nrigid, &rigid) : COROT_OK;
  int room = (nrigid > def->count ? nrigid : def->count) + 1;
  if (!status) status = open_all(m, model, room, u);
  if (!status) status = find_all(m, nrigid, rigid);
  free(rigid);
  if (status) {
    corot_modes_destroy(m);
    return status;
  }
  corot_modes_facts *f = &m->e.facts;
  f->other_s = fmax(0, clock_wall() - start - f->assembly_s - f->factor_s - f->solve_s);
  *modes = m;
  return COROT_OK;
}

void corot_modes_destroy(corot_modes *m) {
  if (!m) return;
  corot_eigen_clear(&m->e);
  corot_state_destroy(m->state);
  free(m->u), free(m->work);
  free(m);
}

/* --- What was found --- */

int corot_modes_count(const corot_modes *m) { return m->e.nfound; }

corot_modes_facts corot_modes_known(const corot_modes *m) { return m->e.facts; }

/* |K x - lambda M x| over |K x|, or where lambda is 0 over the stiffest K_ii |x|. */
static double residual(const corot_modes *m, int k) {
  const eigen *e = &m->e;
  const double *x = e->x + (size_t)k * e->n, *Mx = e->Mx + (size_t)k * e->n;
  double *r = m->work, lambda = e->eigenvalue[k];
  corot_block_multiply(e->model, (const double(*)[9])e->K, x, r);
  double unit = lambda == 0 ? e->stiffest * sqrt(dot(e->n, x, x)) : sqrt(dot(e->n, r, r));
  for (int i = 0; i < e->n; i++) r[i] -= lambda * Mx[i];
  return sqrt(dot(e->n, r, r)) / unit;
}

corot_mode corot_modes_at(const corot_modes *m, int k) {
  const eigen *e = &m->e;
  const int(*dof)[3] = corot_model_dof(e->model);
  const double *Mx = e->Mx + (size_t)k * e->n;
  double lambda = e->eigenvalue[k];
  corot_mode mode = {
      .eigenvalue = lambda,
      .frequency = lambda > 0 ? sqrt(lambda) / (2 * 3.14159265358979323846) : 0,
      .growth = lambda < 0 ? sqrt(-lambda) : 0,
      .residual = residual(m, k),
      .shape = e->x + (size_t)k * e->n,
  };
  for (int c = 0; c < 3; c++) {
    double share = 0;
    for (int n = 0; n < corot_model_mesh(e->model)->nnode; n++)
      if (dof[n][c] >= 0) share += Mx[dof[n][c]];
    mode.effective_mass[c] = share * share;
  }
  return mode;
}
