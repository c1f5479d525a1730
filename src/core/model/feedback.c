/* Feedback: the host's own force, its blocks in K and D, and its directional derivative. What it
   sees are copies of the nodal fields, three to a row. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/fault.h"
#include "inputs.h"

static corot_status allocate(corot_inputs *in) {
  size_t nnode = in->model->mesh->nnode;
  if (in->f) return COROT_OK;
  double(*room[5])[3] = {0};
  bool short_of_memory = false;
  for (int k = 0; k < 5; k++)
    short_of_memory = !(room[k] = calloc(nnode, sizeof *room[k])) || short_of_memory;
  if (short_of_memory) {
    for (int k = 0; k < 5; k++) free(room[k]);
    return corot_fail(COROT_ENOMEM, "no memory for a feedback on %zu nodes", nnode);
  }
  in->u = room[0], in->v = room[1], in->du = room[2], in->dv = room[3], in->f = room[4];
  in->bytes += 5 * nnode * sizeof *in->f;
  return COROT_OK;
}

corot_status corot_inputs_set_feedback(corot_inputs *in, const corot_feedback *feedback) {
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  if (feedback && !feedback->force)
    return corot_fail(COROT_EINVAL, "inputs: the feedback has no force");
  if (feedback) COROT_TRY(allocate(in));
  in->matrices++;
  in->feedback = feedback ? *feedback : (corot_feedback){0};
  snprintf(in->name, sizeof in->name, "%s",
           feedback && feedback->name ? feedback->name : "feedback");
  in->feedback.name = in->name;
  return COROT_OK;
}

/* --- What it sees, and what its answer means ---------------------------------------------------
 */

/* [nnode][4] to [nnode][3]; NULL: zero. */
static const double (*shown(const corot_inputs *in, nodal_field x, double (*to)[3]))[3] {
  int nnode = in->model->mesh->nnode;
  if (!x) memset(to, 0, nnode * sizeof *to);
  for (int n = 0; x && n < nnode; n++) memcpy(to[n], x[n], sizeof to[n]);
  return (const double(*)[3])to;
}

/* Who failed, when, and why, if it says so: `failures` is the count before it was asked. Of the
   positive statuses there is one; and a singular matrix, against which a shorter step helps, is not
   what it means. */
static corot_status answered(const corot_inputs *in, double t, long failures, corot_status status) {
  if (!status) return COROT_OK;
  bool told = corot_fail_count() != failures;
  if (status > 0) status = COROT_RETRY;
  if (status == COROT_ESINGULAR || status < COROT_EINTEGRATE) status = COROT_EINVAL;
  if (told) return corot_fail(status, "%s at t = %g: %s", in->name, t, corot_error());
  return corot_fail(status, "%s at t = %g: it failed, and does not say why", in->name, t);
}

/* Its force, or the change of that. */
static corot_status check_answer(const corot_inputs *in, double t, const char *what) {
  int nnode = in->model->mesh->nnode;
  double sum = 0;
  for (int n = 0; n < nnode; n++) sum += in->f[n][0] + in->f[n][1] + in->f[n][2];
  if (isfinite(sum)) return COROT_OK;
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++)
      if (!isfinite(in->f[n][c]))
        return corot_fail(COROT_RETRY, "%s at t = %g: the %c component of %s on node %d is %g",
                          in->name, t, "xyz"[c], what, n, in -> f[n][c]);
  return corot_fail(COROT_RETRY, "%s at t = %g: %s exceeds double precision", in->name, t, what);
}

static void clear_answer(corot_inputs *in) {
  memset(in->f, 0, in->model->mesh->nnode * sizeof *in->f);
}

corot_status corot_feedback_evaluate(const instant *now, nodal_field u, nodal_field v) {
  corot_inputs *in = now->inputs;
  const corot_feedback *of = &in->feedback;
  long failures = corot_fail_count();
  clear_answer(in);
  corot_status status =
      of->force(of->data, now->t, shown(in, u, in->u), shown(in, v, in->v), in->f);
  COROT_TRY(answered(in, now->t, failures, status));
  return check_answer(in, now->t, "its force");
}

void corot_feedback_add(const instant *now, double *f) {
  const corot_inputs *in = now->inputs;
  const int(*dof)[3] = (const int(*)[3])in->model->dof;
  for (int n = 0; n < in->model->mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) f[dof[n][c]] += in->f[n][c];
}

void corot_feedback_add_nodal(const instant *now, double (*f)[3]) {
  const corot_inputs *in = now->inputs;
  for (int n = 0; n < in->model->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] += in->f[n][c];
}

/* --- Blocks ------------------------------------------------------------------------------------
 */

