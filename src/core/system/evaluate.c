/* Forces, derivatives, matrices and energy of a system from those of its terms. */
#include "kernel_handed.h"
#include "system.h"

/* --- What the terms see ----------------------------------------------------------------------- */

term_fields corot_system_seen(const solid_system *y, const system_state *s, int k,
                              const term_fields *all) {
  if (y->term[k].map < 0) return *all;
  const map_fields *on = &s->on[y->term[k].map];
  return (term_fields){.u = (nodal_field)on->u,
                       .v = all->v ? (nodal_field)on->v : NULL,
                       .du = all->du ? (nodal_field)on->du : NULL,
                       .dv = all->dv ? (nodal_field)on->dv : NULL};
}

/* The frames in use of the terms that have their own; handed down ones are given. */
static void use_frames(const solid_system *y, system_state *s, double age) {
  for (int k = 0; k < y->nterm; k++) {
    solid_state *of = &s->of[k];
    corot_frames kind = y->term[k].frames_from < 0 ? s->frames : COROT_FRAMES_HELD;
    of->frames = (frame_source){kind, of->R, of->spin, age};
  }
}

void corot_system_begin(const solid_system *y, system_state *s, double age,
                        const term_fields *all) {
  s->inverted = -1;
  use_frames(y, s, age);
  for (int k = 0; k < y->nmap; k++) {
    const coarsening *map = &y->map[k].map;
    corot_coarsen(map, all->u, s->on[k].u);
    if (all->v) corot_coarsen(map, all->v, s->on[k].v);
    if (all->du) corot_coarsen(map, all->du, s->on[k].du);
    if (all->dv) corot_coarsen(map, all->dv, s->on[k].dv);
  }
}

corot_status corot_system_told(const solid_system *y, system_state *s, int k, corot_status status) {
  const term *t = &y->term[k];
  int tet = s->of[k].inverted;
  if (status != COROT_RETRY || tet < 0) return status;
  s->inverted = tet * t->below;
  if (t->map < 0) return status;
  return corot_fail(COROT_RETRY, "tet %d of level %d is inverted", tet, t->level);
}

/* --- Frames handed down --- */

/* What term k has of the leader. */
static from_leader lead_of(const solid_system *y, const system_state *s, int k) {
  return (from_leader){.npoint = y->term[y->leader].body.elements.kind->npoint,
                       .above = y->term[k].above,
                       .R = s->of[y->leader].now_R,
                       .dR = s->lead.dR,
                       .moment = s->lead.moment,
                       .dmoment = s->lead.dmoment};
}

/* The leader's frames, of which there is one. */
static corot_status find_frames(const solid_system *y, system_state *s, const term_fields *all) {
  int k = y->leader;
  if (k < 0) return COROT_OK;
  term_fields f = corot_system_seen(y, s, k, all);
  solid_state *of = &s->of[k];
  return corot_system_told(y, s, k,
                           corot_solid_frames_in_use(&y->term[k].body, of, f.u, of->now_R));
}

/* What the loops over chunks take, of a body in frames that are handed down, or of the leader. */
typedef struct handed_work {
  const solid *body;
  const from_leader *lead;
  term_fields f;
  block_mat3 *R; /* to be found */
} handed_work;

static int hand_down_chunk(const void *of, solid_state *s, int chunk) {
  const handed_work *w = of;
  (void)s;
  corot_kernel_hand_down(w->body, w->lead, chunk, w->R);
  return -1;
}

/* They are given to the terms that they are handed down to. */
static corot_status hand_down(const solid_system *y, system_state *s, const term_fields *all) {
  if (y->leader < 0) return COROT_OK;
  COROT_TRY(find_frames(y, s, all));
  for (int k = 0; k < y->nterm; k++) {
    if (y->term[k].frames_from < 0) continue;
    const from_leader lead = lead_of(y, s, k);
    const handed_work w = {.body = &y->term[k].body, .lead = &lead, .R = s->of[k].R};
    COROT_TRY(corot_solid_each(w.body, &s->of[k], hand_down_chunk, &w));
  }
  return COROT_OK;
}

