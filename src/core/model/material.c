/* Materials: each checked, and which tets are made of which. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/fault.h"
#include "definition.h"
#include "model.h"

enum { ZERO_IS_POSITIVE = false, ZERO_IS_NOT_NEGATIVE = true };

#define COEFFICIENT(field, range) \
  {.name = #field, .at = offsetof(corot_material, field), .zero = ZERO_IS_##range},
static const struct {
  const char *name;
  size_t at; /* in a corot_material */
  bool zero; /* may be */
} coefficients[] = {COROT_MATERIAL_RANGES(COEFFICIENT)};

static corot_status check_ranges(const corot_material *m, int k) {
  for (size_t i = 0; i < sizeof coefficients / sizeof *coefficients; i++) {
    const char *name = coefficients[i].name;
    bool zero = coefficients[i].zero;
    double value = *(const double *)((const char *)m + coefficients[i].at);
    if (!isfinite(value))
      return corot_fail_at("material", k, name, "%s = %g is not finite", name, value);
    if (!(value > 0 || (zero && value == 0)))
      return corot_fail_at("material", k, name, "%s = %g is %s", name, value,
                           zero ? "negative" : "not positive");
  }
  return COROT_OK;
}

/* One entry may go without a group, and each group has one; of tets that are told by number, none.
 */
static corot_status check_group(const corot_model_def *def, int k) {
  const char *group = def->material[k].group;
  if (def->tet_material)
    return group ? corot_fail_at("material", k, "group",
                                 "group '%s' is named, but tet_material says which tets it fills",
                                 group)
                 : COROT_OK;
  for (int i = 0; i < k; i++) {
    const char *other = def->material[i].group;
    const corot_fault at = {
        .entry = "material", .index = k, .field = "group", .other = "material", .other_index = i};
    if (!group && !other)
      return corot_fail_about(&at, "group is missing: one entry only may go without");
    if (group && other && strcmp(group, other) == 0)
      return corot_fail_about(&at, "group '%s' has a material already", group);
  }
  return COROT_OK;
}

corot_status corot_material_check(const corot_model_def *def, int k) {
  const corot_material *m = &def->material[k];
  COROT_TRY(check_ranges(m, k));
  if (!(3 * m->lambda + 2 * m->mu > 0) || !isfinite(m->lambda))
    return corot_fail_at("material", k, "lambda",
                         "3 lambda + 2 mu must be > 0, otherwise the solid has no resistance to a "
                         "change of volume; lambda = %g, mu = %g",
                         m->lambda, m->mu);
  return check_group(def, k);
}

/* of_tet = k on the tets of a group. */
static corot_status fill_group(const corot_mesh *mesh, const char *name, int k, int *of_tet) {
  const corot_group *group;
  COROT_TRY(corot_definition_group(mesh, "material", k, name, &group));
  if (!group->ntet)
    return corot_fail_at("material", k, "group",
                         "group '%s' has no tets for a material to fill (%d nodes, %d faces)", name,
                         group->nnode, group->ntri);
  for (int i = 0; i < group->ntet; i++) {
    int e = group->tet[i];
    if (of_tet[e] >= 0)
      return corot_fail_about(&(corot_fault){.entry = "material",
                                             .index = k,
                                             .field = "group",
                                             .other = "material",
                                             .other_index = of_tet[e]},
                              "tet %d belongs to materials %d and %d", e, of_tet[e], k);
    of_tet[e] = k;
  }
  return COROT_OK;
}

/* of_tet = the entries that the definition lists. */
static corot_status take_list(const corot_model_def *def, int ntet, int *of_tet) {
  for (int e = 0; e < ntet; e++) {
    of_tet[e] = def->tet_material[e];
    if (of_tet[e] < 0 || of_tet[e] >= def->nmaterial)
      return corot_fail_at("model", 0, "tet_material",
                           "tet %d is of material %d, of which there are %d", e, of_tet[e],
                           def->nmaterial);
  }
  return COROT_OK;
}

/* of_tet = each material on the tets of its group; one without a group has the rest. */
static corot_status fill_groups(const corot_model_def *def, const corot_mesh *mesh, int *of_tet) {
  int rest = -1;
  for (int e = 0; e < mesh->ntet; e++) of_tet[e] = -1;
  for (int k = 0; k < def->nmaterial; k++)
    if (def->material[k].group)
      COROT_TRY(fill_group(mesh, def->material[k].group, k, of_tet));
    else
      rest = k;
  for (int e = 0; e < mesh->ntet; e++) {
    if (of_tet[e] < 0) of_tet[e] = rest;
    if (of_tet[e] < 0) return corot_fail_at("model", 0, "material", "tet %d has no material", e);
  }
  return COROT_OK;
}

void corot_material_share(const corot_model *m, material *a) {
  double local = m->local_moduli < INFINITY ? m->local_moduli * a->mu : INFINITY;
  bool averaged = a->lambda > local;
  a->lambda_local = averaged ? local : a->lambda;
  a->own_share = averaged ? local / a->lambda : 1;
}

corot_status corot_materials_create(const corot_model_def *def, corot_model *m, int *of_tet,
                                    bool *damped) {
  *damped = false;
  m->nmaterial = def->nmaterial;
  m->material = calloc(def->nmaterial + 1, sizeof *m->material);
  if (!m->material) return corot_fail(COROT_ENOMEM, "no memory for %d materials", def->nmaterial);

  for (int k = 0; k < def->nmaterial; k++) {
    const corot_material *from = &def->material[k];
    m->material[k] = (material){.lambda = from->lambda,
                                .mu = from->mu,
                                .damping_lambda = from->damping_lambda,
                                .damping_mu = from->damping_mu,
                                .damping_mass = from->damping_mass,
                                .density = from->density,
                                .lambda_local = from->lambda,
                                .own_share = 1};
    *damped |= from->damping_lambda > 0 || from->damping_mu > 0;
    m->mass_damped |= from->damping_mass > 0;
  }
  return def->tet_material ? take_list(def, m->mesh->ntet, of_tet)
                           : fill_groups(def, m->mesh, of_tet);
}
