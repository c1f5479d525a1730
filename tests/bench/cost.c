#include "cost.h"

#include <suitesparse/klu.h>

#include "core/ode/state.h"
#include "core/solid/kernel.h"

/* Operations of the pieces, each on one point of a tet. */
enum {
  MUL = 27 + 18, /* product of two matrices */
  APPLY = 9 + 6, /* matrix times vector */
  ADD = 9,
  SCALE = 9,
  SCALE_SYMMETRIC = 6,
  DOT = 9 + 8,
  GRAM = 6 * 5,           /* A' A */
  SYM_TMUL = MUL + 3 + 3, /* sym(A' B) */
  COFACTOR = 9 * 3,
  DET = 5,                 /* with the cofactors at hand */
  DET_ALONE = 3 * 3 + DET, /* with one row of them */
  POLAR_STEP = COFACTOR + DET + DOT + 6 /* tests */ + 2 /* factor */ + 27 /* mean */,
  GRAM_SCHMIDT = 5 + 6 + 2 * (5 + 1 + 3) + 9,
  WARP_FRAME = MUL + GRAM_SCHMIDT + MUL + DET_ALONE,
};

static const element_kind *kind_of(const specimen *s) { return solid_of(s->model)->elements.kind; }

/* Of a field: differences to node 0, once, and at each point their sum times the gradients. */
static double gradient_flops(const specimen *s) {
  const element_kind *k = kind_of(s);
  int others = k->nnode - 1;
  return 3.0 * others + k->npoint * (9 * (2.0 * others - 1));
}

static double deformation_flops(const specimen *s) {
  return gradient_flops(s) + 3 * kind_of(s)->npoint;
}

/* Scale of the coefficients, all nodes but the first, their sums over the points; then the first,
   and the sums at the nodes of the mesh. */
static double nodal_flops(const specimen *s) {
  const element_kind *k = kind_of(s);
  int others = k->nnode - 1;
  return k->npoint * (3 + 15.0 * others) + (k->npoint - 1) * 3.0 * others + 3 * others +
         3.0 * k->nnode;
}

static const strain_measure *measure(const specimen *s) {
  return &strain_measures[solid_of(s->model)->strain];
}

static double frame_flops(const strain_measure *s, bool held, double steps) {
  if (s->frame == FRAME_IDENTITY) return s->shear == BY_FRAME ? 0 : DET_ALONE;
  if (held) return DET_ALONE;
  return s->frame == FRAME_POLAR ? steps * POLAR_STEP : WARP_FRAME;
}

static double strain_flops(basis b) {
  return b == BY_FRAME ? SYM_TMUL + 3 : GRAM + 3 + SCALE_SYMMETRIC;
}

/* tr(e): of the strain at hand, or of the other basis. */
static double dilatation_flops(const strain_measure *s) {
  return s->pressure == s->shear ? 2 : DOT + 2;
}

static double stress_flops(const strain_measure *s) {
  double common = strain_flops(s->shear) + 1 + SCALE_SYMMETRIC + 1 + dilatation_flops(s) + MUL;
  return common + (s->pressure == s->shear ? 3 : SCALE + ADD);
}

static double viscous_flops(void) { return DOT + 1 + SYM_TMUL + MUL + 1 + 27; }

/* --- bytes of arrays --- */

static double vector(const specimen *s) { return 8.0 * s->n; }
static double matrix(const specimen *s) { return 72.0 * solid_of(s->model)->pattern.nblock; }
static double blocks(const specimen *s) {
  const element_set *e = &solid_of(s->model)->elements;
  double block = sizeof *e->block + e->kind->nnode * sizeof *e->node;
  double point = sizeof *e->weight + (e->kind->nnode - 1) * sizeof *e->slope;
  return e->nblock * block + points_of(e) * point;
}
static double frames(const specimen *s) {
  return points_of(&solid_of(s->model)->elements) * (double)sizeof(mat3);
}
static double dofs(const specimen *s) { return 12.0 * solid_of(s->model)->pattern.nnode; }

static double slots(const specimen *s) {
  const pattern *p = &solid_of(s->model)->pattern;
  return 4.0 * (p->nnode + p->first[p->nnode]);
}

