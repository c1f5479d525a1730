/* Whole runs: the files they leave, their exit codes, and that output does not disturb them. */
#include <signal.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/inventory.h"
#include "whole_run.h"

static void a_run_leaves_its_books(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, NULL);
  json_t *result = result_of(dir);
  csv steps = read_csv(in(dir, "out/steps.csv")), probes = read_csv(in(dir, "out/probes.csv"));
  csv energy = read_csv(in(dir, "out/energy.csv"));

  assert_string_equal(word(result, "status", NULL), "ok");
  assert_true(json_is_null(json_object_get(result, "reason")));
  assert_close(number(result, "t_reached", NULL), 1, 0, 0);
  assert_close(number(result, "statistics", "nst"), steps.nrow, 0, 0);
  double sum = 0;
  for (int i = 0; i < steps.nrow; i++) sum += steps.x[i][1];
  assert_close(sum, 1, 1e-12, 0);

  assert_int_equal(probes.nrow, 11);
  assert_int_equal(energy.nrow, 11);
  for (int i = 0; i < 10; i++) assert_close(probes.x[i][0], i * 0.1, 0, 0);
  assert_close(last_time(probes), 1, 0, 0);
  json_t *corner = json_object_get(json_object_get(result, "probes"), "corner");
  assert_int_equal(json_integer_value(json_object_get(corner, "node")), 19);
  json_t *u = json_object_get(corner, "u");
  for (int k = 0; k < 3; k++)
    assert_close(json_real_value(json_array_get(u, (size_t)k)), probes.x[10][1 + k], 0, 0);
  assert_close(number(result, "energy", "balance"), energy.x[10][5], 0, 0);
  assert_true(exists(in(dir, "out/fields/fields_000010.vtu")));
  assert_false(exists(in(dir, "out/fields/fields_000011.vtu")));

  free_csv(steps), free_csv(probes), free_csv(energy);
  json_decref(result);
  remove_folder(dir);
}

static void the_phases_make_up_the_time(void **state) {
  (void)state;
  static const char *const phase[] = {"setup",  "force",  "assembly",    "combine",
                                      "factor", "solve",  "work",        "integrator",
                                      "frames", "output", "space_error", "other"};
  char *dir = temporary_folder();
  run_ok(dir, SET("frames={policy: hold, interval: 0.05}"));
  json_t *result = result_of(dir);
  double sum = 0;
  for (int i = 0; i < 12; i++) {
    assert_above(number(result, "timings", phase[i]), 0);
    sum += number(result, "timings", phase[i]);
  }
  assert_close(sum, number(result, "timings", "wall"), 1e-9, 0);
  assert_above(number(result, "memory", "model"), 0);
  assert_above(number(result, "memory", "peak"), number(result, "memory", "state"));
  json_decref(result);
  remove_folder(dir);
}

static void the_output_grid_leaves_the_steps_alone(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, NULL);
  assert_int_equal(rename(in(dir, "out/steps.csv"), in(dir, "coarse.csv")), 0);
  run_ok(dir, SET("time.output=0.00037", "output.fields=none"));
  assert_same_file(in(dir, "out/steps.csv"), in(dir, "coarse.csv"));

  /* Many output times fell into one step: they are all there, once each, in order. */
  csv steps = read_csv(in(dir, "out/steps.csv")), probes = read_csv(in(dir, "out/probes.csv"));
  assert_int_equal(probes.nrow, 2704); /* 0 to 2702 * 0.00037 = 0.99974, and the end */
  assert_true(probes.nrow > 2 * steps.nrow);
  for (int i = 0; i < 2703; i++) assert_close(probes.x[i][0], i * 0.00037, 0, 0);
  assert_close(last_time(probes), 1, 0, 0);
  free_csv(steps), free_csv(probes);
  remove_folder(dir);
}

static void the_end_is_an_output_time(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("time.output=0.4", "output.every=2"));
  csv probes = read_csv(in(dir, "out/probes.csv"));
  assert_int_equal(probes.nrow, 4);
  assert_close(probes.x[2][0], 0.8, 0, 0);
  assert_close(probes.x[3][0], 1.0, 0, 0);
  char *list = slurp(in(dir, "out/fields.pvd"), NULL); /* the first, the third, the last */
  assert_non_null(strstr(list, "timestep=\"0\" file=\"fields/fields_000000.vtu\""));
  assert_non_null(strstr(list, "timestep=\"0.80000000000000004\" file=\"fields/fields_000001.vtu"));
  assert_non_null(strstr(list, "timestep=\"1\" file=\"fields/fields_000002.vtu\""));
  assert_null(strstr(list, "fields_000003"));
  free(list);
  free_csv(probes);
  remove_folder(dir);
}

