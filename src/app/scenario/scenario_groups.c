/* Groups: what a scenario says of them, in which order they can be made, and on the mesh. */
#include "scenario_fault.h"
#include "scenario_parts.h"

/* --- What is said --- */

static corot_status read_nodes(config *tree, const config_node *list, group_def *group) {
  int *node = config_alloc(tree, (size_t)list->nchild, sizeof *node);
  if (!node) return no_memory();
  const config_node *c = list->child;
  for (int i = 0; i < list->nchild; i++, c = c->next) node[i] = (int)c->number;
  group->nnode = list->nchild;
  group->node = node;
  return COROT_OK;
}

static corot_status read_plane(config *tree, config_node *plane, group_def *group) {
  (void)tree;
  group->axis = text_at(plane, "axis")[0] - 'x';
  group->at = number_at(plane, "at");
  return COROT_OK;
}

static corot_status read_box(config *tree, config_node *box, group_def *group) {
  (void)tree;
  vector_at(box, "min", group->min);
  vector_at(box, "max", group->max);
  for (int i = 0; i < 3; i++)
    if (group->min[i] > group->max[i]) return config_fail(box, "min is larger than max");
  return COROT_OK;
}

static corot_status read_sphere(config *tree, config_node *sphere, group_def *group) {
  (void)tree;
  vector_at(sphere, "center", group->point);
  group->size = number_at(sphere, "radius");
  return COROT_OK;
}

static corot_status read_cylinder(config *tree, config_node *cylinder, group_def *group) {
  (void)tree;
  vector_at(cylinder, "from", group->min);
  vector_at(cylinder, "to", group->max);
  group->size = number_at(cylinder, "radius");
  return COROT_OK;
}

static corot_status read_half_space(config *tree, config_node *half, group_def *group) {
  (void)tree;
  vector_at(half, "point", group->point);
  vector_at(half, "normal", group->along);
  return COROT_OK;
}

static corot_status read_normal(config *tree, config_node *normal, group_def *group) {
  (void)tree;
  vector_at(normal, "direction", group->along);
  group->size = number_at(normal, "angle");
  return COROT_OK;
}

static corot_status read_others(config *tree, const config_node *first, int n, group_def *group) {
  const char **other = config_alloc(tree, (size_t)n, sizeof *other);
  if (!other) return no_memory();
  for (int i = 0; i < n; i++, first = first->next) other[i] = first->text;
  group->nother = n;
  group->other = other;
  return COROT_OK;
}

static corot_status read_near(config *tree, config_node *near, group_def *group) {
  group->size = number_at(near, "distance");
  return read_others(tree, config_find(near, "group"), 1, group);
}

static corot_status read_set(config *tree, config_node *list, group_def *group) {
  if (list->nchild < 2)
    return config_fail(list, "two groups or more are wanted, such as [%.64s, another]",
                       list->child->text);
  return read_others(tree, list->child, list->nchild, group);
}

static const struct {
  const char *key;
  corot_status (*read)(config *tree, config_node *node, group_def *group);
  group_kind kind;
  corot_set_operation operation;
} kinds[] = {
    {.key = "plane", .kind = GROUP_PLANE, .read = read_plane},
    {.key = "box", .kind = GROUP_BOX, .read = read_box},
    {.key = "sphere", .kind = GROUP_SPHERE, .read = read_sphere},
    {.key = "cylinder", .kind = GROUP_CYLINDER, .read = read_cylinder},
    {.key = "half_space", .kind = GROUP_HALF_SPACE, .read = read_half_space},
    {.key = "normal", .kind = GROUP_NORMAL, .read = read_normal},
    {.key = "near", .kind = GROUP_NEAR, .read = read_near},
    {"union", read_set, GROUP_COMBINED, COROT_UNION},
    {"intersection", read_set, GROUP_COMBINED, COROT_INTERSECTION},
    {"difference", read_set, GROUP_COMBINED, COROT_DIFFERENCE},
};

static corot_status read_group(config *tree, config_node *entry, group_def *group) {
  group->name = entry->key;
  group->entry = entry;
  config_node *nodes = config_find(entry, "nodes");
  group->kind = GROUP_NODES;
  if (nodes) return read_nodes(tree, nodes, group);
  size_t i = 0;
  while (!config_find(entry, kinds[i].key)) i++;
  group->kind = kinds[i].kind;
  group->operation = kinds[i].operation;
  return kinds[i].read(tree, config_find(entry, kinds[i].key), group);
}

/* --- Their order --- */

/* A walk from groups to those that they are made of. */
typedef struct walk {
  const group_def *group; /* [n] as they are written */
  int n;
  int *next; /* [n] of group.other, which is to be looked at; -1: the group is done */
  int *path; /* [n] those on the way, each made of the next */
  int npath;
  group_def *done; /* [n] in the order in which they can be made */
  int ndone;
} walk;

