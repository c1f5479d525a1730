/* Follows a signal from turn to turn. */
#include "turning.h"

#include <math.h>

/* The part of the span that is no turn. */
#define WOBBLE 0.1

turning turning_begin(double value, double t) {
  return (turning){.value = value, .t = t, .last = value, .t_last = t};
}

static void take_turn(turning *n) {
  double way = fabs(n->value - n->last);
  if (n->count++ > 0) { /* the first way begins at the start, which need not be a turn */
    n->weight += way;
    n->weighted += way * (n->t - n->t_last);
  }
  n->last = n->value;
  n->t_last = n->t;
}

void turning_follow(turning *n, double span, double value, double t) {
  double ahead = n->direction * (value - n->value);
  if (n->direction == 0) {
    n->direction = (value > n->last) - (value < n->last);
    ahead = 0;
  } else if (ahead < 0) {
    if (!(-ahead > WOBBLE * span)) return;
    take_turn(n);
    n->direction = -n->direction;
  }
  n->value = value;
  n->t = t;
}

double turning_mean(const turning *n) { return n->weight > 0 ? n->weighted / n->weight : 0; }

void turning_exchange(pack *p, turning *n) {
  double *const number[] = {&n->value, &n->t, &n->last, &n->t_last, &n->weight, &n->weighted};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) corot_pack_double(p, number[i]);
  corot_pack_int(p, &n->direction);
  corot_pack_long(p, &n->count);
}
