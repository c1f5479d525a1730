/* Bisection of tets across their longest edges, in rounds: every tet that waits is cut, and who has
   then a node on an edge that it does not know waits for the next round.

   A cut edge is longer than all that are made by cutting it and the tets around it: its halves, and
   the medians from corners opposite, m^2 = (2 a^2 + 2 b^2 - c^2) / 4 <= 3/4 c^2 for a, b <= c. So
   cuts spread to longer edges only, of which there are finitely many, and the rounds end. For the
   same reason a face is always cut across its own longest edge, from whichever side. */
#include "bisection.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum {
  DEPTH = 3,          /* of the parts of a marked tet: it halves all lengths of well-shaped tets */
  MOST = INT_MAX / 12 /* tets, edges, nodes, cut ones included; six places a tet fit an int */
};

/* --- Room --- */

/* A copy of the array with room for n items, more than `room` at first; NULL: there is no memory.
 */
static void *enlarge(void *array, int n, int *room, size_t size) {
  int more = n > *room / 2 * 3 ? n : *room / 2 * 3;
  void *larger = realloc(array, (size_t)more * size);
  if (larger) *room = more;
  return larger;
}

static corot_status no_room(int n, size_t size) {
  return corot_fail(COROT_ENOMEM, "out of memory: %d times %zu bytes", n, size);
}

static corot_status check_size(int n) {
  if (n <= MOST) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "the refined mesh is too large: at most %d tets, cut ones included", MOST);
}

corot_status corot_int_list_push(int_list *list, int i) {
  if (list->n == list->room) {
    int *at = enlarge(list->at, list->n + 64, &list->room, sizeof *at);
    if (!at) return no_room(list->n + 64, sizeof *at);
    list->at = at;
  }
  list->at[list->n++] = i;
  return COROT_OK;
}

static corot_status make_node(bisection *b, const double x[3], int *node) {
  COROT_TRY(check_size(b->nnode + 1));
  if (b->nnode == b->node_room) {
    double(*more)[3] = enlarge(b->x, b->nnode + 64, &b->node_room, sizeof *more);
    if (!more) return no_room(b->nnode + 64, sizeof *more);
    b->x = more;
  }
  memcpy(b->x[b->nnode], x, sizeof *b->x);
  *node = b->nnode++;
  return COROT_OK;
}

static corot_status make_edge_room(bisection *b) {
  COROT_TRY(check_size(b->nedge + 1));
  if (b->nedge < b->edge_room) return COROT_OK;
  int n = b->nedge + 64, room = b->edge_room;
  if (b->s) {
    double(*s)[3] = enlarge(b->s, n, &room, sizeof *s);
    if (!s) return no_room(n, sizeof *s);
    b->s = s;
  }
  cut_edge *edge = enlarge(b->edge, n, &b->edge_room, sizeof *edge);
  if (!edge) return no_room(n, sizeof *edge);
  b->edge = edge;
  return COROT_OK;
}

static corot_status make_tet_room(bisection *b) {
  COROT_TRY(check_size(b->ntet + 2));
  if (b->ntet + 2 <= b->tet_room) return COROT_OK;
  cut_tet *tet = enlarge(b->tet, b->ntet + 64, &b->tet_room, sizeof *tet);
  if (!tet) return no_room(b->ntet + 64, sizeof *tet);
  b->tet = tet;
  return COROT_OK;
}

/* --- Edges --- */

/* To 30 bits, so that lengths which only rounding tells apart are mostly equal. */
static double rounded(double x) {
  int exponent;
  double fraction = frexp(x, &exponent);
  return ldexp(rint(ldexp(fraction, 30)), exponent - 30);
}