/* The loops over tets in handed down frames add to them. */
static void clear_moments(const solid_system *y, system_state *s) {
  if (y->leader < 0) return;
  size_t npoint = points_of(&y->term[y->leader].body.elements);
  memset(s->lead.moment, 0, npoint * sizeof *s->lead.moment);
  memset(s->lead.dmoment, 0, npoint * sizeof *s->lead.dmoment);
}

/* Frames that are held do not turn with u. */
static bool turns(const solid_system *y, const system_state *s) {
  return y->turning && s->frames == COROT_FRAMES_EXACT;
}

corot_status corot_system_settle(const solid_system *y, system_state *s, double age,
                                 nodal_field u) {
  const term_fields all = {.u = u};
  corot_system_begin(y, s, age, &all);
  return hand_down(y, s, &all);
}

/* --- Sums of forces --- */

static void clear_sums(const solid_system *y, system_state *s) {
  for (int k = 0; k < y->nmap; k++)
    memset(s->on[k].sum, 0, y->map[k].map.nnode * sizeof *s->on[k].sum);
}

/* Where the forces of a term go: of one on a map, to the sum of its nodes. */
static force_sum sum_of(const solid_system *y, system_state *s, int k, const int (*row)[3],
                        double *r) {
  const term *t = &y->term[k];
  force_sum sum = {.row = row, .r = r, .sign = t->sign, .from = t->from};
  if (t->map >= 0) sum.row = NULL, sum.r = s->on[t->map].sum[0];
  return sum;
}

/* r += the forces of the maps' terms, L' of their sums. */
static void add_maps(const solid_system *y, system_state *s, const int (*row)[3], double *r) {
  int nnode = y->term[0].body.mesh->nnode;
  if (y->nmap == 0) return;
  memset(s->nodal, 0, nnode * sizeof *s->nodal);
  for (int k = 0; k < y->nmap; k++)
    corot_coarsen_transposed(&y->map[k].map, (nodal_field)s->on[k].sum, s->nodal);
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = row ? row[n][c] : 4 * n + c;
      if (i >= 0) r[i] += s->nodal[n][c];
    }
}

static int handed_force_chunk(const void *of, solid_state *s, int chunk) {
  const handed_work *w = of;
  return corot_kernel_handed_force(w->body, s, w->lead, w->f.u, w->f.v, chunk);
}

static corot_status handed_force(const solid_system *y, system_state *s, int k,
                                 const term_fields *f, force_sum *sum) {
  const from_leader lead = lead_of(y, s, k);
  const handed_work w = {.body = &y->term[k].body, .lead = &lead, .f = *f};
  return corot_solid_sum(w.body, &s->of[k], handed_force_chunk, &w, sum);
}

static int turning_force_chunk(const void *of, solid_state *s, int chunk) {
  const handed_work *w = of;
  return corot_kernel_turning_force(w->body, s, w->lead, w->f.u, chunk);
}

/* Of the leader, from the moments. */
static corot_status turning_force(const solid_system *y, system_state *s, const term_fields *f,
                                  force_sum *sum) {
  const from_leader lead = lead_of(y, s, y->leader);
  const handed_work w = {.body = &y->term[y->leader].body, .lead = &lead, .f = *f};
  sum->sign = 1;
  return corot_solid_sum(w.body, &s->of[y->leader], turning_force_chunk, &w, sum);
}

corot_status corot_system_force(const solid_system *y, system_state *s, double age, nodal_field u,
                                nodal_field v, const int (*row)[3], double *r) {
  const term_fields all = {.u = u, .v = v};
  corot_system_begin(y, s, age, &all);
  COROT_TRY(find_frames(y, s, &all));
  clear_moments(y, s);
  clear_sums(y, s);

  /* each term's own force */
  for (int k = 0; k < y->nterm; k++) {
    const term *t = &y->term[k];
    if (t->sign == 0) continue;
    term_fields f = corot_system_seen(y, s, k, &all);
    force_sum sum = sum_of(y, s, k, row, r);
    corot_status status = t->frames_from >= 0
                              ? handed_force(y, s, k, &f, &sum)
                              : corot_solid_force(&t->body, &s->of[k], f.u, f.v, &sum);
    COROT_TRY(corot_system_told(y, s, k, status));
  }

  /* that by which the leader's frames turn, for which all moments must be there */
  if (turns(y, s)) {
    term_fields f = corot_system_seen(y, s, y->leader, &all);
    force_sum sum = sum_of(y, s, y->leader, row, r);
    COROT_TRY(turning_force(y, s, &f, &sum));
  }
  add_maps(y, s, row, r);
  return COROT_OK;
}

