/* The mass, lumped or consistent, and the mass damping, which is the same matrix with density times
   damping in place of density.

   The shares of an element's nodes and pairs of nodes are those of its kind: of a tet of mass m,
   with linear shape functions, m/10 on the diagonal and m/20 beside it, the same in each component;
   a row sums to m/4, and that is what lumping puts on the diagonal. Of ten-node tets the row sums
   of corners are negative: these are lumped in proportion to the diagonal.

   A consistent mass hands the acceleration of a moving support on to its neighbours (drag.c), and
   would hand on a sudden start as an impulse. So the elements with a node on a support whose
   velocity jumps are lumped: then nothing couples a free node to one of its nodes, and the rows of
   the free nodes still sum to what a uniform acceleration of the whole body takes. */
#include <stdlib.h>

#include "model.h"

void corot_mass_lump(const corot_model *m, double (*nodal)[3]) {
  const element_set *t = &solid_of(m)->elements;
  for (int b = 0; b < t->nblock; b++) {
    const material *mat = &m->material[t->block[b].material];
    for (int l = 0; l < t->block[b].n; l++) {
      double part[KIND_NODES];
      corot_element_lumped(m->mesh, t, b, l, mat->density, part);
      for (int a = 0; a < t->kind->nnode; a++) {
        int n = nodes_at(t, b, a)[l];
        nodal[n][0] += part[a];
        nodal[n][1] += part[a] * mat->damping_mass;
      }
    }
  }
}

/* Of the held nodes too. */
static corot_status lump(const corot_model_def *def, corot_model *m) {
  int nnode = m->mesh->nnode;
  double(*nodal)[3] = calloc(nnode, sizeof *nodal); /* mass, its damping, nothing */
  m->mass = malloc(m->ndof * sizeof *m->mass);
  m->inverse_mass = malloc(m->ndof * sizeof *m->inverse_mass);
  m->node_mass = malloc(nnode * sizeof *m->node_mass);
  if (m->mass_damped) m->mass_damping = malloc(m->ndof * sizeof *m->mass_damping);
  if (!nodal || !m->mass || !m->inverse_mass || !m->node_mass ||
      (m->mass_damped && !m->mass_damping)) {
    free(nodal);
    return corot_fail(COROT_ENOMEM, "no memory for the mass of %d nodes", nnode);
  }
  corot_mass_lump(m, nodal);
  corot_status status = corot_model_restrict(def, nnode, nodal);
  for (int n = 0; n < nnode; n++) {
    memcpy(m->node_mass[n], nodal[n], sizeof m->node_mass[n]);
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      if (i < 0) continue;
      m->mass[i] = nodal[n][0];
      m->inverse_mass[i] = 1 / nodal[n][0];
      if (m->mass_damped) m->mass_damping[i] = nodal[n][1];
    }
  }
  free(nodal);
  return status;
}

/* [nnode] whether the velocity of the node jumps; NULL: no memory. */
static bool *mark_jolted(const corot_model *m) {
  bool *jolted = calloc(m->mesh->nnode, sizeof *jolted);
  for (int k = 0; jolted && k < m->nmotion; k++)
    for (int i = 0; i < m->motion[k].nnode; i++)
      jolted[m->motion[k].node[i]] = corot_motion_jolts(&m->motion[k]);
  return jolted;
}

/* Whether the element in lane l of block b has a node whose velocity jumps. */
static bool lumped_at(const element_set *t, int b, int l, const bool *jolted) {
  for (int a = 0; a < t->kind->nnode; a++)
    if (jolted[nodes_at(t, b, a)[l]]) return true;
  return false;
}

/* The mass between the nodes of an element, lumped beside nodes whose velocity jumps. */
static void share_mass(const corot_model *m, int b, int l, const bool *jolted,
                       double mass[KIND_NODES][KIND_NODES]) {
  const element_set *t = &solid_of(m)->elements;
  double density = m->material[t->block[b].material].density, part[KIND_NODES];
  if (!lumped_at(t, b, l, jolted)) {
    corot_element_mass(m->mesh, t, b, l, density, mass);
    return;
  }
  corot_element_lumped(m->mesh, t, b, l, density, part);
  memset(mass, 0, KIND_NODES * sizeof *mass);
  for (int i = 0; i < t->kind->nnode; i++) mass[i][i] = part[i];
}

/* The pairs of a consistent mass, lumped beside nodes whose velocity jumps. */
static corot_status couple(corot_model *m, const bool *jolted) {
  const pattern *p = &solid_of(m)->pattern;
  m->mass_pair = calloc(p->nblock, sizeof *m->mass_pair);
  if (m->mass_damped) m->damping_pair = calloc(p->nblock, sizeof *m->damping_pair);
  if (!m->mass_pair || (m->mass_damped && !m->damping_pair))
    return corot_fail(COROT_ENOMEM, "no memory for the mass of %d pairs of nodes", p->nblock);
  const element_set *t = &solid_of(m)->elements;
  int npair = t->kind->npair;
  for (int b = 0; b < t->nblock; b++) {
    const material *mat = &m->material[t->block[b].material];
    for (int l = 0; l < t->block[b].n; l++) {
      double mass[KIND_NODES][KIND_NODES];
      share_mass(m, b, l, jolted, mass);
      for (int k = 0; k < npair + t->kind->nnode; k++) {
        int i = k < npair ? t->kind->pair[k][0] : k - npair;
        int j = k < npair ? t->kind->pair[k][1] : i;
        int at = k < npair ? p->place[b * npair + k][l] : p->colptr[nodes_at(t, b, i)[l]];
        m->mass_pair[at] += mass[i][j];
        if (m->mass_damped) m->damping_pair[at] += mass[i][j] * mat->damping_mass;
      }
    }
  }
  return COROT_OK;
}

