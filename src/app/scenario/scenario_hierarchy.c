/* A strain measure of its own for the unrefined mesh. */
#include "scenario_parts.h"

int scenario_levels(const scenario *s) { return (s->marks ? 0 : s->refine) + (s->order == 2); }

corot_status scenario_read_hierarchy(scenario *s) {
  config_node *node = config_find(s->source->root, "hierarchy");
  if (!node) return COROT_OK;
  if (s->marks)
    return config_fail_key(node,
                           "its levels cut every tet, and mesh.marks only some: give one of them");
  corot_hierarchy_def *def = &s->hierarchy;
  s->model.hierarchy = def;
  def->coarse_strain = text_at(node, "coarse_strain");
  def->frame_level = (int)number_at(node, "frame_level");
  def->conservative = text_is(node, "force", "conservative");
  def->coupling = (corot_coupling)choice_at(node, "coupling", words_coupling);
  return COROT_OK;
}
