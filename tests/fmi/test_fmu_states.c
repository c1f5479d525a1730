/* States of an FMU: who goes back and takes a stretch once more gets the same numbers, bit for bit,
   in the same instance, in another one, and in another process. */
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"
#include "importer.h"

enum { STEPS = 4, NAMES = 3 };
static const double h = 0.0078125;
static const char *const names[NAMES] = {"corner.ux", "speed.vx", "push.ax"};

typedef struct track {
  double value[STEPS][NAMES];
} track;

static void start(const fmu *f, fmi3Instance instance) {
  assert_int_equal(f->EnterInitializationMode(instance, false, 0, 0, true, 0.125), fmi3OK);
  assert_int_equal(f->ExitInitializationMode(instance), fmi3OK);
}

static bool has_inputs(const fmu *f) { return strstr(f->description, "name=\"flesh\"") != NULL; }

/* On for some steps, with inputs that change where there are any. */
static track go_on(const fmu *f, fmi3Instance instance) {
  track made;
  double t = fmu_get(f, instance, "time");
  for (int k = 0; k < STEPS; k++) {
    if (has_inputs(f)) fmu_set(f, instance, "push", 0.3 * (k + 1));
    if (has_inputs(f) && k == 2) fmu_set(f, instance, "flesh", 1.2);
    fmu_step(f, instance, t, h);
    t += h;
    for (int i = 0; i < NAMES; i++) made.value[k][i] = fmu_get(f, instance, names[i]);
  }
  return made;
}

static void check_same(const track *a, const track *b) {
  for (int k = 0; k < STEPS; k++)
    for (int i = 0; i < NAMES; i++)
      if (memcmp(&a->value[k][i], &b->value[k][i], sizeof(double)) != 0)
        fail_msg("step %d, %s: %.17g, and at first it was %.17g", k, names[i], b->value[k][i],
                 a->value[k][i]);
}

/* All kinds of Co-Simulation: with steps that take no notice of communication points, with inputs,
   with held frames, with constant steps. */
static const char *const kinds[] = {"free", "driven", "held", "stepped"};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void one_can_go_back(void **state) {
  (void)state;
  for (int i = 0; i < KINDS; i++) {
    fmu_log log = {0};
    fmu *f = fmu_load(fmu_path(kinds[i]));
    fmi3Instance instance = fmu_simulation(f, &log);
    fmi3FMUState kept = NULL;
    start(f, instance);
    go_on(f, instance);
    double before = fmu_get(f, instance, "push.ax");
    assert_int_equal(f->GetFMUState(instance, &kept), fmi3OK);
    assert_close(fmu_get(f, instance, "push.ax"), before, 1e-12, 0);
    track first = go_on(f, instance);
    for (int times = 0; times < 2; times++) {
      assert_int_equal(f->SetFMUState(instance, kept), fmi3OK);
      assert_true(fmu_get(f, instance, "time") == STEPS * h);
      track again = go_on(f, instance);
      check_same(&first, &again);
    }
    assert_int_equal(f->FreeFMUState(instance, &kept), fmi3OK);
    assert_null(kept);
    f->FreeInstance(instance);
    assert_string_equal(log.message, "");
    fmu_unload(f);
  }
}

/* Communication points that lie so near to each other that the integrator's steps pass several:
   what it has done beyond the moment is given up where a state is kept. */
static void one_can_go_back_within_a_step_of_the_integrator(void **state) {
  (void)state;
  const double tiny = h / 4096;
  fmu_log log = {0};
  fmu *f = fmu_load(fmu_path("free"));
  fmi3Instance instance = fmu_simulation(f, &log);
  fmi3FMUState kept = NULL;
  start(f, instance);
  fmu_step(f, instance, 0, 6 * h);
  double t = 6 * h, u[2][16];
  for (int k = 0; k < 5; k++, t += tiny) fmu_step(f, instance, t, tiny);
  double before = fmu_get(f, instance, "speed.vx");
  assert_int_equal(f->GetFMUState(instance, &kept), fmi3OK);
  assert_true(fmu_get(f, instance, "speed.vx") == before);
  for (int times = 0; times < 2; times++) {
    for (int k = 0; k < 16; k++) {
      fmu_step(f, instance, t + k * tiny, tiny);
      u[times][k] = fmu_get(f, instance, "speed.vx");
    }
    assert_int_equal(f->SetFMUState(instance, kept), fmi3OK);
  }
  assert_memory_equal(u[0], u[1], sizeof u[0]);
  assert_close(u[0][0], before, 1e-2, 0);
  f->FreeInstance(instance);
  assert_string_equal(log.message, "");
  fmu_unload(f);
}

