/* Amplitudes: piecewise linear with jumps, splines, sines; their values and derivatives, and how
   far a step may go without passing over what they do. */
#include "amplitude.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/fault.h"

#define TWO_PI 6.283185307179586

/* Whose amplitude it is: an entry of a definition. */
typedef struct user {
  const char *entry;
  int index;
} user;

/* --- Points ---------------------------------------------------------------------------------- */

/* How many points stand at t or before: 0 to n. A search by halves; NaN is before all of them. */
static int points_until(int n, const double *time, double t) {
  int low = 0, high = n;
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (time[middle] <= t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static corot_status check_points(const corot_amplitude *a, const user *of) {
  for (int i = 0; i < a->n; i++) {
    double t = a->time[i];
    const corot_fault at = {
        .entry = of->entry, .index = of->index, .field = "amplitude.time", .point = i};
    if (!isfinite(t) || !isfinite(a->value[i]))
      return corot_fail_about(&at, "point %d of the amplitude is not finite", i);
    if (i > 0 && !(t >= a->time[i - 1]))
      return corot_fail_about(&at,
                              "the amplitude's times do not increase at point %d: %g follows %g", i,
                              t, a->time[i - 1]);
    if (i > 0 && t == a->time[i - 1] && a->curve == COROT_CURVE_SMOOTH)
      return corot_fail_about(
          &at, "the amplitude has two points at t = %g: a smooth one has no jumps", t);
    if (i > 1 && t == a->time[i - 2])
      return corot_fail_about(&at,
                              "the amplitude has more than two points at t = %g: a jump has a "
                              "value before it and one after it",
                              t);
  }
  return COROT_OK;
}

static corot_status copy_points(const corot_amplitude *from, amplitude *to) {
  size_t n = (size_t)from->n;
  to->time = malloc(n * sizeof *to->time);
  to->value = malloc(n * sizeof *to->value);
  if (!to->time || !to->value)
    return corot_fail(COROT_ENOMEM, "no memory for an amplitude of %d points", from->n);
  memcpy(to->time, from->time, n * sizeof *to->time);
  memcpy(to->value, from->value, n * sizeof *to->value);
  to->n = from->n;
  to->least = to->most = to->value[0];
  for (int i = 1; i < to->n; i++) {
    to->least = fmin(to->least, to->value[i]);
    to->most = fmax(to->most, to->value[i]);
  }
  return COROT_OK;
}

/* --- Splines --------------------------------------------------------------------------------- */

/* The slopes m at the points for which the second derivative of the cubic pieces is continuous,
   with d_k = t_(k+1) - t_k (de Boor 1978, chapter IV):

     m_(k-1) / d_(k-1) + 2 (1 / d_(k-1) + 1 / d_k) m_k + m_(k+1) / d_k
       = 3 ((v_k - v_(k-1)) / d_(k-1)^2 + (v_(k+1) - v_k) / d_k^2),   m_0 = m_(n-1) = 0.

   The matrix is diagonally dominant: elimination without pivots, `above` [n] what is left above the
   diagonal. */
static void find_slopes(amplitude *a, double *above) {
  int n = a->n;
  const double *t = a->time, *v = a->value;
  double *m = a->slope;
  m[0] = m[n - 1] = above[0] = 0;
  for (int k = 1; k < n - 1; k++) {
    double p = 1 / (t[k] - t[k - 1]), q = 1 / (t[k + 1] - t[k]);
    double pivot = 2 * (p + q) - p * above[k - 1];
    double right = 3 * ((v[k] - v[k - 1]) * p * p + (v[k + 1] - v[k]) * q * q);
    above[k] = q / pivot;
    m[k] = (right - p * m[k - 1]) / pivot;
  }
  for (int k = n - 2; k > 0; k--) m[k] -= above[k] * m[k + 1];
}

/* The cubic from point k to the next, at the fraction s of the way. */
static double cubic(const amplitude *a, int k, double s) {
  double d = a->time[k + 1] - a->time[k], r = 1 - s;
  return r * r * ((1 + 2 * s) * a->value[k] + s * d * a->slope[k]) +
         s * s * ((1 + 2 * r) * a->value[k + 1] - r * d * a->slope[k + 1]);
}

static double cubic_rate(const amplitude *a, int k, double s) {
  double d = a->time[k + 1] - a->time[k], r = 1 - s;
  return 6 * s * r * (a->value[k + 1] - a->value[k]) / d + r * (1 - 3 * s) * a->slope[k] +
         s * (1 - 3 * r) * a->slope[k + 1];
}

static double cubic_second(const amplitude *a, int k, double s) {
  double d = a->time[k + 1] - a->time[k];
  return (6 * (1 - 2 * s) * (a->value[k + 1] - a->value[k]) / d - (4 - 6 * s) * a->slope[k] -
          (2 - 6 * s) * a->slope[k + 1]) /
         d;
}

/* The fractions inside of piece k at which it turns round, ascending; returns how many: 0 to 2. Its
   derivative is A s^2 + B s + C. */
static int turns(const amplitude *a, int k, double s[2]) {
  double d = a->time[k + 1] - a->time[k], rise = 6 * (a->value[k + 1] - a->value[k]) / d;
  double m0 = a->slope[k], m1 = a->slope[k + 1];
  double A = 3 * (m0 + m1) - rise, B = rise - 4 * m0 - 2 * m1, C = m0;
  double square = B * B - 4 * A * C;
  if (!(square > 0)) return 0;
  double q = -0.5 * (B + copysign(sqrt(square), B)), root[2] = {q / A, C / q};
  int n = 0;
  for (int i = 0; i < 2; i++)
    if (root[i] > 0 && root[i] < 1) s[n++] = root[i];
  if (n == 2 && s[0] > s[1]) s[0] = root[1], s[1] = root[0];
  return n;
}

/* Where the spline begins, bends back and ends: at most three times n of time and value. */
static int list_extremes(const amplitude *a, double (*e)[2]) {
  int n = 0;
  for (int k = 0; k < a->n; k++) {
    e[n][0] = a->time[k], e[n++][1] = a->value[k];
    double s[2];
    int nturn = k + 1 < a->n ? turns(a, k, s) : 0;
    for (int i = 0; i < nturn; i++) {
      e[n][0] = a->time[k] + s[i] * (a->time[k + 1] - a->time[k]);
      e[n++][1] = cubic(a, k, s[i]);
    }
  }
  return n;
}

/* The run between the extremes `from` and `to`, without its slow beginning and end. */
static void add_run(amplitude *a, const double (*e)[2], int from, int to, double little) {
  int begin = from, end = to;
  while (fabs(e[begin + 1][1] - e[from][1]) <= little) begin++;
  while (fabs(e[end - 1][1] - e[to][1]) <= little) end--;
  a->run[a->nrun++] = (amplitude_run){e[begin][0], e[end][0]};
}

/* Splits the spline into runs. What is smaller than a thousandth of its range is none: noise does
   not turn it round. */
static void find_runs(amplitude *a, int n, const double (*e)[2]) {
  double little = 1e-3 * (a->most - a->least);
  int from = 0, to = 0; /* the same: it has gone nowhere yet */
  for (int i = 1; i < n; i++) {
    double step = e[i][1] - e[to][1];
    bool further = to == from ? fabs(step) > little : step * (e[to][1] - e[from][1]) >= 0;
    if (further) {
      to = i;
    } else if (to != from && fabs(step) > little) {
      add_run(a, e, from, to, little);
      from = to, to = i;
    }
  }
  if (to != from) add_run(a, e, from, to, little);
}

static corot_status find_shape(amplitude *a, const user *of, double *above, double (*e)[2]) {
  find_slopes(a, above);
  int n = list_extremes(a, e);
  double least = a->least, most = a->most;
  for (int i = 0; i < n; i++) {
    if (!isfinite(e[i][1]) || !isfinite(e[i][0]))
      return corot_fail_at(of->entry, of->index, "amplitude",
                           "the spline through the amplitude's points overflows");
    least = fmin(least, e[i][1]), most = fmax(most, e[i][1]);
    double beyond = fmax(a->least - e[i][1], e[i][1] - a->most);
    if (beyond > a->most - a->least)
      return corot_fail_at(
          of->entry, of->index, "amplitude",
          "the spline through the amplitude's points swings out to %g at t = %g, "
          "far beyond them, %g to %g: give more points there, or let a rest before "
          "the first or after the last point go without any",
          e[i][1], e[i][0], a->least, a->most);
  }
  a->least = least, a->most = most;
  find_runs(a, n, (const double(*)[2])e);
  return COROT_OK;
}

static corot_status make_spline(amplitude *a, const user *of) {
  size_t n = (size_t)a->n;
  double *above = malloc(n * sizeof *above), (*extreme)[2] = malloc(3 * n * sizeof *extreme);
  a->slope = malloc(n * sizeof *a->slope);
  a->run = malloc(3 * n * sizeof *a->run);
  corot_status status = COROT_OK;
  if (!above || !extreme || !a->slope || !a->run)
    status = corot_fail(COROT_ENOMEM, "no memory for a spline of %d points", a->n);
  else
    status = find_shape(a, of, above, extreme);
  free(above);
  free(extreme);
  return status;
}

/* --- All of them ----------------------------------------------------------------------------- */

static corot_status make_sine(const corot_amplitude *from, const user *of, amplitude *to) {
  if (!(from->frequency > 0) || !isfinite(from->frequency))
    return corot_fail_at(of->entry, of->index, "amplitude.frequency",
                         "the amplitude's frequency = %g is not positive and finite",
                         from->frequency);
  if (!isfinite(from->phase) || !isfinite(from->offset))
    return corot_fail_at(of->entry, of->index, "amplitude.phase",
                         "the amplitude's phase or offset is not finite");
  to->frequency = from->frequency;
  to->phase = from->phase;
  to->offset = from->offset;
  to->least = from->offset - 1, to->most = from->offset + 1;
  return COROT_OK;
}

static corot_status make(const corot_amplitude *from, const user *of, amplitude *to) {
  to->curve = from->curve;
  to->least = to->most = 1;
  if (from->curve == COROT_CURVE_SINE) return make_sine(from, of, to);
  if (from->curve != COROT_CURVE_LINEAR && from->curve != COROT_CURVE_SMOOTH)
    return corot_fail_at(of->entry, of->index, "amplitude",
                         "no kind of amplitude has the number %d", (int)from->curve);
  if (from->n < 0 || (from->n > 0 && (!from->time || !from->value)))
    return corot_fail_at(of->entry, of->index, "amplitude", "the amplitude has n = %d, and %s",
                         from->n, from->n < 0 ? "that is negative" : "no times or no values");
  COROT_TRY(check_points(from, of));
  if (from->n == 0) return COROT_OK;
  COROT_TRY(copy_points(from, to));
  return from->curve == COROT_CURVE_SMOOTH ? make_spline(to, of) : COROT_OK;
}

corot_status corot_amplitude_create(const corot_amplitude *from, const char *entry, int index,
                                    amplitude *to) {
  amplitude a = {0};
  corot_status status = make(from, &(user){entry, index}, &a);
  if (status)
    corot_amplitude_clear(&a);
  else
    *to = a;
  return status;
}

void corot_amplitude_clear(amplitude *a) {
  free(a->time);
  free(a->value);
  free(a->slope);
  free(a->run);
  *a = (amplitude){0};
}

double corot_amplitude_at(const amplitude *a, double phase, double t) {
  if (a->curve == COROT_CURVE_SINE) return a->offset + sin(TWO_PI * a->frequency * t + a->phase);
  if (a->n == 0) return 1;
  int k = points_until(a->n, a->time, a->slope || isnan(phase) ? t : phase);
  if (k == 0) return a->value[0];
  if (k == a->n) return a->value[k - 1];
  double s = (t - a->time[k - 1]) / (a->time[k] - a->time[k - 1]);
  if (a->slope) return cubic(a, k - 1, s);
  return (1 - s) * a->value[k - 1] + s * a->value[k];
}

double corot_amplitude_rate(const amplitude *a, double phase, double t) {
  double omega = TWO_PI * a->frequency;
  if (a->curve == COROT_CURVE_SINE) return omega * cos(omega * t + a->phase);
  if (a->n == 0) return 0;
  int k = points_until(a->n, a->time, a->slope || isnan(phase) ? t : phase);
  if (k == 0 || k == a->n) return 0;
  double d = a->time[k] - a->time[k - 1];
  if (a->slope) return cubic_rate(a, k - 1, (t - a->time[k - 1]) / d);
  return (a->value[k] - a->value[k - 1]) / d;
}

double corot_amplitude_second(const amplitude *a, double phase, double t) {
  double omega = TWO_PI * a->frequency;
  if (a->curve == COROT_CURVE_SINE) return -omega * omega * sin(omega * t + a->phase);
  if (isnan(phase)) phase = t;
  if (!a->slope || phase < a->time[0] || phase >= a->time[a->n - 1]) return 0;
  int k = points_until(a->n, a->time, t);
  k = k == 0 ? 0 : k == a->n ? a->n - 2 : k - 1;
  return cubic_second(a, k, (t - a->time[k]) / (a->time[k + 1] - a->time[k]));
}

double corot_amplitude_jump(const amplitude *a) {
  for (int i = 1; i < a->n; i++)
    if (a->time[i] == a->time[i - 1]) return a->time[i];
  return NAN;
}

int corot_amplitude_nkink(const amplitude *a) { return a->slope ? 0 : a->n; }
const double *corot_amplitude_kinks(const amplitude *a) { return a->time; }

/* Half of the run that t is in, but not past the first half of one that follows: if it is shorter
   than what is left of the step, the step ends where it begins. So does one that comes from a rest,
   unless that is shorter than half of the run, as between the way up and the way down. */
static double spline_horizon(const amplitude *a, double t) {
  int i = 0, last = a->nrun;
  while (i < last) { /* the first run that ends after t */
    int middle = i + (last - i) / 2;
    if (a->run[middle].end > t)
      last = middle;
    else
      i = middle + 1;
  }
  if (i == a->nrun) return INFINITY;
  double half = 0.5 * (a->run[i].end - a->run[i].begin), begin = a->run[i].begin;
  if (begin - t > half) return begin;
  double stop = fmax(t, begin) + half;
  for (i++; i < a->nrun && a->run[i].begin < stop; i++)
    if (0.5 * (a->run[i].begin + a->run[i].end) < stop) return a->run[i].begin;
  return stop;
}

double corot_amplitude_horizon(const amplitude *a, double t) {
  if (a->curve == COROT_CURVE_SINE) return t + 0.25 / a->frequency;
  return a->slope ? spline_horizon(a, t) : INFINITY;
}

size_t corot_amplitude_bytes(const amplitude *a) {
  size_t n = (size_t)a->n;
  return 2 * n * sizeof *a->time + (a->slope ? n * sizeof *a->slope : 0) +
         (a->run ? 3 * n * sizeof *a->run : 0);
}
