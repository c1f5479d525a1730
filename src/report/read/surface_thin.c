/* Clusters of nodes: those in one cube of a grid whose normals point the same way, so that the two
   sides of a thin wall stay apart. The node that is farthest out stands for all of a cluster, which
   keeps corners and edges of the body. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "surface.h"

typedef struct thinning {
  const surface *s;
  const double (*x)[3];           /* of the mesh */
  double low[3], size, middle[3]; /* of the surface: corner, longest side, mean of the nodes */
  int *way;                       /* [s->nnode] 0 to 5: the axis that a node's normal is next to */
  struct member *member;          /* [s->nnode] */
  int *cluster;                   /* [s->nnode] */
  int ncluster, *chosen;          /* [ncluster] the node that stands for it */
} thinning;

typedef struct member {
  long long key; /* of the cube and the way */
  int node;
} member;

static void thinning_clear(thinning *t) {
  free(t->way), free(t->member), free(t->cluster), free(t->chosen);
}

static const double *place(const thinning *t, int i) { return t->x[t->s->node[i]]; }

static void find_extent(thinning *t) {
  double high[3];
  for (int c = 0; c < 3; c++) {
    t->low[c] = INFINITY, high[c] = -INFINITY;
    for (int i = 0; i < t->s->nnode; i++) {
      double x = place(t, i)[c];
      t->low[c] = fmin(t->low[c], x), high[c] = fmax(high[c], x);
      t->middle[c] += x / t->s->nnode;
    }
    t->size = fmax(t->size, high[c] - t->low[c]);
  }
}

/* normal [nnode]: sums over the triangles, weighted by their areas. */
static void find_ways(thinning *t, double (*normal)[3]) {
  for (int i = 0; i < t->s->ntri; i++) {
    const int *v = t->s->corner[i];
    const double *o = place(t, v[0]), *p = place(t, v[1]), *q = place(t, v[2]);
    for (int c = 0; c < 3; c++) {
      int d = (c + 1) % 3, e = (c + 2) % 3;
      double n = (p[d] - o[d]) * (q[e] - o[e]) - (p[e] - o[e]) * (q[d] - o[d]);
      for (int k = 0; k < 3; k++) normal[v[k]][c] += n;
    }
  }
  for (int i = 0; i < t->s->nnode; i++) {
    int axis = 0;
    for (int c = 1; c < 3; c++)
      if (fabs(normal[i][c]) > fabs(normal[i][axis])) axis = c;
    t->way[i] = 2 * axis + (normal[i][axis] > 0);
  }
}

static corot_status begin(thinning *t) {
  size_t n = (size_t)t->s->nnode + 1;
  double(*normal)[3] = calloc(n, sizeof *normal);
  t->way = calloc(n, sizeof *t->way);
  t->member = malloc(n * sizeof *t->member);
  t->cluster = malloc(n * sizeof *t->cluster);
  t->chosen = malloc(n * sizeof *t->chosen);
  bool complete = normal && t->way && t->member && t->cluster && t->chosen;
  if (complete) find_extent(t), find_ways(t, normal);
  free(normal);
  return complete ? COROT_OK
                  : corot_fail(COROT_ENOMEM, "the surface of %d nodes: out of memory", t->s->nnode);
}

static int by_key(const void *a, const void *b) {
  const member *p = a, *q = b;
  if (p->key != q->key) return p->key < q->key ? -1 : 1;
  return (p->node > q->node) - (p->node < q->node);
}

static double off(const thinning *t, int i) {
  double square = 0;
  for (int c = 0; c < 3; c++) {
    double d = place(t, i)[c] - t->middle[c];
    square += d * d;
  }
  return square;
}

/* With cubes that cut the longest side into n. */
static void cluster(thinning *t, int n) {
  int nnode = t->s->nnode;
  for (int i = 0; i < nnode; i++) {
    long long key = t->way[i];
    for (int c = 0; c < 3; c++) {
      double along = t->size > 0 ? n * (place(t, i)[c] - t->low[c]) / t->size : 0;
      key = key * n + (along < n ? (int)along : n - 1);
    }
    t->member[i] = (member){key, i};
  }
  qsort(t->member, (size_t)nnode, sizeof *t->member, by_key);
  t->ncluster = 0;
  for (int k = 0; k < nnode; k++) {
    int i = t->member[k].node;
    if (k == 0 || t->member[k].key != t->member[k - 1].key) t->chosen[t->ncluster++] = i;
    int *best = &t->chosen[t->ncluster - 1];
    t->cluster[i] = t->ncluster - 1;
    if (off(t, i) > off(t, *best)) *best = i;
  }
}

static bool stays(const thinning *t, int i) {
  const int *v = t->s->corner[i], *of = t->cluster;
  return of[v[0]] != of[v[1]] && of[v[1]] != of[v[2]] && of[v[2]] != of[v[0]];
}

static int count(const thinning *t) {
  int n = 0;
  for (int i = 0; i < t->s->ntri; i++) n += stays(t, i);
  return n;
}

/* place [nnode + 1]: the number of a chosen node among those that stay, which keep their order. */
static void number(const thinning *t, int *at) {
  memset(at, 0, (size_t)t->s->nnode * sizeof *at);
  for (int k = 0; k < t->ncluster; k++) at[t->chosen[k]] = 1;
  for (int i = 0, n = 0; i < t->s->nnode; i++) {
    int one = at[i];
    at[i] = n;
    n += one;
  }
}

/* In the arrays of s, which get shorter; stands [nnode of the mesh], at [s->nnode]. */
static void apply(const thinning *t, surface *s, int *stands, int *at) {
  int n = 0;
  number(t, at);
  for (int i = 0; i < s->nnode; i++) stands[s->node[i]] = at[t->chosen[t->cluster[i]]];
  for (int i = 0; i < s->ntri; i++) {
    if (!stays(t, i)) continue;
    for (int k = 0; k < 3; k++) s->corner[n][k] = at[t->chosen[t->cluster[s->corner[i][k]]]];
    s->tet[n++] = s->tet[i];
  }
  s->ntri = n;
  for (int i = 0, kept = 0; i < s->nnode; i++)
    if (t->chosen[t->cluster[i]] == i) s->node[kept++] = s->node[i];
  s->nnode = t->ncluster;
  free(s->middle);
  s->middle = NULL;
  s->stands = stands;
}

corot_status surface_thin(surface *s, const double (*x)[3], int nnode, int most) {
  if (s->ntri <= most) return COROT_OK;
  thinning t = {.s = s, .x = x};
  int *stands = malloc(((size_t)nnode + 1) * sizeof *stands);
  int *at = malloc(((size_t)s->nnode + 1) * sizeof *at);
  corot_status status = begin(&t);
  if (status == COROT_OK && !(stands && at))
    status = corot_fail(COROT_ENOMEM, "the surface of %d nodes: out of memory", s->nnode);
  if (status != COROT_OK) {
    free(stands);
  } else {
    /* of a closed surface, some two triangles a cluster */
    int n = 4 + (int)sqrt(most);
    for (cluster(&t, n); n > 4 && count(&t) > most; cluster(&t, n)) n = n * 9 / 10;
    for (int i = 0; i < nnode; i++) stands[i] = -1;
    apply(&t, s, stands, at);
  }
  free(at);
  thinning_clear(&t);
  return status;
}