/* Inputs that have been set, and that the integrator has not met yet, are a part of the state. */
static void inputs_that_wait_for_the_next_step_are_kept(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) { /* before the first step, and after one */
    fmu_log log = {0};
    fmu *f = fmu_load(fmu_path("driven"));
    fmi3Instance instance = fmu_simulation(f, &log);
    fmi3FMUState kept = NULL;
    start(f, instance);
    if (k) fmu_step(f, instance, 0, h);
    fmu_set(f, instance, "push", 2.0);
    fmu_set(f, instance, "flesh", 1.7);
    assert_int_equal(f->GetFMUState(instance, &kept), fmi3OK);
    fmu_step(f, instance, k * h, h);
    double first = fmu_get(f, instance, "corner.ux");
    fmu_set(f, instance, "push", -1.0);
    assert_int_equal(f->SetFMUState(instance, kept), fmi3OK);
    assert_true(fmu_get(f, instance, "push") == 2.0 && fmu_get(f, instance, "flesh") == 1.7);
    fmu_step(f, instance, k * h, h);
    assert_true(fmu_get(f, instance, "corner.ux") == first);
    f->FreeInstance(instance);
    assert_string_equal(log.message, "");
    fmu_unload(f);
  }
}

/* The state that was saved is one of the same motion: it goes on as the run does, within what the
   new beginning costs. */
static void going_on_is_the_same_motion(void **state) {
  (void)state;
  fmu_log log = {0};
  fmu *f = fmu_load(fmu_path("free"));
  fmi3Instance saved = fmu_simulation(f, &log), other = fmu_simulation(f, &log);
  fmi3FMUState kept = NULL;
  start(f, saved);
  start(f, other);
  go_on(f, saved);
  go_on(f, other);
  assert_int_equal(f->GetFMUState(saved, &kept), fmi3OK);
  track a = go_on(f, saved), b = go_on(f, other);
  for (int k = 0; k < STEPS; k++) assert_close(a.value[k][0], b.value[k][0], 1e-3, 1e-6);
  /* sums of work, which begin anew with the integrator, go on */
  assert_close(fmu_get(f, saved, "given.value"), fmu_get(f, other, "given.value"), 1e-3, 1e-8);
  assert_close(fmu_get(f, saved, "lost.value"), fmu_get(f, other, "lost.value"), 1e-3, 1e-8);
  assert_below(fabs(fmu_get(f, saved, "off.value")), 1e-4 * fmu_get(f, saved, "given.value"));
  f->FreeInstance(saved); /* with the state that is still kept */
  f->FreeInstance(other);
  fmu_unload(f);
}

/* --- As bytes --- */

static fmi3Byte *bytes_of(const fmu *f, fmi3Instance instance, size_t *size) {
  fmi3FMUState kept = NULL;
  assert_int_equal(f->GetFMUState(instance, &kept), fmi3OK);
  assert_int_equal(f->SerializedFMUStateSize(instance, kept, size), fmi3OK);
  fmi3Byte *bytes = malloc(*size);
  assert_non_null(bytes);
  assert_int_equal(f->SerializeFMUState(instance, kept, bytes, *size), fmi3OK);
  assert_int_equal(f->FreeFMUState(instance, &kept), fmi3OK);
  return bytes;
}

