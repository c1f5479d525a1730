/* Whole runs of a steel bar, whose periods are 1e-4 s and whose steps are seconds: the rows between
   the steps are as right as the steps. */
#include "whole_run.h"

/* The bar made steel and slender, and its load 1 MPa. */
#define STEEL                                                                              \
  "mesh={box: {size: [0.02, 0.02, 0.2], cells: [1, 1, 8], split: kuhn}}",                  \
      "groups={base: {plane: {axis: z, at: 0.0}}, top: {plane: {axis: z, at: 0.2}}}",      \
      "material={E: 2.1e11, nu: 0.3, density: 7850, damping: {lambda: 2.0e6, mu: 2.0e6}}", \
      "probes={corner: {point: [0, 0, 0.2]}}", "time={end: 10, output: 0.5}"
#define LOAD(history) "loads=[{group: top, traction: [1.0e6, 0, 0], amplitude: " history "}]"

static const char *const methods[] = {"cvode", "ida", "arkode"};
enum { NMETHOD = 3, MOST_ROWS = 202 };
static const double bent = 7.45131e-5; /* [m] where the tip of that mesh is in equilibrium */

static double worst_after(const char *dir, double t, double expected) {
  double time[MOST_ROWS], u[MOST_ROWS], worst = 0;
  int nrow = column(dir, "probes.csv", 0, MOST_ROWS, time);
  column(dir, "probes.csv", 1, MOST_ROWS, u);
  for (int i = 0; i < nrow; i++)
    if (time[i] >= t) worst = fmax(worst, fabs(u[i] - expected));
  return worst;
}

/* The work and what became of it, by the largest work. */
static double worst_balance(const char *dir) {
  double balance[MOST_ROWS], work[MOST_ROWS], worst = 0, most = 0;
  int nrow = column(dir, "energy.csv", 5, MOST_ROWS, balance);
  column(dir, "energy.csv", 4, MOST_ROWS, work);
  for (int i = 0; i < nrow; i++) {
    worst = fmax(worst, fabs(balance[i]));
    most = fmax(most, fabs(work[i]));
  }
  return worst / most;
}

/* What a test makes of a run that a method, named with its tolerance, has left in dir. */
typedef void look_at(const char *dir, const char *method, double rtol);

/* Runs the bar by every method at tolerances from 10^-first to 10^-last. set: as SET(). */
static void run_all(int first, int last, const char *const *set, look_at *look) {
  enum { MOST = 16 };
  char *dir = temporary_folder();
  for (int k = 0; k < NMETHOD; k++)
    for (int digits = first; digits <= last; digits++) {
      char method[64];
      const char *all[MOST] = {"output={fields: none}", method};
      snprintf(method, sizeof method, "integrator={method: %s, rtol: 1.0e-%d}", methods[k], digits);
      for (int n = 0; set[n] && n + 3 < MOST; n++) all[n + 2] = set[n];
      run_ok(dir, all);
      look(dir, method, pow(10, -digits));
    }
  remove_folder(dir);
}

/* 2.3e-5 is what damping leaves of the ramp at its end. */
static void look_at_ramp(const char *dir, const char *method, double rtol) {
  double off = worst_after(dir, 1, bent) / bent, balance = worst_balance(dir);
  if (!(off < fmax(rtol, 3e-5))) fail_msg("%s: off by %.2g", method, off);
  if (!(balance < 1e-3)) fail_msg("%s: the ledger is off by %.2g", method, balance);
}

static void every_row_after_a_ramp_is_the_equilibrium(void **state) {
  (void)state;
  run_all(3, 8, SET(STEEL, LOAD("[[0, 0], [1, 1]]")), look_at_ramp);
}

static void look_at_rest(const char *dir, const char *method, double rtol) {
  (void)rtol;
  double off = worst_after(dir, 0, bent) / bent;
  if (!(off < 1e-5)) fail_msg("%s: off by %.2g", method, off);
}

static void at_rest_every_row_is_the_start(void **state) {
  (void)state;
  run_all(3, 8, SET(STEEL, "loads=[{group: top, traction: [1.0e6, 0, 0]}]", "start=equilibrium"),
          look_at_rest);
}

#define TURNED                                                                                 \
  STEEL, "loads=[]", "time={end: 10, output: 0.05}",                                           \
      "boundary=[{group: base, rotate: {axis: [0, 1, 0], center: [0, 0, 0], rate: 0.5, from: " \
      "0.5, "                                                                                  \
      "to: 5}}]"

static void look_at_turn(const char *dir, const char *method, double rtol) {
  csv probes = read_csv(in(dir, "out/probes.csv"));
  double worst = 0;
  for (int i = 0; i < probes.nrow; i++) {
    const double *row = probes.x[i];
    double angle = 0.5 * fmin(fmax(row[0] - 0.5, 0), 4.5);
    worst = fmax(worst, hypot(row[1] - 0.2 * sin(angle), row[3] - 0.2 * (cos(angle) - 1)));
  }
  if (rtol < 5e-3 && !(worst < 10 * 0.2 * 1.1 * rtol)) fail_msg("%s: off by %.2g m", method, worst);
  free_csv(probes);
}

/* Ten tolerances from where it would be if it were rigid; the absolute tolerance is a tenth of the
   relative one here. At 1e-2 the steps are too long for errors to be proportional to the tolerance,
   and which they are hangs on rounding: the run is to come to its end. */
static void a_turning_support_inverts_nothing(void **state) {
  (void)state;
  run_all(2, 5, SET(TURNED), look_at_turn);
}

/* Twice the kinetic energy of the rigid bar that turns: the squares of the distances of its masses,
   a quarter of each tet at each corner, times that of 0.5 rad/s [J]. */
static const double carried = 2.1411e-3;

static void look_at_work(const char *dir, const char *method, double rtol) {
  double time[MOST_ROWS], work[MOST_ROWS], from = rtol < 5e-6 ? 1 : 5.5;
  int nrow = column(dir, "energy.csv", 0, MOST_ROWS, time);
  column(dir, "energy.csv", 4, MOST_ROWS, work);
  for (int i = 0; i < nrow; i++)
    if (time[i] > from && !(fabs(work[i] / carried - 1) < 0.01))
      fail_msg("%s: at t = %g the support has put in %g J of %g J", method, time[i], work[i],
               carried);
}

/* A body that turns carries twice its kinetic energy in momentum along its turn, and that is what
   its support has put in, half of it into a vibration that dies out: since the body set out, and
   when it has stopped again. At 1e-5 single rows of velocities are off by a tenth while it turns,
   and the momentum with them. */
static void a_turning_support_puts_in_the_momentum(void **state) {
  (void)state;
  run_all(5, 7, SET(TURNED), look_at_work);
}

static void look_after_jump(const char *dir, const char *method, double rtol) {
  double off = worst_after(dir, 101, 0) / bent;
  if (!(off < rtol)) fail_msg("%s: off by %.2g", method, off);
}

/* Let go within 1e-12 s after a minute and more: nothing is left a second later. */
static void a_jump_after_a_long_hold_is_felt(void **state) {
  (void)state;
  run_all(3, 6,
          SET(STEEL, LOAD("[[0, 0], [1, 1], [100, 1], [100.000000000001, 0]]"),
              "time={end: 110, output: 1}"),
          look_after_jump);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_row_after_a_ramp_is_the_equilibrium),
      cmocka_unit_test(at_rest_every_row_is_the_start),
      cmocka_unit_test(a_turning_support_inverts_nothing),
      cmocka_unit_test(a_turning_support_puts_in_the_momentum),
      cmocka_unit_test(a_jump_after_a_long_hold_is_felt),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