/* An evaluation's: to the matrices, or if `df` is there, times a direction. */
struct corot_blocks {
  const corot_inputs *in;
  double t;
  double (*K)[9], (*D)[9];         /* [pattern.nblock] NULL: not asked for */
  const double (*du)[3], (*dv)[3]; /* [nnode] */
  double (*df)[3];                 /* [nnode] or NULL */
  corot_status status;             /* the first failure */
};

/* *place: the block of the lower triangle for the nodes of a pair. */
static corot_status find_place(const corot_blocks *b, int i, int j, int *place) {
  const pattern *p = &solid_of(b->in->model)->pattern;
  int low = i < j ? i : j, high = i < j ? j : i;
  if (low < 0 || high >= b->in->model->mesh->nnode)
    return corot_fail(COROT_EINVAL, "there is no block for nodes %d and %d: the mesh has %d", i, j,
                      b->in->model->mesh->nnode);
  *place = corot_pattern_find(p, high, low);
  if (p->row[*place] == high) return COROT_OK;
  return corot_fail(COROT_EINVAL, "there is no block for nodes %d and %d: they share no tet", i, j);
}

static corot_status check_block(const double *A, char name, int i, int j) {
  for (int k = 0; A && k < 9; k++)
    if (!isfinite(A[k]))
      return corot_fail(COROT_RETRY, "%c of nodes %d and %d has %g in row %d, column %d", name, i,
                        j, A[k], k / 3, k % 3);
  return COROT_OK;
}

/* A += the symmetric part of the matrix with the block B at (i, j); A is that of the lower
 * triangle.
 */
static void add_symmetric(const double *B, int i, int j, double *A) {
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      if (i >= j) A[3 * r + c] += 0.5 * B[3 * r + c];
      if (i <= j) A[3 * r + c] += 0.5 * B[3 * c + r];
    }
}

/* f -= B x. */
static void subtract_product(const double *B, const double x[3], double f[3]) {
  for (int r = 0; r < 3; r++) f[r] -= B[3 * r] * x[0] + B[3 * r + 1] * x[1] + B[3 * r + 2] * x[2];
}

static corot_status add_block(corot_blocks *b, int i, int j, const double *K, const double *D) {
  int place = 0;
  COROT_TRY(find_place(b, i, j, &place));
  COROT_TRY(check_block(K, 'K', i, j));
  COROT_TRY(check_block(D, 'D', i, j));
  if (b->df) {
    if (K) subtract_product(K, b->du[j], b->df[i]);
    if (D) subtract_product(D, b->dv[j], b->df[i]);
    return COROT_OK;
  }
  if (K && b->K) add_symmetric(K, i, j, b->K[place]);
  if (D && b->D) add_symmetric(D, i, j, b->D[place]);
  return COROT_OK;
}

corot_status corot_blocks_add(corot_blocks *b, int i, int j, const double *K, const double *D) {
  COROT_TRY(COROT_GIVEN_AS(b, "blocks"));
  corot_status status = add_block(b, i, j, K, D);
  if (!b->status) b->status = status;
  return status;
}

/* Asks for the blocks. */
static corot_status collect(corot_blocks *b, nodal_field u, nodal_field v) {
  const corot_inputs *in = b->in;
  const corot_feedback *of = &in->feedback;
  long failures = corot_fail_count();
  corot_status status = of->blocks(of->data, b->t, shown(in, u, in->u), shown(in, v, in->v), b);
  return answered(in, b->t, failures, b->status ? b->status : status);
}

corot_status corot_feedback_matrices(const instant *now, nodal_field u, nodal_field v,
                                     double (*K)[9], double (*D)[9]) {
  if (!now->inputs->feedback.blocks) return COROT_OK;
  corot_blocks b = {.in = now->inputs, .t = now->t, .K = K, .D = D};
  return collect(&b, u, v);
}

corot_status corot_feedback_differentiate(const instant *now, nodal_field u, nodal_field v,
                                          nodal_field du, nodal_field dv) {
  corot_inputs *in = now->inputs;
  const corot_feedback *of = &in->feedback;
  const double(*along_u)[3] = shown(in, du, in->du), (*along_v)[3] = shown(in, dv, in->dv);
  clear_answer(in);
  if (of->change) {
    long failures = corot_fail_count();
    corot_status status = of->change(of->data, now->t, shown(in, u, in->u), shown(in, v, in->v),
                                     along_u, along_v, in->f);
    COROT_TRY(answered(in, now->t, failures, status));
  } else if (of->blocks) {
    corot_blocks b = {.in = in, .t = now->t, .du = along_u, .dv = along_v, .df = in->f};
    COROT_TRY(collect(&b, u, v));
  }
  return check_answer(in, now->t, "the change of its force");
}
