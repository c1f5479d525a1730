/* A host whose integrators are the GNU Scientific Library's: gsl_odeiv2, whose implicit steppers
   ask for a dense Jacobian of all 2n unknowns, so that its explicit ones are what suits a solid, as
   long as its mesh is coarse and its material soft. Needs corot::core alone. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <string.h>

#include "bar.h"

typedef struct solid {
  corot_model *model;
  corot_state *state;
} solid;

/* GSL takes a failure that is not GSL_EBADFUNC for a step that was too long, as an inverted tet is.
 */
static int rate(double t, const double y[], double ydot[], void *parameters) {
  const solid *s = parameters;
  corot_status status = corot_rhs(s->model, s->state, t, y, ydot);
  return status < 0 ? GSL_EBADFUNC : status > 0 ? GSL_FAILURE : GSL_SUCCESS;
}

int main(void) {
  solid s = {.model = bar_create()};
  check(corot_state_create(s.model, &s.state));
  size_t n = 2 * (size_t)corot_model_ndof(s.model);
  double *y = calloc(n, sizeof *y); /* (u, v), at rest */
  if (!y) return 1;

  /* Fehlberg's method of order 8; 1e-8 m as the tolerance of each step */
  gsl_odeiv2_system system = {rate, NULL, n, &s};
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-4, 1e-8, 0);

  /* to the load's kink, and on from there: GSL does not know of it */
  double t = 0, kink = 0;
  while (t < T_END) {
    double stop = corot_model_kinks(s.model, t, T_END, 1, &kink) > 0 ? kink : T_END;
    corot_state_enter(s.state, t);
    int status = gsl_odeiv2_driver_apply(driver, &t, stop, y);
    if (status != GSL_SUCCESS) {
      fprintf(stderr, "gsl: %s; corot: %s\n", gsl_strerror(status), corot_error());
      return 1;
    }
  }
  bar_print(s.model, y);
  fprintf(stderr, "%lu steps\n", driver->n);

  gsl_odeiv2_driver_free(driver);
  free(y);
  corot_state_destroy(s.state);
  corot_model_destroy(s.model);
}
