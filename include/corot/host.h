/* What makes an integrator of SUNDIALS that a host owns as good as corot's own: error weights that
   do not care how the body is turned, how often to make its matrices anew, which order, where to
   stop, what to do after a change, products and preconditioners for Krylov methods, and the
   callbacks of an equilibrium. On the paper's bar a CVODE with plain tolerances and order 5 takes a
   hundred times the steps of one that is set up so.

   The headers corot/sun_cvode.h, sun_ida.h, sun_arkode.h and sun_kinsol.h put all of it together on
   a host's own object; a host may as well call what it wants of these functions by itself. Nothing
   here refers to an integrator.

   A complete program: models/embedding/host_krylov.c. */
#ifndef COROT_HOST_H
#define COROT_HOST_H

#include <corot/solve.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- Error weights ---------------------------------------------------------------------------- */

/* A CVEwtFn, IDAEwtFn and ARKEwtFn: one weight for all displacements and one for all velocities,

     1 / (rtol * longest vector of a node + atol),

   by u and v of y [2n]. Unlike weights by component they do not change when the whole problem is
   turned, nor grow where a component passes through zero. user_data is a corot_sun_data with rtol
   and both atol set, as corot_sun_advise does. Not 0: the motion exceeds double precision, or
   these are not positive. */
COROT_API int corot_sun_weights(N_Vector y, N_Vector weight, void *user_data);

/* --- Settings --------------------------------------------------------------------------------- */

typedef enum corot_sun_method { COROT_SUN_CVODE, COROT_SUN_IDA, COROT_SUN_ARKODE } corot_sun_method;

/* What corot_integrator_defaults() would choose for a model and a tolerance, and why: the comments
   in src/solve/host/advice.c. */
typedef struct corot_sun_advice {
  double atol_displacement; /* [m] rtol * 0.01 * length of the model */
  double atol_velocity;     /* [m/s] that * frequency of the model */
  int max_order;            /* of BDF: 2, unless damping or tolerance make more pay. BDF of order 3
                               to 5 lets vibrations grow that nothing damps, and where more than 2 is
                               advised, stability limit detection is, too. Of arkode: the order */
  corot_tangent tangent;    /* for corot_pencil_use */
  int reassembly;           /* K and D anew at least every so many steps */
  int refactorisation;      /* S; ida has no such rule: 0 */
  double gamma_change;      /* S anew where gamma has changed by this fraction */
  double convergence;       /* Newton's error as a fraction of the tolerance */
  int error_failures;       /* failures of the error test in one step, at most */
  int newton_iterations;    /* of arkode, at most; else 0: SUNDIALS' own */
  int predictor;            /* of arkode; else 0 */
  const char *table;        /* of arkode, SUNDIALS' name of a Butcher table; else NULL */
} corot_sun_advice;

/* COROT_EINVAL: there is no model, or no such method; rtol is not positive and finite. */
COROT_API corot_status corot_sun_advise(const corot_model *model, corot_sun_method method, double rtol,
                              corot_sun_advice *advice);

/* --- Where to stop, and what to do there ------------------------------------------------------ */

typedef struct corot_sun_stop {
  double t;      /* [s] */
  bool kink;     /* a load or a motion has a kink there, or jumps: call corot_state_enter(state, t)
                    at the end of the step, and look whether to begin again (corot_sun_felt) */
  bool sets_out; /* an amplitude that rests sets out soon: begin again before this step, for the
                    history of the solution does not know of it */
} corot_sun_stop;

/* Where the next step from t must stop, at t_stop or before: at the next kink, and, of a step that
   is h long as far as is known (0: not at all), at corot_model_horizon(), so as not to pass over
   what amplitudes do meanwhile. Kinks that t has passed but for rounding are behind it. */
COROT_API corot_sun_stop corot_sun_next_stop(const corot_model *model, double t, double h, double t_stop);

/* Whether a multistep method feels that y' has jumped between two steps, as at a kink, after new
   frames, or after a change of what comes in at run time: whether more than half of the tolerance
   comes of it in the next step. jump [2n], overwritten: y' after it, less the derivative of the
   interpolant before; weight: the error weights; h_last, h_next: lengths of the last step, and the
   next. *h_first: the first step to begin again with, where it is felt; where not, error control
   deals with it. COROT_EINVAL: something is not there, or of another size; COROT_ENOMEM. */
COROT_API corot_status corot_sun_felt(corot_pencil *pencil, N_Vector jump, N_Vector weight, double t,
                            double h_last, double h_next, bool *felt, double *h_first);

/* --- An integrator of the host's, set up ------------------------------------------------------ */

/* The functions of one integrator of SUNDIALS; corot/sun_cvode.h, sun_ida.h and sun_arkode.h each
   fill one, so that the library itself refers to none. */
