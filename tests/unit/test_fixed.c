#include <stdio.h>
#include "bar.h"
#include "follow.h"
static void probe(void **state) {
  (void)state;
  const char *m[] = {"backward-euler", "bdf2", "bdf3", "midpoint", "newmark", "hht", "generalized-alpha"};
  for (int k = 0; k < 7; k++)
  for (double tr = 200; tr < 30000; tr *= 4)
    for (double h = 0.02; h < 2; h *= 5) {
      bar_def of = example2;
      of.ramp = 0, of.traction[0] = tr;
      bar b = bar_create(&of);
      corot_integrator_def def = corot_integrator_defaults();
      def.method = m[k], def.step = h;
      corot_integrator *it = start(&b, &def);
      corot_step step = {0};
      int i;
      corot_status s = 0;
      for (i = 0; i < 20 && !s; i++) s = corot_integrator_step(it, 100, &step);
      corot_statistics q = corot_integrator_statistics(it);
      printf("%s %g %g: steps %ld nfe %ld nni %ld nfac %ld: %s\n", m[k], tr, h, q.nst, q.nfe, q.nni, q.nfactor, s ? corot_error() : "");
      corot_integrator_destroy(it);
      bar_destroy(&b);
    }
}
int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(probe)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
