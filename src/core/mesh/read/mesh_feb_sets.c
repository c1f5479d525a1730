/* Sets and surfaces of FEBio's .feb: what they list is noted as it is read, and looked up when all
   nodes and elements are known. */
#include <string.h>

#include "mesh_feb.h"

/* So that a hostile file cannot multiply its nodes by its sets. */
enum { SETS_MAX = 256, NAMES_MAX = 10000 };

corot_status corot_feb_add_name(corot_feb *f, const corot_xml_tag *tag, const char *text,
                                int *name) {
  void *items = f->name;
  *name = 0;
  if (!*text) return COROT_OK;
  for (size_t i = 0; i < f->nname && !*name; i++)
    if (strcmp(f->name[i].text, text) == 0) *name = (int)i + 1;
  if (*name) return COROT_OK;
  if (corot_group_name_check(text) != COROT_OK)
    return corot_reader_fail(&f->r, tag->at, "%s", corot_error());
  if (f->nname >= NAMES_MAX)
    return corot_reader_fail(&f->r, tag->at, "there are more than %d sets", NAMES_MAX);
  COROT_TRY(corot_make_room(&items, f->nname, &f->name_room, sizeof *f->name));
  f->name = items;
  strcpy(f->name[f->nname].text, text);
  *name = (int)++f->nname;
  return COROT_OK;
}

corot_status corot_feb_add_item(corot_feb *f, corot_feb_item item) {
  void *items = f->item;
  COROT_TRY(corot_make_room(&items, f->nitem, &f->item_room, sizeof item));
  f->item = items;
  f->item[f->nitem++] = item;
  return COROT_OK;
}

/* Past a colon; false if there is none. */
static bool take_colon(corot_feb *f) {
  if (!corot_feb_more(f) || f->r.data[f->r.at] != ':') return false;
  f->r.at++;
  return true;
}

corot_status corot_feb_read_list(corot_feb *f, corot_feb_of of, int name) {
  while (corot_feb_more(f)) {
    corot_feb_item item = {.name = name, .of = of, .at = f->r.at, .step = 1};
    COROT_TRY(corot_feb_long(f, "a number", &item.first));
    item.last = item.first;
    if (take_colon(f)) COROT_TRY(corot_feb_long(f, "the last number", &item.last));
    if (take_colon(f)) COROT_TRY(corot_feb_long(f, "the step", &item.step));
    if (item.step < 1 || item.last < item.first || item.first < 0)
      return corot_reader_fail(&f->r, item.at, "from %lld to %lld by %lld is no range",
                               (long long)item.first, (long long)item.last, (long long)item.step);
    COROT_TRY(corot_feb_add_item(f, item));
  }
  return COROT_OK;
}

/* --- Groups --- */

/* Places of nodes or elements by ascending numbers. */
static corot_status sort_tags(const corot_feb *f, corot_feb_of of, int n, corot_by_tag **sorted) {
  corot_by_tag *s;
  COROT_TRY(COROT_ALLOC(s, n));
  *sorted = s;
  for (int i = 0; i < n; i++)
    s[i] = (corot_by_tag){of == FEB_NODES ? f->d.node[i].tag : f->element[i].tag, i};
  corot_by_tag_sort(s, n);
  for (int i = 1; i < n && of == FEB_ELEMENTS; i++)
    if (s[i].tag == s[i - 1].tag)
      return corot_reader_fail(&f->r, f->element[s[i].index].at,
                               "element %lld is defined a second time", (long long)s[i].tag);
  return COROT_OK;
}

/* A node or an element, by its place, becomes a member of the item's group. */
static corot_status add_one(corot_feb *f, const corot_feb_item *item, int place) {
  if (++f->nmember / SETS_MAX > f->nelement + (size_t)f->d.nnode + 1000)
    return corot_reader_fail(
        &f->r, item->at, "the sets have more than %d times as many members as the mesh", SETS_MAX);
  if (item->of == FEB_ELEMENTS) {
    const corot_feb_element *e = &f->element[place];
    return e->dim ? corot_draft_add_member(&f->d, e->index, item->name) : COROT_OK;
  }
  const corot_draft_element point = {
      .tag = f->d.node[place].tag, .at = f->d.node[place].at, .node = {place}};
  COROT_TRY(corot_draft_add_element(&f->d, &point, NULL));
  return corot_draft_add_member(&f->d, (int)f->d.nelement - 1, item->name);
}

static corot_status add_item(corot_feb *f, const corot_feb_item *item, const corot_by_tag *s,
                             int n) {
  bool nodes = item->of == FEB_NODES;
  for (int64_t i = item->first; i <= item->last && item->by_index; i++)
    COROT_TRY(add_one(f, item, (int)i));
  if (item->by_index) return COROT_OK;
  int i = corot_by_tag_first(s, n, item->first);
  if (item->first == item->last && (i == n || s[i].tag != item->first)) {
    corot_draft_note(&f->d, &f->r, item->at, "%s: %s %lld does not exist",
                     f->name[item->name - 1].text, nodes ? "node" : "element",
                     (long long)item->first);
    return COROT_OK;
  }
  for (; i < n && s[i].tag <= item->last; i++)
    if ((s[i].tag - item->first) % item->step == 0) COROT_TRY(add_one(f, item, s[i].index));
  return COROT_OK;
}

static corot_status add_items(corot_feb *f, corot_feb_of of) {
  int n = of == FEB_NODES ? f->d.nnode : (int)f->nelement;
  corot_by_tag *sorted = NULL;
  corot_status status = sort_tags(f, of, n, &sorted);
  for (size_t i = 0; i < f->nitem && !status; i++)
    if (f->item[i].of == of) status = add_item(f, &f->item[i], sorted, n);
  free(sorted);
  return status;
}

static corot_status add_face(corot_feb *f, const corot_feb_element *e) {
  corot_draft_element t = {.tag = e->tag, .at = e->at, .dim = 2, .kind = e->kind};
  int middle[NMIDDLE_MAX];
  if (e->name == 0) return COROT_OK;
  for (int k = 0; k < e->nnode; k++)
    corot_draft_find_node(&f->d, &t, e->node[k], corot_draft_slot(&t, middle, k));
  COROT_TRY(corot_draft_add_element(&f->d, &t, e->nnode == 6 ? middle : NULL));
  return corot_draft_add_member(&f->d, (int)f->d.nelement - 1, e->name);
}

corot_status corot_feb_groups(corot_feb *f) {
  static const int dims[3] = {0, 2, 3};
  for (size_t i = 0; i < f->nname; i++)
    for (int k = 0; k < 3; k++)
      COROT_TRY(corot_draft_add_name(&f->d, dims[k], (int)i + 1, f->name[i].text));
  for (size_t i = 0; i < f->nface; i++) COROT_TRY(add_face(f, &f->face[i]));
  COROT_TRY(add_items(f, FEB_NODES));
  return add_items(f, FEB_ELEMENTS);
}
