/* A strain measure of its own for the unrefined mesh. */
#include "scenario_parts.h"

/* What the refined mesh's measure must be. */
static corot_status check_strain(scenario *s, config_node *node) {
  config_node *root = s->source->root;
  const config_node *strain = config_find(root, "strain");
  bool warp = strcmp(s->strain, "warp") == 0;
  if (!warp && strcmp(s->strain, "cauchy") != 0 && strcmp(s->strain, "polar") != 0)
    return config_fail(strain,
                       "with a hierarchy it is that of the refined mesh: cauchy, polar or warp, "
                       "which are linear in a given frame");
  if (warp && s->frame_level > 0)
    return config_fail(config_find(node, "frame_level"),
                       "warp takes its frames from level 0 only; polar from any");
  if (warp && s->conservative)
    return config_fail(strain, "warp has no conservative force: hierarchy.force must be paper");
  if (s->viscosity == COROT_OBJECTIVE)
    return config_fail(config_find(root, "viscosity"), "with a hierarchy it must be corotated");
  if (s->dilatation != COROT_DILATATION_LOCAL)
    return config_fail(config_find(root, "dilatation.name"), "with a hierarchy it must be local");
  return COROT_OK;
}

corot_status scenario_read_hierarchy(scenario *s) {
  config_node *node = config_find(s->source->root, "hierarchy");
  if (!node) return COROT_OK;
  s->coarse_strain = text_at(node, "coarse_strain");
  s->frame_level = (int)number_at(node, "frame_level");
  s->conservative = text_is(node, "force", "conservative");
  s->coupling = text_is(node, "coupling", "mean") ? COROT_COUPLING_MEAN : COROT_COUPLING_NODES;
  if (s->frame_level > s->refine)
    return config_fail(config_find(node, "frame_level"), "mesh.refine makes the levels 0 to %d",
                       s->refine);
  return s->refine > 0 ? check_strain(s, node) : COROT_OK;
}
