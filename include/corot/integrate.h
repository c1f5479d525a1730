/* Integration in time with error control, one step at a time, so that the caller can act between
   steps: output, frame updates, a change of load.

   A complete program: tests/examples/integrate.c. */
#ifndef COROT_INTEGRATE_H
#define COROT_INTEGRATE_H

#include <corot/solve.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a step of a fixed-step method is solved. */
typedef enum corot_solution {
  COROT_SOLUTION_NEWTON, /* with backtracking, to a tolerance */
  COROT_SOLUTION_LINEAR, /* one solve: exact, with one matrix, while the frames are held if
                            corot_model_matrices_by_frames, else Newton's first iteration, with a
                            matrix of its own each step */
} corot_solution;

/* What a method of integration is like: which of the settings below are its own. */
typedef struct corot_method_kind {
  const char *name;
  bool controls_error;      /* chooses its steps by rtol; else: of constant step */
  bool multistep;           /* BDF of changing order, at most max_order */
  bool stages;              /* Runge-Kutta: order, or table */
  bool explicit_steps;      /* without linear systems */
  int order_min, order_max; /* of what it can do */
  double gamma_change_below; /* what gamma_change must be less than; 0: any will do */
  double radius_min;        /* least spectral_radius it can do with */
} corot_method_kind;

/* The methods, i = 0, 1, ...; NULL beyond the last. */
COROT_API const corot_method_kind *corot_method_at(int i);

/* The one of this name; NULL: there is none. */
COROT_API const corot_method_kind *corot_method_traits(const char *name);

/* How to integrate. Zero means "choose" wherever the comment says so. Methods:
     cvode              BDF of order 1 to 5, steps and order chosen by error control
     ida                the same with fixed leading coefficient, on the residual M v' - r
     arkode             diagonally implicit Runge-Kutta of one order, 2 to 5, steps by error control
     erk                explicit Runge-Kutta of one order, 2 to 8, steps by error control: for coarse
                        soft meshes, and as a reference without any Newton iteration
     backward-euler, bdf2, bdf3, midpoint, newmark, hht, generalized-alpha
                        of constant step, without error control: baselines */
typedef struct corot_integrator_def {
  size_t bytes; /* sizeof of this, as the defaults set it: see corot/base.h */
  const char *method;
  corot_linear_def linear;
  double rtol;               /* relative tolerance, > 0 */
  double atol_displacement;  /* [m]; 0: rtol * 0.01 * length of the model */
  double atol_velocity;      /* [m/s]; 0: atol_displacement * frequency of the model */
  int max_order;             /* cvode, ida: 1 to 5; 0: 2, more where damping or tolerance make it
                                pay */
  int order;                 /* arkode, erk; 0: choose */
  const char *table;         /* arkode, erk: SUNDIALS' name of a Butcher table; NULL: by order */
  int predictor;             /* arkode: ARKStepSetPredictorMethod's; -1: choose */
  long max_steps;            /* for the whole run; 0: no limit */
  double first_step;         /* [s]; 0: choose */
  double min_step;           /* [s]; 0: none */
  double max_step;           /* [s]; 0: none */
  corot_tangent tangent;     /* the frames' part in K; COROT_TANGENT_AUTO: choose */
  int reassembly;            /* K and D at least every so many steps; 0: choose */
  int refactorisation;       /* S at least every so many steps; 0: choose. ida has no such rule */
  double gamma_change;       /* refactor when gamma has changed by this fraction (ida: < 1);
                                0: choose */
  double convergence;        /* Newton's error as a fraction of the tolerance; 0: choose */
  double step;               /* [s] of a fixed-step method, > 0 */
  corot_solution solution;   /* of a fixed-step method */
  double newton_tolerance;   /* of Newton's last correction, in lengths of the model, > 0 */
  int newton_iterations;     /* at most so many in a step, > 0 */
  double spectral_radius;    /* 0 to 1, at infinite frequency: hht (from 1/2), generalized-alpha */
} corot_integrator_def;

/* cvode, rtol 1e-4, everything that can be chosen left to choose; Newton of the methods of constant
   step to 1e-9 in 50 iterations, spectral radius 0.8. */
COROT_API void corot_integrator_set_defaults(corot_integrator_def *def, size_t bytes);
static inline corot_integrator_def corot_integrator_defaults(void) {
  corot_integrator_def def;
  corot_integrator_set_defaults(&def, sizeof def);
  return def;
}

/* Whether the method of that name controls its error (and so chooses its own steps). */
COROT_API bool corot_integrator_controls_error(const char *method);

typedef struct corot_integrator corot_integrator;

/* Starts at (t, u, v), and enters t (corot_state_enter), unless a step is to cross a kink. Model and state must outlive the integrator; nothing else is kept.
   COROT_EINVAL: there is no method of that name, a setting is out of its range, t, u or v is not
   finite, or as for corot_pencil_create. COROT_ENOMEM. COROT_EINTEGRATE: SUNDIALS refuses a setting.
   COROT_RETRY: newmark, hht and generalized-alpha, which need the acceleration at the start, find a
   tet inverted. */
