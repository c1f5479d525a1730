/* Factors in time, of loads and of moving supports: corot_amplitude of corot/model.h made ready for
   evaluation. Nothing changes in an evaluation, so that a model can be shared. */
#ifndef COROT_CORE_MODEL_AMPLITUDE_H
#define COROT_CORE_MODEL_AMPLITUDE_H

#include <corot/model.h>

/* A time in which a spline goes one way, up or down. */
typedef struct amplitude_run {
  double begin, end;
} amplitude_run;

typedef struct amplitude {
  corot_curve curve;
  int n;                           /* points; 0, and not a sine: one at all times */
  double *time, *value;            /* [n] */
  double *slope;                   /* [n] of a spline at its points [1/s]; NULL: no spline */
  double least, most;              /* what it takes on */
  int nrun;                        /* of a spline */
  amplitude_run *run;              /* [nrun] ascending, apart where the spline rests */
  double frequency, phase, offset; /* of a sine */
} amplitude;

/* Of entry `index` of the list `entry`, "load" or "motion". COROT_EINVAL, with a fault (fault.h): a
   number is not finite, times fall back, or the spline through the points swings far beyond them.
 */
corot_status corot_amplitude_create(const corot_amplitude *from, const char *entry, int index,
                                    amplitude *to);

/* Frees what it holds. */
void corot_amplitude_clear(amplitude *a);

/* Its value at t, by the law in force just after the time `phase`, which goes on as it is beyond
   the kinks on either side; phase NaN: just after t. */
double corot_amplitude_at(const amplitude *a, double phase, double t);

/* Its derivative by time there [1/s]. */
double corot_amplitude_rate(const amplitude *a, double phase, double t);

/* Its second derivative there [1/s^2], which a spline has from its first point to its last. */
double corot_amplitude_second(const amplitude *a, double phase, double t);

/* The time of its first jump; NaN: it has none. */
double corot_amplitude_jump(const amplitude *a);

/* How many kinks it has, and the times of them with repetitions [corot_amplitude_nkink], ascending.
   Where it is smooth there are none. */
int corot_amplitude_nkink(const amplitude *a);
const double *corot_amplitude_kinks(const amplitude *a);

/* As corot_model_horizon, for this amplitude alone. */
double corot_amplitude_horizon(const amplitude *a, double t);

/* Bytes held beside the structure itself. */
size_t corot_amplitude_bytes(const amplitude *a);

#endif
