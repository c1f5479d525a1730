/* Sets and surfaces of Abaqus' .inp: what they list is noted as it is read, and looked up when all
   nodes and elements are known. */
#include <stdio.h>
#include <string.h>

#include "mesh_inp.h"

/* So that a hostile file cannot multiply its nodes by its sets, nor nest these without end. */
enum { SETS_MAX = 256, NAMES_MAX = 10000 };

/* The place of a name in the list; -1: it is not there. */
static int find_name(const corot_inp *f, const char *name) {
  int last = f->nitem > 0 ? f->item[f->nitem - 1].name : 0; /* most often it is that again */
  if (f->nitem > 0 && corot_inp_same(f->name[last].text, name)) return last;
  for (size_t i = 0; i < f->nname; i++)
    if (corot_inp_same(f->name[i].text, name)) return (int)i;
  return -1;
}

static corot_status add_name(corot_inp *f, const char *name, int *place) {
  void *items = f->name;
  if ((*place = find_name(f, name)) >= 0) return COROT_OK;
  if (corot_group_name_check(name) != COROT_OK)
    return corot_reader_fail(&f->r, f->k.at, "%s", corot_error());
  if (f->nname >= NAMES_MAX)
    return corot_reader_fail(&f->r, f->k.at, "there are more than %d sets", NAMES_MAX);
  COROT_TRY(corot_make_room(&items, f->nname, &f->name_room, sizeof *f->name));
  f->name = items;
  corot_inp_name *n = &f->name[f->nname];
  strcpy(n->text, name);
  n->internal = corot_inp_param(f, "INTERNAL") != NULL;
  *place = (int)f->nname++;
  return COROT_OK;
}

corot_status corot_inp_add(corot_inp *f, const char *name, corot_inp_item item) {
  void *items = f->item;
  COROT_TRY(add_name(f, name, &item.name));
  COROT_TRY(corot_make_room(&items, f->nitem, &f->item_room, sizeof item));
  f->item = items;
  f->item[f->nitem++] = item;
  return COROT_OK;
}

/* What stands up to the next comma, without the name of the instance and quotes. */
static corot_status read_word(corot_inp *f, char word[COROT_GROUP_NAME_MAX + 1]) {
  corot_reader *r = &f->r;
  const char *p = r->data + r->at, *end = p;
  size_t prefix = strlen(f->instance);
  while (*end && *end != ',' && *end != '\n') end++;
  r->at = (size_t)(end - r->data);
  while (end > p && strchr(" \t\r\"", end[-1])) end--;
  while (p < end && *p == '"') p++;
  size_t n = (size_t)(end - p);
  if (n > COROT_GROUP_NAME_MAX)
    return corot_reader_fail(r, r->at, "a name has %zu bytes, at most %d are allowed", n,
                             COROT_GROUP_NAME_MAX);
  memcpy(word, p, n);
  word[n] = 0;
  if (prefix > 0 && n > prefix && word[prefix] == '.') {
    word[prefix] = 0;
    bool is_prefix = corot_inp_same(word, f->instance);
    word[prefix] = '.';
    if (is_prefix) memmove(word, word + prefix + 1, n - prefix);
  }
  corot_reader_separator(r);
  return COROT_OK;
}

/* A number or a set that stands before. */
static corot_status read_item(corot_inp *f, corot_inp_kind of, corot_inp_item *item) {
  char word[COROT_GROUP_NAME_MAX + 1];
  item->at = f->r.at;
  COROT_TRY(read_word(f, word));
  item->other = -1;
  if (word[0] && word[strspn(word, "+-0123456789")] == 0) {
    corot_reader number = {.path = f->r.path, .data = word, .size = strlen(word)};
    if (corot_reader_long(&number, "a number", &item->first) != COROT_OK)
      return corot_reader_fail(&f->r, item->at, "'%.30s' is no number", word);
    item->last = item->first;
    return COROT_OK;
  }
  item->other = find_name(f, word);
  for (size_t i = 0; i < f->nitem && item->other >= 0; i++)
    if (f->item[i].name == item->other && f->item[i].kind == of) return COROT_OK;
  return corot_reader_fail(&f->r, item->at, "there is no %s '%.60s' before this line",
                           of == INP_NODES ? "node set" : "element set", word);
}

/* "FIRST, LAST, STEP", the step being 1 if it is missing. */
static corot_status read_range(corot_inp *f, corot_inp_item *item) {
  item->at = f->r.at;
  item->other = -1;
  item->step = 1;
  COROT_TRY(corot_inp_long(f, "the first number", &item->first));
  COROT_TRY(corot_inp_long(f, "the last number", &item->last));
  if (corot_reader_more(&f->r)) COROT_TRY(corot_inp_long(f, "the step", &item->step));
  if (item->step < 1 || item->last < item->first || item->first < 0)
    return corot_reader_fail(&f->r, item->at, "from %lld to %lld by %lld is no range",
                             (long long)item->first, (long long)item->last, (long long)item->step);
  return COROT_OK;
}

