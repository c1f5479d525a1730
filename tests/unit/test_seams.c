/* Where one part hands its failure to another, through SUNDIALS or not: whatever fails, at whatever
   call, in whatever integrator, the run either recovers, with the right answer, or stops with the
   reason, and a status of that meaning. */
#include <corot/integrate.h>
#include <corot/statics.h>

#include "alloc.h"
#include "bar.h"
#include "solver.h"
#include "strike.h"
#include "suitesparse_memory.h"

static const double T_END = 0.05;

/* Of the methods of constant step, which Newton solves to 1e-12. */
static const double STEP = 2.5e-3;

/* A bar of 6 or 12 tets under a sudden shear. */
static body make_bar(corot_mass mass) {
  corot_box box = {.size = {0.1, 0.1, 0.2}, .cells = {1, 1, 2}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_fix base = {"zmin", {true, true, true}};
  corot_load load = {COROT_TRACTION, "zmax", {200, 0, 0}, {0, NULL, NULL}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &load, def.mass = mass;
  return make_body(mesh, def);
}

/* --- Runs ------------------------------------------------------------------------------------ */

typedef struct trial {
  const char *method; /* or "statics" */
  corot_linear_def linear;
  corot_mass mass;
  double rtol; /* of error control */
} trial;

static corot_status integrate(const trial *how, const body *b, double *y) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = how->method, def.linear = how->linear;
  def.rtol = how->rtol, def.step = STEP, def.newton_tolerance = 1e-12;
  corot_integrator *integrator;
  memset(y, 0, 2 * b->n * sizeof *y);
  COROT_TRY(corot_integrator_create(&def, b->model, b->state, 0, y, y + b->n, &integrator));
  corot_status status = COROT_OK;
  corot_step step = {0};
  double dissipated, external;
  /* the grid of a fixed-step method ends at T_END up to rounding */
  double end = corot_integrator_controls_error(how->method) ? T_END : T_END - STEP / 2;
  while (!status && step.t < end) status = corot_integrator_step(integrator, T_END, &step);
  /* what was reached is readable, whatever came then */
  assert_ok(corot_integrator_at(integrator, step.t, y, y + b->n));
  assert_ok(corot_integrator_work(integrator, step.t, &dissipated, &external));
  assert_true(isfinite(norm_max(2 * b->n, y)) && isfinite(dissipated) && isfinite(external));
  corot_integrator_destroy(integrator);
  return status;
}

static corot_status load(const trial *how, const body *b, double *y) {
  corot_statics_def def = corot_statics_defaults();
  def.linear = how->linear, def.first_step = 0.5;
  corot_statics *statics;
  COROT_TRY(corot_statics_create(&def, b->model, 0, NULL, &statics));
  corot_status status = corot_statics_solve(statics);
  corot_statics_at(statics, y);
  assert_true(isfinite(norm_max(b->n, y)));
  corot_statics_destroy(statics);
  return status;
}

/* To y = (u, v) [2 n]; of statics, v is left alone. */
static corot_status go(const trial *how, const body *b, double *y) {
  corot_fail(COROT_OK, "%s", "");
  return strcmp(how->method, "statics") == 0 ? load(how, b, y) : integrate(how, b, y);
}

/* --- What is allowed ------------------------------------------------------------------------- */

static char description[256];

static void describe(const trial *how, bool forever, corot_status given, long k, const char *what) {
  snprintf(description, sizeof description, "%s, %s, %s mass: %s %ld %s status %d", how->method,
           how->linear.solver, how->mass == COROT_MASS_LUMPED ? "lumped" : "consistent", what, k,
           forever ? "and all after it: " : "alone:", (int)given);
}

/* The answer (u, v) of the undisturbed run, and how far another may be from it, relative to the
   largest u and v. A run with error control repeats the step that failed with another length, and
   so makes errors of its own, as large as the undisturbed run's; one without takes the same steps,
   if any, and is the same to the tolerance of its iterations. */
typedef struct answer {
  double *y; /* [2 n] */
  double allowed;
} answer;

/* The larger of the relative differences of u and v. */
static double distance_of(int n, const double *y, const double *from) {
  double most = 0;
  for (int part = 0; part < 2; part++, y += n, from += n)
    if (norm_max(n, from) > 0) most = fmax(most, difference_of(n, y, from) / norm_max(n, from));
  return most;
}

static answer find_answer(const trial *how, const body *b) {
  answer right = {calloc(4 * b->n, sizeof *right.y), 0};
  double *exact = right.y + 2 * b->n;
  trial fine = *how;
  fine.rtol = 1e-9;
  strike_at(0, 0, false, COROT_OK);
  assert_ok(go(&fine, b, exact));
  strike_at(0, 0, false, COROT_OK);
  assert_ok(go(how, b, right.y));
  right.allowed = 5 * distance_of(b->n, right.y, exact) + 1e-9;
  return right;
}

static void expect_answer(const body *b, const double *y, const answer *right) {
  double off = distance_of(b->n, y, right->y);
  if (!(off <= right->allowed))
    fail_msg("%s: off by %.3g, allowed %.3g", description, off, right->allowed);
}

/* A failure that a shorter step might have mended may end a run as COROT_EINTEGRATE, and a start as
   what it is; the stiffness of statics may be found not to be definite, where it was the factor
   that said so. A failure of any other kind keeps its status. */
static void expect_end(corot_status status, corot_status given) {
  bool mendable = given == COROT_RETRY || given == COROT_ESINGULAR;
  bool meant = mendable ? status == COROT_EINTEGRATE || status == given || status == COROT_ESINGULAR
                        : status == given;
  bool said = strstr(corot_error(), "struck: ") ||
              (strike.where >= FACTOR && mendable && strstr(corot_error(), "(buckling)"));
  if (!meant || !said)
    fail_msg("%s: ended with status %d: %s", description, (int)status, corot_error());
}

/* --- Each call of each seam ------------------------------------------------------------------ */

static const corot_status kinds[] = {COROT_RETRY, COROT_ESINGULAR, COROT_ENOMEM, COROT_EINVAL};
enum { NKIND = sizeof kinds / sizeof *kinds };

/* All calls at first, then ever fewer: some twenty of a thousand. */
static long next_call(long k) { return k < 4 ? k + 1 : k + (k + 1) / 2; }

static void strike_each_call(const trial *how, const body *b, const answer *right, seam where,
                             long calls) {
  double *y = calloc(2 * b->n, sizeof *y);
  for (int kind = 0; kind < NKIND; kind += 1 + SANITIZED) /* one that may be tried again, one not */
    for (int forever = 0; forever < 2 - SANITIZED; forever++)
      for (long k = 1; k <= calls; k = next_call(k)) {
        describe(how, forever, kinds[kind], k, seam_name[where]);
        strike_at(where, k, forever, kinds[kind]);
        corot_status status = go(how, b, y);
        if (strike.struck == 0) fail_msg("%s: was not called", description);
        bool fatal = kinds[kind] == COROT_ENOMEM || kinds[kind] == COROT_EINVAL;
        if (fatal && !status) fail_msg("%s: went unnoticed", description);
        if (fatal && strike.struck > 1) fail_msg("%s: was tried again", description);
        if (status)
          expect_end(status, kinds[kind]);
        else
          expect_answer(b, y, right);
      }
  free(y);
}

/* *calls: how often each seam was met. */
static void strike_all(const trial *how, long *calls) {
  body b = make_bar(how->mass);
  answer right = find_answer(how, &b);
  long count[NSEAM];
  memcpy(count, strike.count, sizeof count);
  for (int where = 0; where < NSEAM; where++) {
    if (count[where] > 0) strike_each_call(how, &b, &right, where, count[where]);
    calls[where] += count[where];
  }
  free(right.y);
  drop_body(&b);
}

static const char *const methods[] = {"cvode", "ida",      "arkode",         "erk",
                                      "bdf3",  "midpoint", "newmark",        "generalized-alpha",
                                      "hht",   "bdf2",     "backward-euler", "statics"};
enum { NMETHOD = sizeof methods / sizeof *methods };

/* One of each kind. */
static const char *const some[] = {"cvode", "ida", "arkode", "newmark", "statics"};
enum { NSOME = sizeof some / sizeof *some };

static const corot_linear_def solvers[] = {
    {"klu", "amd", "auto", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL},
    {"cholmod", "amd", "simplicial", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL},
    {"cholmod", "amd", "supernodal", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL},
    {"pcg", "auto", "auto", "block-jacobi", 1e-13, COROT_ROLE_DYNAMIC, NULL},
    {"pcg", "auto", "auto", "incomplete-cholesky", 1e-13, COROT_ROLE_DYNAMIC, NULL},
    {"pcg", "auto", "auto", "amg", 1e-13, COROT_ROLE_DYNAMIC, NULL},
};
enum { NSOLVER = sizeof solvers / sizeof *solvers };

static bool is_built(const corot_linear_def *def) {
  body b = make_bar(COROT_MASS_LUMPED);
  corot_pencil *pencil;
  corot_status status = corot_pencil_create(b.model, b.state, def, &pencil);
  if (!status) corot_pencil_destroy(pencil);
  drop_body(&b);
  return !status;
}

static void every_call_may_fail_with_every_integrator(void **state) {
  (void)state;
  long calls[NSEAM] = {0};
  for (int m = 0; m < NMETHOD; m++)
    for (int mass = 0; mass < 2; mass++)
      strike_all(
          &(trial){methods[m], solvers[0], mass ? COROT_MASS_CONSISTENT : COROT_MASS_LUMPED, 1e-5},
          calls);
  for (int where = 0; where < NSEAM; where++)
    if (calls[where] == 0) fail_msg("%s: was never called", seam_name[where]);
}

static void every_call_may_fail_with_every_linear_solver(void **state) {
  (void)state;
  long calls[NSEAM] = {0};
  for (int s = 1; s < NSOLVER; s++)
    for (int m = 0; m < NSOME && is_built(&solvers[s]); m++)
      strike_all(&(trial){some[m], solvers[s], COROT_MASS_LUMPED, 1e-5}, calls);
}

/* --- Each allocation ------------------------------------------------------------------------- */

/* All that create and the first steps make, then ever fewer. */
static long next_allocation(long k) {
  return k < 200 ? k + ALLOC_STRIDE : k + ALLOC_STRIDE * k / 16;
}

/* Those of SuiteSparse, too, which are made anew with each factor. (SUNDIALS asks
   the C library, and only in set-ups.) */
static void every_allocation_may_fail(void **state) {
  (void)state;
  const suitesparse_memory saved = suitesparse_memory_get();
  /* as this program sees them: see alloc.h */
  suitesparse_memory_set((suitesparse_memory){malloc, calloc, realloc, free});
  for (int s = 0; s < NSOLVER; s++)
    for (int m = 0; m < NSOME && is_built(&solvers[s]); m++) {
      trial how = {some[m], solvers[s], COROT_MASS_CONSISTENT, 1e-5};
      body b = make_bar(how.mass);
      answer right = find_answer(&how, &b);
      double *y = calloc(2 * b.n, sizeof *y);
      alloc_fail_at(0);
      assert_ok(go(&how, &b, y));
      long count = alloc_count();
      for (long k = 1; k <= count; k = next_allocation(k)) {
        describe(&how, false, COROT_ENOMEM, k, "allocation");
        alloc_fail_at(k);
        corot_status status = go(&how, &b, y);
        long left = alloc_live();
        alloc_fail_at(0);
        if (left) fail_msg("%s: %ld blocks leaked", description, left);
        if (!status) /* a smaller block has done as well */
          expect_answer(&b, y, &right);
        else if (status != COROT_ENOMEM || !strstr(corot_error(), "memory"))
          fail_msg("%s: ended with status %d: %s", description, (int)status, corot_error());
      }
      free(right.y), free(y);
      drop_body(&b);
    }
  suitesparse_memory_set(saved);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_call_may_fail_with_every_integrator),
      cmocka_unit_test(every_call_may_fail_with_every_linear_solver),
      cmocka_unit_test(every_allocation_may_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
