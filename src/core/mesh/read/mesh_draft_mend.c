/* What is mended in a draft: nodes that are none, or the same as others, and tets that are only
   written down wrongly. Each is remarked in the report. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "mesh_draft.h"

/* --- Remarks --- */

corot_status corot_draft_remark(corot_draft *d, corot_mended what, int count, const char *format,
                                ...) {
  char text[700];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  return corot_report_add(d->how->report, what, count, text);
}

void corot_draft_list_add(corot_draft_list *list, int64_t number) {
  enum { SHOWN = 8 };
  size_t used = strlen(list->text), room = sizeof list->text - used;
  if (list->n < SHOWN)
    snprintf(list->text + used, room, "%s%lld", list->n ? ", " : "", (long long)number);
  if (list->n++ == SHOWN) snprintf(list->text + used, room, ", ...");
}

/* --- Nodes --- */

static int renumbered(const int *to, int node) { return node < 0 ? node : to[node]; }

/* Node i becomes to[i] <= i, -1: none; of several that become one, the first keeps its place. */
static void renumber(corot_draft *d, const int *to) {
  int n = 0;
  for (int i = 0; i < d->nnode; i++) {
    if (to[i] != n) continue;
    memmove(d->x[n], d->x[i], sizeof *d->x);
    d->node[n++] = d->node[i];
  }
  d->nnode = n;
  for (size_t e = 0; e < d->nelement; e++) {
    corot_draft_element *p = &d->element[e];
    int corners = p->kind ? 4 : p->dim + 1;
    for (int k = 0; k < corners; k++) p->node[k] = renumbered(to, p->node[k]);
  }
  for (size_t i = 0; i < d->nquad; i++)
    for (int k = 0; k < 4; k++) d->quad[i].v[k] = to[d->quad[i].v[k]];
  for (size_t k = 0; k < d->nmiddle; k++) d->middle[k] = renumbered(to, d->middle[k]);
}

static void use(char *used, int node) {
  if (node >= 0) used[node] = 1;
}

corot_status corot_draft_drop_unused(corot_draft *d) {
  char *used = NULL;
  int *to = NULL, n = 0;
  corot_draft_list list = {0};
  if (!d->how || !d->how->mends) return COROT_OK;
  corot_status status = COROT_ALLOC(used, d->nnode);
  if (!status) status = COROT_ALLOC(to, d->nnode);
  if (!status) {
    for (size_t i = 0; i < d->nelement; i++) {
      const corot_draft_element *e = &d->element[i];
      if (e->dim != 3) continue;
      int more = e->kind ? corot_draft_ncorner(e) - 4 : e->middle ? NMIDDLE_MAX : 0;
      for (int k = 0; k < 4; k++) use(used, e->node[k]);
      for (int k = 0; k < more; k++) use(used, d->middle[e->middle - 1 + k]);
    }
    for (int i = 0; i < d->nnode; i++) {
      to[i] = used[i] ? n++ : -1;
      if (!used[i]) corot_draft_list_add(&list, d->node[i].tag);
    }
    if (list.n > 0) renumber(d, to);
  }
  free(used);
  free(to);
  if (status || list.n == 0) return status;
  return corot_draft_remark(d, COROT_MENDED_UNUSED, list.n,
                            "%d node%s of the mesh file %s in no tet and %s left out (%s in the "
                            "file); the others are numbered without %s",
                            list.n, list.n == 1 ? "" : "s", list.n == 1 ? "is" : "are",
                            list.n == 1 ? "is" : "are", list.text, list.n == 1 ? "it" : "them");
}

/* Cubes of space with the nodes in them that stay, in a table of chains. */
typedef struct grid {
  double size;
  const double (*x)[3];
  size_t mask;
  int *first; /* [mask + 1] of the chain, from 1; 0: it is empty */
  int *next;  /* [nnode] */
} grid;