/* A new process takes the bytes from a pipe, goes on, and sends back what it found. */
static track in_another_process(const char *kind, const fmi3Byte *bytes, size_t size) {
  int down[2], up[2], status;
  track found;
  char text[32];
  assert_int_equal(pipe(down), 0);
  assert_int_equal(pipe(up), 0);
  pid_t child = fork();
  if (child == 0) {
    dup2(down[0], 0), dup2(up[1], 1);
    close(down[1]), close(up[0]);
    snprintf(text, sizeof text, "%zu", size);
    execl("/proc/self/exe", "test_fmu_states", "--go-on", kind, text, (char *)NULL);
    _exit(9);
  }
  close(down[0]), close(up[1]);
  for (size_t done = 0; done < size;) {
    ssize_t n = write(down[1], bytes + done, size - done);
    assert_true(n > 0);
    done += (size_t)n;
  }
  close(down[1]);
  assert_int_equal(read(up[0], &found, sizeof found), sizeof found);
  close(up[0]);
  waitpid(child, &status, 0);
  assert_int_equal(status, 0);
  return found;
}

/* What that process does; the answer goes to its output. */
static int go_on_alone(const char *kind, size_t size) {
  fmu_log log = {0};
  fmu *f = fmu_load(fmu_path(kind));
  fmi3Instance instance = fmu_simulation(f, &log);
  fmi3FMUState kept = NULL;
  fmi3Byte *bytes = malloc(size);
  if (!bytes || fread(bytes, 1, size, stdin) != size) return 2;
  if (f->DeserializeFMUState(instance, bytes, size, &kept) != fmi3OK) return 3;
  if (f->SetFMUState(instance, kept) != fmi3OK) return 4;
  track found = go_on(f, instance);
  f->FreeInstance(instance);
  fmu_unload(f);
  free(bytes);
  return fwrite(&found, sizeof found, 1, stdout) == 1 && fflush(stdout) == 0 ? 0 : 5;
}

static void another_process_goes_on(void **state) {
  (void)state;
  for (int i = 0; i < KINDS; i++) {
    fmu_log log = {0};
    size_t size;
    fmu *f = fmu_load(fmu_path(kinds[i]));
    fmi3Instance instance = fmu_simulation(f, &log);
    fmu_set(f, instance, "material.mu", 1.5e4); /* which the other one has to take over */
    start(f, instance);
    go_on(f, instance);
    fmi3Byte *bytes = bytes_of(f, instance, &size);
    track here = go_on(f, instance), there = in_another_process(kinds[i], bytes, size);
    check_same(&here, &there);
    free(bytes);
    f->FreeInstance(instance);
    assert_string_equal(log.message, "");
    fmu_unload(f);
  }
}

static void bytes_that_are_cut_or_damaged_are_refused(void **state) {
  (void)state;
  fmu_log log = {0};
  size_t size;
  fmu *f = fmu_load(fmu_path("driven"));
  fmi3Instance instance = fmu_simulation(f, &log);
  fmi3FMUState kept = NULL;
  start(f, instance);
  go_on(f, instance);
  fmi3Byte *bytes = bytes_of(f, instance, &size);
  for (size_t cut = 0; cut < size; cut += 1 + size / 97)
    assert_int_equal(f->DeserializeFMUState(instance, bytes, cut, &kept), fmi3Error);
  for (size_t k = 0; k < size; k += 1 + size / 97) {
    bytes[k] ^= 4;
    assert_int_equal(f->DeserializeFMUState(instance, bytes, size, &kept), fmi3Error);
    bytes[k] ^= 4;
  }
  assert_null(kept);
  assert_int_equal(f->DeserializeFMUState(instance, bytes, size, &kept), fmi3OK);
  assert_int_equal(f->SetFMUState(instance, kept), fmi3OK);
  /* those of another FMU */
  fmu *other = fmu_load(fmu_path("stepped"));
  fmi3Instance stranger = fmu_simulation(other, &log);
  kept = NULL;
  assert_int_equal(other->DeserializeFMUState(stranger, bytes, size, &kept), fmi3Error);
  assert_non_null(strstr(log.message, "another FMU"));
  other->FreeInstance(stranger);
  fmu_unload(other);
  free(bytes);
  f->FreeInstance(instance);
  fmu_unload(f);
}

