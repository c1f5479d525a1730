/* A small solid, and studies of it in a folder of their own. */
#ifndef STUDY_TEXT_H
#define STUDY_TEXT_H

#include "study/plan/plan.h"
#include "temporary.h"

/* A free cube of two cells, of rest length sqrt(2) x ... : nothing holds it, so that any field is a
   state of it. */
#define FREE_CUBE                                                   \
  "mesh: {box: {size: [1, 1, 1], cells: [1, 1, 2], split: kuhn}}\n" \
  "material: {lambda: 300, mu: 100, density: 2}\n"                  \
  "loads: [{gravity: [0, 0, -10]}]\n"                               \
  "time: {end: 1, output: 0.5}\n"                                   \
  "probes: {corner: {point: [1, 1, 1]}}\n"

/* The study of a file with these lines beside its heads, in DIR/study.yaml over DIR/model.yaml. */
static inline corot_status study_of(const char *dir, const char *lines, study **s) {
  char text[4096];
  put_file(in(dir, "model.yaml"), FREE_CUBE);
  snprintf(text, sizeof text, "study: which\nbase: model.yaml\n%s", lines);
  return study_read_text(in(dir, "study.yaml"), text, strlen(text), s);
}

static inline study *accept_study(const char *dir, const char *lines) {
  study *s = NULL;
  assert_ok(study_of(dir, lines, &s));
  return s;
}

static inline manifest *planned(const char *dir, const char *lines) {
  study *s = accept_study(dir, lines);
  manifest *m = NULL;
  assert_ok(plan_study(s, &m));
  study_destroy(s);
  return m;
}

#endif