typedef struct corot_sun_host corot_sun_host;
typedef struct corot_sun_api {
  const char *name;
  corot_sun_method method;
  int stopped; /* what `advance` returns at the stop time */
  int (*advance)(corot_sun_host *host, double beyond, N_Vector y, sunrealtype *t); /* one step */
  int (*restart)(corot_sun_host *host, double t, N_Vector y);
  int (*set_stop_time)(void *memory, sunrealtype t);
  int (*set_first_step)(void *memory, sunrealtype h);
  int (*interpolate)(void *memory, sunrealtype t, int derivative, N_Vector dky);
  int (*last_step)(void *memory, sunrealtype *h);
  int (*next_step)(void *memory, sunrealtype *h);
  int (*error_weights)(void *memory, N_Vector weight);
  int (*failures)(void *memory, long *ncfn); /* of Newton's iteration */
} corot_sun_api;

/* A host's integrator with what it needs of ours: its user_data, and so it must stay where it is.
   Zero it, then call corot_sun_cvode_open (_ida_open, _arkode_open); in the end, after the
   integrator is freed or before, corot_sun_host_close. Read what you like, write nothing. */
struct corot_sun_host {
  corot_sun_data data; /* first, as user_data of corot_sun_rhs, corot_sun_weights, ... */
  const corot_sun_api *api;
  void *memory; /* the integrator, which the host creates and frees */
  corot_pencil *pencil;
  corot_sun_advice advice; /* as it was set */
  SUNMatrix A;
  SUNLinearSolver LS;
  void *controller; /* of arkode, from SUNDIALS 7 on */
  N_Vector yp;      /* of ida: the host's y' */
  N_Vector jump, old, weight;
  double t, stop;            /* reached; where the step must stop [s] */
  long nst;                  /* steps taken, over all restarts */
  long nrestart;             /* restarts after a change */
  bool fresh;                /* no step since it began */
  double longest;            /* step [s] */
  long ncfn, refused;        /* failures of Newton's iteration, and steps taken at the last one */
  long assembled, ncfn_then; /* of ida: when K and D were made, plus 1; failures by then */
};

/* What the _open functions begin with: vectors like y [2n], matrix and solver, advice, the
   tolerances in host->data that are zero, the tangent, the phase of the state (corot_state_enter).
   rtol 0: 1e-4. COROT_EINVAL: a model, state or pencil is missing, or another model's; y is not a
   serial vector [2n]; t is not finite; rtol is not positive. COROT_ENOMEM. Then there is nothing to
   close. */
COROT_API corot_status corot_sun_host_open(corot_sun_host *host, const corot_sun_api *api, void *memory,
                                 corot_pencil *pencil, const corot_sun_data *data, double t,
                                 N_Vector y);

/* Takes NULL, and zeroed ones. */
COROT_API void corot_sun_host_close(corot_sun_host *host);

/* One internal step from y, which is left at *t; never past t_stop, on which it lands if it comes
   near; at kinks and where amplitudes set out it stops and does what has to be done. Within a step
   the integrator's own GetDky tells. COROT_EINTEGRATE: SUNDIALS gave up, or its steps have shrunk
   to nothing because the body cannot be evaluated beyond; the message has its flag and our reason.
   COROT_EINVAL: t_stop is not after the time reached. COROT_ENOMEM. */
COROT_API corot_status corot_sun_host_step(corot_sun_host *host, double t_stop, N_Vector y, double *t);

/* Steps until t_stop. Failures as of corot_sun_host_step. */
COROT_API corot_status corot_sun_host_advance(corot_sun_host *host, double t_stop, N_Vector y);

/* Call this when r has changed at the time reached, as by other frames or what comes in at run time:
   the integrator begins again if it feels the jump (corot_sun_felt), and keeps its history if not.
   _loaded: by forces that do not depend on u and v, so that the matrices are as they were; _changed:
   these are made anew. Failures as of corot_sun_host_step. */
COROT_API corot_status corot_sun_host_changed(corot_sun_host *host, N_Vector y);
COROT_API corot_status corot_sun_host_loaded(corot_sun_host *host, N_Vector y);

/* Begins again at (t, y) that the host has set, with a first step of h [s]; 0: SUNDIALS chooses.
   Failures as of corot_sun_host_step. */
COROT_API corot_status corot_sun_host_restart(corot_sun_host *host, double t, N_Vector y, double h);

/* COROT_OK where flag >= 0; else COROT_EINTEGRATE, with `call`, the flag, and what corot_error() said
   last, which is the reason if a function of ours was it that failed. */
COROT_API corot_status corot_sun_judge(int flag, const char *call);

/* --- Krylov methods --------------------------------------------------------------------------- */

