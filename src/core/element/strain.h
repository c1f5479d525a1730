/* Strain measures: one table, one stress, one tangent.

   Cauchy, warped, polar, hybrid and Green strain differ in the basis B of the pressure (lambda)
   term, that of the shear (mu) term, each the frame R or the gradient F, and in the rule that
   finds R. With e = sym(R'F) - I for B = R and (F'F - I)/2 for B = F:

     P = lambda tr(e_p) B_p + 2 mu B_s e_s,     energy = lambda/2 tr(e_p)^2 + mu e_s:e_s

   For B = R this is the paper's (4.12) read as e = e^C(R' phi); its (5.6), with u in place of phi,
   is not invariant. All functions work on a tet a lane. */
#ifndef COROT_CORE_ELEMENT_STRAIN_H
#define COROT_CORE_ELEMENT_STRAIN_H

#include <corot/ode.h>

#include "core/lanes/eigen.h"
#include "core/lanes/polar.h"

typedef enum basis { BY_FRAME, BY_GRADIENT } basis;
typedef enum frame_rule { FRAME_IDENTITY, FRAME_WARP, FRAME_POLAR } frame_rule;

typedef struct strain_measure {
  const char *name;
  basis pressure, shear;
  frame_rule frame;
} strain_measure;

/* The measures, a row each: row(index, name, basis of pressure, of shear, frame). A row here is all
   that a measure of this family takes: its kernels are compiled from the table. */
/* clang-format off */
#define STRAIN_MEASURES(row)                                           \
  row(CAUCHY, "cauchy", BY_FRAME,    BY_FRAME,    FRAME_IDENTITY)      \
  row(WARP,   "warp",   BY_FRAME,    BY_FRAME,    FRAME_WARP)          \
  row(POLAR,  "polar",  BY_FRAME,    BY_FRAME,    FRAME_POLAR)         \
  row(HYBRID, "hybrid", BY_GRADIENT, BY_FRAME,    FRAME_POLAR)         \
  row(GREEN,  "green",  BY_GRADIENT, BY_GRADIENT, FRAME_IDENTITY)
/* clang-format on */

#define STRAIN_INDEX(index, name, pressure, shear, frame) index,
enum { STRAIN_MEASURES(STRAIN_INDEX) NSTRAIN };

#define STRAIN_ROW(index, name, pressure, shear, frame) [index] = {name, pressure, shear, frame},
static const strain_measure strain_measures[] = {STRAIN_MEASURES(STRAIN_ROW)};
_Static_assert(sizeof strain_measures / sizeof *strain_measures == NSTRAIN, "a row a measure");

/* Linear in F: there nothing can invert. */
COROT_INLINE bool strain_is_linear(const strain_measure *s) {
  return s->frame == FRAME_IDENTITY && s->pressure == BY_FRAME && s->shear == BY_FRAME;
}

COROT_INLINE mat3 basis_of(basis b, mat3 F, mat3 R) { return b == BY_FRAME ? R : F; }

COROT_INLINE mat3 strain_of(basis b, mat3 F, mat3 R) {
  if (b == BY_FRAME) return mat3_add_identity(mat3_sym_tmul(R, F), vd_all(-1));
  return mat3_scale(vd_all(0.5), mat3_add_identity(mat3_gram(F), vd_all(-1)));
}

/* tr(e), without the rest of e. */
COROT_INLINE vd dilatation_of(basis b, mat3 F, mat3 R) {
  return b == BY_FRAME ? mat3_dot(R, F) - 3 : 0.5 * (mat3_dot(F, F) - 3);
}

/* The law in a frame, lambda tr(e) I + 2 mu e, of a strain or of its rate. */
COROT_INLINE mat3 hooke(vd lambda, vd mu, mat3 e) {
  return mat3_add_identity(mat3_scale(2 * mu, e), lambda * mat3_trace(e));
}

/* First Piola-Kirchhoff stress for a given p in place of lambda tr(e_p). */
COROT_INLINE mat3 stress_at_pressure(const strain_measure *s, vd p, vd mu, mat3 F, mat3 R) {
  mat3 Bp = basis_of(s->pressure, F, R), Bs = basis_of(s->shear, F, R);
  mat3 shear = mat3_scale(2 * mu, strain_of(s->shear, F, R));
  return mat3_add(mat3_scale(p, Bp), mat3_mul(Bs, shear));
}