/* Its fields, once there is room. */
static void set_edge(bisection *b, int i, int p, int q, int middle) {
  double length2 = 0;
  for (int c = 0; c < 3; c++) length2 += (b->x[p][c] - b->x[q][c]) * (b->x[p][c] - b->x[q][c]);
  b->edge[i] = (cut_edge){.end = {p < q ? p : q, p < q ? q : p},
                          .middle = middle,
                          .half = -1,
                          .median = -1,
                          .next = -1,
                          .place = -1,
                          .length2 = rounded(length2)};
}

static corot_status make_edge(bisection *b, int p, int q, const double s[3], int *edge) {
  COROT_TRY(make_edge_room(b));
  set_edge(b, b->nedge, p, q, -1);
  if (b->s) memcpy(b->s[b->nedge], s, sizeof *b->s);
  *edge = b->nedge++;
  return COROT_OK;
}

bool corot_bisection_longer(const bisection *b, int e, int f) {
  const cut_edge *p = &b->edge[e], *q = &b->edge[f];
  if (p->length2 != q->length2) return p->length2 > q->length2;
  if (p->end[1] != q->end[1]) return p->end[1] < q->end[1];
  return p->end[0] < q->end[0];
}

int corot_bisection_half(const bisection *b, int e, int end) {
  return b->edge[e].half + (b->edge[e].end[0] != end);
}

int corot_bisection_median(const bisection *b, int e, int corner) {
  int i = b->edge[e].median;
  while (i >= 0 && b->edge[i].end[0] != corner && b->edge[i].end[1] != corner) i = b->edge[i].next;
  return i;
}

/* By their ends; none is twice. */
static int compare_edges(const void *a, const void *b) {
  const cut_edge *p = *(cut_edge *const *)a, *q = *(cut_edge *const *)b;
  for (int i = 0; i < 2; i++)
    if (p->end[i] != q->end[i]) return p->end[i] < q->end[i] ? -1 : 1;
  return 0;
}

/* Puts nodes on edges, in ascending order of their ends. */
static corot_status make_middles(bisection *b, int n, const int *edge) {
  const cut_edge **sorted;
  corot_status status = COROT_ALLOC(sorted, n);
  for (int i = 0; !status && i < n; i++) sorted[i] = &b->edge[edge[i]];
  if (!status) qsort(sorted, (size_t)n, sizeof *sorted, compare_edges);
  for (int i = 0; !status && i < n; i++) {
    int e = (int)(sorted[i] - b->edge);
    const double *p = b->x[b->edge[e].end[0]], *q = b->x[b->edge[e].end[1]];
    double x[3];
    for (int c = 0; c < 3; c++) x[c] = (p[c] + q[c]) / 2 + (b->s ? b->s[e][c] : 0);
    status = make_node(b, x, &b->edge[e].middle);
  }
  free(sorted);
  return status;
}

/* The deviations are those of the shape functions of ten-node tets: a quadratic function deviates
   on a half by a quarter of what it does on the whole. */
static corot_status halve(bisection *b, int e) {
  double s[3] = {0};
  int half[2];
  for (int c = 0; b->s && c < 3; c++) s[c] = b->s[e][c] / 4;
  for (int i = 0; i < 2; i++)
    COROT_TRY(make_edge(b, b->edge[e].end[i], b->edge[e].middle, s, &half[i]));
  b->edge[e].half = half[0];
  return COROT_OK;
}

/* The median of e to `corner`, made if there is none; `side`: the other two edges of its triangle.
   With the volume coordinates 1/2 at the corner and 1/4 at the ends of e, the node on it is at
   (s_1 + s_2) / 2 + s_e / 4 from where the corners would have it, and its ends' middle at s_e / 2.
 */
static corot_status find_median(bisection *b, int e, int corner, const int side[2], int *median) {
  double s[3] = {0};
  *median = corot_bisection_median(b, e, corner);
  if (*median >= 0) return COROT_OK;
  for (int c = 0; b->s && c < 3; c++)
    s[c] = (b->s[side[0]][c] + b->s[side[1]][c]) / 2 - b->s[e][c] / 4;
  COROT_TRY(make_edge(b, corner, b->edge[e].middle, s, median));
  b->edge[*median].next = b->edge[e].median;
  b->edge[e].median = *median;
  return COROT_OK;
}