corot_status corot_mass_create(const corot_model_def *def, corot_model *m) {
  bool one_way = m->system.term[0].from > 0;
  bool automatic = def->mass == COROT_MASS_AUTO && m->mesh->mid && !one_way;
  COROT_TRY(lump(def, m));
  if (!automatic && def->mass != COROT_MASS_CONSISTENT) return COROT_OK;
  bool *jolted = mark_jolted(m);
  if (!jolted) return corot_fail(COROT_ENOMEM, "no memory for %d nodes", m->mesh->nnode);
  corot_status status = couple(m, jolted);
  free(jolted);
  return status;
}

static void add_row_sums(const corot_model *m, const bool *jolted, double (*nodal)[3]) {
  const element_set *t = &solid_of(m)->elements;
  for (int b = 0; b < t->nblock; b++)
    for (int l = 0; l < t->block[b].n; l++) {
      double mass[KIND_NODES][KIND_NODES];
      share_mass(m, b, l, jolted, mass);
      for (int i = 0; i < t->kind->nnode; i++)
        for (int j = 0; j < t->kind->nnode; j++) nodal[nodes_at(t, b, i)[l]][0] += mass[i][j];
    }
}

corot_status corot_mass_sum_rows(const corot_model *m, double (*nodal)[3]) {
  if (!m->mass_pair || solid_of(m)->elements.kind->order == 1) {
    corot_mass_lump(m, nodal);
    return COROT_OK;
  }
  bool *jolted = mark_jolted(m);
  if (!jolted) return corot_fail(COROT_ENOMEM, "no memory for %d nodes", m->mesh->nnode);
  add_row_sums(m, jolted, nodal);
  free(jolted);
  return COROT_OK;
}

corot_mass corot_model_mass_kind(const corot_model *m) {
  return m->mass_pair ? COROT_MASS_CONSISTENT : COROT_MASS_LUMPED;
}

/* y += factor A x for A lumped or, unless `pair` is NULL, consistent. */
static void add_product(const corot_model *m, double factor, const double *lumped,
                        const double *pair, const double *x, double *y) {
  if (!pair) {
    for (int i = 0; i < m->ndof; i++) y[i] += factor * lumped[i] * x[i];
    return;
  }
  const pattern *p = &solid_of(m)->pattern;
  for (int b = 0; b < p->nnode; b++)
    for (int k = p->colptr[b]; k < p->colptr[b + 1]; k++) {
      double value = factor * pair[k];
      int a = p->row[k];
      for (int c = 0; c < 3; c++) {
        int i = m->dof[a][c], j = m->dof[b][c];
        if (i < 0 || j < 0) continue;
        y[i] += value * x[j];
        if (i != j) y[j] += value * x[i];
      }
    }
}

void corot_mass_multiply(const corot_model *m, const double *x, double *y) {
  for (int i = 0; i < m->ndof; i++) y[i] = 0;
  add_product(m, 1, m->mass, m->mass_pair, x, y);
}

void corot_mass_nodal(const corot_model *m, bool damping, const double (*x)[4], double (*y)[3]) {
  const pattern *p = &solid_of(m)->pattern;
  const double *pair = damping ? m->damping_pair : m->mass_pair;
  if (damping && !m->mass_damped) return;
  for (int b = 0; b < m->mesh->nnode; b++) {
    for (int c = 0; !pair && c < 3; c++) y[b][c] += m->node_mass[b][damping] * x[b][c];
    for (int k = p->colptr[b]; pair && k < p->colptr[b + 1]; k++) {
      int a = p->row[k];
      for (int c = 0; c < 3; c++) {
        y[a][c] += pair[k] * x[b][c];
        if (a != b) y[b][c] += pair[k] * x[a][c];
      }
    }
  }
}

void corot_mass_damp(const corot_model *m, const double *v, double *f) {
  if (m->mass_damped) add_product(m, -1, m->mass_damping, m->damping_pair, v, f);
}

void corot_mass_damping_matrix(const corot_model *m, double (*D)[9]) {
  const pattern *p = &solid_of(m)->pattern;
  if (!m->mass_damped) return;
  if (m->damping_pair) {
    for (int k = 0; k < p->nblock; k++)
      for (int c = 0; c < 3; c++) D[k][4 * c] += m->damping_pair[k];
    return;
  }
  for (int n = 0; n < p->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (m->dof[n][c] >= 0) D[p->colptr[n]][4 * c] += m->mass_damping[m->dof[n][c]];
}
