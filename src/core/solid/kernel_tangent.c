/* Element matrices, and the product of the tangent with a direction. */
#include "kernel.h"

/* The block [9] of each lane is added to the matrix: eight entries as vectors, the ninth alone. */
COROT_INLINE void scatter(double (*A)[9], const int place[LANES], mat3 block) {
  vd row[PARTS][LANES];
  for (int p = 0; p < PARTS; p++) vd_transpose(&block.m[0][0] + p * LANES, row[p]);
  for (int l = 0; l < LANES; l++) {
    double *a = A[place[l]];
    for (int p = 0; p < PARTS; p++) vd_add_to(a + p * LANES, row[p][l]);
    a[8] += block.m[2][2][l];
  }
}

/* lambda p_a p_b' + mu (gg Bs Bs' + s_b s_a') */
COROT_INLINE mat3 constant_bases(vd lambda, vd mu, vd gg, mat3 BsBs, vec3 pa, vec3 pb, vec3 sa,
                                 vec3 sb) {
  mat3 K = mat3_scale(mu * gg, BsBs);
  EACH_IJ K.m[i][j] += lambda * pa.v[i] * pb.v[j] + mu * sb.v[i] * sa.v[j];
  return K;
}

/* The stretch rates of unit velocities e_i of the nodes, and the damping block of two nodes
   under the objective law, dS/dt : D : dS/dt. */
typedef struct node_rates {
  mat3 rate[KIND_NODES][3]; /* [node][component] */
} node_rates;

COROT_INLINE void find_node_rates(point_lanes at, mat3 F, mat3 R, node_rates *n) {
  for (int i = 0; i < 3; i++) {
    for (int a = 1; a < at.kind->nnode; a++) {
      mat3 V = mat3_scale(vd_all(0), R);
      for (int j = 0; j < 3; j++) V.m[i][j] = slope_of(at, a, j);
      n->rate[a][i] = stretch_rate_of(F, R, V).rate;
    }
    mat3 sum = n->rate[1][i];
    for (int a = 2; a < at.kind->nnode; a++) sum = mat3_add(sum, n->rate[a][i]);
    n->rate[0][i] = mat3_scale(vd_all(-1), sum);
  }
}

COROT_INLINE mat3 objective_damping(const strain_measure *s, vd lambda, vd mu, const node_rates *n,
                                    int a, int b, vec3 pa, vec3 pb) {
  mat3 D;
  EACH_IJ {
    D.m[i][j] = 2 * mu * mat3_dot(n->rate[a][i], n->rate[b][j]);
    D.m[i][j] += lambda * (s->pressure == BY_GRADIENT
                               ? pa.v[i] * pb.v[j]
                               : mat3_trace(n->rate[a][i]) * mat3_trace(n->rate[b][j]));
  }
  return D;
}

/* A + [a]x' Q */
COROT_INLINE mat3 add_skew_transposed(mat3 A, vec3 a, mat3 Q) {
  EACH_IJ {
    int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    A.m[i][j] += a.v[i2] * Q.m[i1][j] - a.v[i1] * Q.m[i2][j];
  }
  return A;
}

/* Gradients of the nodes, and the bases applied to them. */
typedef struct node_vectors {
  vec3 g[KIND_NODES], p[KIND_NODES], s[KIND_NODES];
} node_vectors;

/* Of x [n]. */
COROT_INLINE vec3 minus_sum(int n, const vec3 *x) {
  vec3 y;
  for (int c = 0; c < 3; c++) {
    y.v[c] = x[0].v[c];
    for (int a = 1; a < n; a++) y.v[c] += x[a].v[c];
    y.v[c] = -y.v[c];
  }
  return y;
}

COROT_INLINE void find_node_vectors(point_lanes at, const tangent_terms *k, node_vectors *n) {
  for (int a = 1; a < at.kind->nnode; a++) {
    for (int c = 0; c < 3; c++) n->g[a].v[c] = slope_of(at, a, c);
    n->p[a] = mat3_apply(k->Bp, n->g[a]);
    n->s[a] = mat3_apply(k->Bs, n->g[a]);
  }
  int rest = at.kind->nnode - 1;
  n->g[0] = minus_sum(rest, &n->g[1]), n->p[0] = minus_sum(rest, &n->p[1]);
  n->s[0] = minus_sum(rest, &n->s[1]);
}

COROT_INLINE void store_slopes(point_lanes at, const node_vectors *n, block_vd (*slope)[3]) {
  slope += (at.block * at.kind->npoint + at.q) * at.kind->nnode;
  for (int a = 0; a < at.kind->nnode; a++)
    for (int c = 0; c < 3; c++) vd_put(&slope[a][c], at.part, weight_of(at) * n->p[a].v[c]);
}

/* The blocks of an element's pairs, summed over its points. */
typedef struct pair_sums {
  mat3 of[KIND_PAIRS];
} pair_sums;

/* A matrix, and what is set aside of it. */
typedef struct sum_of_blocks {
  double (*A)[9], (*aside)[9];
} sum_of_blocks;

