/* From scenario to mesh and model. What can be wrong here is how the scenario and the mesh fit. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/suggest.h"
#include "refine.h"
#include "scenario_parts.h"

static config_node *place(const scenario *s, const char *path) {
  return config_find(s->source->root, path);
}

/* --- Mesh --- */

static corot_status load_mesh(const scenario *s, corot_mesh **mesh) {
  corot_status status =
      s->mesh_file ? corot_mesh_read(s->mesh_file, mesh) : corot_mesh_box(&s->box, mesh);
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  return config_fail(place(s, s->mesh_file ? "mesh.file" : "mesh.box"), "%s", corot_error());
}

static corot_status add_group(const group_def *g, corot_mesh *mesh) {
  switch (g->kind) {
    case GROUP_PLANE:
      return corot_mesh_group_plane(mesh, g->name, g->axis, g->at, 0);
    case GROUP_BOX:
      return corot_mesh_group_box(mesh, g->name, g->min, g->max, 0);
    default:
      return corot_mesh_group_nodes(mesh, g->name, g->nnode, g->node);
  }
}

/* Those by numbers of nodes, or the others. */
static corot_status add_groups(const scenario *s, bool by_number, corot_mesh *mesh) {
  const config_node *node = place(s, "groups")->child;
  for (int i = 0; i < s->ngroup; i++, node = node->next) {
    if ((s->group[i].kind == GROUP_NODES) != by_number) continue;
    corot_status status = add_group(&s->group[i], mesh);
    if (status == COROT_ENOMEM) return status;
    if (status != COROT_OK) return config_fail_key(node, "%s", corot_error());
  }
  return COROT_OK;
}

static corot_status refine(const scenario *s, corot_mesh **mesh, corot_refinement **refinement) {
  if (s->refine == 0 && !s->coarse_strain) return COROT_OK;
  bool needed = s->coarse_strain || scenario_solves_by_levels(s);
  corot_status status = refine_mesh(s->refine, s->diagonal, mesh, needed ? refinement : NULL);
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  return config_fail(place(s, "mesh.refine"), "%s", corot_error());
}

/* Numbers of nodes are those of the unrefined mesh, and the refined one inherits their groups.
 *refinement is set where it is needed, even on failure. */
static corot_status build_mesh(const scenario *s, corot_mesh **out, corot_refinement **refinement) {
  corot_mesh *mesh = NULL;
  COROT_TRY(load_mesh(s, &mesh));
  corot_status status = add_groups(s, true, mesh);
  if (status == COROT_OK) status = refine(s, &mesh, refinement);
  if (status == COROT_OK) status = add_groups(s, false, mesh);
  if (status == COROT_OK)
    *out = mesh;
  else
    corot_mesh_destroy(mesh);
  return status;
}

/* --- Groups in use --- */

static const char *nearest_name(const char *typed, const corot_mesh *mesh) {
  const char *near = NULL;
  for (int i = 0, nearest = 4; i < mesh->ngroup; i++) {
    const char *name = mesh->group[i].name;
    int distance = suggest_distance(typed, name);
    if (distance < nearest && 2 * distance <= (int)strlen(name)) nearest = distance, near = name;
  }
  return near;
}

static void list_names(const corot_mesh *mesh, size_t size, char *list) {
  size_t used = 0;
  for (int i = 0; i < mesh->ngroup; i++) {
    const char *name = mesh->group[i].name;
    bool fits = used + strlen(name) + sizeof ", , ..." < size;
    used += (size_t)snprintf(list + used, size - used, "%s%s", i ? ", " : "", fits ? name : "...");
    if (!fits) return;
  }
}

static corot_status unknown_group(const config_node *node, const corot_mesh *mesh) {
  const char *near = nearest_name(node->text, mesh);
  char list[256] = "none";
  list_names(mesh, sizeof list, list);
  if (near) return config_fail(node, "no group %.64s; did you mean %s?", node->text, near);
  return config_fail(node, "no group %.64s; there are: %s", node->text, list);
}

/* The group that a map of the scenario refers to; NULL in *group if it refers to none. */
static corot_status find_group(config_node *map, const corot_mesh *mesh,
                               const corot_group **group) {
  const config_node *node = config_find(map, "group");
  *group = node ? corot_mesh_find_group(mesh, node->text) : NULL;
  return node && !*group ? unknown_group(node, mesh) : COROT_OK;
}

static corot_status check_group(config_node *map, const corot_mesh *mesh) {
  const corot_group *group;
  COROT_TRY(find_group(map, mesh, &group));
  /* nodes for supports, forces and starts; faces for tractions; tets for materials */
  const config_node *node = config_find(map, "group");
  if (config_find(map, "fix") && group->nnode == 0)
    return config_fail(node, "%s has no nodes to fix", node->text);
  bool moves =
      config_find(map, "rotate") || config_find(map, "translate") || config_find(map, "move");
  if (moves && group->nnode == 0) return config_fail(node, "%s has no nodes to move", node->text);
  if (config_find(map, "force") && group->nnode == 0)
    return config_fail(node, "%s has no nodes for a force to act on", node->text);
  if ((config_find(map, "traction") || config_find(map, "pressure")) && group->ntri == 0)
    return config_fail(node, "%s has no faces for a %s to act on (%d nodes, %d tets)", node->text,
                       config_find(map, "traction") ? "traction" : "pressure", group->nnode,
                       group->ntet);
  bool starts = config_find(map, "velocity") || config_find(map, "spin");
  if (starts && group && group->nnode == 0)
    return config_fail(node, "%s has no nodes to give a velocity", node->text);
  if (config_find(map, "density") && group && group->ntet == 0)
    return config_fail(node, "%s has no tets for a material to fill (%d nodes, %d faces)",
                       node->text, group->nnode, group->ntri);
  return COROT_OK;
}

