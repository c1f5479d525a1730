/* Reads probes, and holds them against the mesh. */
#include "app/text/plural.h"
#include "probe_location.h"
#include "scenario_fault.h"
#include "scenario_parts.h"

/* --- Of what --- */

/* The quantity with its article, as in "a reaction". */
static const char *named(const probe_quantity *q) {
  static const char *const bare[] = {"elastic",       "kinetic",      "dissipated",
                                     "external_work", "frame_energy", "balance",
                                     "det",           "principal",    "von_mises"};
  for (size_t i = 0; i < sizeof bare / sizeof *bare; i++)
    if (strcmp(q->word, bare[i]) == 0) return "";
  return strchr("aeiou", q->word[0]) ? "an " : "a ";
}

static corot_status read_of(config_node *map, probe_def *p) {
  config_node *of = config_find(map, "of");
  for (int i = 0; of && i < NPROBE_OF; i++)
    if (strcmp(of->text, probe_quantities[i].word) == 0) p->of = (probe_of)i;
  if (p->body && !of)
    return config_fail_key(map,
                           "give a point, a node or a group, or say with of what is recorded of "
                           "the whole body");
  return COROT_OK;
}

static corot_status read_place(config_node *map, probe_def *p) {
  const config_node *node = config_find(map, "node"), *group = config_find(map, "group");
  config_node *nearest = config_find(map, "nearest");
  bool point = config_find(map, "point") != NULL;
  p->node = node ? (int)node->number : -1;
  p->group = group ? group->text : NULL;
  p->body = !node && !group && !point;
  if (point) vector_at(map, "point", p->point);
  if (nearest && !point) return config_fail_key(nearest, "only a point has a nearest node");
  p->nearest = nearest && strcmp(nearest->text, "true") == 0;
  return COROT_OK;
}

/* Whether the quantity goes with the place. */
static corot_status check_place(config_node *map, const probe_def *p) {
  const probe_quantity *q = &probe_quantities[p->of];
  const char *key = p->group ? "group" : p->node >= 0 ? "node" : "point";
  config_node *place = config_find(map, key);
  if (q->carrier == OF_BODY && place)
    return config_fail_key(place, "%s is of the whole body: leave out the %s", q->word, key);
  if (q->carrier == OF_FACES && !p->group)
    return config_fail_key(place ? place : map, "%s%s is of the faces of a group: give a group",
                           named(q), q->word);
  if (q->carrier == SUM_OVER_NODES && place && p->node < 0 && !p->group)
    return config_fail_key(
        place, "%s%s is of nodes: give a node or a group, or neither for the whole body", named(q),
        q->word);
  if (q->carrier == SUM_OVER_TETS && place && !p->group)
    return config_fail_key(place, "%s%s is of tets: give a group, or none for the whole body",
                           named(q), q->word);
  return COROT_OK;
}

/* --- How --- */

static corot_status read_take(config_node *map, probe_def *p) {
  const probe_quantity *q = &probe_quantities[p->of];
  config_node *take = config_find(map, "take");
  bool whole = q->carrier >= SUM_OVER_NODES;
  if (take && probe_is_local(p))
    return config_fail_key(take, "a %s has one value: take is for a group or the whole body",
                           p->node >= 0 ? "node" : "point");
  if (take && whole && strcmp(take->text, "sum") != 0)
    return config_fail(take, "%s%s is the sum over %s: it has no %s", named(q), q->word,
                       p->group ? "its group" : "the body", take->text);
  p->take = take ? (probe_take)words_find(probe_takes, take->text) : TAKE_UNSAID;
  if (!take) p->take = whole ? TAKE_SUM : p->of == PROBE_DET ? TAKE_MIN : TAKE_MEAN;
  return COROT_OK;
}

static corot_status read_component(config_node *map, probe_def *p) {
  const probe_quantity *q = &probe_quantities[p->of];
  config_node *component = config_find(map, "component");
  /* the largest traction is the longest */
  bool extreme = p->take == TAKE_MAX || p->take == TAKE_MIN;
  if (!component && extreme && p->of == PROBE_TRACTION) p->component = COMPONENT_MAGNITUDE;
  if (!component) return COROT_OK;
  if (!q->component)
    return config_fail_key(component, "%s%s has no components to choose from", named(q), q->word);
  int index = words_find(probe_components, component->text);
  int last = q->component == COMPONENT_VECTOR ? COMPONENT_MAGNITUDE : q->component + q->n - 1;
  if (index < q->component || index > last)
    return config_fail(component, "no component of %s%s, which are %s to %s", named(q), q->word,
                       probe_components[q->component], probe_components[last]);
  p->component = index;
  return COROT_OK;
}