corot_status corot_inp_read_set(corot_inp *f, corot_inp_kind kind) {
  const char *name = corot_inp_param(f, kind == INP_NODES ? "NSET" : "ELSET");
  bool generate = corot_inp_param(f, "GENERATE") != NULL;
  if (!name || !*name)
    return corot_reader_fail(&f->r, f->k.at, "*%s has no name: %s=NAME", f->k.word, f->k.word);
  if (kind == INP_NODES && corot_inp_param(f, "ELSET"))
    return corot_reader_fail(&f->r, f->k.at,
                             "node sets of element sets are not supported: list the nodes");
  while (corot_inp_next_line(f)) {
    do {
      corot_inp_item item = {.kind = kind, .step = 1};
      COROT_TRY(generate ? read_range(f, &item) : read_item(f, kind, &item));
      COROT_TRY(corot_inp_add(f, name, item));
    } while (!generate && corot_reader_more(&f->r));
  }
  return COROT_OK;
}

/* "S1" to "S6"; SPOS, SNEG and nothing are no face of a tet. */
static corot_status read_face(corot_inp *f, int *face) {
  char word[COROT_GROUP_NAME_MAX + 1];
  size_t at = f->r.at;
  *face = 0;
  if (!corot_reader_more(&f->r)) return COROT_OK;
  COROT_TRY(read_word(f, word));
  if ((word[0] == 'S' || word[0] == 's') && word[1] >= '1' && word[1] <= '6' && !word[2])
    *face = word[1] - '0';
  else if (!corot_inp_same(word, "SPOS") && !corot_inp_same(word, "SNEG"))
    return corot_reader_fail(&f->r, at, "expected a face, S1 to S6, found '%.20s'", word);
  return COROT_OK;
}

corot_status corot_inp_read_surface(corot_inp *f) {
  const char *name = corot_inp_param(f, "NAME"), *type = corot_inp_param(f, "TYPE");
  bool nodes = type && corot_inp_same(type, "NODE");
  if (!name || !*name) return corot_reader_fail(&f->r, f->k.at, "*SURFACE has no name: NAME=NAME");
  if (corot_inp_param(f, "COMBINE") ||
      (type && *type && !nodes && !corot_inp_same(type, "ELEMENT")))
    return corot_reader_fail(&f->r, f->k.at,
                             "surface %s: only surfaces of faces of elements or of nodes are "
                             "supported",
                             name);
  while (corot_inp_next_line(f)) {
    corot_inp_item item = {.kind = nodes ? INP_NODES : INP_FACES, .step = 1};
    COROT_TRY(read_item(f, nodes ? INP_NODES : INP_ELEMENTS, &item));
    if (!nodes) COROT_TRY(read_face(f, &item.face));
    COROT_TRY(corot_inp_add(f, name, item));
  }
  return COROT_OK;
}

/* --- groups --- */

/* Of nodes or elements by ascending numbers; a number that occurs twice is refused. */
static corot_status sort_tags(corot_inp *f, int n, bool nodes, corot_by_tag **by_tag) {
  corot_by_tag *s;
  COROT_TRY(COROT_ALLOC(s, n));
  for (int i = 0; i < n; i++)
    s[i] = (corot_by_tag){nodes ? f->d.node[i].tag : f->element[i].tag, i};
  corot_by_tag_sort(s, n);
  *by_tag = s;
  for (int i = 1; i < n && !nodes; i++)
    if (s[i].tag == s[i - 1].tag)
      return corot_reader_fail(&f->r, f->element[s[i].index].at,
                               "element %lld is defined a second time", (long long)s[i].tag);
  return COROT_OK;
}

static corot_status add_to_group(corot_inp *f, const corot_draft_element *e, int name) {
  COROT_TRY(corot_draft_add_element(&f->d, e, NULL));
  return corot_draft_add_member(&f->d, (int)f->d.nelement - 1, name + 1);
}

/* The faces of solids, S1 to S6; -1 ends a triangle, and a face that there is not. */
static const int faces[DRAFT_KINDS][6][4] = {
    [DRAFT_SIMPLEX] = {{0, 1, 2, -1}, {0, 3, 1, -1}, {1, 3, 2, -1}, {2, 3, 0, -1}, {-1}, {-1}},
    [DRAFT_PYRAMID] =
        {{0, 1, 2, 3}, {0, 4, 1, -1}, {1, 4, 2, -1}, {2, 4, 3, -1}, {3, 4, 0, -1}, {-1}},
    [DRAFT_PRISM] = {{0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}, {-1}},
    [DRAFT_HEX] =
        {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}},
};

