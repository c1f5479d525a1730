/* Abaqus' and CalculiX' .inp: keywords with parameters, and lines of data behind them. */
#include "mesh_inp.h"

#include <stdio.h>
#include <string.h>

#include "mesh_read.h"

const char *corot_inp_param(const corot_inp *f, const char *key) {
  for (int i = 0; i < f->k.nparam; i++)
    if (strcmp(f->k.param[i].key, key) == 0) return f->k.param[i].value;
  return NULL;
}

/* Goes past blank lines and comments, from the beginning of a line. */
static void skip_comments(corot_reader *r) {
  corot_reader_skip_lines(r);
  while (r->data[r->at] == '*' && r->data[r->at + 1] == '*') {
    corot_reader_skip_line(r);
    corot_reader_skip_lines(r);
  }
}

bool corot_inp_next_line(corot_inp *f) {
  corot_reader_skip_line(&f->r);
  skip_comments(&f->r);
  return f->r.at < f->r.size && f->r.data[f->r.at] != '*';
}

corot_status corot_inp_long(corot_inp *f, const char *what, int64_t *value) {
  corot_reader *r = &f->r;
  if (!corot_reader_more(r) && !corot_inp_next_line(f))
    return corot_reader_fail(r, r->at, "expected %s, found the end of the data", what);
  COROT_TRY(corot_reader_long(r, what, value));
  if (!corot_reader_separator(r) && corot_reader_more(r))
    return corot_reader_fail(r, r->at, "expected a comma");
  return COROT_OK;
}

/* A coordinate, which may be missing: then it is 0. */
static corot_status read_real(corot_inp *f, const char *what, double *value) {
  corot_reader *r = &f->r;
  *value = 0;
  if (corot_reader_separator(r) || !corot_reader_more(r)) return COROT_OK;
  COROT_TRY(corot_reader_real(r, what, value));
  if (!corot_reader_separator(r) && corot_reader_more(r))
    return corot_reader_fail(r, r->at, "expected a comma");
  return COROT_OK;
}

/* --- keywords --- */

static char capital(char c) { return c >= 'a' && c <= 'z' ? (char)(c - 32) : c; }

/* The text from `p` to `end` in capitals, several blanks being one, cut at `size`. */
static void copy_word(const char *p, const char *end, char *word, size_t size) {
  size_t n = 0;
  for (; p < end && n + 1 < size; p++)
    if ((*p != ' ' && *p != '\t') || (n > 0 && word[n - 1] != ' '))
      word[n++] = *p == '\t' ? ' ' : capital(*p);
  while (n > 0 && word[n - 1] == ' ') n--;
  word[n] = 0;
}

/* Without blanks and quotes around it. COROT_EFORMAT: it is too long for a name. */
static corot_status copy_value(const corot_inp *f, const char *p, const char *end, char *value) {
  while (p < end && strchr(" \t\"", *p)) p++;
  while (end > p && strchr(" \t\r\"", end[-1])) end--;
  size_t n = (size_t)(end - p);
  if (n > COROT_GROUP_NAME_MAX)
    return corot_reader_fail(&f->r, f->k.at, "a name has %zu bytes, at most %d are allowed", n,
                             COROT_GROUP_NAME_MAX);
  memcpy(value, p, n);
  value[n] = 0;
  return COROT_OK;
}

/* One of the parts between commas: the word first, then parameters. */
static corot_status take_part(corot_inp *f, const char *p, const char *end, bool first) {
  corot_inp_keyword *k = &f->k;
  const char *equals = memchr(p, '=', (size_t)(end - p));
  while (end > p && strchr(" \t\r\n", end[-1])) end--;
  if (first) copy_word(p, end, k->word, sizeof k->word);
  if (first || p == end || k->nparam == sizeof k->param / sizeof *k->param) return COROT_OK;
  int i = k->nparam++;
  copy_word(p, equals ? equals : end, k->param[i].key, sizeof k->param[i].key);
  k->param[i].value[0] = 0;
  return equals ? copy_value(f, equals + 1, end, k->param[i].value) : COROT_OK;
}

/* The line of a keyword, which a comma at its end continues; then to the next line. */
static corot_status read_keyword(corot_inp *f) {
  corot_reader *r = &f->r;
  bool first = true, more = true;
  f->k = (corot_inp_keyword){.at = r->at++};
  while (more) {
    const char *p = r->data + r->at, *end = p;
    while (end < r->data + r->size && *end != ',' && *end != '\n') end++;
    more = *end == ',';
    COROT_TRY(take_part(f, p, end, first));
    first = false;
    r->at = (size_t)(end - r->data) + (more ? 1 : 0);
    if (more && !corot_reader_more(r)) corot_reader_skip_line(r);
  }
  return COROT_OK;
}

/* --- nodes and elements --- */

