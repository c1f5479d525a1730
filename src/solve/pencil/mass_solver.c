/* M^-1. A consistent mass couples equal components only, so it falls into one matrix for each of x,
   y and z, and these are equal where the same nodes are free: mostly one factor serves all three.
 */
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "solve/linsol/linsol.h"

/* The matrix of one component. */
typedef struct part {
  int n;
  int *dof;      /* [n] its degrees of freedom, ascending */
  int *node;     /* [n] their nodes */
  corot_csc csc; /* shares `node`; without `source` */
  double *value; /* [csc.nnz] */
  void *solver;  /* NULL: that of part `like` serves */
  int like;
} part;

struct corot_mass_solver {
  int n;
  const double *lumped;  /* [n] */
  const linsol_ops *ops; /* NULL: the mass is lumped */
  part part[3];
  double *work; /* [n] */
};

/* The degrees of freedom of component c; *component and *rank [n] are where each one went. */
static corot_status list_dofs(const corot_model *model, int c, int *component, int *rank, part *p) {
  const int(*dof)[3] = corot_model_dof(model);
  int nnode = corot_model_mesh(model)->nnode;
  p->dof = malloc(nnode * sizeof *p->dof);
  p->node = malloc(nnode * sizeof *p->node);
  if (!p->dof || !p->node)
    return corot_fail(COROT_ENOMEM, "no memory for the mass of %d nodes", nnode);
  for (int node = 0; node < nnode; node++) {
    int i = dof[node][c];
    if (i < 0) continue;
    component[i] = c, rank[i] = p->n;
    p->node[p->n] = node;
    p->dof[p->n++] = i;
  }
  return COROT_OK;
}

static void clear_matrix(part *p) {
  free(p->csc.colptr), free(p->csc.row), free(p->csc.diagonal), free(p->value);
  p->csc = (corot_csc){0};
  p->value = NULL;
}

/* The rows and columns of component c out of the whole matrix. */
static corot_status copy_matrix(const corot_csc *all, const double *value, int c,
                                const int *component, const int *rank, part *p) {
  corot_csc *own = &p->csc;
  *own = (corot_csc){.n = p->n, .node = p->node};
  own->colptr = malloc((p->n + 1) * sizeof *own->colptr);
  own->diagonal = malloc(p->n * sizeof *own->diagonal);
  own->row = malloc(all->nnz * sizeof *own->row);
  p->value = malloc(all->nnz * sizeof *p->value);
  if (!own->colptr || !own->diagonal || !own->row || !p->value)
    return corot_fail(COROT_ENOMEM, "no memory for a mass of %d columns", p->n);
  for (int j = 0; j < p->n; j++) {
    own->colptr[j] = own->nnz;
    for (int k = all->colptr[p->dof[j]]; k < all->colptr[p->dof[j] + 1]; k++) {
      int i = all->row[k];
      if (component[i] != c) continue;
      if (rank[i] == j) own->diagonal[j] = own->nnz;
      own->row[own->nnz] = rank[i];
      p->value[own->nnz++] = value[k];
    }
  }
  own->colptr[p->n] = own->nnz;
  return COROT_OK;
}

static corot_status make_matrix(const corot_model *model, corot_triangle triangle, int c,
                                const int *component, const int *rank, part *p) {
  corot_csc *all = NULL;
  COROT_TRY(corot_csc_create(model, triangle, &all));
  double *value = malloc(all->nnz * sizeof *value);
  corot_status status = COROT_OK;
  if (!value) status = corot_fail(COROT_ENOMEM, "no memory for %d entries", all->nnz);
  if (!status) {
    corot_csc_combine(model, all, 1, 0, NULL, 0, NULL, value);
    status = copy_matrix(all, value, c, component, rank, p);
  }
  free(value);
  corot_csc_destroy(all);
  return status;
}

static bool same_nodes(const part *a, const part *b) {
  return a->n == b->n && memcmp(a->node, b->node, a->n * sizeof *a->node) == 0;
}

static corot_status factor(corot_mass_solver *s, const corot_model *model, int c,
                           const int *component, const int *rank) {
  part *p = &s->part[c];
  corot_linear_def how = corot_linear_defaults();
  linsol_plan plan = {0};
  bool fresh;
  how.solver = corot_linsol_direct; /* so that M^-1 is right to rounding */
  COROT_TRY(make_matrix(model, COROT_LOWER, c, component, rank, p));
  corot_status status = corot_linsol_choose(&how, &p->csc, &plan);
  if (!status) s->ops = plan.ops;
  if (!status && plan.ops->triangle == COROT_FULL) {
    clear_matrix(p);
    status = make_matrix(model, COROT_FULL, c, component, rank, p);
  }
  if (!status) status = plan.ops->create(&p->csc, &plan, &p->solver);
  corot_linsol_plan_clear(&plan);
  return status ? status : s->ops->factor(p->solver, p->value, &fresh);
}

static corot_status make_parts(corot_mass_solver *s, const corot_model *model, int *component,
                               int *rank) {
  for (int c = 0; c < 3; c++) COROT_TRY(list_dofs(model, c, component, rank, &s->part[c]));
  for (int c = 0; c < 3; c++) {
    part *p = &s->part[c];
    while (!same_nodes(p, &s->part[p->like])) p->like++;
    if (p->n > 0 && p->like == c) COROT_TRY(factor(s, model, c, component, rank));
  }
  return COROT_OK;
}

static corot_status factor_consistent(corot_mass_solver *s, const corot_model *model) {
  s->work = malloc(s->n * sizeof *s->work);
  int *component = malloc(s->n * sizeof *component), *rank = malloc(s->n * sizeof *rank);
  corot_status status;
  if (!s->work || !component || !rank)
    status = corot_fail(COROT_ENOMEM, "no memory for a mass of %d columns", s->n);
  else
    status = make_parts(s, model, component, rank);
  free(component), free(rank);
  return status;
}

corot_status corot_mass_solver_create(const corot_model *model, corot_mass_solver **solver) {
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(solver));
  corot_mass_solver *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "no memory for a mass");
  s->n = corot_model_ndof(model);
  s->lumped = corot_model_mass(model);
  corot_status status = COROT_OK;
  if (corot_model_mass_kind(model) == COROT_MASS_CONSISTENT) status = factor_consistent(s, model);
  if (status) {
    corot_mass_solver_destroy(s);
    return status;
  }
  *solver = s;
  return COROT_OK;
}

void corot_mass_solver_destroy(corot_mass_solver *s) {
  if (!s) return;
  for (int c = 0; c < 3; c++) {
    part *p = &s->part[c];
    if (p->solver) s->ops->destroy(p->solver);
    clear_matrix(p);
    free(p->dof), free(p->node);
  }
  free(s->work);
  free(s);
}

corot_status corot_mass_solve(corot_mass_solver *s, const double *b, double *x) {
  COROT_TRY(COROT_GIVEN_AS(s, "solver"));
  if (!s->ops) {
    for (int i = 0; i < s->n; i++) x[i] = b[i] / s->lumped[i];
    return COROT_OK;
  }
  for (int c = 0; c < 3; c++) {
    const part *p = &s->part[c];
    if (p->n == 0) continue;
    for (int i = 0; i < p->n; i++) s->work[i] = b[p->dof[i]];
    COROT_TRY(s->ops->solve(s->part[p->like].solver, s->work));
    for (int i = 0; i < p->n; i++) x[p->dof[i]] = s->work[i];
  }
  return COROT_OK;
}
