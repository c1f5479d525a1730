/* Factors of materials: the model's system once more, with other coefficients. */
#include <stdlib.h>
#include <string.h>

#include "inputs.h"

void corot_other_system_destroy(other_system *o) {
  if (!o) return;
  for (int k = 0; k < TERMS; k++) free(o->averaged[k]);
  free(o->material);
  free(o);
}

/* What is averaged of each term's lambda. */
static void fill_averages(const corot_model *m, other_system *o) {
  for (int k = 0; k < m->system.nterm; k++) {
    const element_set *t = &m->system.term[k].body.elements;
    const dilatation *d = &m->system.term[k].body.dilatation;
    for (int b = 0; d->npool && b < t->nblock; b++) {
      const material *a = &o->material[t->block[b].material];
      for (int i = 0; i < d->per; i++)
        for (int l = 0; l < W; l++)
          o->averaged[k][pools_at(d, b, i)[l]] = a->lambda - a->lambda_local;
    }
  }
}

/* The model's own, for a start. */
static corot_status create(const corot_model *m, other_system **other) {
  other_system *o = calloc(1, sizeof *o);
  size_t nmaterial = m->nmaterial;
  bool room = o && (o->material = malloc(nmaterial * sizeof *o->material));
  for (int k = 0; room && k < m->system.nterm; k++) {
    int npool = m->system.term[k].body.dilatation.npool;
    room = npool <= 0 || (o->averaged[k] = malloc(npool * sizeof **o->averaged));
  }
  if (!room) {
    corot_other_system_destroy(o);
    return corot_fail(COROT_ENOMEM, "no memory for factors of %zu materials", nmaterial);
  }
  memcpy(o->material, m->material, nmaterial * sizeof *o->material);
  o->system = m->system;
  for (int k = 0; k < m->system.nterm; k++) {
    o->system.term[k].body.material = o->material;
    if (o->averaged[k]) o->system.term[k].body.dilatation.lambda = o->averaged[k];
  }
  fill_averages(m, o);
  *other = o;
  return COROT_OK;
}

/* Both of them at once. */
corot_status corot_factors_reserve(corot_inputs *in) {
  const corot_model *m = in->model;
  other_system *before;
  if (in->other) return COROT_OK;
  COROT_TRY(create(m, &before));
  corot_status status = create(m, &in->other);
  if (status) {
    corot_other_system_destroy(before);
    return status;
  }
  in->before = before;
  size_t each = sizeof *before + m->nmaterial * sizeof *before->material;
  for (int k = 0; k < m->system.nterm; k++)
    each += m->system.term[k].body.dilatation.npool * sizeof **before->averaged;
  in->bytes += 2 * each;
  return COROT_OK;
}

static corot_status check(const corot_inputs *in, int k, const corot_material_factors *by) {
  const corot_model *m = in->model;
  if (k < 0 || k >= m->nmaterial)
    return corot_fail(COROT_EINVAL, "inputs: there is no material %d: the model has %d", k,
                      m->nmaterial);
  const double factor[] = {by->lambda, by->mu, by->damping_lambda, by->damping_mu};
  const char *const name[] = {"lambda", "mu", "damping_lambda", "damping_mu"};
  for (int i = 0; i < 4; i++)
    if (!isfinite(factor[i]) || (i == 1 && !(factor[i] > 0)) || (i > 1 && !(factor[i] >= 0)))
      return corot_fail(COROT_EINVAL, "inputs: material %d: %g is no factor of %s", k, factor[i],
                        name[i]);
  const material *a = &m->material[k];
  double lambda = by->lambda * a->lambda, mu = by->mu * a->mu;
  if (!isfinite(lambda + mu + by->damping_lambda * a->damping_lambda +
                by->damping_mu * a->damping_mu))
    return corot_fail(COROT_EINVAL, "inputs: material %d: what the factors make is not finite", k);
  if (!(3 * lambda + 2 * mu > 0))
    return corot_fail(COROT_EINVAL,
                      "inputs: material %d: 3 lambda + 2 mu must be > 0; lambda = %g, mu = %g", k,
                      lambda, mu);
  if (a->own_share == 1 && lambda > m->local_moduli * mu && m->local_moduli < INFINITY)
    return corot_fail(COROT_EINVAL,
                      "inputs: material %d: lambda = %g, mu = %g would begin to be averaged, which "
                      "the model is not made for",
                      k, lambda, mu);
  return COROT_OK;
}

void corot_factors_settle(corot_inputs *in) { fill_averages(in->model, in->other); }

corot_status corot_inputs_set_material(corot_inputs *in, int k,
                                       const corot_material_factors *factors) {
  const corot_material_factors one = {1, 1, 1, 1}, *by = factors ? factors : &one;
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  COROT_TRY(check(in, k, by));
  COROT_TRY(corot_factors_reserve(in));
  const corot_model *m = in->model;
  if (!in->pending)
    memcpy(in->before->material, in->other->material, m->nmaterial * sizeof(material));
  fill_averages(m, in->before);
  in->pending = true;

  material *to = &in->other->material[k];
  *to = m->material[k];
  to->lambda *= by->lambda, to->mu *= by->mu;
  to->damping_lambda *= by->damping_lambda, to->damping_mu *= by->damping_mu;
  corot_material_share(m, to);
  corot_factors_settle(in);
  in->matrices++;
  return COROT_OK;
}