COROT_API corot_status corot_integrator_create(const corot_integrator_def *def,
                                               const corot_model *model, corot_state *state,
                                               double t, const double *u, const double *v,
                                               corot_integrator **integrator);

/* Takes NULL. */
COROT_API void corot_integrator_destroy(corot_integrator *integrator);

/* The time reached [s]: where it began, the end of the last step, or where a state was restored. */
COROT_API double corot_integrator_time(const corot_integrator *integrator);

/* One internal step. */
typedef struct corot_step {
  double t;     /* reached [s] */
  double h;     /* length [s] */
  int order;
  double error; /* estimated local error in the weighted norm; 1 is the tolerance */
  int newton;   /* nonlinear iterations */
} corot_step;

/* Advances by one step. With error control it does not go past t_stop and lands on it if it comes
   near; where t_stop is t up to rounding it is reached without a step. Nor does it go past
   corot_model_horizon(). A fixed-step method keeps to its own grid, whatever t_stop.
   COROT_EINTEGRATE: the integrator gave up, or has taken max_steps; the message names its reason and
   the element, if one was inverted. COROT_EINVAL: t_stop is not after the time reached. COROT_ENOMEM.
   Whatever the failure, the state last reached remains readable. */
COROT_API corot_status corot_integrator_step(corot_integrator *integrator, double t_stop,
                                             corot_step *step);

/* u and v [n] at any t within the last step; NULL skips one. After a restart only the end of that
   step is left. cvode and ida: the method's own interpolant. arkode and erk: Hermite's polynomial of
   degree 5 through u, v and the acceleration at both ends, v its derivative (to order 3, Hermite's
   cubic through v and the acceleration); of arkode, in the modes too fast for the step, by a
   polynomial through the displacements of the stages, so that it is right for stiff bodies, too.
   COROT_EINVAL: t is not within the last step. COROT_EINTEGRATE: r cannot be evaluated inside the
   step, or SUNDIALS refuses. COROT_ENOMEM. */
COROT_API corot_status corot_integrator_at(corot_integrator *integrator, double t, double *u,
                                           double *v);

/* Work integrals from the start to t, t within the last step: dissipated and external work [J].
   cvode and ida: of the loads by Lobatto's rule along the interpolant; what dissipates from the
   powers at the ends of the steps, or where these do not tell it, along the interpolant, too. arkode
   and erk: by Lobatto's rule along the interpolant, or where it is not all resolved by the table's
   own sum over the stages. Where all supports turn or translate as one, their work is what changes
   in the momentum they carry (corot_energies.carried), which no force at their nodes blurs. Failures
   as of corot_integrator_at. */
COROT_API corot_status corot_integrator_work(corot_integrator *integrator, double t,
                                             double *dissipated, double *external);

/* Energies and powers at the end of the last step, with the frames of that step if it is asked
   before they are updated; `u` and `v` [n] are those of corot_integrator_at there. cvode, ida and the
   methods of constant step have them from the step; with the others it is one corot_energy, with its
   failure, COROT_RETRY. */
COROT_API corot_status corot_integrator_energy(corot_integrator *integrator, const double *u,
                                               const double *v, corot_energies *energies);

/* What to do with the history of the solution when r has jumped between steps. */
typedef enum corot_history {
  COROT_HISTORY_AUTO,    /* restart if the jump is felt at the tolerance (see multistep.c); bdf2 and
                            bdf3, which have none, keep it, and are of first order over the jump */
  COROT_HISTORY_KEEP,
  COROT_HISTORY_RESTART, /* begin again at order 1 */
} corot_history;

/* Call this after a change of the held frames or of the state's inputs (corot/inputs.h), at the end of
   a step. Where only forces or factors of loads have changed, it is no more than a comparison of the
   loads; K and D are assembled anew only where frames, materials or a feedback have. COROT_EINTEGRATE:
   r cannot be evaluated after the change, or SUNDIALS refuses to begin again. COROT_ENOMEM.
   COROT_RETRY: materials have changed, and a tet is inverted. */
COROT_API corot_status corot_integrator_changed(corot_integrator *integrator,
                                                corot_history history);

/* Call this at a kink of a load or motion (corot_model_kinks), at the end of the step that stops
   there and after corot_state_enter: COROT_HISTORY_AUTO, with the matrices kept, which know of
   positions only. A multistep method begins again where r has jumped and the next step feels it; a
   Runge-Kutta method takes the new r, and a shorter step where the kink excites vibrations above
   the tolerance which that step would not resolve. A method of constant step has nothing to do: over
   a jump of a load the multistep ones and Newmark's family are of first order.
   Failures as of corot_integrator_changed. */
COROT_API corot_status corot_integrator_kink(corot_integrator *integrator);

/* --- Frames that follow the body between steps ------------------------------------------------ */

/* Asked after each step that no other condition ends with an update; true: update the frames now.
   u and v [n] at t; `drift` is how far the frames in use are from the body's. */