/* First Piola-Kirchhoff stress; see above. */
COROT_INLINE mat3 stress(const strain_measure *s, vd lambda, vd mu, mat3 F, mat3 R) {
  if (s->pressure != s->shear)
    return stress_at_pressure(s, lambda * dilatation_of(s->pressure, F, R), mu, F, R);
  mat3 e = strain_of(s->shear, F, R), shear = mat3_scale(2 * mu, e);
  return mat3_mul(basis_of(s->shear, F, R), mat3_add_identity(shear, lambda * mat3_trace(e)));
}

/* Strain energy density; `average` takes the place of one tr(e_p), NULL: it is that. */
COROT_INLINE vd strain_energy(const strain_measure *s, vd lambda, vd mu, mat3 F, mat3 R,
                              const vd *average) {
  mat3 e = strain_of(s->shear, F, R);
  vd trace = dilatation_of(s->pressure, F, R);
  return 0.5 * lambda * trace * (average ? *average : trace) + mu * mat3_dot(e, e);
}

/* Viscous stress: the same law on the rate sym(B' dF/dt) (the paper's D). With the elastic
   coefficients and a change dF it is also the change of P at constant bases. */
COROT_INLINE mat3 stress_viscous(const strain_measure *s, vd lambda, vd mu, mat3 F, mat3 R,
                                 mat3 dF) {
  mat3 Bp = basis_of(s->pressure, F, R), Bs = basis_of(s->shear, F, R);
  vd p = lambda * mat3_dot(Bp, dF);
  return mat3_sum(p, Bp, 2 * mu, mat3_mul(Bs, mat3_sym_tmul(Bs, dF)));
}

/* The objective law's quantities: S = sym(R'F), A = R' dF/dt, the frame's rotation rate w and the
   rate of the stretch dS/dt = A - [w]x S, which is symmetric by the choice of w. */
typedef struct stretch_rate {
  mat3 S, A, Ginv, rate;
  vec3 w;
} stretch_rate;

COROT_INLINE stretch_rate stretch_rate_of(mat3 F, mat3 R, mat3 V) {
  stretch_rate r = {.S = mat3_sym_tmul(R, F), .A = mat3_tmul(R, V)};
  r.Ginv = polar_inverse_g(r.S);
  r.w = mat3_apply(r.Ginv, mat3_vee(r.A));
  r.rate = mat3_sum(vd_all(1), r.A, vd_all(-1), mat3_mul(mat3_skew(r.w), r.S));
  return r;
}

/* Viscous stress of a stretch rate, in the frame: the terms on a frame basis. */
COROT_INLINE mat3 rate_stress(const strain_measure *s, vd lambda, vd mu, mat3 rate) {
  mat3 T = s->shear == BY_FRAME ? mat3_scale(2 * mu, rate) : mat3_scale(vd_all(0), rate);
  return s->pressure == BY_FRAME ? mat3_add_identity(T, lambda * mat3_trace(rate)) : T;
}

/* Objective viscous stress R (T + [G^-1 vee(S T)]x), the adjoint of dF/dt -> dS/dt: its power is
   T : dS/dt. A pressure term on F is objective as it stands. */
COROT_INLINE mat3 stress_objective(const strain_measure *s, vd lambda, vd mu, mat3 F, mat3 R,
                                   mat3 V) {
  stretch_rate r = stretch_rate_of(F, R, V);
  mat3 T = rate_stress(s, lambda, mu, r.rate);
  vec3 z = mat3_apply(r.Ginv, mat3_vee(mat3_mul(r.S, T)));
  mat3 P = mat3_mul(R, mat3_add(T, mat3_skew(z)));
  if (s->pressure == BY_FRAME) return P;
  return mat3_add(P, mat3_scale(lambda * mat3_dot(F, V), F));
}

/* dG x for G = tr(S) I - S. */
COROT_INLINE vec3 apply_g_change(mat3 dS, vec3 x) {
  vec3 y = mat3_apply(dS, x);
  for (int i = 0; i < 3; i++) y.v[i] = mat3_trace(dS) * x.v[i] - y.v[i];
  return y;
}

COROT_INLINE vec3 vec3_less(vec3 a, vec3 b) {
  for (int i = 0; i < 3; i++) a.v[i] -= b.v[i];
  return a;
}

