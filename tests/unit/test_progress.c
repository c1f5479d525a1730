/* The line on the terminal that says how far a run has come. */
#define _XOPEN_SOURCE 700
#include <fcntl.h>
#include <unistd.h>

#include "app/run/progress.h"
#include "app/run/run_clock.h"
#include "check.h"

/* A terminal in the place of stderr. */
typedef struct terminal {
  int master, before;
} terminal;

static terminal open_terminal(void) {
  terminal t = {.master = posix_openpt(O_RDWR | O_NOCTTY)};
  assert_true(t.master >= 0 && grantpt(t.master) == 0 && unlockpt(t.master) == 0);
  int slave = open(ptsname(t.master), O_RDWR | O_NOCTTY);
  t.before = dup(STDERR_FILENO);
  assert_true(slave >= 0 && t.before >= 0 && dup2(slave, STDERR_FILENO) >= 0);
  close(slave);
  return t;
}

/* What has been written since the last call: a mark is written after it, for reading waits where
   there is nothing. */
static const char *written(const terminal *t) {
  static char text[1024];
  size_t n = 0;
  fflush(stderr);
  assert_int_equal(write(STDERR_FILENO, "#", 1), 1);
  do {
    ssize_t got = read(t->master, text + n, 1);
    assert_int_equal(got, 1);
  } while (text[n] != '#' && ++n < sizeof text - 1);
  text[n] = 0;
  return text;
}

static void close_terminal(terminal *t) {
  fflush(stderr);
  dup2(t->before, STDERR_FILENO);
  close(t->before);
  close(t->master);
}

static const corot_step step = {.t = 2.5, .h = 1e-3, .order = 3};

/* A quarter is done after 30 s, so that 90 are left. The line begins anew and wipes what stood
   there. */
static void the_line_tells_how_far(void **state) {
  (void)state;
  terminal t = open_terminal();
  progress p = progress_start(true, 10);
  p.started -= 30, p.shown -= 1;
  progress_show(&p, &step);
  const char *line = written(&t);
  bool soon = wall_clock() - p.started < 30.1; /* else this machine had other things to do */
  close_terminal(&t);
  assert_string_equal(
      line, soon ? "\r\033[Kt = 2.5 of 10 s  h = 1.00e-03 s  order 3   25 %  90 s left" : line);
  assert_non_null(strstr(line, "\r\033[Kt = 2.5 of 10 s  h = 1.00e-03 s  order 3   25 %  "));
}

/* Not again within a fifth of a second: the time of the last line is moved, not waited for. */
static void lines_are_apart(void **state) {
  (void)state;
  terminal t = open_terminal();
  progress p = progress_start(true, 10);
  double began = wall_clock();
  p.shown = began + 1000;
  progress_show(&p, &step);
  bool early = *written(&t);
  p.shown = began - 0.2;
  progress_show(&p, &step);
  bool due = *written(&t);
  double shown = p.shown;
  close_terminal(&t);
  assert_false(early);
  assert_true(due);
  assert_true(shown >= began && shown <= wall_clock());
}

static void the_line_is_taken_away(void **state) {
  (void)state;
  terminal t = open_terminal();
  progress p = progress_start(true, 10);
  progress_clear(&p);
  const char *line = written(&t);
  close_terminal(&t);
  assert_string_equal(line, "\r\033[K");
}

/* Nothing where it is not wanted, or where stderr is a file. */
static void silence(void **state) {
  (void)state;
  terminal t = open_terminal();
  progress p = progress_start(false, 10);
  p.shown -= 1;
  progress_show(&p, &step);
  progress_clear(&p);
  bool unwanted = *written(&t);
  close_terminal(&t);
  assert_false(unwanted);

  int before = dup(STDERR_FILENO), ends[2];
  assert_int_equal(pipe(ends), 0);
  dup2(ends[1], STDERR_FILENO);
  p = progress_start(true, 10);
  p.shown -= 1;
  progress_show(&p, &step);
  progress_clear(&p);
  fflush(stderr);
  dup2(before, STDERR_FILENO);
  close(before), close(ends[1]);
  char c;
  assert_int_equal(read(ends[0], &c, 1), 0);
  close(ends[0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_line_tells_how_far),
      cmocka_unit_test(lines_are_apart),
      cmocka_unit_test(the_line_is_taken_away),
      cmocka_unit_test(silence),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
