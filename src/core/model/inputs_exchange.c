/* Inputs as bytes: forces, factors of loads and of materials, paths. */
#include <string.h>

#include "inputs.h"

static void exchange_forces(pack *p, corot_inputs *in) {
  size_t nnode = in->model->mesh->nnode;
  corot_pack_bool(p, &in->forced);
  corot_pack_double(p, &in->t_force);
  if (in->forced) {
    corot_pack_doubles(p, in->force[0], 3 * nnode);
    corot_pack_doubles(p, in->slope[0], 3 * nnode);
  }
  corot_pack_doubles(p, &in->load[0].t, 3 * (size_t)in->model->nload);
}

/* Where nothing was written for want of paths, those that there are go off. */
static void exchange_paths(pack *p, corot_inputs *in) {
  bool some = in->path != NULL;
  corot_pack_bool(p, &some);
  if (some && p->reading && !p->status) p->status = corot_paths_reserve(in);
  if (p->status) return;
  if (!some) in->npath = 0;
  for (int k = 0; k < in->nheld && in->path; k++) {
    node_path *path = &in->path[k];
    if (!some) path->on = false;
    if (!some) continue;
    corot_pack_bool(p, &path->on);
    corot_pack_double(p, &path->t);
    corot_pack_doubles(p, path->c[0], 18);
  }
  corot_pack_int(p, &in->npath);
}

/* The same: the model's own. */
static void exchange_materials(pack *p, corot_inputs *in) {
  const corot_model *m = in->model;
  bool some = in->other != NULL;
  corot_pack_bool(p, &some);
  if (some && p->reading && !p->status) p->status = corot_factors_reserve(in);
  if (p->status || !in->other) return;
  material *to = in->other->material;
  if (some)
    corot_pack_bytes(p, to, m->nmaterial * sizeof *to);
  else
    memcpy(to, m->material, m->nmaterial * sizeof *to);
  corot_factors_settle(in);
  if (p->reading) in->pending = false; /* what it changes is in the energy that goes with it */
}

void corot_inputs_exchange(pack *p, corot_inputs *in) {
  bool feedback = in->feedback.force != NULL;
  corot_pack_same(p, feedback, "the number of feedbacks");
  exchange_forces(p, in);
  exchange_paths(p, in);
  exchange_materials(p, in);
  if (p->reading) in->loads++, in->paths++, in->matrices++;
}
