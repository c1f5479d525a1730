/* Materials: each checked, and which tets are made of which. */
#include <math.h>
#include <stdlib.h>

#include "model.h"

static corot_status check_material(const corot_material *m, int k) {
  if (!(m->mu > 0) || !isfinite(m->mu))
    return corot_fail(COROT_EINVAL, "material %d: mu = %g is not positive", k, m->mu);
  if (!(3 * m->lambda + 2 * m->mu > 0) || !isfinite(m->lambda))
    return corot_fail(COROT_EINVAL, "material %d: 3 lambda + 2 mu = %g is not positive", k,
                      3 * m->lambda + 2 * m->mu);
  if (!(m->density > 0) || !isfinite(m->density))
    return corot_fail(COROT_EINVAL, "material %d: density = %g is not positive", k, m->density);
  if (!(m->damping_lambda >= 0) || !isfinite(m->damping_lambda))
    return corot_fail(COROT_EINVAL, "material %d: damping_lambda = %g is negative", k,
                      m->damping_lambda);
  if (!(m->damping_mu >= 0) || !isfinite(m->damping_mu))
    return corot_fail(COROT_EINVAL, "material %d: damping_mu = %g is negative", k, m->damping_mu);
  if (!(m->damping_mass >= 0) || !isfinite(m->damping_mass))
    return corot_fail(COROT_EINVAL, "material %d: damping_mass = %g is negative", k,
                      m->damping_mass);
  return COROT_OK;
}

corot_status corot_materials_create(const corot_model_def *def, corot_model *m, int *of_tet,
                                    bool *damped) {
  *damped = false;
  m->nmaterial = def->nmaterial;
  m->material = calloc(def->nmaterial + 1, sizeof *m->material);
  if (!m->material) return corot_fail(COROT_ENOMEM, "no memory for %d materials", def->nmaterial);

  int ntet = m->mesh->ntet, rest = -1;
  for (int e = 0; e < ntet; e++) of_tet[e] = -1;
  for (int k = 0; k < def->nmaterial; k++) {
    const corot_material *from = &def->material[k];
    COROT_TRY(check_material(from, k));
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
    if (!from->group) {
      if (rest >= 0)
        return corot_fail(COROT_EINVAL, "materials %d and %d both have no group", rest, k);
      rest = k;
      continue;
    }
    const corot_group *group;
    COROT_TRY(corot_model_find_group(m->mesh, from->group, "material", &group));
    if (!group->ntet)
      return corot_fail(COROT_EINVAL, "material: group '%s' has no tets", from->group);
    for (int i = 0; i < group->ntet; i++) {
      int e = group->tet[i];
      if (of_tet[e] >= 0)
        return corot_fail(COROT_EINVAL, "tet %d belongs to materials %d and %d", e, of_tet[e], k);
      of_tet[e] = k;
    }
  }
  for (int e = 0; e < ntet; e++) {
    if (of_tet[e] < 0) of_tet[e] = rest;
    if (of_tet[e] < 0) return corot_fail(COROT_EINVAL, "tet %d has no material", e);
  }
  return COROT_OK;
}
