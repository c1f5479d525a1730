/* Forces, derivatives, matrices and energy of a hierarchical model from those of its parts. */
#include "core/ode/trial.h"
#include "core/solid/kernel.h"
#include "levels.h"

/* What a part's evaluation returned; its inverted tet is named by level, and remembered as its
   first descendant. */
static corot_status part_status(const levels *l, corot_state *s, int level, const corot_state *part,
                                corot_status status) {
  if (status != COROT_RETRY || part->inverted < 0) return status;
  s->inverted = part->inverted << 3 * (l->nlevel - level);
  return corot_fail(COROT_RETRY, "tet %d of level %d is inverted", part->inverted, level);
}

/* The frames in use of a part that is displaced. */
static corot_status frames_now(const corot_model *m, corot_state *s, mat3 *R) {
  if (s->frames == COROT_FRAMES_EXACT) return corot_state_check(s, corot_kernel_frames(m, s, R));
  for (int b = 0; b < m->tets.nblock; b++)
    R[b] = s->frames == COROT_FRAMES_EXTRAPOLATED ? rotate_by(s->spin[b], s->elapsed, s->R[b])
                                                  : s->R[b];
  return COROT_OK;
}

void corot_levels_coarsen(const levels *l, const double (*field)[4], double *on_coarse,
                          double *on_framer) {
  corot_coarsen(&l->to_coarse, field, on_coarse);
  if (on_framer != on_coarse) corot_coarsen(&l->to_framer, field, on_framer);
}

/* The displacement as the parts see it, and the framer's frames of time t. */
static corot_status find_frames(const corot_model *m, corot_state *s, double t) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  corot_levels_coarsen(l, (const double(*)[4])s->u, ls->on_coarse.u, ls->on_framer.u);
  corot_state_displace(l->framer, ls->framer, t, ls->on_framer.u);
  corot_status status = frames_now(l->framer, ls->framer, ls->framer->now_R);
  return part_status(l, s, l->frame_level, ls->framer, status);
}

corot_status corot_levels_hand_down(const corot_model *m, corot_state *s, double t) {
  COROT_TRY(find_frames(m, s, t));
  corot_kernel_hand_down(m, s);
  return COROT_OK;
}

static void add_scaled(int n, double a, const double *x, double *y) {
  for (int i = 0; i < n; i++) y[i] += a * x[i];
}

/* The force that `kernel` finds by the moments of the model's tets. */
static corot_status add_turning(const corot_model *m, corot_state *s, double t,
                                force_kernel *kernel) {
  const corot_model *framer = m->levels->framer;
  levels_state *ls = s->levels;
  corot_state *fs = ls->framer;
  corot_state_displace(framer, fs, t, ls->on_framer.u);
  memset(fs->r, 0, framer->ndof * sizeof *fs->r);
  COROT_TRY(corot_sum_forces(framer, fs, t, kernel, false));
  add_scaled(framer->ndof, 1, fs->r, ls->on_framer.sum);
  return COROT_OK;
}

/* The kernels of the model's tets add to them. */
static void clear_moments(const corot_model *m, levels_state *ls) {
  size_t nblock = m->levels->framer->tets.nblock;
  memset(ls->framer->moment, 0, nblock * sizeof *ls->framer->moment);
  memset(ls->framer->dmoment, 0, nblock * sizeof *ls->framer->dmoment);
}

/* Frames that are held do not turn with u. */
static bool turning(const corot_model *m, const corot_state *s) {
  return m->levels->turning && s->levels->frames == COROT_FRAMES_EXACT;
}

static void clear_sums(const levels *l, levels_state *ls) {
  memset(ls->on_coarse.sum, 0, l->coarse->ndof * sizeof(double));
  if (l->turning) memset(ls->on_framer.sum, 0, l->framer->ndof * sizeof(double));
}

/* ls->nodal = the parts' force. */
static void gather_parts(const corot_model *m, levels_state *ls) {
  const levels *l = m->levels;
  memset(ls->nodal, 0, m->mesh->nnode * sizeof *ls->nodal);
  corot_coarsen_transposed(&l->to_coarse, ls->on_coarse.sum, ls->nodal);
  if (l->turning && l->framer != l->linear)
    corot_coarsen_transposed(&l->to_framer, ls->on_framer.sum, ls->nodal);
}

/* Whether level 0 is a mesh of its own. */
static bool one_way(const corot_model *m) { return m->levels->coupling == COROT_COUPLING_ONE_WAY; }