/* What the frame in use is read from. */
static double frame_bytes(const specimen *s, bool held) {
  if (measure(s)->frame == FRAME_IDENTITY) return 0;
  return held || measure(s)->frame == FRAME_WARP ? frames(s) : 0;
}

/* --- kernels --- */

cost cost_force(const specimen *s, bool held, double steps) {
  bool damped = solid_of(s->model)->damped;
  double point = frame_flops(measure(s), held, steps) + stress_flops(measure(s)) +
                 (damped ? viscous_flops() + ADD : 0);
  double flops = deformation_flops(s) + (damped ? gradient_flops(s) : 0) +
                 kind_of(s)->npoint * point + nodal_flops(s);
  return (cost){
      .bytes = blocks(s) + frame_bytes(s, held) + slots(s) + dofs(s) + (damped ? 3 : 2) * vector(s),
      .flops = flops * s->ntet};
}

cost cost_rhs(const specimen *s, double steps) {
  cost c = cost_force(s, false, steps);
  c.bytes += 2 * vector(s); /* M^-1, du/dt */
  c.flops += s->n;
  return c;
}

cost cost_jacobian(const specimen *s, bool exact, double steps) {
  const strain_measure *m = measure(s);
  const pattern *p = &solid_of(s->model)->pattern;
  bool damped = solid_of(s->model)->damped, exact_polar = exact && m->frame == FRAME_POLAR;
  double terms = 4 + dilatation_flops(m) + 1; /* coefficients, pressure */
  if (m->shear == BY_GRADIENT) terms += GRAM + strain_flops(BY_GRADIENT) + 2 * SCALE_SYMMETRIC;
  if (exact_polar) terms += MUL + 2 + COFACTOR + DET + SCALE + SCALE + 3 + 2 * MUL;
  const element_kind *kind = kind_of(s);
  int others = kind->nnode - 1;
  double vectors = others * APPLY * (m->pressure == m->shear ? 1 : 2) + 9 * (others - 1) + 9;
  double bases = 3 + 3 + 1 + SCALE_SYMMETRIC + 9 * 4; /* constant_bases */
  double pair = 5 + bases + 9;                        /* g_a . g_b, the block, its addition */
  if (m->pressure == BY_GRADIENT) pair += APPLY + 5 + 3;
  if (exact_polar) pair += 27 + 9 * 4;
  if (damped) pair += bases + 9;
  double tet = deformation_flops(s) +
               kind->npoint * (frame_flops(m, false, steps) + terms + vectors + kind->npair * pair);
  double diagonal = (p->nblock - p->nnode) * 18.0 * (damped ? 2 : 1);
  return (cost){.bytes = blocks(s) + frame_bytes(s, false) +
                         4.0 * kind->npair * W * solid_of(s->model)->elements.nblock +
                         4.0 * p->nblock + dofs(s) + vector(s) + (damped ? 2 : 1) * matrix(s),
                .flops = tet * s->ntet + diagonal};
}

cost cost_jvp(const specimen *s, double steps) {
  const strain_measure *m = measure(s);
  double frame = 0; /* its change; that of a product of two factors takes two products */
  if (m->frame == FRAME_POLAR) frame = 2 * MUL + 2 + COFACTOR + DET + SCALE + 3 + APPLY + MUL;
  if (m->frame == FRAME_WARP) frame = 5 * MUL + 6 + MUL;
  double by_frame = m->shear == BY_FRAME ? 1 : 0;
  double elastic = viscous_flops() + strain_flops(m->shear) + dilatation_flops(m) + 1 + MUL + 27 +
                   ADD + by_frame * (DOT + 1 + SCALE + ADD + SYM_TMUL + MUL + SCALE + ADD);
  double viscous =
      viscous_flops() + 2 * (DOT + 1) + 27 + ADD + 2 * SYM_TMUL + 2 * MUL + 2 * ADD + SCALE;
  bool damped = solid_of(s->model)->damped;
  double point = frame_flops(m, false, steps) + frame + elastic + (damped ? viscous + ADD : 0);
  double tet = deformation_flops(s) + (damped ? 3 : 1) * gradient_flops(s) +
               kind_of(s)->npoint * point + nodal_flops(s);
  return (cost){.bytes = blocks(s) + frame_bytes(s, false) + slots(s) + dofs(s) + 5 * vector(s),
                .flops = tet * s->ntet};
}

