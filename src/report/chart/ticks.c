/* Steps of 1, 2 and 5 on linear axes, decades on logarithmic ones. */
#include "ticks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Far enough from the ends of double precision for differences and for ten to any power. */
static const double largest = 1e300, smallest = 1e-300;

bool axis_takes(bool log, double x) {
  return log ? x >= smallest && x <= largest : x >= -largest && x <= largest;
}

static axis_range widened(axis_range r) {
  if (r.log) {
    double margin = 0.04 * (log10(r.high) - log10(r.low));
    if (!(margin > 0.01)) margin = 0.2;
    r.low = fmax(pow(10, log10(r.low) - margin), smallest);
    r.high = fmin(pow(10, log10(r.high) + margin), largest);
  } else {
    double margin = 0.04 * (r.high - r.low), size = fmax(fabs(r.low), fabs(r.high));
    if (!(margin > 1e-12 * size)) margin = 0.1 * size;
    if (!(margin > smallest)) margin = 1;
    r.low -= margin, r.high += margin;
  }
  return r;
}

axis_range axis_range_of(int n, const double *x, bool log) {
  axis_range r = {INFINITY, -INFINITY, log};
  for (int i = 0; i < n; i++) {
    if (!axis_takes(log, x[i])) continue;
    r.low = fmin(r.low, x[i]);
    r.high = fmax(r.high, x[i]);
  }
  if (!(r.low <= r.high)) return (axis_range){log ? 0.1 : 0, log ? 10 : 1, log};
  return widened(r);
}

double axis_place(const axis_range *r, double x) {
  if (r->log) return (log10(x) - log10(r->low)) / (log10(r->high) - log10(r->low));
  return (x / 2 - r->low / 2) / (r->high / 2 - r->low / 2);
}

/* A number without superfluous digits: 0.002, 40, 2e-6; `digits` behind the point of `step`. */
static void label_number(double x, double step, tick *t) {
  double size = fabs(x);
  if (size < 1e-9 * step) {
    snprintf(t->label, sizeof t->label, "0");
  } else if (size < 1e6 && step >= 1e-4) {
    int decimals = (int)fmax(0, ceil(-log10(step) - 1e-9));
    snprintf(t->label, sizeof t->label, "%.*f", decimals, x);
  } else {
    int digits = (int)fmin(15, fmax(0, floor(log10(size)) - floor(log10(step) + 1e-9)));
    char text[40];
    snprintf(text, sizeof text, "%.*e", digits, x);
    int mantissa = 0;
    while (text[mantissa] && text[mantissa] != 'e') mantissa++;
    snprintf(t->label, sizeof t->label, "%.*se%d", mantissa, text, atoi(text + mantissa + 1));
  }
}

static int linear_ticks(const axis_range *r, int most, tick *ticks) {
  double span = r->high - r->low;
  double step = pow(10, floor(log10(span / most)));
  const double factor[] = {1, 2, 5, 10, 20};
  int k = 0;
  while (k < 4 && floor(r->high / (factor[k] * step)) - ceil(r->low / (factor[k] * step)) >= most)
    k++;
  step *= factor[k];
  int n = 0;
  for (double i = ceil(r->low / step); i <= floor(r->high / step) && n < TICKS_MAX; i++) {
    ticks[n].at = i * step;
    label_number(ticks[n].at, step, &ticks[n]);
    n++;
  }
  return n;
}

static void label_power(int exponent, tick *t) {
  if (exponent == 0 || exponent == 1)
    snprintf(t->label, sizeof t->label, "%d", exponent ? 10 : 1);
  else
    snprintf(t->label, sizeof t->label, "10^%d", exponent);
}

/* Every tick is a digit times a power of ten; of many decades only those with a label are left. */
static int decade_ticks(const axis_range *r, int stride, bool few, tick *ticks) {
  int n = 0;
  int first = (int)floor(log10(r->low)), last = (int)ceil(log10(r->high));
  for (int e = first; e <= last; e++) {
    if (last - first > TICKS_MAX - 8 && e % stride != 0) continue;
    for (int digit = 1; digit <= (stride == 1 ? 9 : 1) && n < TICKS_MAX; digit++) {
      tick *t = &ticks[n];
      t->at = digit * pow(10, e);
      t->label[0] = '\0';
      if (t->at < r->low || t->at > r->high) continue;
      if (few && (digit == 1 || digit == 2 || digit == 5))
        label_number(t->at, pow(10, e), t);
      else if (digit == 1 && !few && e % stride == 0)
        label_power(e, t);
      n++;
    }
  }
  return n;
}

static int labelled(int n, const tick *ticks) {
  int count = 0;
  for (int i = 0; i < n; i++) count += ticks[i].label[0] != '\0';
  return count;
}

int axis_ticks(const axis_range *r, int most, tick ticks[TICKS_MAX]) {
  if (!r->log) return linear_ticks(r, most, ticks);
  int decades = (int)(floor(log10(r->high)) - ceil(log10(r->low))) + 1;
  if (decades >= 2) {
    int stride = (decades + most - 1) / most;
    if (decades > 8 && stride == 1) stride = 2; /* minor ticks at 2 to 9 would be too many */
    return decade_ticks(r, stride, false, ticks);
  }
  int n = decade_ticks(r, 1, true, ticks);
  return labelled(n, ticks) >= 2 ? n : linear_ticks(r, most, ticks);
}