typedef bool corot_frame_hook(void *data, double t, const double *u, const double *v,
                              const corot_frames_change *drift);

/* When held or extrapolated frames are found anew. Any of the conditions suffices. */
typedef struct corot_frame_policy {
  size_t bytes; /* sizeof of this, as the defaults set it: see corot/base.h */
  corot_frames frames;   /* exact: none of the rest matters */
  bool every_step;
  double interval;       /* [s] at its multiples; 0: no */
  double max_angle;      /* [rad] after a step that leaves a tet's frame off by more; 0: no */
  corot_history history; /* what the integrator does with its past after an update */
  corot_frame_hook *hook; /* or NULL */
  void *hook_data;
} corot_frame_policy;

/* Exact frames; history auto. */
COROT_API void corot_frame_policy_set_defaults(corot_frame_policy *def, size_t bytes);
static inline corot_frame_policy corot_frame_policy_defaults(void) {
  corot_frame_policy def;
  corot_frame_policy_set_defaults(&def, sizeof def);
  return def;
}

/* Extrapolated frames are never turned further than this from where they were found, but for the
   rest of a constant step: an update is forced there [rad]. */
#define COROT_EXTRAPOLATION_CAP 0.1

typedef enum corot_frame_reason {
  COROT_FRAMES_KEPT = 0, /* no update */
  COROT_FRAMES_BY_STEP,
  COROT_FRAMES_BY_INTERVAL,
  COROT_FRAMES_BY_ANGLE,
  COROT_FRAMES_BY_CAP,
  COROT_FRAMES_BY_HOOK,
} corot_frame_reason;

typedef struct corot_frame_event {
  corot_frame_reason reason;
  corot_frames_change change; /* by the update */
  bool restarted;             /* the integrator began again */
} corot_frame_event;

/* Carries a policy out on one integrator. */
typedef struct corot_frame_clock corot_frame_clock;

/* Puts the state on the policy's frames, found at (t, u, v), where the integrator starts. Model,
   state and integrator must outlive the clock. COROT_EINVAL: an interval or angle is negative, or
   held frames have no condition to be updated by. COROT_RETRY when a tet is inverted at the start.
   COROT_ENOMEM. */
COROT_API corot_status corot_frame_clock_create(const corot_frame_policy *policy,
                                                const corot_model *model, corot_state *state,
                                                corot_integrator *integrator, double t,
                                                const double *u, const double *v,
                                                corot_frame_clock **clock);

/* Takes NULL. */
COROT_API void corot_frame_clock_destroy(corot_frame_clock *clock);

/* The next time the integrator must stop for an update; INFINITY: none is fixed. */
COROT_API double corot_frame_clock_stop(const corot_frame_clock *clock);

/* Call this at the end of each step, at t: it updates the frames if it is time, and tells the
   integrator. COROT_RETRY when a tet is inverted, with the frames as they were; else failures as of
   corot_integrator_at and corot_integrator_changed. */
COROT_API corot_status corot_frame_clock_tick(corot_frame_clock *clock, double t,
                                              corot_frame_event *event);

/* --- Statistics ------------------------------------------------------------------------------- */

/* Statistics of the whole run, restarts included, under SUNDIALS' own names. */
typedef struct corot_statistics {
  long nst;     /* steps */
  long nfe;     /* evaluations of the right-hand side by the integrator */
  long nsetups; /* linear solver set-ups */
  long netf;    /* error test failures */
  long nni;     /* nonlinear iterations */
  long ncfn;    /* nonlinear convergence failures */
  long nje;     /* Jacobian evaluations (K and D) */
  long nli;     /* linear iterations; 0 for direct solvers */
  long nfactor, nsolve, nfresh, nindefinite, nclamped, nfallback; /* of the pencil */
  long nlsfail; /* linear solves that failed: the step was repeated with a shorter one, or ended */
  long nfeQ;     /* evaluations of the work integrands */
  long nrestart; /* restarts after a change */
  double hlast;  /* last step [s] */
  int qlast;     /* its order */
  /* Wall time by phase [s]; `integrator_s` is what the others leave of the steps: vectors, error
     control. */
  double force_s, assembly_s, combine_s, factor_s, solve_s, work_s, integrator_s;
} corot_statistics;

COROT_API corot_statistics corot_integrator_statistics(const corot_integrator *integrator);

/* What was chosen where the definition left it open; zero where the method has no such thing. */
typedef struct corot_integrator_choice {
  const char *method;
  const char *linear_solver; /* its name in full, e.g. "cholmod supernodal, amd"; "none" */
  const char *table;         /* of arkode and erk; else "" */
  double atol_displacement, atol_velocity;
  int max_order; /* or the order of arkode, erk */
  corot_tangent tangent;
  int reassembly, refactorisation, predictor;
  double gamma_change, convergence;
} corot_integrator_choice;

COROT_API corot_integrator_choice corot_integrator_chosen(const corot_integrator *integrator);

#ifdef __cplusplus
}
#endif
#endif