/* The change of the objective viscous stress with (dF, dR) and dV. */
COROT_INLINE mat3 stress_objective_derivative(const strain_measure *s, vd lambda, vd mu, mat3 F,
                                              mat3 R, mat3 V, mat3 dF, mat3 dR, mat3 dV) {
  vd minus = vd_all(-1), one = vd_all(1);
  stretch_rate r = stretch_rate_of(F, R, V);
  mat3 dS = mat3_add(mat3_sym_tmul(dR, F), mat3_sym_tmul(R, dF));
  mat3 dA = mat3_add(mat3_tmul(dR, V), mat3_tmul(R, dV));
  vec3 dw = mat3_apply(r.Ginv, vec3_less(mat3_vee(dA), apply_g_change(dS, r.w)));
  mat3 drate = mat3_add(mat3_mul(mat3_skew(dw), r.S), mat3_mul(mat3_skew(r.w), dS));
  drate = mat3_sum(one, dA, minus, drate);

  mat3 T = rate_stress(s, lambda, mu, r.rate), dT = rate_stress(s, lambda, mu, drate);
  vec3 z = mat3_apply(r.Ginv, mat3_vee(mat3_mul(r.S, T)));
  mat3 dST = mat3_add(mat3_mul(dS, T), mat3_mul(r.S, dT));
  vec3 dz = mat3_apply(r.Ginv, vec3_less(mat3_vee(dST), apply_g_change(dS, z)));
  mat3 dP =
      mat3_add(mat3_mul(dR, mat3_add(T, mat3_skew(z))), mat3_mul(R, mat3_add(dT, mat3_skew(dz))));
  if (s->pressure == BY_FRAME) return dP;
  vd p = lambda * mat3_dot(F, V), dp = lambda * (mat3_dot(dF, V) + mat3_dot(F, dV));
  return mat3_add(dP, mat3_sum(p, dF, dp, F));
}

/* The frame of F by the measure's own rule. Q0 (the rest edges' Gram-Schmidt basis) is looked at
   by warp only. */
COROT_INLINE mat3 frame_of(frame_rule rule, mat3 F, const mat3 *Q0, vi *inverted) {
  if (rule == FRAME_POLAR) return polar(F, inverted);
  *inverted = ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
  if (rule == FRAME_IDENTITY) return mat3_identity();
  return mat3_mul(gram_schmidt(mat3_mul(F, *Q0)), mat3_transpose(*Q0));
}

/* The change of the frame R = frame_of(F) with F. */
COROT_INLINE mat3 frame_derivative(frame_rule rule, mat3 F, const mat3 *Q0, mat3 R, mat3 dF) {
  if (rule == FRAME_POLAR) {
    vec3 w = mat3_apply(polar_inverse_g(mat3_tmul(R, F)), mat3_vee(mat3_tmul(R, dF)));
    return mat3_mul(R, mat3_skew(w));
  }
  if (rule == FRAME_IDENTITY) return mat3_scale(vd_all(0), R);
  mat3 dQ = gram_schmidt_derivative(mat3_mul(R, *Q0), mat3_mul(F, *Q0), mat3_mul(dF, *Q0));
  return mat3_mul(dQ, mat3_transpose(*Q0));
}

/* The change of tr(e) with (dF, dR). */
COROT_INLINE vd dilatation_derivative(basis b, mat3 F, mat3 R, mat3 dF, mat3 dR) {
  vd change = mat3_dot(basis_of(b, F, R), dF);
  return b == BY_FRAME ? change + mat3_dot(dR, F) : change;
}

/* The change of the elastic stress with (dF, dR) and with p = lambda tr(e_p) by dp. */
COROT_INLINE mat3 stress_derivative(const strain_measure *s, vd p, vd dp, vd mu, mat3 F, mat3 R,
                                    mat3 dF, mat3 dR) {
  mat3 Bp = basis_of(s->pressure, F, R), Bs = basis_of(s->shear, F, R);
  mat3 dBp = basis_of(s->pressure, dF, dR), dBs = basis_of(s->shear, dF, dR);
  mat3 e = strain_of(s->shear, F, R);
  mat3 de = mat3_sym_tmul(Bs, dF);
  if (s->shear == BY_FRAME) de = mat3_add(de, mat3_sym_tmul(dR, F));
  mat3 shear = mat3_add(mat3_mul(dBs, e), mat3_mul(Bs, de));
  return mat3_add(mat3_sum(dp, Bp, p, dBp), mat3_scale(2 * mu, shear));
}

