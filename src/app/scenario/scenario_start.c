/* The velocities a run starts with. */
#include "scenario_parts.h"

static corot_status read_spin(config_node *node, start_def *start) {
  vector_at(node, "axis", start->axis);
  vector_at(node, "center", start->center);
  start->rate = number_at(node, "rate");
  double *axis = start->axis;
  double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  if (!(length > 0 && isfinite(length)))
    return config_fail(config_find(node, "axis"), "[%g, %g, %g] has no direction", axis[0], axis[1],
                       axis[2]);
  for (int c = 0; c < 3; c++) axis[c] /= length;
  return COROT_OK;
}

/* One of the maps under start. */
static corot_status read_entry(scenario *s, config_node *node, bool alone) {
  config_node *velocity = config_find(node, "velocity"), *spin = config_find(node, "spin");
  config_node *from = config_find(node, "from");
  start_def *start = (start_def *)&s->start[s->nstart];
  start->group = text_at(node, "group");
  if (from && start->group)
    return config_fail_key(from, "is for the whole body: not in an entry with a group");
  if (from && s->start_from) return config_fail_key(from, "is given twice");
  if (from) s->start_from = from->text;
  if (!velocity && !spin && !(from && alone))
    return config_fail(node, "velocity or spin is missing");
  if (velocity) vector_at(node, "velocity", start->velocity);
  if (spin) COROT_TRY(read_spin(spin, start));
  s->nstart += velocity || spin;
  return COROT_OK;
}

/* A body at rest is undeformed only where nothing that moves it is displaced. */
static corot_status check_moved(scenario *s) {
  if (s->start_at_equilibrium) return COROT_OK;
  const corot_motion *m = s->motion;
  config_node *c = config_find(s->source->root, "boundary")->child;
  for (; c; c = c->next) {
    if (config_find(c, "fix")) continue;
    if (config_find(c, "move"))
      COROT_TRY(scenario_check_moved_start(config_find(c, "move.amplitude"), &m->amplitude));
    m++;
  }
  return COROT_OK;
}

corot_status scenario_read_start(scenario *s) {
  config_node *node = config_find(s->source->root, "start");
  int n = node->kind == CONFIG_LIST ? node->nchild : 1;
  s->start = config_alloc(s->source, (size_t)n, sizeof *s->start);
  if (!s->start) return no_memory();
  if (node->kind == CONFIG_SCALAR) s->start_from = node->text;
  if (node->kind == CONFIG_MAP) COROT_TRY(read_entry(s, node, true));
  if (node->kind == CONFIG_LIST)
    for (config_node *c = node->child; c; c = c->next) COROT_TRY(read_entry(s, c, n == 1));
  s->start_at_equilibrium = s->start_from && strcmp(s->start_from, "equilibrium") == 0;
  return check_moved(s);
}

/* The velocity of node n, displaced by u. */
static void give(const corot_model *model, const start_def *start, int n, const double *u,
                 double *v) {
  const int *dof = corot_model_dof(model)[n];
  double arm[3];
  for (int c = 0; c < 3; c++)
    arm[c] = corot_model_mesh(model)->x[n][c] + (dof[c] >= 0 ? u[dof[c]] : 0) - start->center[c];
  for (int c = 0; c < 3; c++) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    double turn = start->rate * (start->axis[i] * arm[j] - start->axis[j] * arm[i]);
    if (dof[c] >= 0) v[dof[c]] = start->velocity[c] + turn;
  }
}

void scenario_start(const scenario *s, const corot_model *model, const double *u, double *v) {
  const corot_mesh *mesh = corot_model_mesh(model);
  for (int i = 0; i < corot_model_ndof(model); i++) v[i] = 0;
  for (int k = 0; k < s->nstart; k++) {
    const start_def *start = &s->start[k];
    const corot_group *group = start->group ? corot_mesh_find_group(mesh, start->group) : NULL;
    int n = start->group ? (group ? group->nnode : 0) : mesh->nnode;
    for (int i = 0; i < n; i++) give(model, start, group ? group->node[i] : i, u, v);
  }
}
