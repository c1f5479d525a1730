/* Energies at the end of a step, as the integrators had them in it. */
#include "solve/integrate/integrator.h"

#include "bar.h"

/* Whether a method has evaluated them there itself. */
static const struct {
  const char *method;
  bool known;
} methods[] = {
    {"cvode", true},   {"ida", true},  {"arkode", false},           {"erk", false},
    {"bdf2", true},    {"bdf3", true}, {"backward-euler", true},    {"midpoint", true},
    {"newmark", true}, {"hht", true},  {"generalized-alpha", true},
};

static void assert_same_energies(const corot_energies *a, const corot_energies *b, double scale) {
  const double *x = &a->kinetic, *y = &b->kinetic;
  for (size_t k = 0; k < sizeof *a / sizeof *x; k++) assert_close(x[k], y[k], 1e-10, 1e-12 * scale);
}

/* The quadratures of multistep methods see y = predictor + correction before it is stored, so that
   the last digits may differ; nothing else. */
static void energies_are_those_of_the_step(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    bar_def of = example2;
    of.ramp = 0.05; /* a kink to stop at */
    bar b = bar_create(&of);
    corot_integrator_def def = corot_integrator_defaults();
    def.method = methods[k].method;
    if (!corot_integrator_controls_error(def.method)) def.step = 0.005;
    corot_integrator *integrator = start(&b, &def);
    double *u = malloc(2 * b.n * sizeof *u), *v = u + b.n;
    int nknown = 0, nstep = 0;
    for (corot_step step = {0}; step.t < 0.1; nstep++) {
      corot_energies e, anew;
      assert_ok(corot_integrator_step(integrator, step.t < 0.05 ? 0.05 : 0.1, &step));
      assert_ok(corot_integrator_at(integrator, step.t, u, v));
      nknown += fabs(integrator->t_energies - step.t) < 1e-12 * step.t;
      assert_ok(corot_integrator_energy(integrator, u, v, &e));
      assert_ok(corot_energy(b.model, b.state, step.t, u, v, &anew));
      assert_same_energies(&e, &anew, anew.kinetic + anew.elastic);
    }
    if (methods[k].known) assert_int_equal(nknown, nstep);
    free(u);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(energies_are_those_of_the_step),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
