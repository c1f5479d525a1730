/* From scenario to mesh and model. What can be wrong here is how the scenario and the mesh fit. */
#include "marks_file.h"
#include "refine.h"
#include "scenario_fault.h"
#include "scenario_parts.h"
#include "warnings.h"

static config_node *place(const scenario *s, const char *path) {
  return config_find(s->source->root, path);
}

/* --- Mesh --- */

corot_status scenario_read_mesh(const scenario *s, corot_mesh **mesh, corot_mesh_report **report) {
  const corot_mending mending = {.cut = s->cut, .scale = s->scale};
  *report = NULL;
  corot_status status = s->mesh_file ? corot_mesh_read_mended(s->mesh_file, &mending, mesh, report)
                                     : corot_mesh_box(&s->box, mesh);
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  return config_fail(place(s, s->mesh_file ? "mesh.file" : "mesh.box"), "%s", corot_error());
}

/* What was mended goes to the warnings, unless these are NULL. */
static corot_status load_mesh(const scenario *s, corot_mesh **mesh, warnings *w) {
  corot_mesh_report *report;
  COROT_TRY(scenario_read_mesh(s, mesh, &report));
  corot_status status = w && report ? warnings_of_report(report, w) : COROT_OK;
  corot_mesh_report_destroy(report);
  if (status) corot_mesh_destroy(*mesh);
  return status;
}

/* Level 0 has four-node tets, and order 2 is the last level. */
static corot_status check_hierarchy(const scenario *s, const corot_mesh *mesh) {
  if (!s->model.hierarchy || !mesh->mid || s->order == 1) return COROT_OK;
  return config_fail(place(s, "hierarchy"),
                     "level 0 has to be of four-node tets, and the file's have ten nodes already: "
                     "mesh.order: 1 makes them four-node ones");
}

/* *refinement, if it is not NULL, gets the level that order 2 adds. */
static corot_status set_order(const scenario *s, corot_mesh **mesh, corot_refinement *refinement) {
  if (s->order == 0) return COROT_OK;
  corot_status status = change_order(s->order, mesh, refinement);
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  return config_fail(place(s, "mesh.order"), "%s", corot_error());
}

/* Before anything is made of the mesh that takes long. */
static corot_status check_memory(const scenario *s, const corot_mesh *mesh) {
  const corot_memory_limit memory = corot_memory_limits();
  int order = s->order > 0 ? s->order : corot_mesh_order(mesh);
  corot_status status = run_fits(mesh->ntet, order, s->refine, &memory);
  if (status == COROT_OK) return COROT_OK;
  config_node *refine = place(s, "mesh.refine");
  return config_fail(s->refine > 0 ? refine : place(s, "mesh"), "%s", corot_error());
}

/* A file's four-node tets may be all that there is. */
static corot_status check_levels(const scenario *s, const corot_refinement *refinement) {
  if (!scenario_solves_by_levels(s) || refinement->nlevel > 0) return COROT_OK;
  return scenario_refuse_levels(s);
}

/* Octasections; *refinement is set where it is needed. */
static corot_status octasect(const scenario *s, int nlevel, bool needed, corot_mesh **mesh,
                             corot_refinement **refinement) {
  if (nlevel == 0 && !needed) return COROT_OK;
  corot_status status = needed ? refine_by_levels(nlevel, s->diagonal, mesh, refinement)
                               : refine_mesh(nlevel, s->diagonal, mesh, NULL);
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  return config_fail(place(s, "mesh.refine"), "%s", corot_error());
}

/* What marks make of the octasected mesh has no levels below it but the corners of ten-node tets.
 */
static corot_status refine(const scenario *s, corot_mesh **mesh, corot_refinement **refinement) {
  bool needed = s->model.hierarchy || scenario_solves_by_levels(s);
  if (!s->marks) return octasect(s, s->refine, needed, mesh, refinement);
  COROT_TRY(octasect(s, s->refine, false, mesh, NULL));
  corot_status status = marks_file_apply(s->marks, mesh);
  if (status == COROT_EIO) return config_fail(place(s, "mesh.marks"), "%s", corot_error());
  COROT_TRY(status);
  return octasect(s, 0, needed, mesh, refinement);
}