/* --- Their changes --- */

static int handed_derivative_chunk(const void *of, solid_state *s, int chunk) {
  const handed_work *w = of;
  const term_fields *f = &w->f;
  return corot_kernel_handed_derivative(w->body, s, w->lead, f->u, f->v, f->du, f->dv, chunk);
}

static corot_status handed_derivative(const solid_system *y, system_state *s, int k,
                                      const term_fields *f, force_sum *sum) {
  const from_leader lead = lead_of(y, s, k);
  const handed_work w = {.body = &y->term[k].body, .lead = &lead, .f = *f};
  return corot_solid_sum(w.body, &s->of[k], handed_derivative_chunk, &w, sum);
}

static int turning_derivative_chunk(const void *of, solid_state *s, int chunk) {
  const handed_work *w = of;
  return corot_kernel_turning_derivative(w->body, s, w->lead, w->f.u, w->f.du, chunk);
}

static corot_status turning_derivative(const solid_system *y, system_state *s, const term_fields *f,
                                       force_sum *sum) {
  const from_leader lead = lead_of(y, s, y->leader);
  const handed_work w = {.body = &y->term[y->leader].body, .lead = &lead, .f = *f};
  sum->sign = 1;
  return corot_solid_sum(w.body, &s->of[y->leader], turning_derivative_chunk, &w, sum);
}

static int change_chunk(const void *of, solid_state *s, int chunk) {
  const handed_work *w = of;
  (void)s;
  corot_kernel_frames_change(w->body, w->lead->R, w->f.u, w->f.du, chunk, w->R);
  return -1;
}

/* The change of the leader's frames; zero where they do not follow. */
static corot_status change_frames(const solid_system *y, system_state *s, const term_fields *all,
                                  bool follow) {
  if (y->leader < 0) return COROT_OK;
  const solid *leader = &y->term[y->leader].body;
  const from_leader lead = lead_of(y, s, y->leader);
  const handed_work w = {
      .body = leader, .lead = &lead, .f = corot_system_seen(y, s, y->leader, all), .R = s->lead.dR};
  if (follow) return corot_solid_each(leader, &s->of[y->leader], change_chunk, &w);
  memset(s->lead.dR, 0, points_of(&leader->elements) * sizeof *s->lead.dR);
  return COROT_OK;
}

corot_status corot_system_derivative(const solid_system *y, system_state *s, double age,
                                     nodal_field u, nodal_field v, nodal_field du, nodal_field dv,
                                     corot_tangent tangent, const int (*row)[3], double *r) {
  const term_fields all = {u, v, du, dv};
  bool exact = tangent > COROT_TANGENT_HELD;
  corot_system_begin(y, s, age, &all);
  COROT_TRY(find_frames(y, s, &all));
  COROT_TRY(change_frames(y, s, &all, exact));
  clear_moments(y, s);
  clear_sums(y, s);

  /* as the forces are summed */
  for (int k = 0; k < y->nterm; k++) {
    const term *t = &y->term[k];
    if (t->sign == 0) continue;
    term_fields f = corot_system_seen(y, s, k, &all);
    force_sum sum = sum_of(y, s, k, row, r);
    corot_status status =
        t->frames_from >= 0
            ? handed_derivative(y, s, k, &f, &sum)
            : corot_solid_derivative(&t->body, &s->of[k], f.u, f.v, f.du, f.dv, exact, &sum);
    COROT_TRY(corot_system_told(y, s, k, status));
  }
  if (turns(y, s) && exact) {
    term_fields f = corot_system_seen(y, s, y->leader, &all);
    force_sum sum = sum_of(y, s, y->leader, row, r);
    COROT_TRY(turning_derivative(y, s, &f, &sum));
  }
  add_maps(y, s, row, r);
  return COROT_OK;
}

