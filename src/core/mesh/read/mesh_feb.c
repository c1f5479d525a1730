/* FEBio's .feb, of which only the mesh matters: <Geometry> up to format 2.5, <Mesh> from 3.0 on. */
#include "mesh_feb.h"

#include <stdio.h>
#include <string.h>

#include "mesh_read.h"

bool corot_feb_more(corot_feb *f) {
  corot_reader *r = &f->r;
  for (;;) {
    corot_reader_skip_lines(r);
    const char *p = r->data + r->at;
    if (strncmp(p, "<!--", 4) != 0) return r->at < r->size && *p != '<';
    const char *end = strstr(p, "-->");
    r->at = end ? (size_t)(end - r->data) + 3 : r->size;
  }
}

/* Past the comma behind a number. */
static void past_comma(corot_feb *f) {
  if (corot_feb_more(f) && f->r.data[f->r.at] == ',') f->r.at++;
}

corot_status corot_feb_long(corot_feb *f, const char *what, int64_t *value) {
  if (!corot_feb_more(f))
    return corot_reader_fail(&f->r, f->r.at, "expected %s, found a tag", what);
  COROT_TRY(corot_reader_long(&f->r, what, value));
  past_comma(f);
  return COROT_OK;
}

static corot_status read_real(corot_feb *f, const char *what, double *value) {
  if (!corot_feb_more(f))
    return corot_reader_fail(&f->r, f->r.at, "expected %s, found a tag", what);
  COROT_TRY(corot_reader_real(&f->r, what, value));
  past_comma(f);
  return COROT_OK;
}

static corot_status end_of_text(corot_feb *f, const char *what, int64_t tag) {
  if (!corot_feb_more(f)) return COROT_OK;
  return corot_reader_fail(&f->r, f->r.at, "%s %lld has more numbers than it should", what,
                           (long long)tag);
}

static corot_status read_id(const corot_feb *f, const corot_xml_tag *tag, int64_t *id) {
  COROT_TRY(corot_xml_number(&f->r, tag, "id", -1, id));
  if (*id < 0) return corot_reader_fail(&f->r, tag->at, "<%s> has no id", tag->name);
  return COROT_OK;
}

/* --- What stands in a section --- */

/* The section that is being read. */
typedef struct section {
  const char *word; /* NULL: none of those that matter */
  corot_status (*read)(corot_feb *f, const struct section *s, const corot_xml_tag *tag);
  int name;
  corot_feb_element like; /* of elements: their type */
} section;

static corot_status read_node(corot_feb *f, const section *s, const corot_xml_tag *tag) {
  corot_draft_node node = {.at = tag->at};
  double x[3];
  static const char *const what[3] = {"x", "y", "z"};
  (void)s;
  if (strcmp(tag->name, "node") != 0) return COROT_OK;
  COROT_TRY(read_id(f, tag, &node.tag));
  for (int k = 0; k < 3; k++) COROT_TRY(read_real(f, what[k], &x[k]));
  COROT_TRY(end_of_text(f, "node", node.tag));
  return corot_draft_add_node(&f->d, node, x);
}

static corot_status add_row(corot_feb_element **row, size_t *n, size_t *room,
                            const corot_feb_element *e) {
  void *items = *row;
  COROT_TRY(corot_make_room(&items, *n, room, sizeof *e));
  *row = items;
  (*row)[(*n)++] = *e;
  return COROT_OK;
}

static corot_status read_nodes_of(corot_feb *f, const corot_xml_tag *tag, corot_feb_element *e) {
  e->at = tag->at;
  COROT_TRY(read_id(f, tag, &e->tag));
  if (!e->dim) return COROT_OK;
  for (int k = 0; k < e->nnode; k++) COROT_TRY(corot_feb_long(f, "a node", &e->node[k]));
  return COROT_OK;
}

static corot_status read_element(corot_feb *f, const section *s, const corot_xml_tag *tag) {
  corot_feb_element e = s->like;
  if (strcmp(tag->name, "elem") != 0) return COROT_OK;
  COROT_TRY(read_nodes_of(f, tag, &e));
  if (e.dim) COROT_TRY(end_of_text(f, "element", e.tag));
  return add_row(&f->element, &f->nelement, &f->element_room, &e);
}

