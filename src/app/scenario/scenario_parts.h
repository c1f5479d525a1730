/* Inside of reading a scenario: the parts that have a file of their own, and how values are taken
   from the tree. After schema_apply every key has its type, its range and, where there is one, its
   default: what is left to check is how keys go together. */
#ifndef COROT_APP_SCENARIO_SCENARIO_PARTS_H
#define COROT_APP_SCENARIO_SCENARIO_PARTS_H

#include <math.h>
#include <string.h>

#include "app/config/config.h"
#include "app/text/no_memory.h"
#include "scenario.h"
#include "words.h"

/* groups, in an order in which they can be made */
corot_status scenario_read_groups(scenario *s);

/* The groups by numbers of nodes, or the others, on the mesh. */
corot_status scenario_add_groups(const scenario *s, bool by_number, corot_mesh *mesh);

/* boundary and loads */
corot_status scenario_read_conditions(scenario *s);

/* mass, dilatation, viscosity, frames, integrator and linear_solver */
corot_status scenario_read_method(scenario *s);

/* Whether the linear solver may have to know the levels of mesh.refine. */
bool scenario_solves_by_levels(const scenario *s);

/* The levels above the mesh as it is given: of mesh.refine, unless mesh.marks follow, and of
   mesh.order: 2 one more. */
int scenario_levels(const scenario *s);

/* COROT_EFORMAT: the preconditioner needs levels. */
corot_status scenario_refuse_levels(const scenario *s);

/* hierarchy */
corot_status scenario_read_hierarchy(scenario *s);

/* statics, after linear_solver */
corot_status scenario_read_statics(scenario *s);

/* start, after boundary */
corot_status scenario_read_start(scenario *s);

/* probes; and whether they fit the mesh */
corot_status scenario_read_probes(scenario *s);
corot_status scenario_check_probes(const scenario *s, const corot_mesh *mesh);

/* quantities, after time */
corot_status scenario_read_quantities(scenario *s);

/* A name becomes the head of columns of a CSV file, or a key of result.json. */
bool scenario_is_column_name(const char *name);

/* inputs, after time, integrator and compare */
corot_status scenario_read_inputs(scenario *s);

/* An amplitude; its memory is the tree's. */
corot_status scenario_read_amplitude(scenario *s, config_node *node, corot_amplitude *a);

/* COROT_EFORMAT at `node` where the amplitude of a motion is not zero at t = 0. */
corot_status scenario_check_moved_start(const config_node *node, const corot_amplitude *a);

static inline double number_at(config_node *node, const char *path) {
  return config_find(node, path)->number;
}

static inline const char *text_at(config_node *node, const char *path) {
  const config_node *found = config_find(node, path);
  return found ? found->text : NULL;
}

static inline bool text_is(config_node *node, const char *path, const char *text) {
  return strcmp(text_at(node, path), text) == 0;
}

/* The number of the word there, one of those in the list as the schema has seen to; -1: it is a
   word of the scenario alone, as auto. */
static inline int choice_at(config_node *node, const char *path, const char *const *words) {
  return words_find(words, text_at(node, path));
}

static inline void vector_at(config_node *node, const char *path, double vector[3]) {
  const config_node *c = config_find(node, path)->child;
  for (int i = 0; i < 3; i++, c = c->next) vector[i] = c->number;
}

#endif