/* --- Tets --- */

static const int end_of[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
static const int edge_at[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};

static int longest(const bisection *b, const cut_tet *tet) {
  int k = 0;
  for (int i = 1; i < 6; i++)
    if (corot_bisection_longer(b, tet->edge[i], tet->edge[k])) k = i;
  return k;
}

/* Enters a tet at its edges. */
static void enter(bisection *b, int t) {
  cut_tet *tet = &b->tet[t];
  for (int k = 0; k < 6; k++) {
    cut_edge *edge = &b->edge[tet->edge[k]];
    tet->next[k] = edge->place;
    edge->place = 6 * t + k;
  }
}

static corot_status wait(bisection *b, int t, int_list *list) {
  if (b->tet[t].waits) return COROT_OK;
  b->tet[t].waits = true;
  return corot_int_list_push(list, t);
}

/* Whether a new tet has to be cut. */
static bool is_wanted(const bisection *b, const cut_tet *tet) {
  bool cut = b->marked[tet->root] && tet->depth < DEPTH;
  for (int k = 0; k < 6; k++) cut |= b->edge[tet->edge[k]].half >= 0;
  return cut;
}

/* Makes the child of a tet that keeps corner i of its edge ij, across which it is cut: j becomes
   the middle, so that it winds as before. */
static corot_status make_child(bisection *b, int t, int i, int j, const int median[4],
                               int_list *next) {
  cut_tet child = b->tet[t];
  int e = child.edge[edge_at[i][j]];
  child.v[j] = b->edge[e].middle;
  child.edge[edge_at[i][j]] = corot_bisection_half(b, e, child.v[i]);
  for (int k = 0; k < 4; k++)
    if (k != i && k != j) child.edge[edge_at[j][k]] = median[k];
  child.child = -1;
  child.depth++;
  child.waits = false;
  b->tet[b->ntet] = child;
  enter(b, b->ntet++);
  return is_wanted(b, &child) ? wait(b, b->ntet - 1, next) : COROT_OK;
}

/* Cuts a tet across its longest edge, which has been cut. */
static corot_status cut_tet_in_two(bisection *b, int t, int_list *next) {
  const int *at = end_of[longest(b, &b->tet[t])];
  int i = at[0], j = at[1], median[4];
  COROT_TRY(make_tet_room(b));
  const cut_tet *tet = &b->tet[t];
  for (int k = 0; k < 4; k++) {
    if (k == i || k == j) continue;
    const int side[2] = {tet->edge[edge_at[i][k]], tet->edge[edge_at[j][k]]};
    COROT_TRY(find_median(b, tet->edge[edge_at[i][j]], tet->v[k], side, &median[k]));
  }
  b->tet[t].child = b->ntet;
  COROT_TRY(make_child(b, t, i, j, median, next));
  return make_child(b, t, j, i, median, next);
}

/* --- Rounds --- */

/* The longest edges of the tets that wait, as far as they are not cut, each once. */
static corot_status list_cuts(bisection *b, int_list *cuts) {
  for (int i = 0; i < b->wait.n; i++) {
    const cut_tet *tet = &b->tet[b->wait.at[i]];
    cut_edge *edge = &b->edge[tet->edge[longest(b, tet)]];
    if (edge->half != -1) continue;
    edge->half = -2;
    COROT_TRY(corot_int_list_push(cuts, (int)(edge - b->edge)));
  }
  return COROT_OK;
}

/* Cuts an edge; the tets around it that do not wait yet do so for the next round. */
static corot_status cut_edge_in_two(bisection *b, int e, int_list *next) {
  COROT_TRY(halve(b, e));
  for (int at = b->edge[e].place; at >= 0; at = b->tet[at / 6].next[at % 6])
    if (b->tet[at / 6].child < 0) COROT_TRY(wait(b, at / 6, next));
  return COROT_OK;
}

/* Order 2: every edge since the first of this round gets its node. */
static corot_status make_new_middles(bisection *b, int first) {
  int n = b->nedge - first, *edge;
  COROT_TRY(COROT_ALLOC(edge, n));
  for (int i = 0; i < n; i++) edge[i] = first + i;
  corot_status status = make_middles(b, n, edge);
  free(edge);
  return status;
}

static corot_status cut_waiting(bisection *b, int_list *cuts, int_list *next) {
  int first = b->nedge;
  COROT_TRY(list_cuts(b, cuts));
  if (!b->s) COROT_TRY(make_middles(b, cuts->n, cuts->at));
  for (int i = 0; i < cuts->n; i++) COROT_TRY(cut_edge_in_two(b, cuts->at[i], next));
  for (int i = 0; i < b->wait.n; i++) COROT_TRY(cut_tet_in_two(b, b->wait.at[i], next));
  return b->s ? make_new_middles(b, first) : COROT_OK;
}

static corot_status run_round(bisection *b) {
  int_list cuts = {0}, next = {0};
  corot_status status = cut_waiting(b, &cuts, &next);
  free(cuts.at);
  free(b->wait.at);
  b->wait = next;
  return status;
}

corot_status corot_bisection_run(bisection *b) {
  while (b->wait.n > 0) COROT_TRY(run_round(b));
  return COROT_OK;
}

/* --- Beginning and end --- */

static corot_status take_edges(bisection *b, const corot_edges *edges) {
  COROT_TRY(check_size(edges->n));
  COROT_TRY(COROT_ALLOC(b->edge, edges->n));
  if (edges->middle) COROT_TRY(COROT_ALLOC(b->s, edges->n));
  b->nedge = b->edge_room = edges->n;
  for (int i = 0; i < edges->n; i++) {
    int p = edges->end[i][0], q = edges->end[i][1], m = edges->middle ? edges->middle[i] : -1;
    set_edge(b, i, p, q, m);
    for (int c = 0; b->s && c < 3; c++) b->s[i][c] = b->x[m][c] - (b->x[p][c] + b->x[q][c]) / 2;
  }
  return COROT_OK;
}

static corot_status take_tets(bisection *b, const corot_edges *edges) {
  COROT_TRY(check_size(b->mesh->ntet));
  COROT_TRY(COROT_ALLOC(b->tet, b->mesh->ntet));
  b->ntet = b->tet_room = b->mesh->ntet;
  for (int t = 0; t < b->ntet; t++) {
    b->tet[t] = (cut_tet){.root = t, .child = -1};
    memcpy(b->tet[t].v, b->mesh->tet[t], sizeof b->tet[t].v);
    memcpy(b->tet[t].edge, edges->tet[t], sizeof b->tet[t].edge);
    enter(b, t);
  }
  return COROT_OK;
}

corot_status corot_bisection_begin(const corot_mesh *mesh, const corot_edges *edges, int nmark,
                                   const int *mark, bisection *b) {
  b->mesh = mesh;
  COROT_TRY(COROT_ALLOC(b->x, mesh->nnode));
  COROT_TRY(COROT_ALLOC(b->marked, mesh->ntet));
  b->nnode = b->node_room = mesh->nnode;
  memcpy(b->x, mesh->x, (size_t)mesh->nnode * sizeof *b->x);
  COROT_TRY(take_edges(b, edges));
  COROT_TRY(take_tets(b, edges));
  for (int i = 0; i < nmark; i++) {
    b->marked[mark[i]] = 1;
    COROT_TRY(wait(b, mark[i], &b->wait));
  }
  return COROT_OK;
}

void corot_bisection_clear(bisection *b) {
  free(b->x);
  free(b->edge);
  free(b->s);
  free(b->tet);
  free(b->marked);
  free(b->wait.at);
  memset(b, 0, sizeof *b);
}