/* --- Model Exchange, and before the start --- */

static void states_of_model_exchange_are_whole(void **state) {
  (void)state;
  fmu_log log = {0};
  fmu *f = fmu_load(fmu_path("driven"));
  fmi3Instance instance = fmu_exchange(f, &log);
  fmi3FMUState kept = NULL;
  fmi3Boolean flag[5];
  double next;
  assert_int_equal(f->EnterInitializationMode(instance, false, 0, 0, false, 0), fmi3OK);
  assert_int_equal(f->ExitInitializationMode(instance), fmi3OK);
  f->UpdateDiscreteStates(instance, &flag[0], &flag[1], &flag[2], &flag[3], &flag[4], &next);
  assert_int_equal(f->EnterContinuousTimeMode(instance), fmi3OK);
  size_t n = 2 * fmu_size(f, "body.u");
  double *x = calloc(3 * n, sizeof *x), *slope = x + n, *again = slope + n;
  for (size_t i = 0; i < n; i++) x[i] = 1e-4 * sin((double)i);
  assert_int_equal(f->SetTime(instance, 0.25), fmi3OK);
  assert_int_equal(f->SetContinuousStates(instance, x, n), fmi3OK);
  fmu_set(f, instance, "push", 0.7);
  assert_int_equal(f->GetContinuousStateDerivatives(instance, slope, n), fmi3OK);
  assert_int_equal(f->GetFMUState(instance, &kept), fmi3OK);
  /* away, and back */
  fmu_set(f, instance, "push", 0.0);
  assert_int_equal(f->SetTime(instance, 0.5), fmi3OK);
  memset(again, 0, n * sizeof *again);
  assert_int_equal(f->SetContinuousStates(instance, again, n), fmi3OK);
  assert_int_equal(f->Reset(instance), fmi3OK);
  assert_int_equal(f->SetFMUState(instance, kept), fmi3OK);
  assert_true(fmu_get(f, instance, "time") == 0.25 && fmu_get(f, instance, "push") == 0.7);
  assert_int_equal(f->GetContinuousStateDerivatives(instance, again, n), fmi3OK);
  assert_memory_equal(again, slope, n * sizeof *slope);
  free(x);
  f->FreeInstance(instance);
  assert_string_equal(log.message, "");
  fmu_unload(f);
}

static void settings_before_the_start_are_kept(void **state) {
  (void)state;
  fmu_log log = {0};
  fmu *f = fmu_load(fmu_path("driven"));
  fmi3Instance instance = fmu_simulation(f, &log);
  fmi3FMUState kept = NULL;
  fmu_set(f, instance, "material.density", 900.0);
  fmu_set(f, instance, "push", 0.2);
  assert_int_equal(f->GetFMUState(instance, &kept), fmi3OK);
  start(f, instance);
  track first = go_on(f, instance);
  assert_int_equal(f->Reset(instance), fmi3OK);
  assert_true(fmu_get(f, instance, "material.density") == 1000.0);
  assert_int_equal(f->SetFMUState(instance, kept), fmi3OK);
  assert_true(fmu_get(f, instance, "material.density") == 900.0);
  assert_true(fmu_get(f, instance, "push") == 0.2);
  start(f, instance); /* which is allowed before the start alone */
  track again = go_on(f, instance);
  check_same(&first, &again);
  f->FreeInstance(instance);
  assert_string_equal(log.message, "");
  fmu_unload(f);
}

int main(int argc, char **argv) {
  if (argc == 4) return go_on_alone(argv[2], strtoul(argv[3], NULL, 10));
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_can_go_back),
      cmocka_unit_test(one_can_go_back_within_a_step_of_the_integrator),
      cmocka_unit_test(inputs_that_wait_for_the_next_step_are_kept),
      cmocka_unit_test(going_on_is_the_same_motion),
      cmocka_unit_test(another_process_goes_on),
      cmocka_unit_test(bytes_that_are_cut_or_damaged_are_refused),
      cmocka_unit_test(states_of_model_exchange_are_whole),
      cmocka_unit_test(settings_before_the_start_are_kept),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