/* Numbers of nodes are those of the unrefined mesh, and the refined one inherits their groups.
 *refinement is set where it is needed, even on failure. */
static corot_status build_mesh(const scenario *s, corot_mesh **out, corot_refinement **refinement,
                               warnings *w) {
  corot_mesh *mesh = NULL;
  COROT_TRY(load_mesh(s, &mesh, w));
  corot_status status = check_memory(s, mesh);
  if (status == COROT_OK) status = scenario_add_groups(s, true, mesh);
  if (status == COROT_OK) status = check_hierarchy(s, mesh);
  if (status == COROT_OK && s->order == 1) status = set_order(s, &mesh, NULL);
  if (status == COROT_OK) status = refine(s, &mesh, refinement);
  if (status == COROT_OK && s->order == 2) status = set_order(s, &mesh, *refinement);
  if (status == COROT_OK) status = check_levels(s, *refinement);
  if (status == COROT_OK) status = scenario_add_groups(s, false, mesh);
  if (status == COROT_OK)
    *out = mesh;
  else
    corot_mesh_destroy(mesh);
  return status;
}

/* --- What the core does not know of --- */

static corot_status check_start(const config_node *node, const corot_mesh *mesh) {
  const corot_group *group = node ? corot_mesh_find_group(mesh, node->text) : NULL;
  if (!node || (group && group->nnode > 0)) return COROT_OK;
  if (!group) return scenario_unknown_group(node, mesh);
  return config_fail(node, "group '%s' has no nodes to give a velocity", node->text);
}

static corot_status check_starts(const scenario *s, const corot_mesh *mesh) {
  config_node *node = place(s, "start");
  if (node->kind == CONFIG_MAP) return check_start(config_find(node, "group"), mesh);
  for (config_node *c = node->child; c; c = c->next)
    COROT_TRY(config_keep(s->source, check_start(config_find(c, "group"), mesh)));
  return COROT_OK;
}

static corot_status check_group(const scenario *s, config_node *entry, const corot_mesh *mesh) {
  const config_node *node = config_find(entry, "group");
  if (!node || corot_mesh_find_group(mesh, node->text)) return COROT_OK;
  return config_keep(s->source, scenario_unknown_group(node, mesh));
}

/* The groups that entries of a list, or a map in its place, name. */
static corot_status check_groups(const scenario *s, const char *key, const corot_mesh *mesh) {
  config_node *list = place(s, key);
  if (list->kind == CONFIG_MAP) return check_group(s, list, mesh);
  for (config_node *c = list->child; c; c = c->next) COROT_TRY(check_group(s, c, mesh));
  return COROT_OK;
}

/* What names groups and nodes of the mesh, all of it at once. */
static corot_status check_names(const scenario *s, const corot_mesh *mesh) {
  COROT_TRY(check_groups(s, "material", mesh));
  COROT_TRY(check_groups(s, "boundary", mesh));
  COROT_TRY(check_groups(s, "loads", mesh));
  COROT_TRY(config_keep(s->source, check_starts(s, mesh)));
  COROT_TRY(scenario_check_probes(s, mesh));
  return config_kept(s->source);
}

/* --- Model --- */

static corot_status build_model(const scenario *s, const corot_mesh *mesh,
                                const corot_refinement *refinement, corot_model **model) {
  COROT_TRY(check_names(s, mesh));
  corot_model_def def = s->model;
  corot_hierarchy_def hierarchy = s->hierarchy;
  hierarchy.refinement = refinement;
  def.mesh = mesh;
  if (def.hierarchy) def.hierarchy = &hierarchy;
  return scenario_told(s, mesh, corot_model_create(&def, model));
}

corot_status scenario_build(const scenario *s, corot_mesh **mesh, corot_refinement **refinement,
                            corot_model **model) {
  return scenario_build_warned(s, mesh, refinement, model, NULL);
}

corot_status scenario_build_warned(const scenario *s, corot_mesh **out,
                                   corot_refinement **refinement, corot_model **model,
                                   warnings *w) {
  corot_mesh *mesh = NULL;
  corot_refinement *r = NULL;
  corot_status status = build_mesh(s, &mesh, &r, w);
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
