/* Eigenfrequencies and modes: the small vibrations of a body about rest or about an equilibrium,

     K x = w^2 M x,   K = -dr/du there with exact frames, M the model's mass in use

   on the free degrees of freedom; supports stand still. K is symmetric: of a pressure it has the
   symmetric part (corot_load_stiffness), and damping is left out. At rest all strain measures have
   the same K, and so the same modes. About an equilibrium it has the stress's part, so that a
   pressed column sounds lower the nearer its load is to Euler's; beyond that w^2 is negative, and
   the mode grows as e^(g t), g = sqrt(-w^2).

   The modes of least w^2 are found by ARPACK (Lehoucq, Sorensen & Yang 1998: implicitly restarted
   Lanczos) in the inverse of K - s M, factored once, where the shift s lies below all of w^2: the
   factor itself proves that. Rigid motions that no support hinders are known beforehand and kept
   out of the search, and a last search beside all modes found makes sure that none is missed, as one
   of two equal ones may be. The same call gives the same bits.

   A complete program: tests/examples/modes.c. */
#ifndef COROT_MODES_H
#define COROT_MODES_H

#include <corot/solve.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct corot_modes_def {
  size_t bytes; /* sizeof of this, as the defaults set it: see corot/base.h */
  int count;               /* modes wanted, > 0 and less than the degrees of freedom */
  corot_linear_def linear; /* "auto": the best direct solver; else a direct one */
  double tolerance;        /* of 1/(w^2 - s) in ARPACK, relative, > 0 */
  int max_restarts;        /* of Lanczos's iteration, > 0 */
  bool (*stop)(void *data); /* asked at every solution; true: end with COROT_EINTEGRATE. Or NULL. It
                               must not look for modes itself */
  void *stop_data;
} corot_modes_def;

/* Ten modes, the linear solver "auto", tolerance 1e-12, 300 restarts. */
COROT_API void corot_modes_set_defaults(corot_modes_def *def, size_t bytes);
static inline corot_modes_def corot_modes_defaults(void) {
  corot_modes_def def;
  corot_modes_set_defaults(&def, sizeof def);
  return def;
}

/* Whether this build has ARPACK. */
COROT_API bool corot_modes_available(void);

typedef struct corot_mode {
  double eigenvalue; /* w^2 [1/s^2]; 0: a rigid motion, or nothing but rounding; < 0: unstable */
  double frequency;  /* w / 2 pi [Hz]; 0 unless w^2 > 0 */
  double growth;     /* sqrt(-w^2) [1/s] of an unstable one; else 0 */
  double residual;   /* |K x - w^2 M x| / |K x|; where w^2 is 0, |K x| / (largest K_ii |x|) */
  double effective_mass[3]; /* (x' M e)^2, e a unit motion of all that is free along x, y, z [kg]:
                               what of the mass follows a support shaken that way. Over all modes
                               they add up to e' M e */
  const double *shape; /* [n] x, with x' M x = 1 kg m^2; the largest component is positive. Of modes
                          with equal frequencies any mixture is one */
} corot_mode;

typedef struct corot_modes corot_modes;

/* The modes about u [n] under the loads of time t, where the supports stand as at t; NULL: about
   rest, without loads. u is taken as it is: whoever has an equilibrium has it from corot/statics.h.
   The model must outlive the modes.

   ARPACK keeps its place in variables of its own: calls from several threads take turns, and nobody
   else in the process may use it meanwhile.

   COROT_EINVAL: this build has no ARPACK; the definition makes no sense; there are not so many
   modes; u is not finite; supports are displaced at rest; K of this model is not all there (that of
   a hierarchy, or of warp, away from rest; with COROT_COUPLING_ONE_WAY anywhere), or as for
   corot_pencil_create. COROT_RETRY: a tet is inverted. COROT_ESINGULAR: no shift was found.
   COROT_EINTEGRATE: ARPACK did not converge within max_restarts, or was stopped. COROT_ENOMEM. */
COROT_API corot_status corot_modes_find(const corot_modes_def *def, const corot_model *model,
                                        double t, const double *u, corot_modes **modes);

/* What corot_modes_find refuses without a look at u: COROT_EINVAL, but for what u or the supports are
   at fault for. For who has an equilibrium to find first. */
COROT_API corot_status corot_modes_check(const corot_modes_def *def, const corot_model *model,
                                         double t, bool at_rest);

/* Takes NULL. */
COROT_API void corot_modes_destroy(corot_modes *modes);

/* Mode i = 0, 1, ... below corot_modes_count, by ascending w^2; its shape belongs to `modes`. */
COROT_API corot_mode corot_modes_at(const corot_modes *modes, int i);
COROT_API int corot_modes_count(const corot_modes *modes);

/* About all of them. */
typedef struct corot_modes_facts {
  int nrigid;         /* rigid motions that nothing hinders, of which modes are those with w^2 = 0 */
  double zero;        /* w^2 below this in size is rounding, and reported as 0 [1/s^2] */
  double shift;       /* s [1/s^2] */
  double asymmetry;   /* what the symmetric K leaves out of the derivative of r between two modes, at
                         most, over the larger w^2 of the two: no w^2 is further off than this part of
                         the largest, by these modes */
  const char *solver; /* the linear solver's name in full */
  long nsolve, nfactor, nrestart;
  double assembly_s, factor_s, solve_s, other_s; /* wall time [s] */
} corot_modes_facts;

COROT_API corot_modes_facts corot_modes_known(const corot_modes *modes);

#ifdef __cplusplus
}
#endif
#endif