cost cost_frames(const specimen *s, double steps) {
  return (cost){
      .bytes = blocks(s) + dofs(s) + vector(s) + frames(s) + frame_bytes(s, false),
      .flops = (deformation_flops(s) + kind_of(s)->npoint * frame_flops(measure(s), false, steps)) *
               s->ntet};
}

cost cost_energy(const specimen *s, double steps) {
  const strain_measure *m = measure(s);
  bool damped = solid_of(s->model)->damped;
  double point = frame_flops(m, false, steps) + strain_flops(m->shear) + dilatation_flops(m) + DOT +
                 7 + (damped ? viscous_flops() + DOT + 2 : 0);
  double tet = deformation_flops(s) + (damped ? gradient_flops(s) : 0) + kind_of(s)->npoint * point;
  return (cost){.bytes = blocks(s) + frame_bytes(s, false) + dofs(s) + 3 * vector(s) +
                         24.0 * solid_of(s->model)->pattern.nnode,
                .flops = tet * s->ntet + 5.0 * s->n};
}

cost cost_combine(const specimen *s, const corot_csc *csc) {
  return (cost){.bytes = 12.0 * csc->nnz + 2 * matrix(s) + 12.0 * csc->n,
                .flops = 3.0 * csc->nnz + 2.0 * csc->n};
}

COROT_INLINE double polar_steps(const element_kind *kind, const element_set *t, nodal_field u) {
  double sum = 0;
  for (int at = 0; at < points_of(t); at++) {
    int b = at / kind->npoint;
    differences of_u = differences_of(point_at(kind, t, b, 0), u);
    mat3 X = deformation(point_at(kind, t, b, at % kind->npoint), &of_u);
    for (int k = 0;; k++) { /* as in core/lanes/polar.h, strains this small being left unscaled */
      mat3 C = mat3_cofactor(X);
      vi rough = ~(mat3_dot(X, X) - 3 < 1e-8);
      X = mat3_sum(vd_all(0.5), X, 0.5 / mat3_det(X, C), C);
      sum++;
      if (k > 0 && !vi_any(rough)) break;
    }
  }
  return sum / points_of(t);
}

double cost_polar_steps(const specimen *s) {
  const element_set *t = &solid_of(s->model)->elements;
  corot_element_fields none = {0};
  if (corot_elements(s->model, s->state, 0, s->u, &none) != COROT_OK) return 0; /* sets state->u */
  return OF_KIND(t, polar_steps, t, (nodal_field)s->state->u);
}

corot_status cost_direct(const corot_csc *full, bool cholesky, solver_cost *out) {
  klu_common common;
  klu_defaults(&common);
  common.btf = 0;
  klu_symbolic *symbolic = klu_analyze(full->n, full->colptr, full->row, &common);
  if (!symbolic) return corot_fail(COROT_ENOMEM, "no memory for an analysis by klu");
  double lnz = symbolic->lnz, flops = symbolic->est_flops, share = cholesky ? 0.5 : 1;
  klu_free_symbolic(&symbolic, &common);
  double index = cholesky ? 0 : 4; /* dense blocks need none to speak of */
  out->factor =
      (cost){.bytes = share * (12.0 * full->nnz + 2 * lnz * (8 + index)), .flops = share * flops};
  out->solve = (cost){.bytes = 2 * lnz * (8 + index) + 16.0 * full->n,
                      .flops = 4 * lnz,
                      .data = 2 * share * lnz * (8 + index)};
  return COROT_OK;
}

solver_cost cost_pcg(const corot_csc *full, double iterations) {
  double n = full->n, below = (full->nnz - 3 * n) / 2; /* entries in blocks below the diagonal */
  double matrix = (8 + 4.0 / 9) * below, diagonal = 8 * 3 * n;
  /* an iteration: the blocks twice, three dot products and three updates of vectors */
  double data = matrix + diagonal + 5 * 8 * n;
  return (solver_cost){
      .factor = {.bytes = 2 * (12 * below + diagonal), .flops = 14 * below + 40 * n},
      .solve = {.bytes = iterations * (2 * matrix + diagonal + 13 * 8 * n),
                .flops = iterations * (4 * below + 6 * n + 12 * n),
                .data = data},
  };
}
