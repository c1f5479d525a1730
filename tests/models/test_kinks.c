/* Kinks and jumps of a load, met by every integrator with error control after steps of any length:
   a clamped bar of metal, whose periods are far shorter than anything its load does. */
#include <corot/statics.h>

#include "bar.h"

static const char *const methods[] = {"arkode", "cvode", "ida"};
enum { NMETHOD = 3 };

/* A load's history, of at most 4 points. */
typedef struct history {
  int n;
  double time[4], value[4];
} history;

/* A bar of this elastic modulus [Pa] and `size` times 0.2 m long; its damping lets no vibration
   live for long. The load bends it by the same share of its length, whatever it is made of. */
static bar build(double E, double size, const history *h) {
  corot_box box = {.size = {0.02 * size, 0.02 * size, 0.2 * size}, .cells = {1, 1, 8}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material material = {.lambda = 0.577 * E, .mu = 0.385 * E, .density = 7850};
  double damping = 3 * size / sqrt(E / 7850); /* [s] that of a quarter of its slowest period */
  material.damping_lambda = damping * material.lambda, material.damping_mu = damping * material.mu;
  corot_fix base = {"zmin", {true, true, true}};
  corot_load load = {COROT_TRACTION, "zmax", {5e-6 * E, 0, 0}, {h->n, h->time, h->value}};
  corot_model_def model = corot_model_defaults();
  model.mesh = mesh, model.strain = "polar";
  model.nmaterial = 1, model.material = &material;
  model.nfix = 1, model.fix = &base;
  model.nload = 1, model.load = &load;
  bar b = {0};
  int corner = mesh->nnode - 1;
  assert_ok(corot_model_create(&model, &b.model));
  assert_ok(corot_state_create(b.model, &b.state));
  corot_mesh_destroy(mesh);
  b.n = corot_model_ndof(b.model);
  b.tip = corot_model_dof(b.model)[corner][0];
  b.u = calloc(2 * b.n, sizeof *b.u);
  b.v = b.u + b.n;
  return b;
}

/* What a run does: stops at each kink, and tells the integrator. Returns the steps it took. */
static long run(bar *b, const corot_integrator_def *def, double end, const char *what) {
  double kink[8];
  int nkink = corot_model_kinks(b->model, 0, end, 8, kink);
  assert_in_range(nkink, 1, 8);
  memset(b->u, 0, 2 * b->n * sizeof *b->u);
  corot_state_enter(b->state, 0);
  corot_integrator *integrator = start(b, def);
  corot_step step = {0};
  for (int k = 0; k <= nkink; k++) {
    double stop = k < nkink ? kink[k] : end;
    while (step.t < stop)
      if (corot_integrator_step(integrator, stop, &step))
        fail_msg("%s, rtol %g, %s: %s", def->method, def->rtol, what, corot_error());
    if (k == nkink) break;
    corot_state_enter(b->state, kink[k]);
    assert_ok(corot_integrator_kink(integrator));
  }
  assert_ok(corot_integrator_at(integrator, end, b->u, b->v));
  long steps = corot_integrator_statistics(integrator).nst;
  corot_integrator_destroy(integrator);
  return steps;
}

/* Where the tip is in equilibrium with the load of the time t. */
static double tip_at_rest(bar *b, double t) {
  corot_statics_def def = corot_statics_defaults();
  corot_statics *statics;
  assert_ok(corot_statics_create(&def, b->model, t, NULL, &statics));
  assert_ok(corot_statics_solve(statics));
  corot_statics_at(statics, b->u);
  corot_statics_destroy(statics);
  return b->u[b->tip];
}

/* All methods and tolerances on bars of three metals, so to say, and two sizes: some seconds after
   the last kink the bar is at rest again, to ten tolerances of the displacement, whose largest is
   that under the full load. */
static void check(const history *h, const char *what) {
  static const double E[] = {2.1e11, 2.1e9, 2.1e7}, size[] = {0.1, 1};
  double end = h->time[h->n - 1] + 3;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 2; j++) {
      bar b = build(E[i], size[j], h);
      double most = fabs(tip_at_rest(&b, 1)), rest = tip_at_rest(&b, end);
      for (int k = 0; k < NMETHOD; k++)
        for (double rtol = 1e-3; rtol > 0.5e-9; rtol /= 10) {
          corot_integrator_def def = corot_integrator_defaults();
          def.method = methods[k], def.rtol = rtol;
          def.atol_displacement = 0.1 * rtol * most;
          long steps = run(&b, &def, end, what);
          double off = fabs(b.u[b.tip] - rest) / most;
          if (!(off < 10 * rtol) || steps > 20000)
            fail_msg("%s, rtol %g, E %g, size %g, %s: off by %.2g, %ld steps", methods[k], rtol,
                     E[i], size[j], what, off, steps);
        }
      bar_destroy(&b);
    }
}

static void the_end_of_a_ramp_is_passed(void **state) {
  (void)state;
  history h = {2, {0, 1}, {0, 1}};
  check(&h, "ramp");
}

/* However long the step before it, and however close the two times. */
static void a_jump_after_a_long_hold_is_seen(void **state) {
  (void)state;
  static const double hold[] = {10, 100, 1e3};
  for (int k = 0; k < 3; k++) {
    history h = {4, {0, 1, hold[k], hold[k] * (1 + 1e-14)}, {0, 1, 1, 0}};
    if (!(h.time[3] > hold[k])) h.time[3] = nextafter(hold[k], INFINITY);
    check(&h, "let go after a hold");
  }
}

static void kinks_closer_than_rounding_are_one_jump(void **state) {
  (void)state;
  history h = {4, {0, 1, 1, 1}, {0, 1, 5, 0.5}};
  h.time[2] = nextafter(1, 2), h.time[3] = nextafter(h.time[2], 2);
  check(&h, "two jumps at once");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_end_of_a_ramp_is_passed),
      cmocka_unit_test(a_jump_after_a_long_hold_is_seen),
      cmocka_unit_test(kinks_closer_than_rounding_are_one_jump),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
