/* Rows of a draft as they are read, tags turned into indices, and the mesh out of it. */
#include "mesh_draft.h"

#include <limits.h>
#include <string.h>

void corot_draft_clear(corot_draft *d) {
  free(d->x);
  free(d->node);
  free(d->by_tag);
  free(d->element);
  free(d->middle);
  free(d->member);
  free(d->name);
  memset(d, 0, sizeof *d);
}

corot_status corot_draft_alloc_nodes(corot_draft *d, int n) {
  COROT_TRY(COROT_ALLOC(d->x, n));
  COROT_TRY(COROT_ALLOC(d->node, n));
  d->nnode = n;
  return COROT_OK;
}

static int compare_tags(const void *a, const void *b) {
  const corot_draft_node *p = a, *q = b;
  if (p->tag != q->tag) return p->tag < q->tag ? -1 : 1;
  return (p->at > q->at) - (p->at < q->at);
}

static bool consecutive(const corot_draft *d) {
  for (int i = 1; i < d->nnode; i++)
    if (d->node[i - 1].tag == INT64_MAX || d->node[i].tag != d->node[i - 1].tag + 1) return false;
  return true;
}

corot_status corot_draft_index_nodes(corot_draft *d) {
  for (int i = 0; i < d->nnode; i++)
    if (d->node[i].tag < 0)
      return corot_reader_fail(d->node_file, d->node[i].at,
                               "node %lld: the number of a node may not be negative",
                               (long long)d->node[i].tag);
  if (consecutive(d)) return COROT_OK;
  COROT_TRY(COROT_ALLOC(d->by_tag, d->nnode));
  for (int i = 0; i < d->nnode; i++) d->by_tag[i] = (corot_draft_node){d->node[i].tag, (size_t)i};
  qsort(d->by_tag, (size_t)d->nnode, sizeof *d->by_tag, compare_tags);
  for (int i = 1; i < d->nnode; i++)
    if (d->by_tag[i].tag == d->by_tag[i - 1].tag)
      return corot_reader_fail(d->node_file, d->node[d->by_tag[i].at].at,
                               "node %lld is defined a second time", (long long)d->by_tag[i].tag);
  return COROT_OK;
}

/* -1: there is none. */
static int index_of(const corot_draft *d, int64_t tag) {
  if (d->by_tag) {
    int low = 0, high = d->nnode;
    while (low < high) {
      int middle = low + (high - low) / 2;
      if (d->by_tag[middle].tag < tag)
        low = middle + 1;
      else
        high = middle;
    }
    return low < d->nnode && d->by_tag[low].tag == tag ? (int)d->by_tag[low].at : -1;
  }
  if (d->nnode == 0 || tag < d->node[0].tag || tag > d->node[d->nnode - 1].tag) return -1;
  return (int)(tag - d->node[0].tag);
}

corot_status corot_draft_find_node(const corot_draft *d, const corot_draft_element *element,
                                   int64_t tag, int *index) {
  int i = index_of(d, tag);
  if (i < 0)
    return corot_draft_fail(d, element, "%s %lld: node %lld does not exist",
                            corot_draft_word(d, element), (long long)element->tag, (long long)tag);
  *index = i;
  return COROT_OK;
}

corot_status corot_make_room(void **items, size_t n, size_t *room, size_t size) {
  if (n < *room) return COROT_OK;
  size_t more = *room ? 2 * *room : 64;
  void *p = more <= SIZE_MAX / size ? realloc(*items, more * size) : NULL;
  if (!p) return corot_fail(COROT_ENOMEM, "out of memory: %zu times %zu bytes", more, size);
  *items = p;
  *room = more;
  return COROT_OK;
}

corot_status corot_draft_add_node(corot_draft *d, corot_draft_node node, const double x[3]) {
  void *nodes = d->node, *places = d->x;
  if (d->nnode == INT_MAX) return corot_fail(COROT_ENOMEM, "too many nodes: %d", d->nnode);
  COROT_TRY(corot_make_room(&nodes, (size_t)d->nnode, &d->node_room, sizeof node));
  d->node = nodes;
  COROT_TRY(corot_make_room(&places, (size_t)d->nnode, &d->x_room, sizeof *d->x));
  d->x = places;
  d->node[d->nnode] = node;
  memcpy(d->x[d->nnode++], x, sizeof *d->x);
  return COROT_OK;
}