static corot_status read_part(config_node *map, probe_def *p) {
  config_node *part = config_find(map, "part"), *about = config_find(map, "about");
  if (part && p->of != PROBE_REACTION)
    return config_fail_key(part, "only a reaction has parts, not %s%s",
                           named(&probe_quantities[p->of]), probe_quantities[p->of].word);
  if (about && !probe_quantities[p->of].about)
    return config_fail_key(about,
                           "%s%s has no moment: about is for reaction, force and "
                           "angular_momentum",
                           named(&probe_quantities[p->of]), probe_quantities[p->of].word);
  p->part = part ? (probe_part)words_find(probe_parts, part->text) : PART_TOTAL;
  if (about) vector_at(map, "about", p->about);
  return COROT_OK;
}

static corot_status read_probe(config_node *map, probe_def *p) {
  if (!scenario_is_column_name(map->key))
    return config_fail_key(map, "the name of a probe is made of letters, digits, _ and -");
  p->name = map->key;
  COROT_TRY(read_place(map, p));
  COROT_TRY(read_of(map, p));
  COROT_TRY(check_place(map, p));
  COROT_TRY(read_take(map, p));
  COROT_TRY(read_component(map, p));
  return read_part(map, p);
}

corot_status scenario_read_probes(scenario *s) {
  config_node *map = config_find(s->source->root, "probes");
  probe_def *probe = config_alloc(s->source, (size_t)map->nchild, sizeof *probe);
  if (!probe) return no_memory();
  s->probe = probe;
  for (config_node *c = map->child; c; c = c->next)
    COROT_TRY(config_keep(s->source, read_probe(c, &probe[s->nprobe++])));
  return COROT_OK;
}

/* --- The mesh --- */

static corot_status check_group(const scenario *s, config_node *node, const probe_def *p,
                                const corot_mesh *mesh) {
  const probe_quantity *q = &probe_quantities[p->of];
  const corot_group *group = corot_mesh_find_group(mesh, p->group);
  if (!group) return scenario_unknown_group(node, mesh);
  if (group->nnode == 0) return config_fail(node, "group '%s' has no nodes", p->group);
  if (q->carrier == OF_TETS && group->ntet == 0 && group->ntri == 0)
    return config_fail(node, "group '%s' has neither tets nor faces for %s%s (%d node%s)", p->group,
                       named(q), q->word, group->nnode, plural(group->nnode));
  if (q->carrier == OF_FACES && group->ntri == 0)
    return config_fail(node, "group '%s' has no faces for %s%s (%d node%s, %d tet%s)", p->group,
                       named(q), q->word, group->nnode, plural(group->nnode), group->ntet,
                       plural(group->ntet));
  if (q->carrier == SUM_OVER_TETS && group->ntet == 0)
    return config_fail(node, "group '%s' has no tets for %s%s (%d node%s, %d face%s)", p->group,
                       named(q), q->word, group->nnode, plural(group->nnode), group->ntri,
                       plural(group->ntri));
  if (p->of == PROBE_ELASTIC && s->model.hierarchy)
    return config_fail(node, "with a hierarchy only the whole body has an elastic energy");
  return COROT_OK;
}

corot_status scenario_check_probes(const scenario *s, const corot_mesh *mesh) {
  config_node *map = config_find(s->source->root, "probes")->child;
  for (int i = 0; i < s->nprobe; i++, map = map->next) {
    const probe_def *p = &s->probe[i];
    corot_status status = COROT_OK;
    if (p->node >= mesh->nnode)
      status = config_fail(config_find(map, "node"), "the mesh has %d nodes, numbered from 0",
                           mesh->nnode);
    if (p->group) status = check_group(s, config_find(map, "group"), p, mesh);
    COROT_TRY(config_keep(s->source, status));
  }
  return COROT_OK;
}
