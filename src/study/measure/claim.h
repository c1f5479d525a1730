/* An error that is claimed, and how far: the size of a part, against what its reference is known
 * by. */
#ifndef COROT_STUDY_MEASURE_CLAIM_H
#define COROT_STUDY_MEASURE_CLAIM_H

#include "convergence.h"
#include "errors.h"

typedef enum claim_kind {
  CLAIM_MISSING,   /* a run failed */
  CLAIM_UNCHECKED, /* nobody knows how good the reference is */
  CLAIM_ABOUT,
  CLAIM_AT_LEAST,
  CLAIM_AT_MOST, /* below the floor */
  CLAIM_KINDS,
} claim_kind;

extern const char *const claim_words[CLAIM_KINDS];

/* One number that is claimed, and between which it is; NaN: not known. */
typedef struct claim_bound {
  claim_kind kind;
  double value, low, high, floor;
} claim_bound;

/* What is claimed of a part, or of a total. Zeroed to begin with. */
typedef struct claim {
  const trajectory *before, *after; /* NULL: not known; borrowed */
  errors error;                     /* n = 0: not known */
  errors shown;                     /* of space: what the levels have shown; else n = 0 */
  errors known;                     /* what the reference is known by; n = 0: nobody knows */
  errors rest;                      /* of space by order: what the reference's own mesh leaves */
  bool is_space, by_order;
  bool is_open; /* nobody knows how much larger it is: a mesh that is not asymptotic, a part missing
                 */
  int nlevel;   /* of space */
  convergence convergence; /* of space with three levels */
  trajectory made;         /* `after`, where it is extrapolated */
} claim;

/* The error of a mesh by its next one or two octasections: before, known and nlevel = 0 are given;
   `finest` may be NULL. Stores all the rest. The order is that of mean squares over time. */
corot_status claim_by_levels(yardstick *y, const trajectory *middle, const trajectory *finest,
                             claim *c);

/* The error of a mesh of four-node tets by the same tets with ten nodes, and by these refined once,
   `finer`, which may be NULL. Given and stored are the same. With a finer mesh that is the
   reference, and what it leaves is less than it changed: displacements of ten-node tets converge at
   an order of at least one, also near corners of supports. Where that is no better than half of the
   error, this is open. */
corot_status claim_by_order(yardstick *y, const trajectory *raised, const trajectory *finer,
                            claim *c);
/* The same of one number, its errors in the place of the displacement's: from q[0] to q[1] (nlevel
   0), or of a mesh of that order by its next one or two octasections, q [nlevel]. `known`: what
   they are known by, NaN: nobody knows; *limit: what they tend to. Errors are in the number's own
   unit; claim_scale() divides them by a size. */
corot_status claim_of_numbers(int mesh_order, int nlevel, const double *q, double known, claim *c,
                              double *limit);
void claim_scale(claim *c, double size);

/* Of error measure i (errors.h), over time or at the end. */
claim_bound claim_bounds(const claim *c, int i, bool end);

/* What is to be said of the displacement beside its number, such as "not asymptotic: at least
   0.27": into `text`. left_out: why there is no third level. */
void claim_verdict(const claim *c, const char *left_out, size_t size, char *text);

/* Distances of two runs, the second taken as exact; n = 0 where either is NULL. */
corot_status claim_distance(yardstick *y, const trajectory *run, const trajectory *reference,
                            errors *out);

void claim_free(claim *c);

#endif
