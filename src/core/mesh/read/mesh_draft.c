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
  free(d->quad);
  free(d->member);
  free(d->name);
  memset(d, 0, sizeof *d);
}

int corot_draft_ncorner(const corot_draft_element *e) {
  static const int n[DRAFT_KINDS] = {
      [DRAFT_QUAD] = 4, [DRAFT_PYRAMID] = 5, [DRAFT_PRISM] = 6, [DRAFT_HEX] = 8};
  return e->kind ? n[e->kind] : e->dim + 1;
}

/* How many of its nodes are not in `node`. */
static int nmore(const corot_draft_element *e) {
  if (e->kind) return corot_draft_ncorner(e) - 4;
  return e->middle ? corot_draft_nedge(e->dim) : 0;
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
      corot_draft_note(d, d->node_file, d->node[i].at,
                       "node %lld: the number of a node may not be negative",
                       (long long)d->node[i].tag);
  if (consecutive(d)) return COROT_OK;
  COROT_TRY(COROT_ALLOC(d->by_tag, d->nnode));
  for (int i = 0; i < d->nnode; i++) d->by_tag[i] = (corot_draft_node){d->node[i].tag, (size_t)i};
  qsort(d->by_tag, (size_t)d->nnode, sizeof *d->by_tag, compare_tags);
  for (int i = 1; i < d->nnode; i++)
    if (d->by_tag[i].tag == d->by_tag[i - 1].tag)
      corot_draft_note(d, d->node_file, d->node[d->by_tag[i].at].at,
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

void corot_draft_find_node(corot_draft *d, const corot_draft_element *element, int64_t tag,
                           int *index) {
  *index = index_of(d, tag);
  if (*index < 0)
    corot_draft_note(d, corot_draft_file(d, element), element->at,
                     "%s %lld: node %lld does not exist", corot_draft_word(d, element),
                     (long long)element->tag, (long long)tag);
}

bool corot_draft_is_broken(const corot_draft *d, const corot_draft_element *e) {
  int n = e->kind ? 4 : e->dim + 1, more = nmore(e);
  for (int k = 0; k < n; k++)
    if (e->node[k] < 0) return true;
  for (int k = 0; k < more; k++)
    if (d->middle[e->middle - 1 + k] < 0) return true;
  return false;
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

/* Whether a solid is of the order of those before it. */
static corot_status check_order(corot_draft *d, const corot_draft_element *element, int order) {
  if (d->order && d->order != order)
    return corot_reader_fail(
        d->element_file, element->at,
        "element %lld is a %s of %d nodes, the tets before it have %d: orders do not mix",
        (long long)element->tag, element->kind ? "solid" : "tet",
        element->kind ? corot_draft_ncorner(element)
        : order == 2  ? 10
                      : 4,
        order == 2 ? 4 : 10);
  d->order = order;
  return COROT_OK;
}

corot_status corot_draft_add_element(corot_draft *d, const corot_draft_element *element,
                                     const int *middle) {
  void *items = d->element;
  if (element->dim == 3) COROT_TRY(check_order(d, element, middle && !element->kind ? 2 : 1));
  if (d->nmiddle > INT_MAX - NMIDDLE_MAX)
    return corot_fail(COROT_ENOMEM, "too many elements: %zu", d->nelement);
  COROT_TRY(corot_make_room(&items, d->nelement, &d->element_room, sizeof *element));
  d->element = items;
  corot_draft_element *e = &d->element[d->nelement];
  *e = *element;
  e->middle = middle ? (int)d->nmiddle + 1 : 0;
  int n = middle ? nmore(e) : 0;
  for (int k = 0; k < n; k++) COROT_TRY(add_middle(d, middle[k]));
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

/* What messages need to know of a mesh that is made of a draft. */
typedef struct origin {
  const corot_draft *d;
  const int *element; /* [ntet] that a tet was */
} origin;

/* Puts the place in the file before the message of a failed check. */
static void locate(const void *file, corot_mesh_place place, int index, const char *text) {
  const origin *o = file;
  const corot_draft *d = o->d;
  if (place == PLACE_NODE)
    corot_reader_fail(d->node_file, d->node[index].at, "%s", text);
  else if (place == PLACE_TET)
    corot_reader_fail(d->element_file, d->element[o->element[index]].at, "%s", text);
  else
    corot_fail(COROT_EFORMAT, "%s: %s", d->element_file->path, text);
}

/* The numbers of nodes and tets in the file, for messages. */
typedef struct tags {
  int64_t *node, *tet;
  int *element; /* that a tet was */
  char *known;
} tags;

static corot_status list_tags(const corot_draft *d, const int *tet, int ntet, tags *t) {
  COROT_TRY(COROT_ALLOC(t->node, d->nnode));
  COROT_TRY(COROT_ALLOC(t->tet, ntet));
  COROT_TRY(COROT_ALLOC(t->element, ntet));
  COROT_TRY(COROT_ALLOC(t->known, d->nnode));
  for (int i = 0; i < d->nnode; i++) t->node[i] = d->node[i].tag;
  for (size_t e = d->nelement; e-- > 0;) /* downwards: the first of repeated elements stays */
    if (tet[e] >= 0) {
      t->tet[tet[e]] = d->element[e].tag;
      t->element[tet[e]] = (int)e;
    }
  return COROT_OK;
}

static void know(const corot_draft *d, int node, char *known) {
  if (node >= 0 && node < d->nnode) known[node] = 1;
}

/* Marks the nodes of solids that do not become tets: these have been told, and not their nodes. */
static void mark_known(const corot_draft *d, const int *tet, char *known) {
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    if (e->dim != 3 || tet[i] >= 0) continue;
    for (int k = 0; k < 4; k++) know(d, e->node[k], known);
    for (int k = 0; k < nmore(e); k++) know(d, d->middle[e->middle - 1 + k], known);
  }
}

static corot_status check(corot_draft *d, const int *tet, const corot_mesh *mesh,
                          corot_face **face) {
  tags t = {0};
  corot_status status = list_tags(d, tet, mesh->ntet, &t);
  if (!status) {
    mark_known(d, tet, t.known);
    const origin o = {d, t.element};
    const corot_mesh_names names = {"element", t.node, t.tet, d->nmember ? NULL : d->unused_hint,
                                    t.known,   locate, &o};
    status = corot_mesh_check(mesh, &names, &d->faults, face);
  }
  free(t.node);
  free(t.tet);
  free(t.element);
  free(t.known);
  return status;
}

/* Fills a zeroed mesh with nodes and tets. */
static corot_status fill(corot_draft *d, const int *tet, corot_mesh *mesh) {
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
  return COROT_OK;
}

/* Fails with all faults, which are forgotten then. */
static corot_status tell(corot_draft *d) {
  corot_status status = corot_faults_fail(&d->faults, COROT_EFORMAT);
  d->faults.n = 0;
  return status;
}

/* Fills a zeroed mesh with nodes, tets and groups; `tet` [nelement] is scratch. */
static corot_status build(corot_draft *d, int *tet, corot_mesh *mesh) {
  corot_face *face = NULL;
  corot_draft_check_orders(d);
  if (d->order == 2) corot_draft_check_middles(d);
  COROT_TRY(corot_draft_turn(d));
  COROT_TRY(corot_draft_number_tets(d, tet, &mesh->ntet));
  COROT_TRY(corot_draft_drop_unused(d));
  COROT_TRY(fill(d, tet, mesh));
  if (mesh->ntet > 0 || d->faults.n == 0) {
    COROT_TRY(check(d, tet, mesh, &face));
  }
  if (d->faults.n == 0) corot_draft_match_quads(d, 4 * mesh->ntet, face);
  if (d->faults.n > 0) free(face);
  COROT_TRY(tell(d));
  corot_status status = corot_draft_groups(d, tet, face, mesh);
  free(face);
  return status ? status : tell(d);
}

corot_status corot_draft_end(corot_draft *d, corot_status status) {
  if (status != COROT_EFORMAT || d->faults.n == 0) return status;
  corot_faults_add(&d->faults);
  return corot_faults_fail(&d->faults, status);
}

/* Coordinates become metres. What is too large then is refused with the others. */
static void scale(corot_draft *d) {
  double factor = d->how ? d->how->scale : 0;
  for (int i = 0; i < d->nnode && factor != 0; i++)
    for (int k = 0; k < 3; k++) d->x[i][k] *= factor;
}

corot_status corot_draft_finish(corot_draft *d, corot_mesh **mesh) {
  corot_mesh *m;
  int *tet = NULL;
  scale(d);
  COROT_TRY(corot_draft_merge(d));
  COROT_TRY(corot_draft_cut(d));
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

/* --- By numbers --- */

static int compare_numbers(const void *a, const void *b) {
  const corot_by_tag *p = a, *q = b;
  if (p->tag != q->tag) return p->tag < q->tag ? -1 : 1;
  return (p->index > q->index) - (p->index < q->index);
}

void corot_by_tag_sort(corot_by_tag *s, int n) { qsort(s, (size_t)n, sizeof *s, compare_numbers); }

int corot_by_tag_first(const corot_by_tag *s, int n, int64_t tag) {
  int low = 0, high = n;
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (s[middle].tag < tag)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}
