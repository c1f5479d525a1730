/* Observed orders, and factors of safety. */
#include "goal_rule.h"

#include <math.h>
#include <stddef.h>

/* (a^p - b^p) / (b^p - c^p) of sizes a > b > c, which grows with p: where it is `ratio`. 0: nowhere
   above 0.01; infinite: nowhere below 20. */
static double order_of(const double size[3], double ratio) {
  double low = 0.01, high = 20;
  for (int i = 0; i < 60; i++) {
    double p = (low + high) / 2, a = pow(size[0] / size[1], p), c = pow(size[2] / size[1], p);
    if ((a - 1) / (1 - c) < ratio)
      low = p;
    else
      high = p;
  }
  return low < 0.011 ? 0 : high > 19.9 ? INFINITY : low;
}

/* What remains of the last difference at order p. */
static double remainder_of(double ratio, double p) { return 1 / (pow(ratio, p) - 1); }

static double highest_order(bool local) {
  return local ? GOAL_HIGHEST_ORDER_LOCAL : GOAL_HIGHEST_ORDER;
}

static const char *doubt(double d1, double d2, double order, bool local) {
  if (!isfinite(d1) || !isfinite(d2)) return "a mesh has no value";
  if (d1 * d2 < 0) return "the values alternate from mesh to mesh";
  if (order == 0) return "the values do not settle as the mesh is refined";
  if (!(order >= GOAL_LOWEST_ORDER)) return "the values hardly settle as the mesh is refined";
  if (order > highest_order(local)) return "the values settle faster than ten-node tets can";
  return NULL;
}

/* By one mesh: four-node tets on it are further off than ten-node ones. */
static goal_error judge_one(const goal_level *level, double coarse) {
  double d = fabs(level->value - coarse);
  return (goal_error){.estimate = NAN,
                      .half = isfinite(d) ? GOAL_SAFETY_ALONE * d : INFINITY,
                      .order = NAN,
                      .why = "there is but one mesh of ten-node tets"};
}

/* Whether an earlier difference, no smaller than the last, has the other sign. */
static bool has_turned(int n, const goal_level *level, double d2) {
  for (int i = 1; i < n - 1; i++) {
    double d = level[i].value - level[i - 1].value;
    if (d * d2 < 0 && fabs(d) >= fabs(d2)) return true;
  }
  return false;
}

/* Without an order to believe in. */
static void widen(goal_error *e, double d1, double d2, double ratio) {
  double d = isfinite(d1) ? fmax(fabs(d2), fabs(d1) / ratio) : fabs(d2);
  e->estimate = NAN;
  e->half = isfinite(d) ? GOAL_SAFETY_UNPROVEN * d * fmax(1, remainder_of(ratio, 1)) : INFINITY;
  if (e->diverging || d1 * d2 < 0) e->half = fmax(e->half, 2 * (fabs(d1) + fabs(d2)));
}

/* The order that an estimate counts, of one that is seen. */
static double counted(double order, bool local) {
  if (local) return fmin(0.75 * order, 3.5);
  return order * (1 - 0.1 * fmin(1, fmax(0, 3 - order) / 1.5));
}

/* What the last three meshes say, if they converge. */
static void extrapolate(goal_error *e, double d1, double d2, double ratio, double noise,
                        bool local) {
  double cautious = fmin(GOAL_CAUTIOUS_FACTOR * e->order, GOAL_CAUTIOUS_ORDER);
  double fall = local ? GOAL_CAUTIOUS_FALL_LOCAL : GOAL_CAUTIOUS_FALL;
  double least = fabs(d1) * pow(ratio, -fall);
  e->estimate = d2 * remainder_of(ratio, counted(e->order, local));
  e->half = GOAL_SAFETY * fmax(fmax(fabs(d2), least), noise) * remainder_of(ratio, cautious);
}

/* A last difference that seems too small may be larger by what the values are known by. */
static double seen_order(const double size[3], double d1, double d2, double noise, bool local) {
  if (!(d1 * d2 > 0)) return NAN;
  double order = order_of(size, d1 / d2);
  if (order <= highest_order(local)) return order;
  return order_of(size, fabs(d1) / (fabs(d2) + noise));
}

