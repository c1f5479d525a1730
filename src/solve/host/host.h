/* What corot's own integrators share with a host's. */
#ifndef COROT_SOLVE_HOST_HOST_H
#define COROT_SOLVE_HOST_HOST_H

#include <corot/host.h>

#include "core/base/sisters.h"

typedef struct tolerance {
  double rtol, atol_displacement, atol_velocity;
} tolerance;

/* w [2n] of y [2n]. COROT_EINTEGRATE: the motion exceeds double precision. */
COROT_SISTERS corot_status corot_weigh(const corot_model *model, const tolerance *tol,
                                       const double *y, double *w);

/* The choices of corot_sun_advise where no step is longer than max_step (0: no limit). `moves`:
   supports do, those of the model or by inputs. */
COROT_SISTERS corot_sun_advice corot_advise(const corot_model *model, corot_sun_method method,
                                            double rtol, double max_step, bool moves);

/* Where a step from t, h long as far as is known (0: not at all), must stop: at t_stop, or before,
   at corot_model_horizon(). A step that goes past what an amplitude does has not seen it, and its
   error is not controlled. h_last: of the step that ended at t, by which rounding is judged. */
COROT_SISTERS double corot_sight(const corot_model *model, double t, double h_last, double h,
                                 double t_stop);

/* Whether a step that was to be h long, and now ends at `sight`, sets out from rest so much more
   slowly that the history of the solution is of no use: IDA's estimate of the error even falls with
   the ratio of the steps. */
COROT_SISTERS bool corot_sets_out(double t, double h, double sight, double t_stop);

/* A radian [s] of the transient that a change of r excites in modes too fast for a step, if it is
   more than the tolerance; else infinity. v, a = M^-1 r, change = M^-1 dr/dt [n] after it; weight:
   of a displacement; room: three arrays [n]. Failures as of corot_pencil_solve. */
COROT_SISTERS corot_status corot_transient(corot_pencil *pencil, const double *v, const double *a,
                                           const double *change, double weight,
                                           double *const room[3], double *radian);

/* The largest force on a node where the residual at u is r: internal, a load, or a support's [N]. f
   [nnode] is room for the internal ones. COROT_RETRY when a tet is inverted. */
COROT_SISTERS corot_status corot_largest_force(const corot_model *model, corot_state *state,
                                               double t, const double *u, const double *r,
                                               double (*f)[3], double *largest);

/* F is 1 plus differences of u over edges, so a nodal force, a sum over its tets, is off by about
   this times (longest edge + |u|) [N/m]: eps K_ii, of S as it was last combined. */
COROT_SISTERS double corot_rounding_of_forces(const corot_pencil *pencil);
COROT_SISTERS double corot_longest_edge(const corot_mesh *mesh);

#endif