/* The change of the viscous stress for the rate V = dF/dt with (dF, dR) and with dV. */
COROT_INLINE mat3 stress_viscous_derivative(const strain_measure *s, vd lambda, vd mu, mat3 F,
                                            mat3 R, mat3 V, mat3 dF, mat3 dR, mat3 dV) {
  mat3 Bp = basis_of(s->pressure, F, R), Bs = basis_of(s->shear, F, R);
  mat3 dBp = basis_of(s->pressure, dF, dR), dBs = basis_of(s->shear, dF, dR);
  mat3 dP = stress_viscous(s, lambda, mu, F, R, dV);
  dP = mat3_add(dP, mat3_sum(lambda * mat3_dot(dBp, V), Bp, lambda * mat3_dot(Bp, V), dBp));
  mat3 rate = mat3_sym_tmul(Bs, V), change = mat3_sym_tmul(dBs, V);
  return mat3_add(dP, mat3_scale(2 * mu, mat3_add(mat3_mul(Bs, change), mat3_mul(dBs, rate))));
}

/* What the tangent of a tet needs beside the gradients g_a of its nodes: its element matrix is V
   times
     lambda p_a p_b' + mu (g_a.g_b Bs Bs' + s_b s_a')   at constant bases, p_a = Bp g_a, s_a = Bs
   g_a
   + (g_a . Z g_b) I                                    the stress on a basis F that turns with it
   + [s_a]x' H [s_b]x                                   the variation of an exact polar frame
   with Z = p I, p = lambda tr(e_p), for Bp = F, plus 2 mu e_s for Bs = F, and H = R h R' (so that
   all is in spatial axes), h = mu I + c G^-1, c = p for Bp = R (else 0) - 2 mu. The damping matrix
   is the first line with the damping coefficients. Where the dilatation is averaged, p is that of
   the average, and lambda the part that acts on the tet's own; the rest is no element's matrix.

   Each line is a quadratic form of its own in dF. The first is positive semidefinite (hybrid, whose
   bases differ: while lambda |F|^2 >= -2 mu), the others are so while Z and H are. Clamped, Z loses
   its negative eigenvalues, and c and lambda stop where H and the first line become singular. */
typedef struct tangent_terms {
  mat3 Bp, Bs, BsBs, Z, H;
  vd lambda;
} tangent_terms;

/* H. The eigenvalues of h are mu + c / g_k with those of G: for c < 0 the smallest g_k, tr(S) less
   the largest eigenvalue of S, decides. It is positive in a frame that is F's own; beside a frame
   held too long there is nothing to go by, and clamped H is zero. */
COROT_INLINE mat3 frame_variation(int clamped, vd mu, vd c, mat3 F, mat3 R) {
  mat3 S = mat3_sym_tmul(R, F);
  vd least = vd_all(1);
  if (clamped) {
    least = mat3_trace(S) - largest_eigenvalue(S);
    c = vd_max(c, -mu * least);
  }
  mat3 h = mat3_add_identity(mat3_scale(c, polar_inverse_g(S)), mu);
  if (clamped) h = mat3_select(least > vd_all(0), h, mat3_scale(vd_all(0), R));
  return mat3_mul(R, mat3_mul(h, mat3_transpose(R)));
}

COROT_INLINE tangent_terms tangent_terms_of(const strain_measure *s, corot_tangent tangent,
                                            vd lambda, vd p, vd mu, mat3 F, mat3 R) {
  tangent_terms k = {.Bp = basis_of(s->pressure, F, R), .Bs = basis_of(s->shear, F, R)};
  int clamped = tangent == COROT_TANGENT_CLAMPED;
  k.BsBs = s->shear == BY_GRADIENT ? mat3_gram(mat3_transpose(F)) : mat3_identity();
  k.lambda = lambda;
  vd c = -2 * mu;
  if (s->pressure == BY_FRAME) {
    c += p;
  } else if (s->shear == BY_FRAME) {
    k.Z = mat3_scale(clamped ? vd_max(p, vd_all(0)) : p, mat3_identity());
    if (clamped) k.lambda = vd_max(lambda, -2 * mu / mat3_dot(F, F));
  } else {
    mat3 Z = mat3_add_identity(mat3_scale(2 * mu, strain_of(BY_GRADIENT, F, R)), p);
    k.Z = clamped ? positive_part(Z) : Z;
  }
  if (tangent != COROT_TANGENT_HELD && s->frame == FRAME_POLAR)
    k.H = frame_variation(clamped, mu, c, F, R);
  return k;
}

#endif
