/* Scenarios written in a test: the shortest one, and what is said of one that is refused. */
#ifndef SCENARIO_TEXT_H
#define SCENARIO_TEXT_H

#include <stdio.h>

#include "app/scenario/scenario.h"
#include "check.h"

#define MESH "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2], split: kuhn}}\n"
#define MATERIAL "material: {lambda: 1.0e5, mu: 1.0e4, density: 1000}\n"
#define TIME "time: {end: 2}\n"
#define MINIMAL MESH MATERIAL TIME /* 3 lines */

#define FILE_NAME BINARY_DIR "/" TEST_NAME ".yaml"
#define JSON_NAME BINARY_DIR "/" TEST_NAME ".json"

static inline void write_file(const char *path, const char *text, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

static inline corot_status read_as(const char *path, const char *text, scenario **s) {
  write_file(path, text, strlen(text));
  return scenario_read(path, 0, NULL, s);
}

static inline scenario *accept(const char *text) {
  scenario *s = NULL;
  assert_ok(read_as(FILE_NAME, text, &s));
  return s;
}

/* The message is FILE:PLACE: WORDS. */
static inline void refuse(const char *text, const char *place_and_words) {
  scenario *s = NULL;
  char expected[1024];
  snprintf(expected, sizeof expected, "%s:%s", FILE_NAME, place_and_words);
  assert_fails(read_as(FILE_NAME, text, &s), COROT_EFORMAT, expected);
  assert_null(s);
}

typedef struct refusal {
  const char *text;
  const char *message; /* from LINE:COLUMN on */
} refusal;

/* Of scenarios that are read, and refused where mesh and model are made. */
static inline void refuse_builds(const refusal *r, size_t n) {
  for (size_t i = 0; i < n; i++) {
    corot_mesh *mesh = NULL;
    corot_refinement *refinement = NULL;
    corot_model *model = NULL;
    scenario *s = accept(r[i].text);
    assert_fails(scenario_build(s, &mesh, &refinement, &model), COROT_EFORMAT, r[i].message);
    assert_true(!mesh && !refinement && !model);
    scenario_destroy(s);
  }
}

#endif