/* A triangle or quad that is an element, or a face of a solid; their corners. */
static corot_status add_face(corot_inp *f, const corot_inp_element *e, int face, int name) {
  corot_draft_element t = {.tag = e->tag, .at = e->at, .dim = 2};
  const int *local = e->dim == 3 && face > 0 ? faces[e->kind][face - 1] : NULL;
  if (e->dim == 3 && (!local || local[0] < 0))
    return corot_reader_fail(&f->r, e->at,
                             "element %lld is in surface %s, which does not say with which face, "
                             "S1 to S%d",
                             (long long)e->tag, f->name[name].text,
                             e->kind == DRAFT_HEX ? 6
                             : e->kind            ? 5
                                                  : 4);
  int n = local ? (local[3] >= 0 ? 4 : 3) : e->kind ? 4 : 3;
  if (n == 4) t.kind = DRAFT_QUAD;
  for (int k = 0; k < n; k++)
    corot_draft_find_node(&f->d, &t, e->node[local ? local[k] : k], &t.node[k]);
  return add_to_group(f, &t, name);
}

/* A node or an element, by its place, becomes a member of the group of `name`. */
static corot_status add_one(corot_inp *f, const corot_inp_item *item, int face, int place,
                            corot_inp_kind kind, int name) {
  if (++f->nmember / SETS_MAX > f->nelement + (size_t)f->d.nnode + 1000)
    return corot_reader_fail(
        &f->r, item->at, "the sets have more than %d times as many members as the mesh", SETS_MAX);
  if (f->name[name].internal) return COROT_OK;
  if (item->kind == INP_NODES) {
    const corot_draft_element point = {
        .tag = f->d.node[place].tag, .at = item->at, .node = {place}};
    return add_to_group(f, &point, name);
  }
  const corot_inp_element *e = &f->element[place];
  if (kind == INP_FACES || e->dim == 2) return add_face(f, e, face, name);
  return corot_draft_add_member(&f->d, e->index, name + 1);
}

/* All nodes and elements by number; what is looked for. */
typedef struct lookup {
  corot_by_tag *node, *element;
  size_t *seen; /* [nitem] the last top item that took it, from 1 */
} lookup;

/* The members that an item lists by numbers or places. */
static corot_status add_listed(corot_inp *f, const lookup *l, const corot_inp_item *item, int face,
                               corot_inp_kind kind, int name) {
  bool nodes = item->kind == INP_NODES;
  int n = nodes ? f->d.nnode : (int)f->nelement;
  const corot_by_tag *s = nodes ? l->node : l->element;
  if (item->by_index) {
    for (int64_t i = item->first; i <= item->last; i++)
      COROT_TRY(add_one(f, item, face, (int)i, kind, name));
    return COROT_OK;
  }
  int i = corot_by_tag_first(s, n, item->first);
  /* a set may list elements that are left out, which have no places */
  if (nodes && item->first == item->last && (i == n || s[i].tag != item->first))
    return corot_reader_fail(&f->r, item->at, "node %lld does not exist", (long long)item->first);
  for (; i < n && s[i].tag <= item->last; i++)
    if ((s[i].tag - item->first) % item->step == 0)
      COROT_TRY(add_one(f, item, face, s[i].index, kind, name));
  return COROT_OK;
}

/* The members of item number `i` for the group of item `top`: its own, or those of the sets that it
   names. Each item is taken once, so that sets of sets of sets end. */
static corot_status add_members(corot_inp *f, const lookup *l, size_t i, int face, size_t top) {
  const corot_inp_item *item = &f->item[i], *first = &f->item[top];
  if (l->seen[i] == top + 1) return COROT_OK;
  l->seen[i] = top + 1;
  f->nmember++;
  if (item->other < 0) return add_listed(f, l, item, face, first->kind, first->name);
  corot_inp_kind of = item->kind == INP_NODES ? INP_NODES : INP_ELEMENTS;
  for (size_t j = 0; j < i; j++)
    if (f->item[j].name == item->other && f->item[j].kind == of)
      COROT_TRY(add_members(f, l, j, face, top));
  return COROT_OK;
}

static corot_status add_groups(corot_inp *f, lookup *l) {
  static const int dims[3] = {0, 2, 3};
  COROT_TRY(sort_tags(f, f->d.nnode, true, &l->node));
  COROT_TRY(sort_tags(f, (int)f->nelement, false, &l->element));
  COROT_TRY(COROT_ALLOC(l->seen, f->nitem));
  for (size_t i = 0; i < f->nname; i++)
    for (int k = 0; k < 3; k++)
      COROT_TRY(corot_draft_add_name(&f->d, dims[k], (int)i + 1, f->name[i].text));
  for (size_t i = 0; i < f->nitem; i++) COROT_TRY(add_members(f, l, i, f->item[i].face, i));
  return COROT_OK;
}

corot_status corot_inp_groups(corot_inp *f) {
  lookup l = {0};
  corot_status status = add_groups(f, &l);
  free(l.node);
  free(l.element);
  free(l.seen);
  return status;
}
