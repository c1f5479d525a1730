/* Averages of the dilatation: see dilatation.h. All sums are in the order of the tets. This file
   sees whole blocks: LANES is W. */
#include "kernel.h"

void corot_kernel_pool(const solid *body, const block_vd *theta, int first, int end, double *pool) {
  const dilatation *d = &body->dilatation;
  const element_set *e = &body->elements;
  for (int p = first; p < end; p++) {
    double sum = 0;
    for (int k = d->tet_first[p]; k < d->tet_first[p + 1]; k++) {
      int b = d->tet[k] / W, l = d->tet[k] % W;
      EACH_POINT (e->kind, q) {
        int at = b * e->kind->npoint + q;
        sum += e->weight[at][l] * theta[at][l];
      }
    }
    pool[p] = sum / d->volume[p];
  }
}

void corot_kernel_unpool(const solid *body, const double *pool, int chunk, block_vd *theta) {
  const dilatation *d = &body->dilatation;
  const element_set *e = &body->elements;
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    double own = body->material[e->block[b].material].own_share;
    vd sum = vd_all(0);
    for (int a = 0; a < d->per; a++)
      for (int l = 0; l < W; l++) sum[l] += pool[pools_at(d, b, a)[l]];
    EACH_POINT (e->kind, q) {
      int at = index_of(point_at(e->kind, e, b, q));
      theta[at] = own * theta[at] + (1 - own) / d->per * sum;
    }
  }
}

COROT_INLINE void own_loop(const element_kind *kind, const solid *body, const solid_state *state,
                           nodal_field u, int chunk, vd *theta) {
  const strain_measure *s = &strain_measures[body->strain];
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    differences of_u = differences_of(point_at(kind, &body->elements, b, 0), u);
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      mat3 F = deformation(at, &of_u), R = F;
      vi inverted = {0};
      if (s->pressure == BY_FRAME) R = frame_in_use(s, &state->frames, at, F, &inverted);
      theta[index_of(at)] = dilatation_of(s->pressure, F, R);
    }
  }
}

COROT_CLONES static void own_dilatation(const solid *body, const solid_state *state, nodal_field u,
                                        int chunk, vd *theta) {
  OF_KIND(&body->elements, own_loop, body, state, u, chunk, theta);
}

void corot_kernel_dilatation(const solid *body, const solid_state *state, nodal_field u, int chunk,
                             block_vd *theta) {
  own_dilatation(body, state, u, chunk, theta);
}

COROT_INLINE void internal_loop(const element_kind *kind, const solid *body, nodal_field u,
                                const strain_measure *s, int chunk, vd *theta) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    differences of_u = differences_of(point_at(kind, &body->elements, b, 0), u);
    mat3 Q0 = mat3_identity();
    if (s->frame == FRAME_WARP)
      Q0 = corot_tets_rest_basis(body->mesh, body->elements.number + b * W);
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      mat3 F = deformation(at, &of_u), R = F;
      vi inverted = {0};
      if (s->pressure == BY_FRAME) R = frame_of(s->frame, F, &Q0, &inverted);
      theta[index_of(at)] = dilatation_of(s->pressure, F, R);
    }
  }
}

COROT_CLONES static void internal_dilatation(const solid *body, nodal_field u,
                                             const strain_measure *s, int chunk, vd *theta) {
  OF_KIND(&body->elements, internal_loop, body, u, s, chunk, theta);
}

void corot_kernel_internal_dilatation(const solid *body, nodal_field u, int strain, int chunk,
                                      block_vd *theta) {
  internal_dilatation(body, u, &strain_measures[strain], chunk, theta);
}

COROT_INLINE void change_loop(const element_kind *kind, const solid *body, const solid_state *state,
                              nodal_field u, nodal_field du, bool exact, int chunk, vd *change) {
  const strain_measure *s = &strain_measures[body->strain];
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_du = differences_of(here, du);
    EACH_POINT (kind, q) {
      element e = element_at(s, body, &state->frames, &of_u, point_at(kind, &body->elements, b, q));
      mat3 dF = gradient(e.at, &of_du);
      mat3 dR = mat3_scale(vd_all(0), e.R);
      if (exact && s->frame != FRAME_IDENTITY) {
        mat3 room;
        const mat3 *Q0 = rest_basis_of(s->frame, e.at, &room);
        dR = frame_derivative(s->frame, e.F, Q0, e.R, dF);
      }
      change[index_of(e.at)] = dilatation_derivative(s->pressure, e.F, e.R, dF, dR);
    }
  }
}

COROT_CLONES static void change_of_dilatation(const solid *body, const solid_state *state,
                                              nodal_field u, nodal_field du, bool exact, int chunk,
                                              vd *change) {
  OF_KIND(&body->elements, change_loop, body, state, u, du, exact, chunk, change);
}

void corot_kernel_dilatation_change(const solid *body, const solid_state *state, nodal_field u,
                                    nodal_field du, bool exact, int chunk, block_vd *change) {
  change_of_dilatation(body, state, u, du, exact, chunk, change);
}

/* gathered = sum over a pool's tets of V d tr(e_p) / du. */
static void gather_slopes(const solid *body, const solid_state *state, int pool,
                          double (*gathered)[3]) {
  const dilatation *d = &body->dilatation;
  const element_kind *kind = body->elements.kind;
  for (int k = d->tet_first[pool]; k < d->tet_first[pool + 1]; k++) {
    int b = d->tet[k] / W, l = d->tet[k] % W;
    EACH_POINT (kind, q)
      for (int a = 0; a < kind->nnode; a++) {
        const block_vd *slope = state->slope[(b * kind->npoint + q) * kind->nnode + a];
        double *sum = gathered[nodes_at(&body->elements, b, a)[l]];
        for (int c = 0; c < 3; c++) sum[c] += slope[c][l];
      }
  }
}

/* K += factor q q' on the nodes of a ring. */
static void add_ring(const pattern *p, const int *ring, int n, double factor, double (*q)[3],
                     double (*K)[9]) {
  for (int j = 0; j < n; j++) {
    double *qj = q[ring[j]];
    for (int i = j, at = p->colptr[ring[j]]; i < n; i++, at++) {
      while (p->row[at] < ring[i]) at++;
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) K[at][3 * r + c] += factor * (q[ring[i]][r] * qj[c]);
    }
  }
}

void corot_kernel_dilatation_tangent(const solid *body, const solid_state *state, int batch,
                                     double (*gathered)[3], double (*K)[9]) {
  const dilatation *d = &body->dilatation;
  for (int pool = batch * BATCH; pool < batch_end(d, batch); pool++) {
    const int *ring = d->ring + d->ring_first[pool];
    int n = d->ring_first[pool + 1] - d->ring_first[pool];
    if (!n) continue;
    gather_slopes(body, state, pool, gathered);
    add_ring(&body->pattern, ring, n, d->lambda[pool] / (d->per * d->volume[pool]), gathered, K);
    for (int j = 0; j < n; j++) memset(gathered[ring[j]], 0, sizeof *gathered);
  }
}
