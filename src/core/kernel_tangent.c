#include "core/kernel.h"

typedef double vd_unaligned __attribute__((vector_size(64), aligned(8), may_alias));

/* The block [9] of each lane is added to the matrix: eight entries as a vector, the ninth alone. */
COROT_INLINE void scatter(double (*A)[9], const int place[W], mat3 block) {
  vd row[W];
  vd_transpose(&block.m[0][0], row);
  for (int l = 0; l < W; l++) {
    double *a = A[place[l]];
    *(vd_unaligned *)a += row[l];
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

/* The stretch rates of unit velocities e_i of the upper nodes, and the damping block of two nodes
   under the objective law, dS/dt : D : dS/dt. */
typedef struct node_rates {
  mat3 rate[3][3]; /* [node][component] */
} node_rates;

COROT_INLINE node_rates node_rates_of(const tet_block *block, mat3 F, mat3 R) {
  node_rates n;
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 3; i++) {
      mat3 V = mat3_scale(vd_all(0), R);
      for (int j = 0; j < 3; j++) V.m[i][j] = block->g.m[a][j];
      n.rate[a][i] = stretch_rate_of(F, R, V).rate;
    }
  return n;
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

/* Gradients of the three upper nodes, and the bases applied to them. */
typedef struct node_vectors {
  vec3 g[3], p[3], s[3];
} node_vectors;

COROT_INLINE node_vectors node_vectors_of(const tet_block *block, const tangent_terms *k) {
  node_vectors n;
  for (int a = 0; a < 3; a++) {
    for (int c = 0; c < 3; c++) n.g[a].v[c] = block->g.m[a][c];
    n.p[a] = mat3_apply(k->Bp, n.g[a]);
    n.s[a] = mat3_apply(k->Bs, n.g[a]);
  }
  return n;
}

/* The blocks of the pairs with node 0, whose gradient is minus the sum of the others', and then
   all ten are added to the matrix. A_ba = A_ab'. upper: pairs of nodes 1 to 3, lower triangle by
   rows 11, 21, 22, 31, 32, 33. */
COROT_INLINE void complete_and_scatter(double (*M)[9], const int (*place)[W], const mat3 upper[6]) {
  const mat3 *A11 = &upper[0], *A21 = &upper[1], *A22 = &upper[2], *A31 = &upper[3],
             *A32 = &upper[4], *A33 = &upper[5];
  vd minus = vd_all(-1);
  mat3 A10 = mat3_scale(
      minus, mat3_add(*A11, mat3_transpose(mat3_add(*A21, *A31)))); /* -(A11 + A12 + A13) */
  mat3 A20 = mat3_scale(minus, mat3_add(mat3_add(*A21, *A22), mat3_transpose(*A32)));
  mat3 A30 = mat3_scale(minus, mat3_add(mat3_add(*A31, *A32), *A33));
  mat3 A00 = mat3_scale(minus, mat3_add(mat3_add(A10, A20), A30));
  /* symmetric up to rounding already; exactly so for the factorisation's sake */
  EACH_IJ if (i > j) A00.m[i][j] = A00.m[j][i] = 0.5 * (A00.m[i][j] + A00.m[j][i]);
  scatter(M, place[0], A00), scatter(M, place[1], A10), scatter(M, place[2], A20);
  scatter(M, place[3], A30), scatter(M, place[4], *A11), scatter(M, place[5], *A21);
  scatter(M, place[6], *A31), scatter(M, place[7], *A22), scatter(M, place[8], *A32);
  scatter(M, place[9], *A33);
}

COROT_INLINE int tangent_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                              bool exact, double (*K)[9], double (*D)[9]) {
  for (int b = 0; b < m->tets.nblock; b++) {
    const tet_block *block = &m->tets.block[b];
    const material *mat = &m->material[block->material];
    const int(*place)[W] = (const int(*)[W])m->pattern.place[b];
    vi inverted = {0};
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 R = frame_in_use(s, m, state, b, F, &inverted);
    if (vi_any(inverted)) return first_inverted(m, b, inverted);

    vd lambda = block->volume * mat->lambda, mu = block->volume * mat->mu;
    tangent_terms t = tangent_terms_of(s, exact, lambda, mu, F, R);
    node_vectors n = node_vectors_of(block, &t);
    vd damping_lambda = block->volume * mat->damping_lambda,
       damping_mu = block->volume * mat->damping_mu;
    bool objective = m->objective && s->frame == FRAME_POLAR;
    node_rates rates;
    if (D && objective) rates = node_rates_of(block, F, R);
    mat3 element[6], damping[6];
    for (int a = 0, k = 0; a < 3; a++)
      for (int c = 0; c <= a; c++, k++) {
        vd gg = vec3_dot(n.g[a], n.g[c]);
        element[k] = constant_bases(lambda, mu, gg, t.BsBs, n.p[a], n.p[c], n.s[a], n.s[c]);
        if (D && objective)
          damping[k] =
              objective_damping(s, damping_lambda, damping_mu, &rates, a, c, n.p[a], n.p[c]);
        else if (D)
          damping[k] = constant_bases(damping_lambda, damping_mu, gg, t.BsBs, n.p[a], n.p[c],
                                      n.s[a], n.s[c]);
        if (s->pressure == BY_GRADIENT)
          element[k] = mat3_add_identity(element[k], vec3_dot(n.g[a], mat3_apply(t.Z, n.g[c])));
        if (exact && s->frame == FRAME_POLAR)
          element[k] = add_skew_transposed(element[k], n.s[a], mat3_mul(t.H, mat3_skew(n.s[c])));
      }
    if (K) complete_and_scatter(K, place, element);
    if (D) complete_and_scatter(D, place, damping);
  }
  return -1;
}

COROT_CLONES int kernel_tangent(const corot_model *m, corot_state *state, corot_tangent tangent,
                                double (*K)[9], double (*D)[9]) {
  return tangent_loop(&strain_measures[m->strain], m, state, tangent == COROT_TANGENT_EXACT, K, D);
}

COROT_INLINE int derivative_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                                 bool exact) {
  for (int b = 0; b < m->tets.nblock; b++) {
    const tet_block *block = &m->tets.block[b];
    const material *mat = &m->material[block->material];
    vi inverted = {0};
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 R = frame_in_use(s, m, state, b, F, &inverted);
    if (vi_any(inverted)) return first_inverted(m, b, inverted);

    mat3 dF = gradient(block, (const double(*)[4])state->du);
    mat3 dR = mat3_scale(vd_all(0), R);
    if (exact && s->frame != FRAME_IDENTITY) {
      const mat3 *Q0 = s->frame == FRAME_WARP ? &m->tets.rest_basis[b] : NULL;
      dR = frame_derivative(s->frame, F, Q0, R, dF);
    }
    mat3 dP = stress_derivative(s, vd_all(mat->lambda), vd_all(mat->mu), F, R, dF, dR);
    if (m->damped) {
      mat3 V = gradient(block, (const double(*)[4])state->v);
      mat3 dV = gradient(block, (const double(*)[4])state->dv);
      vd lambda = vd_all(mat->damping_lambda), mu = vd_all(mat->damping_mu);
      dP = mat3_add(dP, m->objective && s->frame == FRAME_POLAR
                            ? stress_objective_derivative(s, lambda, mu, F, R, V, dF, dR, dV)
                            : stress_viscous_derivative(s, lambda, mu, F, R, V, dF, dR, dV));
    }
    store_forces(block, dP, state->force[b]);
  }
  return -1;
}

COROT_CLONES int kernel_derivative(const corot_model *m, corot_state *state,
                                   corot_tangent tangent) {
  return derivative_loop(&strain_measures[m->strain], m, state, tangent == COROT_TANGENT_EXACT);
}
