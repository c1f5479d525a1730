/* The rigid motions of a part are six numbers (a, w): x moves by a + w x (x - c). Supports hold a
   component of a node, one linear equation each; G is the 6x6 sum of their squares, and a motion is
   free if it is in the null space of G. */
#include "rigid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Below this fraction of the largest, an eigenvalue of G is zero: supports that miss a motion by
   less than 1e-5 of the part's size do not hold it. */
static const double ZERO = 1e-10;

/* The nodes part by part. */
typedef struct partition {
  int npart;
  int *begin; /* [nnode + 1] of which the first npart + 1 say where each part's nodes stand in */
  int *node;  /* [nnode] ascending within a part, so that the first names it */
  int *root;  /* [nnode] the smallest node of each node's part */
} partition;

static void partition_free(partition *p) {
  free(p->begin);
  free(p->node);
  free(p->root);
}

static void join(int *root, int i, int j) {
  while (root[i] != i) i = root[i] = root[root[i]];
  while (root[j] != j) j = root[j] = root[root[j]];
  root[i > j ? i : j] = i > j ? j : i;
}

/* root [nnode]: the smallest node of each node's part. */
static void find_roots(const corot_mesh *mesh, int *root) {
  for (int n = 0; n < mesh->nnode; n++) root[n] = n;
  for (int e = 0; e < mesh->ntet; e++) {
    for (int a = 1; a < 4; a++) join(root, mesh->tet[e][0], mesh->tet[e][a]);
    for (int k = 0; mesh->mid && k < 6; k++) join(root, mesh->tet[e][0], mesh->mid[e][k]);
  }
  for (int n = 0; n < mesh->nnode; n++) root[n] = root[root[n]];
}

/* Counts the nodes of each root, gives the roots their places in ascending order, and fills them.
 */
static corot_status partition_create(const corot_mesh *mesh, partition *out) {
  size_t nnode = (size_t)mesh->nnode;
  partition p = {.begin = calloc(nnode + 1, sizeof *p.begin),
                 .node = malloc(nnode * sizeof *p.node),
                 .root = malloc(nnode * sizeof *p.root)};
  int *place = calloc(nnode, sizeof *place);
  if (!p.begin || !p.node || !p.root || !place) {
    partition_free(&p);
    free(place);
    return corot_fail(COROT_ENOMEM, "no memory for %zu nodes", nnode);
  }
  /* so many nodes has each root, and begins where the one before ends */
  find_roots(mesh, p.root);
  for (int n = 0; n < mesh->nnode; n++) place[p.root[n]]++;
  for (int n = 0, next = 0; n < mesh->nnode; n++) {
    if (p.root[n] != n) continue;
    int count = place[n];
    p.begin[p.npart++] = place[n] = next;
    p.begin[p.npart] = next += count;
  }
  /* every node goes to the next free place of its root */
  for (int n = 0; n < mesh->nnode; n++) p.node[place[p.root[n]]++] = n;
  free(place);
  *out = p;
  return COROT_OK;
}

void corot_diagonalise(double G[6][6], double V[6][6]) {
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) V[i][j] = i == j;
  for (int sweep = 0; sweep < 20; sweep++)
    for (int p = 0; p < 5; p++)
      for (int q = p + 1; q < 6; q++) {
        double angle = 0.5 * atan2(2 * G[p][q], G[q][q] - G[p][p]), c = cos(angle), s = sin(angle);
        for (int k = 0; k < 6; k++) {
          double a = G[p][k], b = G[q][k], v = V[k][p], w = V[k][q];
          G[p][k] = c * a - s * b, G[q][k] = s * a + c * b;
          V[k][p] = c * v - s * w, V[k][q] = s * v + c * w;
        }
        for (int k = 0; k < 6; k++) {
          double a = G[k][p], b = G[k][q];
          G[k][p] = c * a - s * b, G[k][q] = s * a + c * b;
        }
      }
}

typedef struct part_shape {
  int nnode;
  const int *node; /* [nnode] */
  double center[3], radius;
} part_shape;

static part_shape measure(const double (*x)[3], int nnode, const int *node) {
  part_shape p = {.nnode = nnode, .node = node};
  for (int k = 0; k < nnode; k++)
    for (int c = 0; c < 3; c++) p.center[c] += (x[node[k]][c] - p.center[c]) / (k + 1);
  for (int k = 0; k < nnode; k++) {
    const double *at = x[node[k]], *o = p.center;
    p.radius = fmax(p.radius, hypot(hypot(at[0] - o[0], at[1] - o[1]), at[2] - o[2]));
  }
  return p;
}

/* How component c of a node at x answers to the six motions, turns by 1/radius. */
static void component_row(const part_shape *p, const double x[3], int c, double row[6]) {
  int i = (c + 1) % 3, j = (c + 2) % 3;
  memset(row, 0, 6 * sizeof *row);
  row[c] = 1; /* (w x d)_c = w_i d_j - w_j d_i */
  row[3 + i] = (x[j] - p->center[j]) / p->radius;
  row[3 + j] = -(x[i] - p->center[i]) / p->radius;
}