/* A face; of those with more nodes than corners and edges, and of quads, the corners. */
static corot_status read_face(corot_feb *f, const section *s, const corot_xml_tag *tag) {
  static const struct {
    const char *name;
    int nnode;
    corot_draft_kind kind;
  } types[] = {{"tri3", 3, DRAFT_SIMPLEX},  {"tri6", 6, DRAFT_SIMPLEX}, {"tri7", 6, DRAFT_SIMPLEX},
               {"tri10", 3, DRAFT_SIMPLEX}, {"quad4", 4, DRAFT_QUAD},   {"quad8", 4, DRAFT_QUAD},
               {"quad9", 4, DRAFT_QUAD}};
  for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
    corot_feb_element e = {
        .dim = 2, .kind = types[i].kind, .nnode = types[i].nnode, .name = s->name};
    if (strcmp(tag->name, types[i].name) != 0) continue;
    COROT_TRY(read_nodes_of(f, tag, &e));
    return add_row(&f->face, &f->nface, &f->face_room, &e);
  }
  return corot_reader_fail(&f->r, tag->at,
                           "<%s> in a <Surface> is not supported: its faces must be listed, as "
                           "tri3, tri6 or quad4",
                           tag->name);
}

/* A member of a set, one tag each, as formats 2.5 and 3.0 have it. */
static corot_status read_member(corot_feb *f, const section *s, const corot_xml_tag *tag) {
  corot_feb_item item = {.name = s->name, .at = tag->at, .step = 1};
  bool nodes = strcmp(s->word, "NodeSet") == 0;
  item.of = nodes ? FEB_NODES : FEB_ELEMENTS;
  const char *words[2] = {nodes ? "node" : "elem", nodes ? "n" : "e"};
  if (strcmp(tag->name, words[0]) != 0 && strcmp(tag->name, words[1]) != 0)
    return corot_reader_fail(&f->r, tag->at,
                             "<%s> in a <%s> is not supported: its members must be listed",
                             tag->name, s->word);
  COROT_TRY(read_id(f, tag, &item.first));
  item.last = item.first;
  return corot_feb_add_item(f, item);
}

/* --- Sections --- */

static char small(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + 32) : c; }

/* Whether a type begins with a word, in capitals or not; *rest is what is behind it. */
static bool begins(const char *type, const char *word, const char **rest) {
  for (; *word; word++, type++)
    if (small(*type) != *word) return false;
  *rest = type;
  return true;
}

/* The type of the elements of a section: a name, and perhaps the rule of integration, as in
   TET10G4. */
static corot_status find_type(const corot_feb *f, const corot_xml_tag *tag, corot_feb_element *e) {
  static const struct {
    const char *name;
    int nnode;
    corot_draft_kind kind;
  } solids[] = {{"tet4", 4, DRAFT_SIMPLEX},   {"ut4", 4, DRAFT_SIMPLEX},
                {"tet10", 10, DRAFT_SIMPLEX}, {"hex8", 8, DRAFT_HEX},
                {"penta6", 6, DRAFT_PRISM},   {"pyra5", 5, DRAFT_PYRAMID}};
  static const char *const others[] = {"tri", "quad", "q4", "truss", "line", "beam"};
  const char *rest;
  char type[32];
  corot_xml_attribute(&f->r, tag, "type", sizeof type, type);
  for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
    if (begins(type, solids[i].name, &rest) && (!*rest || small(*rest) == 'g')) {
      *e = (corot_feb_element){.dim = 3, .nnode = solids[i].nnode, .kind = solids[i].kind};
      return COROT_OK;
    }
  *e = (corot_feb_element){0};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    if (begins(type, others[i], &rest)) return COROT_OK;
  return corot_reader_fail(&f->r, tag->at,
                           "elements of type '%s': only tet4 and tet10 are supported, and hex8, "
                           "penta6 and pyra5, to be cut into tets",
                           type);
}

/* The name of a section's group; of elements without one, their material's number. */
static corot_status read_name(corot_feb *f, const corot_xml_tag *tag, bool elements, int *name) {
  char text[COROT_GROUP_NAME_MAX + 2], material[40];
  corot_xml_attribute(&f->r, tag, "name", sizeof text, text);
  if (!*text && elements) corot_xml_attribute(&f->r, tag, "elset", sizeof text, text);
  if (!*text && elements && corot_xml_attribute(&f->r, tag, "mat", sizeof material, material))
    snprintf(text, sizeof text, "material-%s", material);
  return corot_feb_add_name(f, tag, text, name);
}

static corot_status refuse_part(const corot_feb *f, const corot_xml_tag *tag) {
  return corot_reader_fail(&f->r, tag->at,
                           "the mesh is made of parts and instances of them: write it out as one, "
                           "with Nodes and Elements alone");
}

static corot_status refuse_other_file(const corot_feb *f, const corot_xml_tag *tag) {
  char file[200];
  if (!corot_xml_attribute(&f->r, tag, "from", sizeof file, file)) return COROT_OK;
  return corot_reader_fail(&f->r, tag->at, "the mesh is in another file: read %s", file);
}