static corot_status read_nodes(corot_inp *f) {
  static const char *const name[3] = {"x", "y", "z"};
  corot_inp_item item = {
      .kind = INP_NODES, .other = -1, .by_index = true, .step = 1, .at = f->k.at};
  const char *system = corot_inp_param(f, "SYSTEM"), *set = corot_inp_param(f, "NSET");
  item.first = f->d.nnode;
  if (system && *system && !corot_inp_same(system, "R"))
    return corot_reader_fail(&f->r, f->k.at, "coordinates of SYSTEM=%s are not supported", system);
  while (corot_inp_next_line(f)) {
    corot_draft_node node = {.at = f->r.at};
    double x[3];
    COROT_TRY(corot_inp_long(f, "a node", &node.tag));
    for (int k = 0; k < 3; k++) COROT_TRY(read_real(f, name[k], &x[k]));
    COROT_TRY(corot_draft_add_node(&f->d, node, x));
  }
  item.last = f->d.nnode - 1;
  return set && *set ? corot_inp_add(f, set, item) : COROT_OK;
}

/* Types of elements that are no solids: triangles, quads. */
static const struct {
  const char *name;
  int nnode;
} surfaces[] = {
    {"S4", 4},     {"S4R", 4},    {"S4RS", 4},   {"S4R5", 4},   {"DS4", 4},   {"CPS4", 4},
    {"CPE4", 4},   {"CAX4", 4},   {"CPS4R", 4},  {"CPE4R", 4},  {"CAX4R", 4}, {"M3D4", 4},
    {"M3D4R", 4},  {"R3D4", 4},   {"SFM3D4", 4}, {"S3", 3},     {"S3R", 3},   {"STRI3", 3},
    {"DS3", 3},    {"CPS3", 3},   {"CPE3", 3},   {"CAX3", 3},   {"M3D3", 3},  {"R3D3", 3},
    {"SFM3D3", 3}, {"CPS6", 6},   {"CPE6", 6},   {"CAX6", 6},   {"S6", 6},    {"DS6", 6},
    {"M3D6", 6},   {"STRI65", 6}, {"CPS6M", 6},  {"SFM3D6", 6},
};

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Solids. */
static const struct {
  const char *name;
  int nnode;
  corot_draft_kind kind;
} solids[] = {
    {"C3D4", 4, DRAFT_SIMPLEX}, {"C3D10", 10, DRAFT_SIMPLEX}, {"C3D5", 5, DRAFT_PYRAMID},
    {"C3D6", 6, DRAFT_PRISM},   {"C3D8", 8, DRAFT_HEX},
};

/* Dimension, kind and number of nodes of a type, which go into `e`; dimension 0: it is left out. */
static corot_status find_type(const corot_inp *f, const char *type, corot_inp_element *e) {
  char name[16];
  copy_word(type, type + strlen(type), name, sizeof name);
  const char *solid = strncmp(name, "DC3D", 4) == 0 ? name + 1 : name;
  *e = (corot_inp_element){0};
  for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
    size_t n = strlen(solids[i].name);
    if (strncmp(solid, solids[i].name, n) == 0 && !is_digit(solid[n]))
      *e = (corot_inp_element){.dim = 3, .nnode = solids[i].nnode, .kind = solids[i].kind};
  }
  for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces && !e->dim; i++)
    if (strcmp(surfaces[i].name, name) == 0)
      *e = (corot_inp_element){.dim = 2,
                               .nnode = surfaces[i].nnode,
                               .kind = surfaces[i].nnode == 4 ? DRAFT_QUAD : DRAFT_SIMPLEX};
  if (!e->dim && (strncmp(solid, "C3D", 3) == 0 || strncmp(name, "SC", 2) == 0))
    return corot_reader_fail(
        &f->r, f->k.at,
        "elements of type %s: only C3D4 and C3D10 are supported, and C3D5, C3D6 "
        "and C3D8, to be cut into tets",
        name);
  return COROT_OK;
}

static corot_status add_element(corot_inp *f, const corot_inp_element *e) {
  void *items = f->element;
  COROT_TRY(corot_make_room(&items, f->nelement, &f->element_room, sizeof *e));
  f->element = items;
  f->element[f->nelement++] = *e;
  return COROT_OK;
}

static corot_status read_elements(corot_inp *f) {
  corot_inp_item item = {
      .kind = INP_ELEMENTS, .other = -1, .by_index = true, .step = 1, .at = f->k.at};
  const char *type = corot_inp_param(f, "TYPE"), *set = corot_inp_param(f, "ELSET");
  corot_inp_element e;
  if (!type || !*type)
    return corot_reader_fail(&f->r, f->k.at, "*ELEMENT has no TYPE, as in TYPE=C3D10");
  COROT_TRY(find_type(f, type, &e));
  item.first = (int64_t)f->nelement;
  while (corot_inp_next_line(f)) {
    if (!e.dim) continue;
    e.at = f->r.at;
    COROT_TRY(corot_inp_long(f, "an element", &e.tag));
    for (int k = 0; k < e.nnode; k++) COROT_TRY(corot_inp_long(f, "a node", &e.node[k]));
    if (corot_reader_more(&f->r))
      return corot_reader_fail(&f->r, f->r.at, "element %lld has more than %d nodes",
                               (long long)e.tag, e.nnode);
    COROT_TRY(add_element(f, &e));
  }
  item.last = (int64_t)f->nelement - 1;
  return set && *set ? corot_inp_add(f, set, item) : COROT_OK;
}