static void exact_frames_stop_at_kinks_only(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, NULL);
  csv steps = read_csv(in(dir, "out/steps.csv"));
  int kinks = 0;
  for (int i = 0; i < steps.nrow; i++) {
    if (!steps.event[i][0]) continue;
    assert_string_equal(steps.event[i], "kink");
    assert_close(steps.x[i][0], 0.3, 0, 0);
    kinks++;
  }
  assert_int_equal(kinks, 1);
  free_csv(steps);
  remove_folder(dir);
}

static double largest_imbalance(const char *dir, const char *const *set) {
  run_ok(dir, set);
  csv energy = read_csv(in(dir, "out/energy.csv"));
  double largest = 0;
  for (int i = 0; i < energy.nrow; i++) largest = fmax(largest, fabs(energy.x[i][5]));
  assert_above(energy.x[energy.nrow - 1][4], 0.01); /* the work it is to be compared with [J] */
  free_csv(energy);
  return largest;
}

/* With held frames the ledger closes as well, though the frames put in energy a thousand times the
   imbalance. */
static void the_ledger_closes_with_the_tolerance(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *loose = "integrator.rtol=1.0e-4", *tight = "integrator.rtol=1.0e-7";
  const char *hold = "frames={policy: hold, interval: 0.1}";
  double exact = largest_imbalance(dir, SET(loose)), fine = largest_imbalance(dir, SET(tight));
  assert_below(exact, 1e-3);
  assert_below(fine, 0.05 * exact);
  double held = largest_imbalance(dir, SET(tight, hold));
  json_t *result = result_of(dir);
  assert_above(number(result, "frames", "energy"), 100 * held);
  json_decref(result);
  remove_folder(dir);
}

static void the_same_run_leaves_the_same_bytes(void **state) {
  (void)state;
  static const char *const name[] = {"probes.csv", "energy.csv", "steps.csv", "fields.pvd",
                                     "fields/fields_000010.vtu"};
  char *dir = temporary_folder();
  run_ok(dir, NULL);
  json_t *first = result_of(dir);
  assert_int_equal(rename(in(dir, "out"), in(dir, "first")), 0);
  run_ok(dir, NULL);
  json_t *second = result_of(dir);
  for (int i = 0; i < 5; i++) {
    char a[64], b[64];
    snprintf(a, sizeof a, "first/%s", name[i]);
    snprintf(b, sizeof b, "out/%s", name[i]);
    assert_same_file(in(dir, a), in(dir, b));
  }
  assert_string_equal(word(first, "hashes", "run"), word(second, "hashes", "run"));

  run_ok(dir, SET("integrator.rtol=1.0e-3"));
  json_t *third = result_of(dir);
  assert_string_equal(word(first, "hashes", "mesh"), word(third, "hashes", "mesh"));
  assert_string_not_equal(word(first, "hashes", "scenario"), word(third, "hashes", "scenario"));
  assert_string_not_equal(word(first, "hashes", "run"), word(third, "hashes", "run"));
  run_ok(dir, SET("mesh.box.size=[0.1, 0.1, 0.40000001]"));
  json_t *fourth = result_of(dir);
  assert_string_not_equal(word(first, "hashes", "mesh"), word(fourth, "hashes", "mesh"));
  json_decref(first), json_decref(second), json_decref(third), json_decref(fourth);
  remove_folder(dir);
}

static void a_used_folder_holds_one_run(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, NULL);
  put_file(in(dir, "out/notes.txt"), "mine");
  run_ok(dir, SET("time.output=0.5"));
  assert_true(exists(in(dir, "out/fields/fields_000002.vtu")));
  assert_false(exists(in(dir, "out/fields/fields_000003.vtu")));
  run_ok(dir, SET("output.fields=none"));
  assert_false(exists(in(dir, "out/fields.pvd")));
  assert_false(exists(in(dir, "out/fields/fields_000000.vtu")));
  char *notes = slurp(in(dir, "out/notes.txt"), NULL);
  assert_string_equal(notes, "mine");
  free(notes);
  remove_folder(dir);
}