/* Where the blocks of LANES elements go: [kind->npair], from the first lane on. */
typedef struct block_places {
  const int (*at)[W];
  int lane;
  bool detour; /* some are parts that are set aside */
} block_places;

COROT_INLINE block_places places_of(const solid *body, const range_plan *plan, int b) {
  int block = b / PARTS, npair = body->elements.kind->npair;
  int detour = plan->n > 1 ? plan->detour[block] : -1;
  const int(*usual)[W] = (const int(*)[W])body->pattern.place + block * npair;
  return (block_places){.at = detour < 0 ? usual : (const int(*)[W])plan->place + detour * npair,
                        .lane = b % PARTS * LANES,
                        .detour = detour >= 0};
}

/* As scatter, lane by lane. */
static void scatter_aside(sum_of_blocks to, const int place[LANES], const mat3 *block) {
  for (int l = 0; l < LANES; l++) {
    double *a = place[l] < 0 ? to.aside[-1 - place[l]] : to.A[place[l]];
    EACH_IJ {
      double value = block->m[i][j][l];
      a[3 * i + j] = place[l] < 0 ? value : a[3 * i + j] + value;
    }
  }
}

/* Adds a point's block to those of the points before it; of the last one, all to the matrix. */
COROT_INLINE void add_block(point_lanes at, mat3 block, mat3 *sum, sum_of_blocks to,
                            block_places places, int pair) {
  const int *place = places.at[pair] + places.lane;
  if (at.q > 0) EACH_IJ block.m[i][j] = sum->m[i][j] + block.m[i][j];
  if (at.q < at.kind->npoint - 1)
    EACH_IJ sum->m[i][j] = block.m[i][j]; /* copied whole it would take several times as long */
  else if (places.detour) {
    mat3 copy; /* the block itself stays in registers */
    EACH_IJ copy.m[i][j] = block.m[i][j];
    scatter_aside(to, place, &copy);
  } else
    scatter(to.A, place, block);
}

/* Adds the blocks of one point to the sums over the points before it, and at the last point those
   to the matrices, either of which may be NULL. */
COROT_INLINE void add_point(const element_kind *kind, const strain_measure *s, const solid *body,
                            solid_state *state, corot_tangent tangent, const element *e,
                            block_places places, sum_of_blocks K, sum_of_blocks D, pair_sums *of_K,
                            pair_sums *of_D) {
  /* coefficients, and what the point gives to all pairs */
  bool turning = tangent != COROT_TANGENT_HELD && s->frame == FRAME_POLAR;
  vd lambda = weight_of(e->at) * e->mat->lambda, mu = weight_of(e->at) * e->mat->mu;
  vd dlambda = weight_of(e->at) * e->mat->damping_lambda,
     dmu = weight_of(e->at) * e->mat->damping_mu;
  bool averaged = body->dilatation.npool;
  vd theta =
      averaged ? vd_at(state->dilatation, index_of(e->at)) : dilatation_of(s->pressure, e->F, e->R);
  vd local = weight_of(e->at) * e->mat->lambda_local;
  tangent_terms t = tangent_terms_of(s, tangent, local, lambda * theta, mu, e->F, e->R);
  node_vectors n;
  find_node_vectors(e->at, &t, &n);
  if (averaged) store_slopes(e->at, &n, state->slope);
  bool objective = D.A && body->objective && s->frame == FRAME_POLAR;
  node_rates rates;
  if (objective) find_node_rates(e->at, e->F, e->R, &rates);

  /* pair by pair, column by column */
  vec3 Zg;
  mat3 Hs;
  for (int k = 0; k < kind->npair; k++) {
    int a = kind->pair[k][0], c = kind->pair[k][1];
    if (k == 0 || kind->pair[k - 1][1] != c) { /* a new column */
      if (s->pressure == BY_GRADIENT) Zg = mat3_apply(t.Z, n.g[c]);
      if (turning) Hs = mat3_mul(t.H, mat3_skew(n.s[c]));
    }
    vd gg = vec3_dot(n.g[a], n.g[c]);
    mat3 A = constant_bases(t.lambda, mu, gg, t.BsBs, n.p[a], n.p[c], n.s[a], n.s[c]);
    if (s->pressure == BY_GRADIENT) A = mat3_add_identity(A, vec3_dot(n.g[a], Zg));
    if (turning) A = add_skew_transposed(A, n.s[a], Hs);
    if (K.A) add_block(e->at, A, &of_K->of[k], K, places, k);
    if (objective)
      add_block(e->at, objective_damping(s, dlambda, dmu, &rates, a, c, n.p[a], n.p[c]),
                &of_D->of[k], D, places, k);
    else if (D.A)
      add_block(e->at, constant_bases(dlambda, dmu, gg, t.BsBs, n.p[a], n.p[c], n.s[a], n.s[c]),
                &of_D->of[k], D, places, k);
  }
}