/* Coarse less linear force; one way, coarse force. */
static corot_status coarse_force(const corot_model *m, corot_state *s, double t) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  const level_fields *f = &ls->on_coarse;
  int n = l->coarse->ndof;
  if (l->same) return COROT_OK;
  corot_status status = corot_residual_trial(l->coarse, ls->coarse, t, f->u, f->v, ls->r);
  COROT_TRY(part_status(l, s, 0, ls->coarse, status));
  add_scaled(n, 1, ls->r, f->sum);
  if (one_way(m)) return COROT_OK;
  status = corot_residual_trial(l->linear, ls->linear, t, f->u, f->v, ls->r);
  COROT_TRY(part_status(l, s, 0, ls->linear, status));
  add_scaled(n, -1, ls->r, f->sum);
  return COROT_OK;
}

/* ls->nodal = the parts' force; the model's own kernel has been through. */
static corot_status parts_force(const corot_model *m, corot_state *s, double t, bool damped) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  const double(*v)[4] = (const double(*)[4])s->v;
  if (damped) corot_levels_coarsen(l, v, ls->on_coarse.v, ls->on_framer.v);
  clear_sums(l, ls);
  COROT_TRY(coarse_force(m, s, t));
  if (turning(m, s)) COROT_TRY(add_turning(m, s, t, corot_kernel_turning_force));
  gather_parts(m, ls);
  return COROT_OK;
}

/* s->r += the forces of the parts on free degrees of freedom. */
static void add_parts(const corot_model *m, corot_state *s) {
  const double(*f)[4] = (const double(*)[4])s->levels->nodal;
  for (int n = 0; n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      if (i >= 0) s->r[i] += f[n][c];
    }
}

/* s->r += force of the finest level; one way, nothing of it on the nodes of level 0. */
static corot_status fine_force(const corot_model *m, corot_state *s, double t, force_kernel *kernel,
                               bool damped) {
  size_t kept = m->body_ndof * sizeof *s->r;
  if (one_way(m)) memcpy(s->levels->kept, s->r, kept);
  clear_moments(m, s->levels);
  COROT_TRY(corot_sum_forces(m, s, t, kernel, damped));
  if (one_way(m)) memcpy(s->r, s->levels->kept, kept);
  return COROT_OK;
}

corot_status corot_levels_force(const corot_model *m, corot_state *s, double t, bool damped) {
  COROT_TRY(find_frames(m, s, t));
  COROT_TRY(fine_force(m, s, t, corot_kernel_handed_force, damped));
  COROT_TRY(parts_force(m, s, t, damped));
  add_parts(m, s);
  return COROT_OK;
}

corot_status corot_levels_nodal_force(const corot_model *m, corot_state *s, double t, bool damped,
                                      double (*f)[4]) {
  const double(*parts)[4] = (const double(*)[4])s->levels->nodal;
  COROT_TRY(find_frames(m, s, t));
  clear_moments(m, s->levels);
  COROT_TRY(corot_nodal_forces(m, s, corot_kernel_handed_force, damped, f));
  if (one_way(m)) memset(f, 0, m->body_nnode * sizeof *f);
  COROT_TRY(parts_force(m, s, t, damped));
  for (int n = 0; n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] += parts[n][c];
  return COROT_OK;
}

/* Its change. */
static corot_status coarse_derivative(const corot_model *m, corot_state *s, double t,
                                      corot_tangent tangent) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  const level_fields *f = &ls->on_coarse;
  int n = l->coarse->ndof;
  if (l->same) return COROT_OK;
  corot_status status =
      corot_jvp(l->coarse, ls->coarse, t, f->u, f->v, tangent, f->du, f->dv, ls->r);
  COROT_TRY(part_status(l, s, 0, ls->coarse, status));
  add_scaled(n, 1, ls->r, f->sum);
  if (one_way(m)) return COROT_OK;
  status = corot_jvp(l->linear, ls->linear, t, f->u, f->v, tangent, f->du, f->dv, ls->r);
  COROT_TRY(part_status(l, s, 0, ls->linear, status));
  add_scaled(n, -1, ls->r, f->sum);
  return COROT_OK;
}

/* ls->nodal = change of the parts' force. */
static corot_status parts_derivative(const corot_model *m, corot_state *s, double t,
                                     corot_tangent tangent) {
  levels_state *ls = s->levels;
  clear_sums(m->levels, ls);
  COROT_TRY(coarse_derivative(m, s, t, tangent));
  if (turning(m, s) && tangent > COROT_TANGENT_HELD) {
    corot_model_spread(m->levels->framer, ls->on_framer.du, ls->framer->du[0], 4);
    COROT_TRY(add_turning(m, s, t, corot_kernel_turning_derivative));
  }
  gather_parts(m, ls);
  return COROT_OK;
}