/* motion [6][6], of which the first rows, as many as the value says, span the motions that nothing
   holds; x [nnode]: where the nodes are. */
static int free_motions(const corot_model *model, const double (*x)[3], const part_shape *p,
                        double motion[6][6]) {
  const int(*dof)[3] = corot_model_dof(model);
  double G[6][6] = {{0}}, V[6][6], row[6];
  for (int k = 0; k < p->nnode; k++)
    for (int c = 0; c < 3; c++) {
      if (dof[p->node[k]][c] >= 0) continue;
      component_row(p, x[p->node[k]], c, row);
      for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) G[i][j] += row[i] * row[j];
    }
  corot_diagonalise(G, V);
  double largest = 0;
  for (int k = 0; k < 6; k++) largest = fmax(largest, G[k][k]);
  int nfree = 0;
  for (int k = 0; k < 6; k++)
    if (!(G[k][k] > ZERO * largest)) {
      for (int i = 0; i < 6; i++) motion[nfree][i] = V[i][k];
      nfree++;
    }
  return nfree;
}

/* Whether the first (translations) or last three numbers of the motions reach `direction`; of
   translations, those with no turn in them: `motion` is orthonormal, so e is among them if its
   projection has length one. */
static double reach(int nfree, double motion[6][6], int first, int k) {
  double square = 0;
  for (int m = 0; m < nfree; m++) square += motion[m][first + k] * motion[m][first + k];
  return square;
}

/* The turns w of the free motions span a space of dimension 0 to 3; whether e_k is in it. */
static bool can_turn(int nfree, double motion[6][6], int k) {
  double basis[3][3];
  int rank = 0;
  for (int m = 0; m < nfree && rank < 3; m++) { /* Gram-Schmidt */
    double w[3] = {motion[m][3], motion[m][4], motion[m][5]};
    for (int r = 0; r < rank; r++) {
      double along = w[0] * basis[r][0] + w[1] * basis[r][1] + w[2] * basis[r][2];
      for (int c = 0; c < 3; c++) w[c] -= along * basis[r][c];
    }
    double length = hypot(hypot(w[0], w[1]), w[2]);
    if (length < 1e-6) continue;
    for (int c = 0; c < 3; c++) basis[rank][c] = w[c] / length;
    rank++;
  }
  double square = 0;
  for (int r = 0; r < rank; r++) square += basis[r][k] * basis[r][k];
  return square > 1 - 1e-6;
}

/* Appends to `text`, which has room. */
static void add(char *text, size_t size, const char *words) {
  size_t length = strlen(text);
  snprintf(text + length, size - length, "%s", words);
}

/* "move along x and y and turn about z" */
static void describe(int nfree, double motion[6][6], size_t size, char *text) {
  bool named[6];
  int count = 0;
  text[0] = 0;
  for (int k = 0; k < 6; k++) {
    named[k] = k < 3 ? reach(nfree, motion, 0, k) > 1 - 1e-6 : can_turn(nfree, motion, k - 3);
    count += named[k];
  }
  if (!count) { /* an axis that leans */
    const double *m = motion[0];
    bool turns = hypot(hypot(m[3], m[4]), m[5]) > 1e-6;
    const double *d = turns ? m + 3 : m;
    double length = hypot(hypot(d[0], d[1]), d[2]);
    snprintf(text, size, "%s (%.3g, %.3g, %.3g)", turns ? "turn about" : "move along",
             d[0] / length, d[1] / length, d[2] / length);
    return;
  }
  static const char *const axis[] = {"x", "y", "z"};
  static const char *const verb[] = {"move along ", "turn about "};
  for (int kind = 0; kind < 2; kind++) {
    int left = named[3 * kind] + named[3 * kind + 1] + named[3 * kind + 2];
    if (left && text[0]) add(text, size, " and ");
    if (left) add(text, size, verb[kind]);
    for (int k = 0; k < 3; k++) {
      if (!named[3 * kind + k]) continue;
      add(text, size, axis[k]);
      if (--left) add(text, size, left == 1 ? " and " : ", ");
    }
  }
}

static void find_free(const corot_model *model, const int *node, corot_part *part) {
  double motion[6][6];
  const double(*x)[3] = (const double(*)[3])corot_model_mesh(model)->x;
  part_shape p = measure(x, part->nnode, node);
  part->nfree = free_motions(model, x, &p, motion);
  if (part->nfree) describe(part->nfree, motion, sizeof part->can, part->can);
}

/* model NULL: without motions. */
static corot_status list_parts(const corot_mesh *mesh, const corot_model *model, int *npart,
                               corot_part **out) {
  partition p = {0};
  COROT_TRY(partition_create(mesh, &p));
  corot_part *part = calloc((size_t)p.npart, sizeof *part);
  for (int k = 0; part && k < p.npart; k++) {
    const int *node = p.node + p.begin[k];
    part[k].first = node[0];
    part[k].nnode = p.begin[k + 1] - p.begin[k];
    if (model) find_free(model, node, &part[k]);
  }
  int count = p.npart;
  partition_free(&p);
  if (!part) return corot_fail(COROT_ENOMEM, "no memory for %d parts of the body", count);
  *npart = count;
  *out = part;
  return COROT_OK;
}