static corot_status add_middle(corot_draft *d, int node) {
  void *items = d->middle;
  COROT_TRY(corot_make_room(&items, d->nmiddle, &d->middle_room, sizeof *d->middle));
  d->middle = items;
  d->middle[d->nmiddle++] = node;
  return COROT_OK;
}

corot_status corot_draft_add_element(corot_draft *d, const corot_draft_element *element,
                                     const int *middle) {
  void *items = d->element;
  int order = middle ? 2 : 1, nedge = corot_draft_nedge(element->dim);
  if (element->dim == 3 && d->order && d->order != order)
    return corot_reader_fail(
        d->element_file, element->at,
        "element %lld is a tet of %d nodes, the tets before it have %d: orders do not mix",
        (long long)element->tag, middle ? 10 : 4, middle ? 4 : 10);
  if (element->dim == 3) d->order = order;
  if (d->nmiddle > INT_MAX - NMIDDLE_MAX)
    return corot_fail(COROT_ENOMEM, "too many elements: %zu", d->nelement);
  COROT_TRY(corot_make_room(&items, d->nelement, &d->element_room, sizeof *element));
  d->element = items;
  d->element[d->nelement] = *element;
  d->element[d->nelement].middle = middle ? (int)d->nmiddle + 1 : 0;
  for (int k = 0; middle && k < nedge; k++) COROT_TRY(add_middle(d, middle[k]));
  d->nelement++;
  return COROT_OK;
}

corot_status corot_draft_add_member(corot_draft *d, int element, int physical) {
  void *items = d->member;
  if (physical == 0) return COROT_OK;
  COROT_TRY(corot_make_room(&items, d->nmember, &d->member_room, sizeof *d->member));
  d->member = items;
  d->member[d->nmember++] = (corot_draft_member){element, physical};
  return COROT_OK;
}