/* -1: none of the scenario. */
static int number_of(const walk *w, const char *name) {
  for (int i = 0; i < w->n; i++)
    if (strcmp(w->group[i].name, name) == 0) return i;
  return -1;
}

static corot_status refuse_circle(const walk *w, int again) {
  char list[256] = "";
  int first = 0;
  size_t used = 0;
  while (w->path[first] != again) first++;
  for (int i = first; i < w->npath && used < 160; i++)
    used +=
        (size_t)snprintf(list + used, sizeof list - used, "%.64s of ", w->group[w->path[i]].name);
  return config_fail_key(w->group[again].entry, "is made of itself: %s%.64s", list,
                         w->group[again].name);
}

/* Goes on from the last group on the path: to one that it is made of, or back. */
static corot_status step(walk *w) {
  int at = w->path[w->npath - 1];
  const group_def *g = &w->group[at];
  if (w->next[at] == g->nother) {
    w->done[w->ndone++] = *g;
    w->next[at] = -1;
    w->npath--;
    return COROT_OK;
  }
  int other = number_of(w, g->other[w->next[at]++]);
  if (other < 0 || w->next[other] < 0) return COROT_OK;
  for (int i = 0; i < w->npath; i++)
    if (w->path[i] == other) return refuse_circle(w, other);
  w->path[w->npath++] = other;
  return COROT_OK;
}

static corot_status put_in_order(config *tree, int n, const group_def *group, group_def *done) {
  walk w = {.group = group, .n = n, .done = done};
  w.next = config_alloc(tree, (size_t)n, sizeof *w.next);
  w.path = config_alloc(tree, (size_t)n, sizeof *w.path);
  if (!w.next || !w.path) return no_memory();
  for (int k = 0; k < 2 * n; k++) { /* those by place first, which a message can list then */
    int i = k % n;
    if (w.next[i] < 0 || (k < n && group[i].nother)) continue;
    w.path[w.npath++] = i;
    while (w.npath > 0) COROT_TRY(step(&w));
  }
  return COROT_OK;
}

corot_status scenario_read_groups(scenario *s) {
  config_node *map = config_find(s->source->root, "groups");
  size_t n = (size_t)map->nchild;
  group_def *group = config_alloc(s->source, n, sizeof *group);
  group_def *ordered = config_alloc(s->source, n, sizeof *ordered);
  if (!group || !ordered) return no_memory();
  int i = 0;
  for (config_node *c = map->child; c; c = c->next)
    COROT_TRY(config_keep(s->source, read_group(s->source, c, &group[i++])));
  /* of what is made of itself there is no order; it has names, for what is read after it */
  corot_status status = put_in_order(s->source, map->nchild, group, ordered);
  s->group = status ? group : ordered;
  s->ngroup = map->nchild;
  return config_keep(s->source, status);
}

/* --- On the mesh --- */

static corot_status add_group(const group_def *g, corot_mesh *mesh) {
  switch (g->kind) {
    case GROUP_PLANE:
      return corot_mesh_group_plane(mesh, g->name, g->axis, g->at, 0);
    case GROUP_BOX:
      return corot_mesh_group_box(mesh, g->name, g->min, g->max, 0);
    case GROUP_SPHERE:
      return corot_mesh_group_sphere(mesh, g->name, g->point, g->size, 0);
    case GROUP_CYLINDER:
      return corot_mesh_group_cylinder(mesh, g->name, g->min, g->max, g->size, 0);
    case GROUP_HALF_SPACE:
      return corot_mesh_group_half_space(mesh, g->name, g->point, g->along, 0);
    case GROUP_NORMAL:
      return corot_mesh_group_normal(mesh, g->name, g->along, g->size);
    case GROUP_NEAR:
      return corot_mesh_group_near(mesh, g->name, g->other[0], g->size);
    case GROUP_COMBINED:
      return corot_mesh_group_combine(mesh, g->name, g->operation, g->nother, g->other);
    default:
      return corot_mesh_group_nodes(mesh, g->name, g->nnode, g->node);
  }
}

/* Those that a group is made of are there. */
static corot_status check_others(const scenario *s, const group_def *g, const corot_mesh *mesh) {
  config_node *value = g->entry->child;
  const config_node *name = g->kind == GROUP_NEAR ? config_find(value, "group") : value->child;
  for (int i = 0; i < g->nother; i++, name = name->next)
    if (!corot_mesh_find_group(mesh, g->other[i])) return scenario_unknown_other(s, name, mesh);
  return COROT_OK;
}

corot_status scenario_add_groups(const scenario *s, bool by_number, corot_mesh *mesh) {
  for (int i = 0; i < s->ngroup; i++) {
    const group_def *g = &s->group[i];
    if ((g->kind == GROUP_NODES) != by_number) continue;
    COROT_TRY(check_others(s, g, mesh));
    corot_status status = add_group(g, mesh);
    if (status == COROT_ENOMEM) return status;
    if (status != COROT_OK) return config_fail_key(g->entry, "%s", corot_error());
  }
  return COROT_OK;
}