static corot_status check_section(const scenario *s, const char *section, const corot_mesh *mesh) {
  config_node *node = place(s, section);
  if (node->kind == CONFIG_MAP) return check_group(node, mesh);
  for (config_node *c = node->child; c; c = c->next) COROT_TRY(check_group(c, mesh));
  return COROT_OK;
}

/* What holds a node. */
typedef struct holder {
  config_node *entry; /* the condition that moves it, or else one that fixes it; NULL: none */
  bool component[3];
} holder;

static const char *group_of(config_node *entry) { return config_find(entry, "group")->text; }

/* A node that moves is held in all its components and by that alone; but motions of one group may
   follow one another. */
static corot_status check_holder(config_node *entry, const corot_mesh *mesh, holder *held) {
  const config_node *fix = config_find(entry, "fix");
  const corot_group *group = corot_mesh_find_group(mesh, group_of(entry));
  for (int i = 0; i < group->nnode; i++) {
    holder *h = &held[group->node[i]];
    bool moved = h->entry && !config_find(h->entry, "fix");
    bool follows = moved && !fix && strcmp(group_of(h->entry), group_of(entry)) == 0;
    /* who moves a node must be the only one that holds it, but for other moves of one group */
    if (h->entry && (moved || !fix) && !follows) {
      char path[64];
      config_path(h->entry, sizeof path, path);
      return config_fail(config_find(entry, "group"),
                         "node %d of %s cannot be %s: it is in %s, too, which %s %s",
                         group->node[i], group_of(entry), fix ? "fixed" : "moved",
                         group_of(h->entry), path, moved ? "moves" : "fixes");
    }
    h->entry = entry;
    for (int k = 0; k < 3; k++) h->component[k] |= !fix;
    for (const config_node *c = fix ? fix->child : NULL; c; c = c->next)
      h->component[c->text[0] - 'x'] = true;
  }
  return COROT_OK;
}

static corot_status check_holders(const scenario *s, const corot_mesh *mesh) {
  config_node *list = place(s, "boundary");
  holder *held = calloc((size_t)mesh->nnode, sizeof *held);
  if (!held) return corot_fail(COROT_ENOMEM, "%d nodes: out of memory", mesh->nnode);
  corot_status status = COROT_OK;
  for (config_node *c = list->child; c && status == COROT_OK; c = c->next)
    status = check_holder(c, mesh, held);
  bool free_somewhere = false;
  for (int n = 0; n < mesh->nnode; n++)
    for (int k = 0; k < 3; k++) free_somewhere |= !held[n].component[k];
  free(held);
  if (status == COROT_OK && !free_somewhere)
    return config_fail_key(list, "all components of all %d nodes are held: nothing can move",
                           mesh->nnode);
  return status;
}

static corot_status check_probes(const scenario *s, const corot_mesh *mesh) {
  config_node *node = place(s, "probes")->child;
  for (int i = 0; i < s->nprobe; i++, node = node->next)
    if (s->probe[i].node >= mesh->nnode)
      return config_fail(config_find(node, "node"), "the mesh has %d nodes, numbered from 0",
                         mesh->nnode);
  return COROT_OK;
}

/* --- Model --- */

static corot_status build_model(const scenario *s, const corot_mesh *mesh,
                                const corot_refinement *refinement, corot_model **model) {
  COROT_TRY(check_section(s, "material", mesh));
  COROT_TRY(check_section(s, "boundary", mesh));
  COROT_TRY(check_holders(s, mesh));
  COROT_TRY(check_section(s, "loads", mesh));
  COROT_TRY(check_section(s, "start", mesh));
  COROT_TRY(check_probes(s, mesh));
  corot_model_def def = corot_model_defaults();
  corot_hierarchy_def hierarchy = {.refinement = refinement,
                                   .coarse_strain = s->coarse_strain,
                                   .frame_level = s->frame_level,
                                   .conservative = s->conservative,
                                   .coupling = s->coupling};
  def.mesh = mesh;
  def.hierarchy = s->coarse_strain ? &hierarchy : NULL;
  def.strain = s->strain;
  def.nmaterial = s->nmaterial;
  def.material = s->material;
  def.nfix = s->nfix;
  def.fix = s->fix;
  def.nmotion = s->nmotion;
  def.motion = s->motion;
  def.nload = s->nload;
  def.load = s->load;
  def.viscosity = s->viscosity;
  def.mass = s->mass;
  def.dilatation = s->dilatation;
  def.dilatation_local = s->dilatation_local;
  corot_status status = corot_model_create(&def, model);
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  /* names and coefficients are checked above: what is left is a mass that the supports do not
     allow, and which tet has which material */
  bool mass = s->mass == COROT_MASS_CONSISTENT && s->nmotion > 0;
  return config_fail_key(place(s, mass ? "mass" : "material"), "%s", corot_error());
}

corot_status scenario_build(const scenario *s, corot_mesh **out, corot_refinement **refinement,
                            corot_model **model) {
  corot_mesh *mesh = NULL;
  corot_refinement *r = NULL;
  corot_status status = build_mesh(s, &mesh, &r);
  if (status == COROT_OK) status = build_model(s, mesh, r, model);
  if (status != COROT_OK || !refinement || !scenario_solves_by_levels(s)) {
    corot_refinement_destroy(r);
    r = NULL;
  }
  if (status != COROT_OK) {
    corot_mesh_destroy(mesh);
    return status;
  }
  *out = mesh;
  if (refinement) *refinement = r;
  return COROT_OK;
}