/* For a host whose linear solver is one of SUNDIALS' iterative ones (SPGMR, ...), as where the
   solid is a part of a larger system: products with the exact Jacobian, of which nothing is left
   out, and the pencil as the preconditioner. user_data is a corot_sun_data, with `pencil` for the
   latter two. They return what the functions of corot/solve.h do.

   CVLsJacTimesVecFn and ARKLsJacTimesVecFn; CVLsPrecSetupFn and ARKLsPrecSetupFn; CVLsPrecSolveFn
   and ARKLsPrecSolveFn, of I - gamma J, from the left as well as from the right: */
COROT_API int corot_sun_jtimes(N_Vector v, N_Vector Jv, sunrealtype t, N_Vector y, N_Vector fy,
                     void *user_data, N_Vector tmp);
COROT_API int corot_sun_psetup(sunrealtype t, N_Vector y, N_Vector fy, sunbooleantype jok,
                     sunbooleantype *jcur, sunrealtype gamma, void *user_data);
COROT_API int corot_sun_psolve(sunrealtype t, N_Vector y, N_Vector fy, N_Vector r, N_Vector z,
                     sunrealtype gamma, sunrealtype delta, int lr, void *user_data);

/* IDALsJacTimesVecFn, IDALsPrecSetupFn, IDALsPrecSolveFn, of dF/dy + cj dF/dy': */
COROT_API int corot_sun_jtimes_dae(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, N_Vector v,
                         N_Vector Jv, sunrealtype cj, void *user_data, N_Vector tmp1,
                         N_Vector tmp2);
COROT_API int corot_sun_psetup_dae(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, sunrealtype cj,
                         void *user_data);
COROT_API int corot_sun_psolve_dae(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, N_Vector r, N_Vector z,
                         sunrealtype cj, sunrealtype delta, void *user_data);

/* --- Equilibria ------------------------------------------------------------------------------- */

/* F(u) = -r(u) [n] of the state of user_data, a corot_sun_data, in which corot_state_stand_still
   has been called, with a pencil whose role is static: a KINSysFn. */
COROT_API int corot_sun_force(N_Vector u, N_Vector F, void *user_data);

/* A KINLsJacFn, whose user_data is not looked at, and the solver to go with it and
   corot_sun_matrix; NULL where memory ran out. The Jacobian is K = dF/du; where it is not positive
   definite, a clamped one takes its place, so that the iteration leads downhill to a stable
   equilibrium. */
COROT_API int corot_sun_jacobian_static(N_Vector u, N_Vector F, SUNMatrix A, void *user_data, N_Vector tmp1,
                              N_Vector tmp2);
COROT_API SUNLinearSolver corot_sun_linsol_static(corot_pencil *pencil, SUNContext ctx);

/* Forces by which an equilibrium is judged, at u [n] under the loads that the state stands under:
   *largest, the largest on a node (internal, a load, or a support's) [N]; *rounding, what rounding
   leaves of r's largest component [N], by the stiffness there. Assembles K. COROT_RETRY when a tet
   is inverted; COROT_EINVAL: the state does not stand still, or something is missing; COROT_ENOMEM.
 */
COROT_API corot_status corot_sun_force_scale(const corot_sun_data *data, const double *u, double *largest,
                                   double *rounding);

/* What corot/sun_kinsol.h needs: a host's KINSOL with scales, matrix and solver; as corot_sun_host.
 */
typedef struct corot_sun_rest {
  corot_sun_data data; /* first, as user_data */
  void *memory;        /* KINSOL, which the host creates and frees */
  SUNMatrix A;
  SUNLinearSolver LS;
  N_Vector u_scale, f_scale; /* [n] 1 / length of the model, 1 / largest force, everywhere */
} corot_sun_rest;

/* COROT_EINVAL: something is missing, another model's, or of another kind: u is a serial vector
   [n]. COROT_ENOMEM. Then there is nothing to close. The pencil's tangent becomes the exact one. */
COROT_API corot_status corot_sun_rest_open(corot_sun_rest *rest, void *memory, corot_pencil *pencil,
                                 const corot_sun_data *data, N_Vector u);

/* Takes NULL, and zeroed ones. */
COROT_API void corot_sun_rest_close(corot_sun_rest *rest);

/* KINLsJacTimesVecFn, KINLsPrecSetupFn, KINLsPrecSolveFn; as above. */
COROT_API int corot_sun_jtimes_static(N_Vector v, N_Vector Jv, N_Vector u, sunbooleantype *new_u,
                            void *user_data);
COROT_API int corot_sun_psetup_static(N_Vector u, N_Vector uscale, N_Vector F, N_Vector fscale,
                            void *user_data);
COROT_API int corot_sun_psolve_static(N_Vector u, N_Vector uscale, N_Vector F, N_Vector fscale, N_Vector v,
                            void *user_data);

#ifdef __cplusplus
}
#endif
#endif
