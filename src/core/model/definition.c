/* The rules of a definition that are about the model as a whole, and the order of all of them. */
#include "definition.h"

#include <math.h>

#include "core/base/fault.h"

corot_status corot_definition_group(const corot_mesh *mesh, const char *entry, int index,
                                    const char *name, const corot_group **group) {
  *group = name ? corot_mesh_find_group(mesh, name) : NULL;
  if (*group) return COROT_OK;
  return corot_fail_at(entry, index, "group", "the mesh has no group '%s'", name ? name : "");
}

corot_status corot_definition_nodes(const corot_mesh *mesh, const char *entry, int index,
                                    const char *name, const corot_group **group) {
  COROT_TRY(corot_definition_group(mesh, entry, index, name, group));
  if ((*group)->nnode) return COROT_OK;
  return corot_fail_at(entry, index, "group", "group '%s' has no nodes for a %s to act on", name,
                       entry);
}

/* The viscous law needs the frames of the measure that the mesh's own tets have. */
static corot_status check_viscosity(const corot_model_def *def, int nlevel) {
  const char *strain = def->hierarchy && nlevel == 0 ? def->hierarchy->coarse_strain : def->strain;
  const corot_strain_kind *kind = corot_strain_find(strain);
  if ((unsigned)def->viscosity > COROT_VISCOSITY_AUTO)
    return corot_fail_at("model", 0, "viscosity", "there is no viscous law %d",
                         (int)def->viscosity);
  if (def->viscosity == COROT_OBJECTIVE && kind && !kind->polar)
    return corot_fail_at("model", 0, "viscosity",
                         "the objective viscous law needs a polar frame, not strain %s", strain);
  return COROT_OK;
}

static corot_status check_dilatation(const corot_model_def *def) {
  double local = def->dilatation_local;
  if ((unsigned)def->dilatation > COROT_DILATATION_ELEMENT)
    return corot_fail_at("model", 0, "dilatation", "there is no dilatation %d",
                         (int)def->dilatation);
  if (def->dilatation != COROT_DILATATION_NODAL || (local >= 0 && isfinite(local))) return COROT_OK;
  return corot_fail_at("model", 0, "dilatation_local",
                       "dilatation_local = %g is not a number of shear moduli >= 0", local);
}

/* A consistent mass couples neighbours. */
static corot_status check_mass(const corot_model_def *def, bool one_way) {
  if ((unsigned)def->mass > COROT_MASS_AUTO)
    return corot_fail_at("model", 0, "mass", "no kind of mass has the number %d", (int)def->mass);
  if (def->mass != COROT_MASS_CONSISTENT) return COROT_OK;
  if (one_way)
    return corot_fail_at("model", 0, "mass",
                         "a consistent mass would couple the finer nodes of a one-way hierarchy to "
                         "level 0, which has a mass of its own");
  return COROT_OK;
}

/* What the finest level's measure must be, and what else goes with it. */
static corot_status check_finest(const corot_model_def *def) {
  const corot_hierarchy_def *h = def->hierarchy;
  const corot_strain_kind *kind = corot_strain_find(def->strain);
  if (!kind) return COROT_OK; /* refused elsewhere */
  bool warp = kind->frames && !kind->polar;
  if (!kind->linear_in_frames)
    return corot_fail_at(
        "model", 0, "strain",
        "strain %s is not linear in a given frame, as that of a hierarchy's finest "
        "level must be; cauchy, warp and polar are",
        kind->name);
  if (def->viscosity == COROT_OBJECTIVE)
    return corot_fail_at("model", 0, "viscosity",
                         "under a hierarchy the viscous law must be the corotated one");
  if (warp && h->conservative)
    return corot_fail_at("hierarchy", 0, "conservative",
                         "strain warp has no conservative force: use polar, or the "
                         "paper's force, which is not conservative");
  if (warp && h->frame_level > 0)
    return corot_fail_at("hierarchy", 0, "frame_level",
                         "frame level %d, but warp frames depend on the edges of a tet, "
                         "and those of level 0 alone fit the coarse motion: use polar, or frame "
                         "level 0",
                         h->frame_level);
  if (def->dilatation != COROT_DILATATION_LOCAL)
    return corot_fail_at("model", 0, "dilatation", "%s are not provided for in a hierarchy",
                         def->dilatation == COROT_DILATATION_NODAL ? "dilatations averaged at nodes"
                                                                   : "averages of the dilatation");
  return COROT_OK;
}

/* A level 0 that moves by itself feels nothing of the finer surface. */
static corot_status check_pressures(const corot_model_def *def) {
  for (int k = 0; k < def->nload; k++)
    if (def->load[k].kind == COROT_PRESSURE)
      return corot_fail_at("load", k, "kind",
                           "pressure on group '%s': it follows the fine surface, which level 0 of "
                           "a one-way hierarchy does not have",
                           def->load[k].group ? def->load[k].group : "");
  return COROT_OK;
}

static corot_status check_hierarchy(const corot_model_def *def, int nlevel) {
  const corot_hierarchy_def *h = def->hierarchy;
  if (h->frame_level < 0 || h->frame_level > nlevel)
    return corot_fail_at("hierarchy", 0, "frame_level",
                         "frame level %d, where the levels are 0 to %d", h->frame_level, nlevel);
  if ((unsigned)h->coupling > COROT_COUPLING_ONE_WAY)
    return corot_fail_at("hierarchy", 0, "coupling", "no coupling has the number %d",
                         (int)h->coupling);
  if (nlevel == 0) return COROT_OK; /* a plain model */
  if (h->coupling == COROT_COUPLING_ONE_WAY) COROT_TRY(check_pressures(def));
  return check_finest(def);
}

corot_status corot_definition_check(const corot_model_def *def, int nlevel) {
  const corot_hierarchy_def *h = def->hierarchy;
  if (h) COROT_TRY(check_hierarchy(def, nlevel));
  COROT_TRY(check_viscosity(def, nlevel));
  COROT_TRY(check_dilatation(def));
  COROT_TRY(check_mass(def, h && nlevel > 0 && h->coupling == COROT_COUPLING_ONE_WAY));
  for (int k = 0; k < def->nmaterial; k++) COROT_TRY(corot_material_check(def, k));
  for (int k = 0; k < def->nmotion; k++) COROT_TRY(corot_motion_check(def, k));
  for (int k = 0; k < def->nload; k++) COROT_TRY(corot_load_check(def, k));
  return COROT_OK;
}
