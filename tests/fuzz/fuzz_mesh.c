/* Mesh files of any content: no crash, and what is accepted is sound. What is of no format that
   shows in its content is a TetGen .node file, a 0 byte, a .ele file, and perhaps another 0 byte
   and a .face file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/mesh/read/mesh_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The bytes and a 0, in a block of just that size. */
static char *copy(const uint8_t *data, size_t size) {
  char *p = malloc(size + 1);
  if (!p) abort();
  if (size) memcpy(p, data, size);
  p[size] = 0;
  return p;
}

static void require(bool condition, const char *what) {
  if (condition) return;
  fprintf(stderr, "%s: %s\n", what, corot_error());
  abort();
}

static void require_ascending(int n, const int *a, int end, const char *what) {
  for (int i = 0; i < n; i++) require(a[i] >= 0 && a[i] < end && (i == 0 || a[i] > a[i - 1]), what);
}

/* The same tets by hand. */
static corot_status make_again(const corot_mesh *m, corot_mesh **again) {
  const double(*x)[3] = (const double(*)[3])m->x;
  if (!m->mid) return corot_mesh_create(m->nnode, x, m->ntet, (const int(*)[4])m->tet, again);
  int(*tet)[10] = malloc((size_t)m->ntet * sizeof *tet);
  if (!tet) abort();
  for (int e = 0; e < m->ntet; e++) {
    memcpy(tet[e], m->tet[e], sizeof *m->tet);
    memcpy(tet[e] + 4, m->mid[e], sizeof *m->mid);
  }
  corot_status status =
      corot_mesh_create_order_2(m->nnode, x, m->ntet, (const int(*)[10])tet, again);
  free(tet);
  return status;
}

/* Either order can be made the other; what cannot be raised is at the limit of what is flat. */
static void require_other_order(const corot_mesh *m) {
  corot_mesh *other = NULL;
  corot_status status = corot_mesh_change_order(m, 3 - corot_mesh_order(m), &other);
  require(status == COROT_OK || (status == COROT_EINVAL && !m->mid), "no mesh of the other order");
  if (status == COROT_OK) require(corot_mesh_order(other) != corot_mesh_order(m), "the same order");
  corot_mesh_destroy(other);
}

static void require_sound(const corot_mesh *m) {
  corot_mesh *again;
  require(make_again(m, &again) == COROT_OK, "an unsound mesh");
  corot_mesh_destroy(again);
  require_other_order(m);
  for (int g = 0; g < m->ngroup; g++) {
    const corot_group *p = &m->group[g];
    require(p->nnode > 0, "an empty group");
    require(corot_mesh_find_group(m, p->name) == p, "a repeated name");
    require_ascending(p->nnode, p->node, m->nnode, "a group's nodes");
    require_ascending(p->ntet, p->tet, m->ntet, "a group's tets");
    for (int i = 0; i < 3 * p->ntri; i++)
      require(p->tri[i / 3][i % 3] >= 0 && p->tri[i / 3][i % 3] < m->nnode, "a group's triangles");
  }
  require(corot_mesh_measure(m).volume > 0, "no volume");
}

/* Of texts with a 0 byte between them, what is behind the next one: NULL if there is none. */
static const uint8_t *rest_of(const uint8_t *data, const uint8_t *end) {
  const uint8_t *zero = data < end ? memchr(data, 0, (size_t)(end - data)) : NULL;
  return zero ? zero + 1 : NULL;
}

static corot_status parse_tetgen(const uint8_t *data, size_t size, corot_mesh **m) {
  const uint8_t *end = data + size, *ele = rest_of(data, end), *face = ele ? rest_of(ele, end) : 0;
  size_t nnode = ele ? (size_t)(ele - data) - 1 : size,
         nele = !ele ? 0 : (size_t)((face ? face - 1 : end) - ele),
         nface = face ? (size_t)(end - face) : 0;
  char *text[] = {copy(data, nnode), copy(ele, nele), copy(face, nface)};
  const corot_mesh_text n = {"fuzz.node", text[0], nnode}, e = {"fuzz.ele", text[1], nele},
                        f = {"fuzz.face", text[2], nface};
  corot_status status = corot_tetgen_parse(&n, &e, face ? &f : NULL, NULL, m);
  for (int i = 0; i < 3; i++) free(text[i]);
  return status;
}

/* What is sound is what it was; what is not may be mended, and is sound then. */
static void mend(const char *text, size_t size, const corot_mesh *sound) {
  corot_mesh_report report = {0};
  const corot_reading how = {
      .mends = true, .cuts = true, .merge = sound ? 0 : 1e-3, .report = &report};
  corot_mesh *m = NULL;
  corot_status status = corot_mesh_parse("fuzz", text, size, &how, &m);
  if (sound)
    require(status == COROT_OK && report.nremark == 0 && m->ntet == sound->ntet,
            "mended what was sound");
  if (status == COROT_OK)
    require_sound(m);
  else
    require(status == COROT_EFORMAT && !m && *corot_error(), "not a clean failure");
  corot_mesh_destroy(m);
  for (int i = 0; i < report.nremark; i++) free(report.remark[i].text);
  free(report.remark);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  corot_mesh *m = NULL;
  corot_status status;
  char *text = copy(data, size);
  status = corot_mesh_parse("fuzz", text, size, NULL, &m);
  char *told = copy((const uint8_t *)corot_error(), strlen(corot_error()));
  mend(text, size, m);
  free(text);
  if (status && (strstr(told, "not a mesh file") || strstr(told, "is empty")))
    status = parse_tetgen(data, size, &m);
  free(told);
  if (status == COROT_OK)
    require_sound(m);
  else
    require(status == COROT_EFORMAT && !m && *corot_error(), "not a clean failure");
  corot_mesh_destroy(m);
  return 0;
}