/* Of three meshes and more, that are not settled: whether the last three seem to converge. */
static goal_error judge_three(int n, const goal_level *level, double noise, bool local) {
  const goal_level *last = level + n - 1;
  const double size[3] = {last[-2].size, last[-1].size, last[0].size};
  double d1 = last[-1].value - last[-2].value, d2 = last[0].value - last[-1].value;
  goal_error e = {.order = seen_order(size, d1, d2, noise, local)};
  e.why = doubt(d1, d2, e.order, local);
  if (!e.why && has_turned(n, level, d2)) e.why = "the values have turned, and may do so again";
  e.diverging = e.order == 0;
  if (e.why)
    widen(&e, d1, d2, size[1] / size[2]);
  else
    extrapolate(&e, d1, d2, size[1] / size[2], noise, local);
  return e;
}

/* Of the levels, from fine to coarse, those that are each coarser than the one before by a factor
   that lets an order be seen: pick [4]. Returns their number. */
static int pick_strides(int n, const goal_level *level, goal_level pick[4]) {
  int count = 0;
  for (int i = n - 1; i >= 0 && count < 4; i--)
    if (count == 0 || level[i].size >= GOAL_STRIDE * pick[count - 1].size) pick[count++] = level[i];
  return count;
}

/* Richardson's extrapolation of three, from fine to coarse, of an order that is taken as it is
   seen: what remains. NaN: they do not converge. */
static double richardson(const goal_level *fine, bool local, double *order) {
  const double size[3] = {fine[2].size, fine[1].size, fine[0].size};
  double d1 = fine[1].value - fine[2].value, d2 = fine[0].value - fine[1].value;
  *order = d1 * d2 > 0 ? order_of(size, d1 / d2) : NAN;
  if (!(*order >= GOAL_LOWEST_ORDER && *order <= highest_order(local))) return NAN;
  return d2 * remainder_of(size[1] / size[2], *order);
}

/* Three meshes always have an order; a fourth has to lead to the same limit: what that has moved by
   goes on at order two. */
static void ask_for_four(int n, const goal_level *level, bool local, goal_error *e) {
  goal_level pick[4];
  double order, before;
  int count = pick_strides(n, level, pick);
  e->why = "three meshes of ten-node tets are no proof, a fourth has to lead to the same limit";
  if (count < 4) return;
  double estimate = richardson(pick, local, &order);
  double limit = pick[1].value + richardson(pick + 1, local, &before);
  double to_come =
      fabs(pick[0].value + estimate - limit) * remainder_of(pick[1].size / pick[0].size, 2);
  e->why = "the last two extrapolations do not lead to the same limit";
  if (!(to_come <= GOAL_AGREEMENT * fabs(estimate))) return;
  e->why = NULL;
  e->asymptotic = true;
  e->order = order;
  e->estimate = estimate;
  e->half = fmax(e->half, GOAL_SAFETY * fabs(estimate));
}

/* Nothing is to be seen beside what the values are known by anyway. Of two meshes with ten-node
   tets four-node ones are the third. */
static bool is_settled(int n, const goal_level *level, double coarse, double noise, goal_error *e) {
  double d2 = level[n - 1].value - level[n - 2].value;
  double before = level[n - 2].value - (n >= 3 ? level[n - 3].value : coarse);
  if (!(fabs(d2) <= noise) || (n >= 3 && fabs(before) > noise)) return false;
  *e = (goal_error){.estimate = d2,
                    .half = GOAL_SAFETY_UNPROVEN * fabs(d2) + noise,
                    .order = NAN,
                    .settled = true,
                    .asymptotic = fabs(before) <= noise};
  if (!e->asymptotic) e->why = "there are but two meshes of ten-node tets";
  return true;
}

goal_error goal_judge(int n, const goal_level *level, double coarse, double noise, bool local) {
  goal_error e = {.order = NAN, .why = "there are but two meshes of ten-node tets"};
  if (n < 2) return judge_one(level, coarse);
  if (is_settled(n, level, coarse, noise, &e)) return e;
  if (n >= 3) {
    e = judge_three(n, level, noise, local);
    if (!e.why) ask_for_four(n, level, local, &e);
    return e;
  }
  widen(&e, NAN, level[1].value - level[0].value, level[0].size / level[1].size);
  return e;
}
