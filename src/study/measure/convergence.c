/* The observed order of three levels, and whether to believe it. */
#include "convergence.h"

#include <math.h>
#include <stddef.h>

static const char *doubt(const convergence *c, int mesh_order, double d1, double d2, double cosine,
                         double known) {
  if (!isfinite(d1) || !isfinite(d2)) return "a level is not known";
  if (!(d2 >= 10 * known)) return "the levels differ by less than ten times what they are known by";
  if (cosine < 0) return "the differences of the levels alternate";
  if (d2 >= d1) return "the second difference of the levels is not smaller than the first";
  if (c->order < CONVERGENCE_LOWEST)
    return "the second difference of the levels is hardly smaller than the first";
  if (mesh_order == 1 && c->order > CONVERGENCE_HIGHEST)
    return "the levels converge faster than linear tets do";
  if (c->order > CONVERGENCE_HIGHEST_2) return "the levels converge faster than ten-node tets do";
  return NULL;
}

convergence convergence_observe_of(int mesh_order, double d1, double d2, double cosine,
                                   double known) {
  convergence c = {.order = d1 > 0 && d2 > 0 ? log2(d1 / d2) : NAN};
  c.why = doubt(&c, mesh_order, d1, d2, cosine, known);
  c.asymptotic = !c.why;
  if (c.asymptotic) c.remainder = 1 / (exp2(c.order) - 1);
  return c;
}

convergence convergence_observe(double d1, double d2, double cosine, double known) {
  return convergence_observe_of(1, d1, d2, cosine, known);
}