corot_status corot_mesh_parts(const corot_mesh *mesh, int *npart, corot_part **part) {
  return list_parts(mesh, NULL, npart, part);
}

corot_status corot_model_parts(const corot_model *model, int *npart, corot_part **part) {
  return list_parts(corot_model_mesh(model), model, npart, part);
}

/* field [nfree][ndof] of the motions of one part; the rest of the body stays. */
static void fill_fields(const corot_model *model, const double (*x)[3], const part_shape *p,
                        int nfree, double motion[6][6], double *field) {
  const int(*dof)[3] = corot_model_dof(model);
  int n = corot_model_ndof(model);
  double row[6];
  for (int i = 0; i < p->nnode; i++)
    for (int c = 0; c < 3; c++) {
      int to = dof[p->node[i]][c];
      if (to < 0) continue;
      component_row(p, x[p->node[i]], c, row);
      for (int k = 0; k < nfree; k++)
        for (int j = 0; j < 6; j++) field[(size_t)k * n + to] += motion[k][j] * row[j];
    }
}

/* Adds those of each part to x [][n], or only counts them where that is NULL. */
static int move_parts(const corot_model *model, const partition *p, double *x) {
  size_t n = (size_t)corot_model_ndof(model);
  const double(*at)[3] = (const double(*)[3])corot_model_mesh(model)->x;
  int count = 0;
  for (int k = 0; k < p->npart; k++) {
    double motion[6][6];
    const int *node = p->node + p->begin[k];
    part_shape shape = measure(at, p->begin[k + 1] - p->begin[k], node);
    int nfree = free_motions(model, at, &shape, motion);
    if (x) fill_fields(model, at, &shape, nfree, motion, x + (size_t)count * n);
    count += nfree;
  }
  return count;
}

corot_status corot_rigid_motions(const corot_model *model, int *count, double **motion) {
  size_t n = (size_t)corot_model_ndof(model);
  partition p = {0};
  COROT_TRY(partition_create(corot_model_mesh(model), &p));
  int nfree = move_parts(model, &p, NULL);
  double *x = nfree ? calloc((size_t)nfree * n, sizeof *x) : NULL;
  if (x) move_parts(model, &p, x);
  partition_free(&p);
  if (nfree && !x) return corot_fail(COROT_ENOMEM, "no memory for %d rigid motions", nfree);
  *count = nfree;
  *motion = x;
  return COROT_OK;
}

corot_status corot_rigid_check(const corot_model *model) {
  int npart;
  corot_part *part;
  corot_status status = COROT_OK;
  COROT_TRY(corot_model_parts(model, &npart, &part));
  for (int k = 0; k < npart && !status; k++) {
    char who[64] = "the body";
    if (!part[k].nfree) continue;
    if (npart > 1)
      snprintf(who, sizeof who, "the part of the body with node %d (%d nodes)", part[k].first,
               part[k].nnode);
    status = corot_fail(COROT_ESINGULAR, "statics: %s can %s freely: no support hinders it", who,
                        part[k].can);
  }
  free(part);
  return status;
}

/* --- Motions as fields --- */

static void fill_parts(const corot_model *model, const double (*x)[3], const partition *p,
                       corot_rigid *r) {
  double motion[6][6];
  for (int k = 0; k < p->npart; k++) {
    const int *node = p->node + p->begin[k];
    part_shape shape = measure(x, p->begin[k + 1] - p->begin[k], node);
    r->nfree[k] = free_motions(model, x, &shape, motion);
    fill_fields(model, x, &shape, r->nfree[k], motion, r->field);
    for (int i = 0; i < shape.nnode; i++) r->part[node[i]] = k;
  }
}

corot_status corot_rigid_create(const corot_model *model, const double (*x)[3],
                                corot_rigid *rigid) {
  partition p = {0};
  size_t nnode = (size_t)corot_model_mesh(model)->nnode, n = (size_t)corot_model_ndof(model);
  *rigid = (corot_rigid){0};
  COROT_TRY(partition_create(corot_model_mesh(model), &p));
  rigid->npart = p.npart;
  rigid->nfree = calloc((size_t)p.npart, sizeof *rigid->nfree);
  rigid->part = calloc(nnode, sizeof *rigid->part);
  rigid->field = calloc(6 * n, sizeof *rigid->field);
  bool room = rigid->nfree && rigid->part && rigid->field;
  if (room) fill_parts(model, x, &p, rigid);
  partition_free(&p);
  return room ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for motions of %zu nodes", nnode);
}

void corot_rigid_clear(corot_rigid *rigid) {
  free(rigid->nfree);
  free(rigid->part);
  free(rigid->field);
  *rigid = (corot_rigid){0};
}