static void stdout_has_the_result_on_request(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_with(dir, (run_options){.json = true}, SET("time.end=0.01"));
  assert_int_equal(a.code, 0);
  char *file = slurp(in(dir, "out/result.json"), NULL);
  assert_string_equal(a.out, file);
  char *line = a.err; /* warnings, and the summary in one line */
  while (strncmp(line, "warning: ", 9) == 0) line = strchr(line, '\n') + 1;
  assert_non_null(strstr(line, " steps, "));
  assert_ptr_equal(strchr(line, '\n'), a.err + strlen(a.err) - 1);
  free(file);
  forget(a);
  remove_folder(dir);
}

/* A load that turns the bar inside out, in the end. */
static void an_inverted_element_ends_the_run(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_with(dir, (run_options){.quiet = true},
                      SET("loads=[{group: top, traction: [0.0, 0.0, -1.0e5], "
                          "amplitude: [[0.0, 0.0], [1.0, 1.0]]}]"));
  assert_int_equal(a.code, 4);
  json_t *result = result_of(dir);
  assert_string_equal(word(result, "status", NULL), "failed");
  assert_close(number(result, "exit_code", NULL), 4, 0, 0);
  assert_non_null(strstr(word(result, "reason", NULL), "tet "));
  assert_non_null(strstr(a.err, word(result, "reason", NULL)));

  double t = number(result, "t_reached", NULL);
  assert_true(t > 0 && t < 1);
  csv probes = read_csv(in(dir, "out/probes.csv")), steps = read_csv(in(dir, "out/steps.csv"));
  assert_close(last_time(probes), t, 0, 0);
  assert_close(last_time(steps), t, 0, 0);
  char entry[64];
  snprintf(entry, sizeof entry, "timestep=\"%.17g\"", t);
  char *list = slurp(in(dir, "out/fields.pvd"), NULL);
  assert_non_null(strstr(list, entry));
  free(list);
  free_csv(probes), free_csv(steps);
  json_decref(result);
  forget(a);
  remove_folder(dir);
}

static void check_interrupted(const char *dir, answer a, int signal_number) {
  assert_int_equal(a.code, 128 + signal_number);
  assert_non_null(strstr(a.err, "interrupted"));
  json_t *result = result_of(dir);
  assert_string_equal(word(result, "status", NULL), "interrupted");
  csv probes = read_csv(in(dir, "out/probes.csv")), steps = read_csv(in(dir, "out/steps.csv"));
  /* the same instant; an output time met by the last step may differ from its end by rounding */
  assert_close(last_time(probes), number(result, "t_reached", NULL), 1e-12, 0);
  assert_int_equal(steps.nrow, number(result, "statistics", "nst"));
  free_csv(probes), free_csv(steps);
  json_decref(result);
  forget(a);
}

static const char *volatile watched; /* a table that grows */

static bool has_grown(void) {
  struct stat info;
  return stat(watched, &info) == 0 && info.st_size > 4096;
}

static void interrupt_when_grown(int signal_number) {
  (void)signal_number;
  if (!watched || !has_grown()) return;
  watched = NULL; /* once */
  run_interrupt(SIGTERM);
}

#define FOR_HOURS SET("time={end: 1.0e6, output: 0.1}")

static void an_interrupted_run_keeps_what_it_had(void **state) {
  (void)state;
  char *dir = temporary_folder(), steps_path[1024];
  run_interrupt(SIGINT);
  check_interrupted(dir, run_with(dir, (run_options){.quiet = true}, NULL), SIGINT);

  /* In the midst of a run. */
  snprintf(steps_path, sizeof steps_path, "%s/out/steps.csv", dir);
  watched = steps_path;
  struct sigaction action = {.sa_handler = interrupt_when_grown}, before;
  sigaction(SIGALRM, &action, &before);
  struct itimerval often = {{.tv_usec = 10000}, {.tv_usec = 10000}}, never = {0};
  setitimer(ITIMER_REAL, &often, NULL);
  answer a = run_with(dir, (run_options){.quiet = true}, FOR_HOURS);
  setitimer(ITIMER_REAL, &never, NULL);
  sigaction(SIGALRM, &before, NULL);
  check_interrupted(dir, a, SIGTERM);
  csv steps = read_csv(steps_path);
  assert_true(steps.nrow > 10);
  free_csv(steps);

  run_ok(dir, NULL); /* the request is forgotten */
  remove_folder(dir);
}

/* The kernel may cut a write short where it crosses a page: such a row is nobody's. */
static void drop_cut_row(const char *path) {
  size_t size;
  char *text = slurp(path, &size);
  while (size > 0 && text[size - 1] != '\n') size--;
  assert_true(size > 0);
  assert_int_equal(truncate(path, (off_t)size), 0);
  free(text);
}