corot_status corot_draft_add_name(corot_draft *d, int dim, int physical, const char *name) {
  void *items = d->name;
  COROT_TRY(corot_group_name_check(name));
  COROT_TRY(corot_make_room(&items, d->nname, &d->name_room, sizeof *d->name));
  d->name = items;
  corot_draft_name *n = &d->name[d->nname];
  n->dim = dim;
  n->physical = physical;
  n->order = (int)d->nname++;
  strcpy(n->text, name);
  return COROT_OK;
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

static listed list(const corot_draft_element *t, int element) {
  listed l = {.element = element};
  memcpy(l.v, t->node, sizeof l.v);
  for (int i = 1; i < 4; i++)
    for (int j = i; j > 0 && l.v[j] < l.v[j - 1]; j--) {
      int swap = l.v[j];
      l.v[j] = l.v[j - 1];
      l.v[j - 1] = swap;
    }
  return l;
}

/* Whether both are the same tet in two groups; otherwise a tet is there twice. */
static bool same_tet(const corot_draft *d, const listed *a, const listed *b) {
  const corot_draft_element *p = &d->element[a->element], *q = &d->element[b->element];
  return a->physical != 0 && a->physical != b->physical &&
         memcmp(p->node, q->node, sizeof a->v) == 0 &&
         (!p->middle || memcmp(d->middle + p->middle - 1, d->middle + q->middle - 1,
                               NMIDDLE_MAX * sizeof *d->middle) == 0);
}

/* first[e] = the first element that is the same tet as element e; on entry it is e. */
static corot_status find_repeats(const corot_draft *d, int *first) {
  listed *l;
  size_t n = 0, m = 0;
  COROT_TRY(COROT_ALLOC(l, d->nelement));
  for (size_t e = 0; e < d->nelement; e++) {
    while (m < d->nmember && (size_t)d->member[m].element < e) m++;
    if (d->element[e].dim != 3) continue;
    l[n] = list(&d->element[e], (int)e);
    if (m < d->nmember && (size_t)d->member[m].element == e) l[n].physical = d->member[m].physical;
    n++;
  }
  qsort(l, n, sizeof *l, compare_listed);
  for (size_t start = 0, end; start < n; start = end) {
    int least = l[start].element;
    for (end = start + 1; end < n && same_tet(d, &l[end - 1], &l[end]); end++)
      if (l[end].element < least) least = l[end].element;
    for (size_t i = start; i < end; i++) first[l[i].element] = least;
  }
  free(l);
  return COROT_OK;
}

/* Which elements become tets: tet[e] is the tet's number, or -1 for elements of lower dimension. */
static corot_status number_tets(const corot_draft *d, int *tet, int *ntet) {
  int n = 0;
  for (size_t e = 0; e < d->nelement; e++) tet[e] = (int)e;
  if (d->repeats) COROT_TRY(find_repeats(d, tet));
  for (size_t e = 0; e < d->nelement; e++)
    if (d->element[e].dim != 3)
      tet[e] = -1;
    else
      tet[e] = tet[e] == (int)e ? n++ : tet[tet[e]];
  *ntet = n;
  return COROT_OK;
}

/* Puts the place in the file before the message of a failed check. */
static corot_status locate(const corot_draft *d, const corot_mesh_place *place,
                           const int *element_of) {
  if (place->kind == PLACE_NODE)
    return corot_reader_fail(d->node_file, d->node[place->index].at, "%s", corot_error());
  if (place->kind == PLACE_TET) {
    size_t at = d->element[element_of[place->index]].at;
    return corot_reader_fail(d->element_file, at, "%s", corot_error());
  }
  return corot_fail(COROT_EFORMAT, "%s: %s", d->element_file->path, corot_error());
}

/* The numbers of nodes and tets in the file, for messages. */
typedef struct tags {
  int64_t *node, *tet;
  int *element; /* that a tet was */
} tags;

static corot_status list_tags(const corot_draft *d, const int *tet, int ntet, tags *t) {
  COROT_TRY(COROT_ALLOC(t->node, d->nnode));
  COROT_TRY(COROT_ALLOC(t->tet, ntet));
  COROT_TRY(COROT_ALLOC(t->element, ntet));
  for (int i = 0; i < d->nnode; i++) t->node[i] = d->node[i].tag;
  for (size_t e = d->nelement; e-- > 0;) /* downwards: the first of repeated elements stays */
    if (tet[e] >= 0) {
      t->tet[tet[e]] = d->element[e].tag;
      t->element[tet[e]] = (int)e;
    }
  return COROT_OK;
}

static corot_status check(const corot_draft *d, const int *tet, const corot_mesh *mesh,
                          corot_face **face) {
  corot_mesh_place place = {PLACE_MESH, 0};
  tags t = {0};
  corot_status status = list_tags(d, tet, mesh->ntet, &t);
  if (!status) {
    const corot_mesh_names names = {"element", t.node, t.tet, d->nmember ? NULL : d->unused_hint};
    status = corot_mesh_check(mesh, &names, &place, face);
  }
  if (status == COROT_EINVAL) status = locate(d, &place, t.element);
  free(t.node);
  free(t.tet);
  free(t.element);
  return status;
}

/* Fills a zeroed mesh with nodes, tets and groups; `tet` [nelement] is scratch. */
static corot_status build(corot_draft *d, int *tet, corot_mesh *mesh) {
  corot_face *face;
  COROT_TRY(corot_draft_check_orders(d));
  if (d->order == 2) COROT_TRY(corot_draft_check_middles(d));
  COROT_TRY(number_tets(d, tet, &mesh->ntet));
  COROT_TRY(COROT_ALLOC(mesh->tet, mesh->ntet));
  if (d->order == 2) COROT_TRY(COROT_ALLOC(mesh->mid, mesh->ntet));
  for (size_t e = d->nelement; e-- > 0;) {
    if (tet[e] < 0) continue;
    memcpy(mesh->tet[tet[e]], d->element[e].node, sizeof *mesh->tet);
    if (mesh->mid)
      memcpy(mesh->mid[tet[e]], d->middle + d->element[e].middle - 1, sizeof *mesh->mid);
  }
  mesh->nnode = d->nnode;
  mesh->x = d->x;
  d->x = NULL;
  COROT_TRY(check(d, tet, mesh, &face));
  corot_status status = corot_draft_groups(d, tet, face, mesh);
  free(face);
  return status;
}

corot_status corot_draft_finish(corot_draft *d, corot_mesh **mesh) {
  corot_mesh *m;
  int *tet = NULL;
  COROT_TRY(COROT_ALLOC(m, 1));
  corot_status status = COROT_ALLOC(tet, d->nelement);
  if (!status) status = build(d, tet, m);
  free(tet);
  if (status)
    corot_mesh_destroy(m);
  else
    *mesh = m;
  return status;
}