corot_status corot_levels_derivative(const corot_model *m, corot_state *s, double t,
                                     corot_tangent tangent) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  corot_state *fs = ls->framer;
  const level_fields *c = &ls->on_coarse, *f = &ls->on_framer;
  COROT_TRY(find_frames(m, s, t));
  corot_levels_coarsen(l, (const double(*)[4])s->v, c->v, f->v);
  corot_levels_coarsen(l, (const double(*)[4])s->du, c->du, f->du);
  corot_levels_coarsen(l, (const double(*)[4])s->dv, c->dv, f->dv);
  if (tangent > COROT_TANGENT_HELD) {
    corot_model_spread(l->framer, f->du, fs->du[0], 4);
    corot_kernel_frames_change(l->framer, fs);
  } else {
    memset(fs->dR, 0, l->framer->tets.nblock * sizeof *fs->dR);
  }
  bool damped = m->damped && !s->still;
  COROT_TRY(fine_force(m, s, t, corot_kernel_handed_derivative, damped));
  COROT_TRY(parts_derivative(m, s, t, tangent));
  add_parts(m, s);
  return COROT_OK;
}

static void add_blocks(const levels *l, double a, const double (*part)[9], double (*A)[9]) {
  for (int k = 0; k < l->coarse->pattern.nblock; k++) add_scaled(9, a, part[k], A[l->place[k]]);
}

/* The columns of level 0, and with them its rows. */
static void clear_columns(const corot_model *m, double (*A)[9]) {
  memset(A, 0, m->pattern.colptr[m->body_nnode] * sizeof *A);
}

corot_status corot_levels_add_matrices(const corot_model *m, corot_state *s, double t,
                                       corot_tangent tangent, double (*K)[9], double (*D)[9]) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  const level_fields *f = &ls->on_coarse;
  if (!l->place) return COROT_OK;
  double(*part_K)[9] = K ? ls->K : NULL, (*part_D)[9] = D ? ls->D : NULL;
  if (one_way(m) && K) clear_columns(m, K);
  if (one_way(m) && D) clear_columns(m, D);
  for (int k = 0; k < (one_way(m) ? 1 : 2); k++) {
    const corot_model *part = k == 0 ? l->coarse : l->linear;
    corot_state *state = k == 0 ? ls->coarse : ls->linear;
    double sign = k == 0 ? 1 : -1;
    corot_status status = corot_jacobian(part, state, t, f->u, f->v,
                                         k == 0 ? tangent : COROT_TANGENT_HELD, part_K, part_D);
    COROT_TRY(part_status(l, s, 0, state, status));
    if (K) add_blocks(l, sign, (const double(*)[9])part_K, K);
    if (D) add_blocks(l, sign, (const double(*)[9])part_D, D);
  }
  return COROT_OK;
}

/* Energy and viscous power of a part. */
static corot_status part_energy(const corot_model *part, corot_state *state, double t,
                                const level_fields *f, bool damped, double *elastic,
                                double *power) {
  corot_state_displace(part, state, t, f->u);
  if (damped) corot_model_velocity(part, NAN, t, f->v, state->v[0], 4);
  return corot_state_check(state, corot_kernel_energy(part, state, damped, elastic, power));
}

corot_status corot_levels_energy(const corot_model *m, corot_state *s, double t, bool damped,
                                 double *elastic, double *power) {
  const levels *l = m->levels;
  levels_state *ls = s->levels;
  double coarse[2] = {0}, linear[2] = {0}, fine[2] = {0};
  COROT_TRY(corot_levels_hand_down(m, s, t));
  const level_fields *f = &ls->on_coarse;
  if (damped) corot_levels_coarsen(l, (const double(*)[4])s->v, f->v, ls->on_framer.v);
  if (!one_way(m))
    COROT_TRY(corot_state_check(s, corot_kernel_energy(m, s, damped, &fine[0], &fine[1])));
  if (!l->same) {
    corot_status status = part_energy(l->coarse, ls->coarse, t, f, damped, &coarse[0], &coarse[1]);
    COROT_TRY(part_status(l, s, 0, ls->coarse, status));
  }
  if (!l->same && !one_way(m)) {
    corot_status status = part_energy(l->linear, ls->linear, t, f, damped, &linear[0], &linear[1]);
    COROT_TRY(part_status(l, s, 0, ls->linear, status));
  }
  *elastic = coarse[0] + (fine[0] - linear[0]);
  *power = coarse[1] + (fine[1] - linear[1]);
  return COROT_OK;
}