COROT_INLINE int tangent_loop(const element_kind *kind, const strain_measure *s, const solid *body,
                              solid_state *state, nodal_field u, corot_tangent tangent, int chunk,
                              double (*A)[9], double (*B)[9]) {
  const sum_of_blocks K = {A, state->ranges.aside_K}, D = {B, state->ranges.aside_D};
  pair_sums of_K, of_D;
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    differences of_u = differences_of(point_at(kind, &body->elements, b, 0), u);
    block_places places = places_of(body, &state->ranges.plan, b);
    vi inverted = {0};
    EACH_POINT (kind, q) {
      element e = element_at(s, body, &state->frames, &of_u, point_at(kind, &body->elements, b, q));
      inverted |= e.inverted;
      add_point(kind, s, body, state, tangent, &e, places, K, D, &of_K, &of_D);
    }
    if (vi_any(inverted)) return first_inverted(body, b, inverted);
  }
  return -1;
}

/* a -= b */
COROT_INLINE void subtract_block(double a[9], const double b[9]) {
  for (int i = 0; i < 8; i += LANES) vd_add_to(a + i, -vd_load(b + i));
  a[8] -= b[8];
}

/* A body moved as a whole feels no force: a diagonal block is minus the sum of the others of its
   row, which stand in the columns before and in its own. It is symmetric up to rounding; for the
   factorisation's sake exactly so. */
void corot_kernel_diagonals(const solid *body, const int *node, int n, double (*A)[9]) {
  const pattern *p = &body->pattern;
  for (int at = 0; at < n; at++) {
    int j = node[at];
    double *diagonal = A[p->colptr[j]], half[9];
    for (int k = p->left_first[j]; k < p->left_first[j + 1]; k++)
      subtract_block(diagonal, A[p->left[k]]);
    for (int k = p->colptr[j] + 1; k < p->colptr[j + 1]; k++) subtract_block(diagonal, A[k]);
    for (int i = 0; i < 9; i++) half[i] = 0.5 * diagonal[i];
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) diagonal[3 * r + c] = half[3 * r + c] + half[3 * c + r];
  }
}

int corot_kernel_tangent(const solid *body, solid_state *state, nodal_field u,
                         corot_tangent tangent, int chunk, double (*K)[9], double (*D)[9]) {
  const strain_measure *s = &strain_measures[body->strain];
  if (tangent == COROT_TANGENT_CLAMPED) /* compiled apart, so as not to burden the others */
    return OF_KIND(&body->elements, tangent_loop, s, body, state, u, COROT_TANGENT_CLAMPED, chunk,
                   K, D);
  return OF_KIND(&body->elements, tangent_loop, s, body, state, u, tangent, chunk, K, D);
}

COROT_INLINE int derivative_loop(const element_kind *kind, const strain_measure *s,
                                 const solid *body, solid_state *state, nodal_field u,
                                 nodal_field v, nodal_field du, nodal_field dv, bool exact,
                                 int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_du = differences_of(here, du), of_v, of_dv;
    if (v) of_v = differences_of(here, v), of_dv = differences_of(here, dv);
    node_forces f;
    vi inverted = {0};
    EACH_POINT (kind, q) {
      element e = element_at(s, body, &state->frames, &of_u, point_at(kind, &body->elements, b, q));
      inverted |= e.inverted;

      /* the change of the frame */
      mat3 dF = gradient(e.at, &of_du);
      mat3 dR = mat3_scale(vd_all(0), e.R);
      if (exact && s->frame != FRAME_IDENTITY) {
        mat3 room;
        const mat3 *Q0 = rest_basis_of(s->frame, e.at, &room);
        dR = frame_derivative(s->frame, e.F, Q0, e.R, dF);
      }
      vd minus = -weight_of(e.at);
      bool averaged = body->dilatation.npool;
      vd theta = averaged ? vd_at(state->dilatation, index_of(e.at))
                          : dilatation_of(s->pressure, e.F, e.R);
      vd change = averaged ? vd_at(state->dilatation_change, index_of(e.at))
                           : dilatation_derivative(s->pressure, e.F, e.R, dF, dR);
      /* of the elastic stress, and of the viscous one */
      vd elastic = minus * e.mat->lambda, shear = minus * e.mat->mu;
      mat3 dA = stress_derivative(s, elastic * theta, elastic * change, shear, e.F, e.R, dF, dR);
      if (v) {
        mat3 V = gradient(e.at, &of_v);
        mat3 dV = gradient(e.at, &of_dv);
        vd lambda = minus * e.mat->damping_lambda, mu = minus * e.mat->damping_mu;
        dA = mat3_add(dA, body->objective && s->frame == FRAME_POLAR
                              ? stress_objective_derivative(s, lambda, mu, e.F, e.R, V, dF, dR, dV)
                              : stress_viscous_derivative(s, lambda, mu, e.F, e.R, V, dF, dR, dV));
      }
      add_forces(e.at, dA, &f);
    }
    if (vi_any(inverted)) return first_inverted(body, b, inverted);
    store_forces(body, state, here, &f);
  }
  return -1;
}

int corot_kernel_derivative(const solid *body, solid_state *state, nodal_field u, nodal_field v,
                            nodal_field du, nodal_field dv, bool exact, int chunk) {
  return OF_KIND(&body->elements, derivative_loop, &strain_measures[body->strain], body, state, u,
                 v, du, dv, exact, chunk);
}