/* --- Matrices and energy --- */

static void add_blocks(const term *t, const double (*part)[9], double (*A)[9]) {
  for (int k = 0; k < t->body.pattern.nblock; k++)
    for (int i = 0; i < 9; i++) A[t->place[k]][i] += t->sign * part[k][i];
}

/* One way, the columns of level 0, and with them its rows, are those of the coarse term. */
static void clear_columns(const term *t, double (*A)[9]) {
  if (A) memset(A, 0, t->body.pattern.colptr[t->from] * sizeof *A);
}

/* Those of a term are added where they are placed. */
static corot_status add_matrices(const solid_system *y, system_state *s, int k, nodal_field u,
                                 corot_tangent tangent, double (*K)[9], double (*D)[9]) {
  const term *t = &y->term[k];
  size_t bytes = t->body.pattern.nblock * sizeof *K;
  double(*part_K)[9] = K ? s->K : NULL, (*part_D)[9] = D ? s->D : NULL;
  if (K) memset(part_K, 0, bytes);
  if (D) memset(part_D, 0, bytes);
  COROT_TRY(corot_solid_matrices(&t->body, &s->of[k], u, tangent, part_K, part_D));
  if (K) add_blocks(t, (const double(*)[9])part_K, K);
  if (D) add_blocks(t, (const double(*)[9])part_D, D);
  return COROT_OK;
}

corot_status corot_system_matrices(const solid_system *y, system_state *s, double age,
                                   nodal_field u, corot_tangent tangent, double (*K)[9],
                                   double (*D)[9]) {
  const term_fields all = {.u = u};
  const term *first = &y->term[0];
  corot_tangent own = first->frames_from >= 0 ? COROT_TANGENT_HELD : tangent;
  corot_system_begin(y, s, age, &all);
  COROT_TRY(hand_down(y, s, &all));
  corot_status status = corot_solid_matrices(&first->body, &s->of[0], u, own, K, D);
  COROT_TRY(corot_system_told(y, s, 0, status));
  clear_columns(first, K);
  clear_columns(first, D);
  for (int k = 1; k < y->nterm; k++) {
    if (!y->term[k].place) continue;
    term_fields f = corot_system_seen(y, s, k, &all);
    own = y->term[k].sign > 0 ? tangent : COROT_TANGENT_HELD;
    COROT_TRY(corot_system_told(y, s, k, add_matrices(y, s, k, f.u, own, K, D)));
  }
  return COROT_OK;
}

/* Of one term; one way, the detail has none. */
static corot_status term_energy(const solid_system *y, system_state *s, int k,
                                const term_fields *all, double *elastic, double *power) {
  const term *t = &y->term[k];
  *elastic = *power = 0;
  if (t->sign == 0 || t->from > 0) return COROT_OK;
  term_fields f = corot_system_seen(y, s, k, all);
  corot_status status = corot_solid_energy(&t->body, &s->of[k], f.u, f.v, elastic, power);
  return corot_system_told(y, s, k, status);
}

/* Less what is taken off first: fine less linear is the detail, small beside the rest. */
corot_status corot_system_sum_energy(const solid_system *y, system_state *s, const term_fields *all,
                                     double *elastic, double *power) {
  double e[TERMS], p[TERMS];
  COROT_TRY(hand_down(y, s, all));
  for (int k = 0; k < y->nterm; k++) COROT_TRY(term_energy(y, s, k, all, &e[k], &p[k]));
  *elastic = e[0];
  *power = p[0];
  for (int sign = -1; sign <= 1; sign += 2)
    for (int k = 1; k < y->nterm; k++)
      if (y->term[k].sign == sign) *elastic += sign * e[k], *power += sign * p[k];
  return COROT_OK;
}

corot_status corot_system_energy(const solid_system *y, system_state *s, double age, nodal_field u,
                                 nodal_field v, double *elastic, double *power) {
  const term_fields all = {.u = u, .v = v};
  corot_system_begin(y, s, age, &all);
  return corot_system_sum_energy(y, s, &all, elastic, power);
}