static void a_killed_run_leaves_whole_rows(void **state) {
  (void)state;
  char *dir = temporary_folder(), steps_path[1024];
  snprintf(steps_path, sizeof steps_path, "%s/out/steps.csv", dir);
  watched = steps_path;
  pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    run_with(dir, (run_options){.quiet = true}, FOR_HOURS);
    _exit(0);
  }
  while (!has_grown()) assert_int_equal(waitpid(child, NULL, WNOHANG), 0);
  kill(child, SIGKILL);
  assert_int_equal(waitpid(child, NULL, 0), child);

  drop_cut_row(steps_path);
  drop_cut_row(in(dir, "out/probes.csv"));
  csv steps = read_csv(steps_path), probes = read_csv(in(dir, "out/probes.csv"));
  assert_true(steps.nrow > 10);
  assert_true(probes.nrow > 0);
  assert_close(last_time(probes), (probes.nrow - 1) * 0.1, 1e-15, 0);
  char *list = slurp(in(dir, "out/fields.pvd"), NULL);
  const char *tail = "/>\n</Collection>\n</VTKFile>\n";
  assert_string_equal(list + strlen(list) - strlen(tail), tail);
  assert_false(exists(in(dir, "out/result.json")));
  free(list);
  free_csv(steps), free_csv(probes);
  remove_folder(dir);
}

static void a_full_disk_is_an_exit_code_of_its_own(void **state) {
  (void)state;
  static const char *const file[] = {"out/steps.csv", "out/probes.csv", "out/energy.csv",
                                     "out/fields/frame.tmp", "out/result.json.tmp"};
  for (int i = 0; i < 5; i++) {
    char *dir = temporary_folder();
    run_ok(dir, SET("time.end=0.01"));
    unlink(in(dir, file[i]));
    assert_int_equal(symlink("/dev/full", in(dir, file[i])), 0);
    answer a = run_with(dir, (run_options){.quiet = true}, NULL);
    assert_int_equal(a.code, 5);
    assert_non_null(strstr(a.err, file[i]));
    assert_non_null(strstr(a.err, "No space left"));
    forget(a);
    remove_folder(dir);
  }
}

/* All that a run writes stands in the inventory: what is cleaned leaves no file. */
static void the_inventory_is_complete(void **state) {
  (void)state;
  char *dir = temporary_folder();
  forget(run_with(
      dir, (run_options){.quiet = true},
      SET("time.end=0.01", "output.states=binary", "output.fields=vtu", "compare=[polar]")));
  for (int i = 0; i < INVENTORY_SIZE; i++)
    if (inventory[i].listed) assert_true(inventory[i].cleaned);
  assert_true(exists(in(dir, "out/fields/fields_000000.vtu")));
  assert_true(exists(in(dir, "out/compare.csv")));
  assert_ok(folder_clean(in(dir, "out")));
  assert_int_equal(rmdir(in(dir, "out/fields")), 0);
  assert_int_equal(rmdir(in(dir, "out")), 0);
  remove_folder(dir);
}

static void a_bad_scenario_leaves_no_folder(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_with(dir, (run_options){.quiet = true}, SET("groups.top.plane.at=0.3141"));
  assert_int_equal(a.code, 3);
  assert_true(strlen(a.err) > 0);
  assert_false(exists(in(dir, "out")));
  forget(a);
  a = run_with(dir, (run_options){.dir = in(dir, "bar.yaml/out")}, NULL);
  assert_int_equal(a.code, 5);
  assert_non_null(strstr(a.err, "bar.yaml: exists and is not a folder"));
  forget(a);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_run_leaves_its_books),
      cmocka_unit_test(the_phases_make_up_the_time),
      cmocka_unit_test(the_output_grid_leaves_the_steps_alone),
      cmocka_unit_test(the_end_is_an_output_time),
      cmocka_unit_test(exact_frames_stop_at_kinks_only),
      cmocka_unit_test(the_ledger_closes_with_the_tolerance),
      cmocka_unit_test(the_same_run_leaves_the_same_bytes),
      cmocka_unit_test(a_used_folder_holds_one_run),
      cmocka_unit_test(stdout_has_the_result_on_request),
      cmocka_unit_test(an_inverted_element_ends_the_run),
      cmocka_unit_test(an_interrupted_run_keeps_what_it_had),
      cmocka_unit_test(a_killed_run_leaves_whole_rows),
      cmocka_unit_test(a_full_disk_is_an_exit_code_of_its_own),
      cmocka_unit_test(the_inventory_is_complete),
      cmocka_unit_test(a_bad_scenario_leaves_no_folder),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
