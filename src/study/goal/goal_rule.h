/* What values on ever finer meshes say about the error of the last one.

   With an error C h^p, h the size of the elements, three values give p, and what remains: of the
   last difference d the error is e = d / (r^p - 1), r the ratio of the last two sizes (Richardson's
   extrapolation). Where four meshes, each some 1.4 times as fine as the one before, look as if that
   were true, both triples of them leading to the same limit, the values are called asymptotic, and
   e is the estimate. (Where tets are cut locally the size is the third root of the number of
   unknowns, the order that is seen may be anything, and three meshes prove nothing; near a
   re-entrant corner it falls from mesh to mesh.)

   The truth is taken to be within 1.25 |e| of the last value where an order is seen; elsewhere
   within 3 |d| / (r - 1), of order one, whatever the order may be: the factors of safety of ASME
   V&V 20-2009, section 2-4 (P. J. Roache, Verification and Validation in Computational Science and
   Engineering, 1998, chapter 5).

   As long as values are not asymptotic, the estimate counts nine tenths of an order of 1.5 or less,
   all of one of 3 and more, which errs on the safe side where the order falls, to 2 x 0.54 at the
   corner of an L; where tets are cut locally three quarters, and none above 3.5.

   For half-widths more is taken away: they count 0.55 of the observed order, and none above 2.5;
   nor that the last difference has fallen faster than at order 3 (4, where tets are cut locally),
   which may be chance. The smooth part of an error vanishes first, and the order it vanishes with
   says little of what a singular corner leaves. With that the interval holds for any sum of a part
   of order 4 and one of order 1.2, whichever is the larger, and sizes in ratios from 1.2 to 2
   (tests/unit/test_goal_rule.c). */
#ifndef COROT_STUDY_GOAL_GOAL_RULE_H
#define COROT_STUDY_GOAL_GOAL_RULE_H

#include <stdbool.h>

/* Values of ten-node tets converge at up to order 4, near edges of supports at 1 to 1.5; what seems
   slower has not begun to, or never will. */
#define GOAL_LOWEST_ORDER 0.5
#define GOAL_HIGHEST_ORDER 5.0
#define GOAL_HIGHEST_ORDER_LOCAL 9.0
#define GOAL_CAUTIOUS_ORDER 2.5
#define GOAL_CAUTIOUS_FACTOR 0.55
#define GOAL_CAUTIOUS_FALL 3.0
#define GOAL_CAUTIOUS_FALL_LOCAL 4.0
#define GOAL_STRIDE 1.39   /* the ratio of sizes of which orders are seen to be the same */
#define GOAL_AGREEMENT 0.1 /* the limit may still move by so much, in parts of the estimate */

#define GOAL_SAFETY 1.25         /* asymptotic */
#define GOAL_SAFETY_UNPROVEN 3.0 /* not */
#define GOAL_SAFETY_ALONE 5.0    /* one mesh, beside four-node tets on it */

typedef struct goal_level {
  double value;
  double size; /* of the elements, in any unit */
} goal_level;

typedef struct goal_error {
  double estimate; /* the limit less the last value; NaN: not known */
  double half;     /* the truth is within this of the last value; infinite: not known */
  double order;    /* observed; NaN: none */
  bool asymptotic;
  bool settled;    /* the values differ by no more than what each is known by */
  bool diverging;  /* differences grow */
  const char *why; /* not asymptotic, static; NULL: it is */
} goal_error;

/* level [n], from coarse to fine, n >= 1; of them the last three count, and that none before has
   changed the other way; for what is asymptotic four that are far enough apart. `coarse`: the value
   of four-node tets on the mesh of the first level, NaN: not known; it counts where there is but
   one. `noise`: what each value is known by. `local`: the last mesh is one whose tets are cut where
   they are marked. */
goal_error goal_judge(int n, const goal_level *level, double coarse, double noise, bool local);

#endif