static size_t chain_of(const grid *g, const double cell[3]) {
  uint64_t hash = 0;
  for (int k = 0; k < 3; k++) {
    uint64_t bits;
    double c = cell[k] + 0.0; /* -0 is 0 */
    memcpy(&bits, &c, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return (size_t)hash & g->mask;
}

/* The nearest of the nodes that stay within g->size of node i, the first in a tie; -1: none. */
static int find_near(const grid *g, int i) {
  double best = g->size;
  int found = -1;
  for (int k = 0; k < 27; k++) {
    const double cell[3] = {floor(g->x[i][0] / g->size) + k % 3 - 1,
                            floor(g->x[i][1] / g->size) + k / 3 % 3 - 1,
                            floor(g->x[i][2] / g->size) + k / 9 - 1};
    for (int j = g->first[chain_of(g, cell)]; j; j = g->next[j - 1]) {
      const double *a = g->x[i], *b = g->x[j - 1];
      double off = hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
      if (off < best || (off == best && (found < 0 || j - 1 < found))) {
        best = off;
        found = j - 1;
      }
    }
  }
  return found;
}

static void enter(grid *g, int i) {
  const double cell[3] = {floor(g->x[i][0] / g->size), floor(g->x[i][1] / g->size),
                          floor(g->x[i][2] / g->size)};
  int *first = &g->first[chain_of(g, cell)];
  g->next[i] = *first;
  *first = i + 1;
}

/* to[i] = the new number of node i; the value is how many are left. */
static int match_nodes(corot_draft *d, grid *g, int *to, corot_draft_list *list) {
  int n = 0;
  for (int i = 0; i < d->nnode; i++) {
    int near = find_near(g, i);
    to[i] = near < 0 ? n++ : to[near];
    if (near < 0)
      enter(g, i);
    else
      corot_draft_list_add(list, d->node[i].tag);
  }
  return n;
}

corot_status corot_draft_merge(corot_draft *d) {
  if (!d->how || !(d->how->merge > 0)) return COROT_OK;
  grid g = {.size = d->how->merge, .x = (const double(*)[3])d->x, .mask = 1};
  int *to = NULL;
  corot_draft_list list = {0};
  while (g.mask < (size_t)d->nnode) g.mask = 2 * g.mask + 1;
  corot_status status = COROT_ALLOC(g.first, g.mask + 1);
  if (!status) status = COROT_ALLOC(g.next, d->nnode);
  if (!status) status = COROT_ALLOC(to, d->nnode);
  if (!status) {
    match_nodes(d, &g, to, &list);
    if (list.n > 0) renumber(d, to);
  }
  free(g.first);
  free(g.next);
  free(to);
  if (status || list.n == 0) return status;
  return corot_draft_remark(d, COROT_MENDED_MERGED, list.n,
                            "%d node%s of the mesh file %s merged with others within %g m (%s in "
                            "the file)",
                            list.n, list.n == 1 ? "" : "s", list.n == 1 ? "is" : "are",
                            d->how->merge, list.text);
}

/* --- Tets --- */

static void swap(int *a, int *b) {
  int c = *a;
  *a = *b;
  *b = c;
}

/* Corners 0 and 1 change places, and with them the nodes on the edges 02 and 12, 03 and 13. */
static void turn_round(corot_draft *d, corot_draft_element *e) {
  swap(&e->node[0], &e->node[1]);
  if (!e->middle) return;
  int *middle = d->middle + e->middle - 1;
  swap(&middle[1], &middle[2]);
  swap(&middle[3], &middle[4]);
}

void corot_draft_turn_all(corot_draft *d) {
  const double(*x)[3] = (const double(*)[3])d->x;
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    if (e->dim != 3 || e->kind) continue;
    if (corot_draft_is_broken(d, e) || !(corot_tet_volume(x, e->node) < 0)) return;
  }
  for (size_t i = 0; i < d->nelement; i++)
    if (d->element[i].dim == 3 && !d->element[i].kind) turn_round(d, &d->element[i]);
}

corot_status corot_draft_turn(corot_draft *d) {
  const double(*x)[3] = (const double(*)[3])d->x;
  corot_draft_list list = {0};
  if (!d->how || !d->how->mends) return COROT_OK;
  for (size_t i = 0; i < d->nelement; i++) {
    corot_draft_element *e = &d->element[i];
    if (e->dim != 3 || e->kind || corot_draft_is_broken(d, e)) continue;
    if (!(corot_tet_volume(x, e->node) < 0) || corot_tet_is_flat(x, e->node)) continue;
    turn_round(d, e);
    corot_draft_list_add(&list, e->tag);
  }
  if (list.n == 0) return COROT_OK;
  return corot_draft_remark(d, COROT_MENDED_TURNED, list.n,
                            "%d left-handed tet%s of the mesh file %s turned round (element%s %s)",
                            list.n, list.n == 1 ? "" : "s", list.n == 1 ? "is" : "are",
                            list.n == 1 ? "" : "s", list.text);
}

/* A tet of the list and the group it is listed for. */
typedef struct listed {
  int v[4]; /* nodes, ascending */
  int physical, element;
} listed;

static int compare_listed(const void *a, const void *b) {
  const listed *p = a, *q = b;
  for (int i = 0; i < 4; i++)
    if (p->v[i] != q->v[i]) return p->v[i] < q->v[i] ? -1 : 1;
  if (p->physical != q->physical) return p->physical < q->physical ? -1 : 1;
  return (p->element > q->element) - (p->element < q->element);
}

static void sort(int n, int *v) {
  for (int i = 1; i < n; i++)
    for (int j = i; j > 0 && v[j] < v[j - 1]; j--) swap(&v[j], &v[j - 1]);
}

static listed list(const corot_draft_element *t, int element) {
  listed l = {.element = element};
  memcpy(l.v, t->node, sizeof l.v);
  sort(4, l.v);
  return l;
}

/* Whether both are the same tet in two groups. */
static bool is_for_groups(const corot_draft *d, const listed *a, const listed *b) {
  const corot_draft_element *p = &d->element[a->element], *q = &d->element[b->element];
  return d->repeats && a->physical != 0 && a->physical != b->physical &&
         memcmp(p->node, q->node, sizeof a->v) == 0 &&
         (!p->middle || memcmp(d->middle + p->middle - 1, d->middle + q->middle - 1,
                               NMIDDLE_MAX * sizeof *d->middle) == 0);
}

/* Whether both have the same nodes, in whatever order. */
static bool has_same_nodes(const corot_draft *d, const listed *a, const listed *b) {
  const corot_draft_element *p = &d->element[a->element], *q = &d->element[b->element];
  int mp[NMIDDLE_MAX], mq[NMIDDLE_MAX];
  if (memcmp(a->v, b->v, sizeof a->v) != 0) return false;
  if (!p->middle) return true;
  memcpy(mp, d->middle + p->middle - 1, sizeof mp);
  memcpy(mq, d->middle + q->middle - 1, sizeof mq);
  sort(NMIDDLE_MAX, mp);
  sort(NMIDDLE_MAX, mq);
  return memcmp(mp, mq, sizeof mp) == 0;
}

/* From a sorted list: first[e] = the first element that is the same tet as element e. */
static void match(const corot_draft *d, const listed *l, size_t n, int *first, bool *twice) {
  bool mends = d->how && d->how->mends;
  for (size_t start = 0, end; start < n; start = end) {
    int least = l[start].element;
    for (end = start + 1; end < n; end++) {
      bool fine = is_for_groups(d, &l[end - 1], &l[end]);
      if (!fine && !(mends && has_same_nodes(d, &l[end - 1], &l[end]))) break;
      if (l[end].element < least) least = l[end].element;
      if (!fine) twice[l[end].element] = true;
    }
    for (size_t i = start; i < end; i++) first[l[i].element] = least;
  }
}

/* first[e] as above; on entry it is e, or -1 for what is no tet. */
static corot_status find_repeats(corot_draft *d, int *first) {
  listed *l = NULL;
  bool *twice = NULL;
  size_t n = 0, m = 0;
  corot_draft_list told = {0};
  corot_status status = COROT_ALLOC(l, d->nelement);
  if (!status) status = COROT_ALLOC(twice, d->nelement);
  for (size_t e = 0; e < d->nelement && !status; e++) {
    while (m < d->nmember && (size_t)d->member[m].element < e) m++;
    if (first[e] < 0) continue;
    l[n] = list(&d->element[e], (int)e);
    if (m < d->nmember && (size_t)d->member[m].element == e) l[n].physical = d->member[m].physical;
    n++;
  }
  if (!status) {
    qsort(l, n, sizeof *l, compare_listed);
    match(d, l, n, first, twice);
    for (size_t e = 0; e < d->nelement; e++)
      if (twice[e]) corot_draft_list_add(&told, d->element[e].tag);
  }
  free(l);
  free(twice);
  if (status || told.n == 0) return status;
  return corot_draft_remark(d, COROT_MENDED_REPEATED, told.n,
                            "%d tet%s of the mesh file %s there before, with the same corners, and "
                            "count%s once (element%s %s)",
                            told.n, told.n == 1 ? "" : "s", told.n == 1 ? "is" : "are",
                            told.n == 1 ? "s" : "", told.n == 1 ? "" : "s", told.text);
}

corot_status corot_draft_number_tets(corot_draft *d, int *tet, int *ntet) {
  int n = 0;
  for (size_t e = 0; e < d->nelement; e++) {
    const corot_draft_element *p = &d->element[e];
    tet[e] = p->dim == 3 && !p->kind && !corot_draft_is_broken(d, p) ? (int)e : -1;
  }
  if (d->repeats || (d->how && d->how->mends)) COROT_TRY(find_repeats(d, tet));
  for (size_t e = 0; e < d->nelement; e++)
    if (tet[e] >= 0) tet[e] = tet[e] == (int)e ? n++ : tet[tet[e]];
  *ntet = n;
  return COROT_OK;
}
