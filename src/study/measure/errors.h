/* How far one solution is from another of the same solid, and a solution from its own books.

   All solutions are sampled at the output times, which the two must share, the last one in any
   case. What is compared are the degrees of freedom of the model at hand, M its mass and K its
   stiffness at rest:

     displacement  |u - r|_M over the largest |r|_M,  |u|_M = sqrt(u' M u), r the reference
     velocity      the same of v
     energy        sqrt((u - r)' K (u - r) / 2) over the largest sqrt(r' K r / 2): a norm of the
                   strains, which sees what is rough; of a body that has turned K is not the
                   tangent, but still a norm
     mixed         the largest |y - r| / (a + |r|) of the components of y = (u, v), where
                   a = 0.01 length of the model for u, times its frequency for v, as in the
                   tolerances that `auto` stands for (include/corot/integrate.h); -log10 of it at
                   the end is "mescd", the mixed error significant correct digits of the Test Set
                   for IVP Solvers (Mazzia & Magherini, release 2.4, 2008)
     probe.NAME    |u - r| at the point or node of a probe that is its displacement [m]

   each at the end, and the largest over time. The reference may be of a finer mesh: its nodes begin
   with those of the coarser. */
#ifndef COROT_STUDY_MEASURE_ERRORS_H
#define COROT_STUDY_MEASURE_ERRORS_H

#include <stdbool.h>

#include "app/folder/states.h"
#include "app/scenario/scenario.h"

enum { ERROR_DISPLACEMENT, ERROR_VELOCITY, ERROR_ENERGY, ERROR_MIXED, ERROR_PROBES };
extern const char *const error_words[ERROR_PROBES];

/* The error of that name; -1: there is none. */
int error_named(const char *name);

typedef struct error_pair {
  double max, end; /* over time; at the last time */
} error_pair;

/* One rule of floors for all that is claimed: an error is rated if it is at least so many times
   what its reference is known by; below that it is said to be below the floor, and nothing else. */
#define ERROR_FLOOR 10.0

/* known: how far the reference is from the truth, as far as is known; NaN: nobody knows. */
bool is_rated(const error_pair *error, const error_pair *known, bool end);

/* error / scale; where there is no scale, as the reference does not move, an error is infinite. */
double error_relative(double error, double scale);

typedef struct errors {
  int n;          /* ERROR_PROBES and the number of such probes */
  error_pair *of; /* [n] */
  double parting; /* the first time at which the displacement's exceeds 1e-3 [s]; NaN: none */
} errors;

/* What errors of one solid are measured with. */
typedef struct yardstick {
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  double (*stiffness)[9]; /* K at rest, as blocks */
  int nprobe;
  const probe_def **probe_def; /* [nprobe] those of the scenario that are displacements of a point
                                  or a node */
  corot_location *probe;       /* [nprobe] */
  double *work;                /* [3][n] */
} yardstick;

/* The scenario must outlive it. */
corot_status yardstick_create(const scenario *s, yardstick **out);
void yardstick_destroy(yardstick *y);

/* `run` is of the yardstick's own model; the reference has its degrees of freedom at least.
   COROT_EINVAL: they do not fit together. */
corot_status errors_measure(yardstick *y, const trajectory *run, const trajectory *reference,
                            errors *out);
corot_status errors_copy(const errors *e, errors *out);
void errors_free(errors *e);

/* Component c of x [n], a displacement or a difference of two, at probe k. */
double yardstick_probe(const yardstick *y, int k, int c, const double *x);

/* x' M z, each [n]. */
double yardstick_product(yardstick *y, const double *x, const double *z);

/* What ought to be conserved, NaN where it is not known or cannot be said:

     energy    the largest imbalance of the energy over the largest kinetic + elastic + dissipated
     momentum  of a body without supports, pressures and mass damping: the largest distance of its
               momentum from the impulse of its loads, over the largest of these */
typedef struct drift {
  double energy, momentum;
} drift;

/* From DIR/energy.csv. */
corot_status drift_measure(yardstick *y, const scenario *s, const char *dir, drift *out);

#endif