/* --- parts --- */

static corot_status read_part(corot_inp *f) {
  if (f->has_part)
    return corot_reader_fail(&f->r, f->k.at,
                             "a second part: only one is supported, or a file without parts");
  f->has_part = true;
  while (corot_inp_next_line(f)) continue;
  return COROT_OK;
}

/* An instance that is moved or turned has lines of data. */
static corot_status read_instance(corot_inp *f) {
  const char *name = corot_inp_param(f, "NAME");
  if (f->instance[0])
    return corot_reader_fail(&f->r, f->k.at,
                             "a second instance: only one is supported, or a file without parts");
  strcpy(f->instance, name && *name ? name : "?");
  while (corot_inp_next_line(f)) {
    double move;
    while (corot_reader_more(&f->r)) {
      size_t at = f->r.at;
      COROT_TRY(read_real(f, "a number", &move));
      if (move != 0)
        return corot_reader_fail(&f->r, at, "the instance is moved: write a file without parts");
    }
  }
  return COROT_OK;
}

static corot_status refuse_generated(corot_inp *f) {
  return corot_reader_fail(
      &f->r, f->k.at, "*%s makes nodes or elements: let them be written out instead", f->k.word);
}

static corot_status read_nset(corot_inp *f) { return corot_inp_read_set(f, INP_NODES); }

static corot_status read_elset(corot_inp *f) { return corot_inp_read_set(f, INP_ELEMENTS); }

static const struct {
  const char *word;
  corot_status (*read)(corot_inp *f);
} keywords[] = {
    {"NODE", read_nodes},         {"ELEMENT", read_elements},          {"NSET", read_nset},
    {"ELSET", read_elset},        {"SURFACE", corot_inp_read_surface}, {"PART", read_part},
    {"INSTANCE", read_instance},  {"NGEN", refuse_generated},          {"NFILL", refuse_generated},
    {"NCOPY", refuse_generated},  {"NMAP", refuse_generated},          {"ELGEN", refuse_generated},
    {"ELCOPY", refuse_generated},
};

static corot_status read_block(corot_inp *f) {
  COROT_TRY(read_keyword(f));
  for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
    if (strcmp(keywords[i].word, f->k.word) == 0) return keywords[i].read(f);
  while (corot_inp_next_line(f)) continue;
  return COROT_OK;
}

/* The nodes of all elements are known by now: tets go into the draft. */
static corot_status add_tets(corot_inp *f) {
  for (size_t i = 0; i < f->nelement; i++) {
    corot_inp_element *e = &f->element[i];
    corot_draft_element t = {.tag = e->tag, .at = e->at, .dim = 3, .kind = e->kind};
    int middle[NMIDDLE_MAX];
    if (e->dim != 3) continue;
    for (int k = 0; k < e->nnode; k++)
      corot_draft_find_node(&f->d, &t, e->node[k], corot_draft_slot(&t, middle, k));
    COROT_TRY(corot_draft_add_element(&f->d, &t, e->nnode > 4 ? middle : NULL));
    e->index = (int)f->d.nelement - 1;
  }
  return COROT_OK;
}

static corot_status parse(corot_inp *f, corot_mesh **mesh) {
  corot_reader *r = &f->r;
  skip_comments(r);
  while (r->at < r->size) {
    if (r->data[r->at] != '*') return corot_reader_fail(r, r->at, "expected a keyword, as *NODE");
    COROT_TRY(read_block(f));
  }
  if (f->d.nnode == 0) return corot_fail(COROT_EFORMAT, "%s: the file has no *NODE", r->path);
  COROT_TRY(corot_draft_index_nodes(&f->d));
  COROT_TRY(add_tets(f));
  if (f->d.nelement == 0)
    return corot_fail(COROT_EFORMAT, "%s: the file has no *ELEMENT of type C3D4 or C3D10", r->path);
  COROT_TRY(corot_inp_groups(f));
  return corot_draft_finish(&f->d, mesh);
}

corot_status corot_inp_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh) {
  corot_inp_text text = {0};
  corot_inp f = {0};
  corot_status status = corot_inp_expand(path, data, size, &text);
  f.r = (corot_reader){.path = path, .data = text.data, .size = text.size, .separator = ','};
  f.r.npiece = text.npiece, f.r.piece = text.piece;
  f.d.how = how;
  f.d.node_file = f.d.element_file = &f.r;
  f.d.raises = true;
  if (!status) status = corot_draft_end(&f.d, parse(&f, mesh));
  corot_draft_clear(&f.d);
  free(f.element);
  free(f.name);
  free(f.item);
  corot_inp_text_clear(&text);
  return status;
}