/* The nodes of a section that has a name are a set of that name. */
static corot_status end_section(corot_feb *f, const section *s, int first) {
  const corot_feb_item item = {.name = s->name,
                               .of = FEB_NODES,
                               .by_index = true,
                               .first = first,
                               .last = f->d.nnode - 1,
                               .step = 1};
  if (!s->word || strcmp(s->word, "Nodes") != 0 || s->name == 0) return COROT_OK;
  return corot_feb_add_item(f, item);
}

/* A tag between sections may begin one. */
static corot_status begin_section(corot_feb *f, const corot_xml_tag *tag, section *s) {
  static const section sections[] = {{.word = "Nodes", .read = read_node},
                                     {.word = "Elements", .read = read_element},
                                     {.word = "Surface", .read = read_face},
                                     {.word = "NodeSet", .read = read_member},
                                     {.word = "ElementSet", .read = read_member}};
  if (strcmp(tag->name, "Part") == 0 || strcmp(tag->name, "Instance") == 0)
    return refuse_part(f, tag);
  for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
    if (strcmp(tag->name, sections[i].word) != 0) continue;
    section new = sections[i];
    bool elements = new.read == read_element;
    COROT_TRY(refuse_other_file(f, tag));
    if (elements) COROT_TRY(find_type(f, tag, &new.like));
    COROT_TRY(read_name(f, tag, elements, &new.name));
    new.like.name = new.name;
    if (new.read == read_member &&new.name == 0)
      return corot_reader_fail(&f->r, tag->at, "<%s> has no name", tag->name);
    if (!tag->closes) *s = new;
    if (new.read == read_member && !tag->closes)
      return corot_feb_read_list(f, strcmp(new.word, "NodeSet") == 0 ? FEB_NODES : FEB_ELEMENTS,
                                 new.name);
    return COROT_OK;
  }
  return COROT_OK;
}

static bool is_mesh(const corot_xml_tag *tag) {
  return strcmp(tag->name, "Geometry") == 0 || strcmp(tag->name, "Mesh") == 0;
}

static corot_status read_tags(corot_feb *f) {
  corot_xml_tag tag;
  section s = {0};
  bool found = true, inside = false;
  int first = 0;
  for (;;) {
    COROT_TRY(corot_xml_next(&f->r, &tag, &found));
    if (!found) return COROT_OK;
    if (is_mesh(&tag)) {
      inside = tag.opens && !tag.closes;
      if (tag.opens) COROT_TRY(refuse_other_file(f, &tag));
    } else if (inside && s.word && tag.closes && strcmp(tag.name, s.word) == 0) {
      COROT_TRY(end_section(f, &s, first));
      s = (section){0};
    } else if (inside && s.word && tag.opens) {
      COROT_TRY(s.read(f, &s, &tag));
    } else if (inside && !s.word && tag.opens) {
      first = f->d.nnode;
      COROT_TRY(begin_section(f, &tag, &s));
    }
  }
}

/* The nodes of all elements are known by now: solids go into the draft. */
static corot_status add_solids(corot_feb *f) {
  for (size_t i = 0; i < f->nelement; i++) {
    corot_feb_element *e = &f->element[i];
    corot_draft_element t = {.tag = e->tag, .at = e->at, .dim = 3, .kind = e->kind};
    int middle[NMIDDLE_MAX];
    if (!e->dim) continue;
    for (int k = 0; k < e->nnode; k++)
      corot_draft_find_node(&f->d, &t, e->node[k], corot_draft_slot(&t, middle, k));
    COROT_TRY(corot_draft_add_element(&f->d, &t, e->nnode > 4 ? middle : NULL));
    e->index = (int)f->d.nelement - 1;
    COROT_TRY(corot_draft_add_member(&f->d, e->index, e->name));
  }
  return COROT_OK;
}

static corot_status parse(corot_feb *f, corot_mesh **mesh) {
  COROT_TRY(read_tags(f));
  if (f->d.nnode == 0)
    return corot_fail(COROT_EFORMAT, "%s: the file has no Nodes in a Mesh or Geometry", f->r.path);
  COROT_TRY(corot_draft_index_nodes(&f->d));
  COROT_TRY(add_solids(f));
  if (f->d.nelement == 0)
    return corot_fail(COROT_EFORMAT, "%s: the file has no Elements of type tet4 or tet10",
                      f->r.path);
  COROT_TRY(corot_feb_groups(f));
  return corot_draft_finish(&f->d, mesh);
}

corot_status corot_feb_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh) {
  corot_feb f = {.r = {.path = path,
                       .data = data,
                       .size = size,
                       .separator = ',',
                       .stops = "<:",
                       .flows = true}};
  f.d.how = how;
  f.d.node_file = f.d.element_file = f.d.face_file = &f.r;
  f.d.raises = true;
  corot_status status = corot_draft_end(&f.d, parse(&f, mesh));
  corot_draft_clear(&f.d);
  free(f.element);
  free(f.face);
  free(f.name);
  free(f.item);
  return status;
}
