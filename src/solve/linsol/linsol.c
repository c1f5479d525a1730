/* Creates a solver as the choice says. */
#include "linsol.h"

#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"

/* The solver of a definition whose size is not ours, which has no first member to say so. */
static const char other_version[] = "of another version";

void corot_linear_set_defaults(corot_linear_def *def, size_t bytes) {
  const corot_linear_def ours = {.solver = bytes == sizeof ours ? "auto" : other_version,
                                 .ordering = "auto",
                                 .factor = "auto",
                                 .preconditioner = "auto",
                                 .tolerance = 1e-10,
                                 .role = COROT_ROLE_DYNAMIC};
  memset(def, 0, bytes);
  memcpy(def, &ours, bytes < sizeof ours ? bytes : sizeof ours);
}

corot_status corot_linear_check(const corot_linear_def *def) {
  if (def->solver != other_version) return COROT_OK;
  return corot_fail(
      COROT_EINVAL,
      "a corot_linear_def of another size than corot %s has: the program was compiled "
      "with headers of another version",
      corot_version());
}

static corot_status check_refinement(const corot_model *model, const corot_refinement *r) {
  int nnode = corot_model_mesh(model)->nnode;
  if (!r || r->nnode[r->nlevel] == nnode) return COROT_OK;
  return corot_fail(COROT_EINVAL, "linear solver: the refinement is of %d nodes, the mesh has %d",
                    r->nnode[r->nlevel], nnode);
}

/* Where the nodes are, for solvers that ask. */
static corot_status place(const corot_model *model, linsol_plan *plan, linsol *s) {
  if (!plan->by_place) return COROT_OK;
  const corot_mesh *mesh = corot_model_mesh(model);
  s->x = malloc(mesh->nnode * sizeof *s->x);
  if (!s->x) return corot_fail(COROT_ENOMEM, "no memory for %d nodes", mesh->nnode);
  memcpy(s->x, mesh->x, mesh->nnode * sizeof *s->x);
  plan->x = (const double(*)[3])s->x;
  return COROT_OK;
}

void corot_linsol_move(linsol *s, const corot_model *model, double t, const double *u) {
  if (!s->x) return;
  const corot_mesh *mesh = corot_model_mesh(model);
  corot_nodal(model, t, u, NULL, s->x, NULL);
  for (int i = 0; i < mesh->nnode; i++)
    for (int c = 0; c < 3; c++) s->x[i][c] += mesh->x[i][c];
}

static corot_status make(const corot_model *model, linsol_plan *plan, linsol *s) {
  s->ops = plan->ops;
  s->name = plan->name;
  s->by_cost = plan->by_cost;
  s->rival = plan->rival;
  if (s->ops->triangle == COROT_FULL) {
    corot_csc_destroy(s->csc);
    s->csc = NULL;
    COROT_TRY(corot_csc_create(model, COROT_FULL, &s->csc));
  }
  s->value = malloc(s->csc->nnz * sizeof *s->value);
  if (!s->value) return corot_fail(COROT_ENOMEM, "no memory for %d entries", s->csc->nnz);
  COROT_TRY(place(model, plan, s));
  return s->ops->create(s->csc, plan, &s->solver);
}

corot_status corot_linsol_create(const corot_model *model, const corot_linear_def *def, linsol *s) {
  linsol_plan plan = {0};
  *s = (linsol){0};
  COROT_TRY(corot_linear_check(def));
  COROT_TRY(check_refinement(model, def->refinement));
  corot_status status = corot_csc_create(model, COROT_LOWER, &s->csc);
  if (!status) status = corot_linsol_choose(def, s->csc, &plan);
  if (!status) status = make(model, &plan, s);
  corot_linsol_plan_clear(&plan);
  return status;
}

void corot_linsol_clear(linsol *s) {
  if (s->solver) s->ops->destroy(s->solver);
  corot_csc_destroy(s->csc);
  free(s->value);
  free(s->x);
  *s = (linsol){0};
}

corot_status corot_linsol_count_negative(const linsol *s, const double *value, int *negative) {
  *negative = 0;
  return s->ops->count_negative ? s->ops->count_negative(s->csc, value, negative) : COROT_OK;
}

corot_status corot_linsol_singular(const corot_csc *csc, const char *solver, int dof,
                                   double ratio) {
  return corot_fail(
      COROT_ESINGULAR,
      "%s: the matrix is singular at degree of freedom %d of node %d (pivot ratio %.1e)", solver,
      dof, csc->node[dof], ratio);
}
