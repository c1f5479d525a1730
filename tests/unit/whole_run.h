/* Whole runs of a scenario into a folder, and reading what they leave there. */
#ifndef WHOLE_RUN_H
#define WHOLE_RUN_H

#include <fcntl.h>

#include "app/run/run.h"
#include "temporary.h"

static const char bar[] =
    "title: a bar\n"
    "mesh: {box: {size: [0.1, 0.1, 0.4], cells: [1, 1, 4], split: kuhn}}\n"
    "groups:\n"
    "  base: {plane: {axis: z, at: 0.0}}\n"
    "  top: {plane: {axis: z, at: 0.4}}\n"
    "material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}\n"
    "boundary:\n"
    "  - {group: base, fix: [x, y, z]}\n"
    "loads:\n"
    "  - {group: top, traction: [200.0, 0.0, 0.0], amplitude: [[0.0, 0.0], [0.3, 1.0]]}\n"
    "time: {end: 1.0, output: 0.1}\n"
    "probes: {corner: {point: [0.1, 0.1, 0.4]}}\n";

/* Methods of every kind. */
static const char *const every_method[] = {
    "integrator={method: cvode}",
    "integrator={method: ida}",
    "integrator={method: arkode}",
    "integrator={method: erk}",
    "integrator={method: newmark, step: 0.0125}",
    "integrator={method: bdf3, step: 0.0125}",
    "integrator={method: backward-euler, step: 0.03}", /* which passes the end */
};
enum { NEVERY = sizeof every_method / sizeof *every_method };

/* What a run answered and said. */
typedef struct answer {
  int code;
  char *out, *err;
} answer;

static inline void forget(answer a) {
  free(a.out);
  free(a.err);
}

/* Points a standard stream to a file; returns what it was. */
static inline int redirect(FILE *stream, const char *path) {
  fflush(stream);
  int before = dup(fileno(stream)), fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  assert_true(before >= 0 && fd >= 0 && dup2(fd, fileno(stream)) >= 0);
  close(fd);
  return before;
}

static inline void restore(FILE *stream, int before) {
  fflush(stream);
  dup2(before, fileno(stream));
  close(before);
}

/* Runs a scenario with overrides, ending with NULL, into DIR/out. */
static inline answer run_text(const char *dir, const char *text, run_options options,
                              const char *const *set) {
  int n = 0;
  while (set && set[n]) n++;
  put_file(in(dir, "bar.yaml"), text);
  scenario *s = NULL;
  assert_ok(scenario_read(in(dir, "bar.yaml"), n, (char *const *)set, &s));
  if (!options.dir) options.dir = in(dir, "out");
  int out = redirect(stdout, in(dir, "stdout")), err = redirect(stderr, in(dir, "stderr"));
  answer a = {.code = run_scenario(s, &options)};
  restore(stdout, out);
  restore(stderr, err);
  a.out = slurp(in(dir, "stdout"), NULL);
  a.err = slurp(in(dir, "stderr"), NULL);
  scenario_destroy(s);
  return a;
}

/* The same of the bar. */
static inline answer run_with(const char *dir, run_options options, const char *const *set) {
  return run_text(dir, bar, options, set);
}

#define SET(...) ((const char *const[]){__VA_ARGS__, NULL})

/* The same, expecting success. */
static inline void run_ok(const char *dir, const char *const *set) {
  answer a = run_with(dir, (run_options){.quiet = true}, set);
  if (a.code != 0) fail_msg("exit code %d: %s", a.code, a.err);
  assert_string_equal(a.err, "");
  assert_string_equal(a.out, "");
  forget(a);
}

static inline json_t *result_of(const char *dir) {
  json_error_t why;
  json_t *result = json_load_file(in(dir, "out/result.json"), 0, &why);
  if (!result) fail_msg("result.json:%d: %s", why.line, why.text);
  return result;
}

static inline double number(json_t *object, const char *key, const char *inner) {
  json_t *value = json_object_get(object, key);
  if (inner) value = json_object_get(value, inner);
  if (!json_is_number(value)) fail_msg("result.json: %s %s is no number", key, inner ? inner : "");
  return json_number_value(value);
}

static inline const char *word(json_t *object, const char *key, const char *inner) {
  json_t *value = json_object_get(object, key);
  if (inner) value = json_object_get(value, inner);
  if (!json_is_string(value)) fail_msg("result.json: %s %s is no text", key, inner ? inner : "");
  return json_string_value(value);
}

enum { COLUMNS = 16 };

/* A table without quotes, of at most COLUMNS columns. */
typedef struct csv {
  int nrow;
  double (*x)[COLUMNS]; /* [nrow] numbers; empty cells and words are NaN */
  char (*event)[64];    /* [nrow] the sixth column as it is */
  char (*reason)[64];   /* [nrow] the tenth */
} csv;

static inline csv read_csv(const char *path) {
  char *text = slurp(path, NULL);
  csv c = {0};
  for (char *line = strchr(text, '\n') + 1; *line; c.nrow++) {
    c.x = realloc(c.x, (size_t)(c.nrow + 1) * sizeof *c.x);
    c.event = realloc(c.event, (size_t)(c.nrow + 1) * sizeof *c.event);
    c.reason = realloc(c.reason, (size_t)(c.nrow + 1) * sizeof *c.reason);
    assert_true(c.x && c.event && c.reason);
    c.event[c.nrow][0] = c.reason[c.nrow][0] = '\0';
    char *end = strchr(line, '\n');
    assert_non_null(end); /* only whole rows */
    *end = '\0';
    for (int k = 0; k < COLUMNS && line; k++) {
      char *comma = strchr(line, ','), *rest;
      if (comma) *comma = '\0';
      double x = strtod(line, &rest);
      c.x[c.nrow][k] = *line && !*rest ? x : NAN;
      if (k == 5) snprintf(c.event[c.nrow], sizeof *c.event, "%s", line);
      if (k == 9) snprintf(c.reason[c.nrow], sizeof *c.reason, "%s", line);
      line = comma ? comma + 1 : NULL;
    }
    line = end + 1;
  }
  free(text);
  return c;
}

static inline void free_csv(csv c) {
  free(c.x);
  free(c.event);
  free(c.reason);
}

static inline double last_time(csv c) { return c.x[c.nrow - 1][0]; }

static inline void assert_same_file(const char *a, const char *b) {
  size_t size_a, size_b;
  char *text_a = slurp(a, &size_a), *text_b = slurp(b, &size_b);
  if (size_a != size_b || memcmp(text_a, text_b, size_a) != 0) fail_msg("%s: differs", a);
  free(text_a);
  free(text_b);
}

/* A column of a table at DIR/out, [nrow] in the caller's array of `size`; returns nrow. */
static inline int column(const char *dir, const char *file, int k, int size, double *x) {
  char path[64];
  snprintf(path, sizeof path, "out/%s", file);
  csv c = read_csv(in(dir, path));
  assert_true(c.nrow <= size);
  for (int i = 0; i < c.nrow; i++) x[i] = c.x[i][k];
  int n = c.nrow;
  free_csv(c);
  return n;
}

#endif
