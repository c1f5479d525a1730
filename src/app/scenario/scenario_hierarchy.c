/* A strain measure of its own for the unrefined mesh. */
#include "scenario_parts.h"

/* What the refined mesh's measure must be. */
static corot_status check_strain(scenario *s, config_node *node) {
  config_node *root = s->source->root;
  const config_node *strain = config_find(root, "strain");
  const corot_strain_kind *kind = corot_strain_find(s->strain);
  bool warp = kind->frames && !kind->polar;
  if (!kind->linear_in_frames)
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

/* What a level 0 with a mass and loads of its own does not go with. */
static corot_status check_one_way(const scenario *s, config_node *node) {
  if (s->mass == COROT_MASS_CONSISTENT)
    return config_fail(config_find(s->source->root, "mass"),
                       "with hierarchy.coupling one-way it must be lumped");
  for (int k = 0; k < s->nload; k++)
    if (s->load[k].kind == COROT_PRESSURE)
      return config_fail(config_find(node, "coupling"),
                         "a pressure follows the refined surface, of which the unrefined mesh "
                         "feels nothing one way");
  return COROT_OK;
}

static corot_coupling coupling_at(config_node *node) {
  if (text_is(node, "coupling", "nodes")) return COROT_COUPLING_NODES;
  return text_is(node, "coupling", "one-way") ? COROT_COUPLING_ONE_WAY : COROT_COUPLING_MEAN;
}

corot_status scenario_read_hierarchy(scenario *s) {
  config_node *node = config_find(s->source->root, "hierarchy");
  if (!node) return COROT_OK;
  s->coarse_strain = text_at(node, "coarse_strain");
  s->frame_level = (int)number_at(node, "frame_level");
  s->conservative = text_is(node, "force", "conservative");
  s->coupling = coupling_at(node);
  if (s->frame_level > s->refine)
    return config_fail(config_find(node, "frame_level"), "mesh.refine makes the levels 0 to %d",
                       s->refine);
  if (s->refine == 0) return COROT_OK;
  if (s->coupling == COROT_COUPLING_ONE_WAY) COROT_TRY(check_one_way(s, node));
  return check_strain(s, node);
}
