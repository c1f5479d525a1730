/* Hexahedra, prisms and pyramids cut into tets, and quads into triangles, so that neighbours match
   (Dompierre, Labbe, Vallet, Camarero 1999): each quad is cut by the diagonal from its corner of
   the lowest number, which both solids at it find the same. A solid is the cone from its own such
   corner over the faces that do not have it, these being cut in that way. */
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "mesh_draft.h"

/* The faces of a solid, winding outward; -1 ends a triangle. */
static const struct {
  int nface;
  int face[6][4];
} shapes[DRAFT_KINDS] = {
    [DRAFT_PYRAMID] = {5,
                       {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}},
    [DRAFT_PRISM] = {5, {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
    [DRAFT_HEX] =
        {6, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
};

static const char *const words[DRAFT_KINDS][2] = {
    [DRAFT_PYRAMID] = {"pyramid", "pyramids"},
    [DRAFT_PRISM] = {"prism", "prisms"},
    [DRAFT_HEX] = {"hexahedron", "hexahedra"},
};

/* What an element becomes: tets, or triangles. */
typedef struct parts {
  int n;
  int node[6][4];
} parts;

static void add_part(parts *p, int n, const int *v) {
  for (int i = 1; i < n; i++)
    for (int j = 0; j < i; j++)
      if (v[i] == v[j]) return; /* the solid has this corner twice: nothing is there */
  memcpy(p->node[p->n++], v, (size_t)n * sizeof *v);
}

/* The corners of a quad from the one of the lowest number on. */
static void begin_at_lowest(const int quad[4], int v[4]) {
  int low = 0;
  for (int k = 1; k < 4; k++)
    if (quad[k] < quad[low]) low = k;
  for (int k = 0; k < 4; k++) v[k] = quad[(low + k) % 4];
}

static void cut_quad(const int quad[4], parts *p) {
  int v[4];
  begin_at_lowest(quad, v);
  add_part(p, 3, (int[]){v[0], v[1], v[2]});
  add_part(p, 3, (int[]){v[0], v[2], v[3]});
}

/* The tets over a face, which winds outward as seen from `top`. */
static void add_cone(const int face[4], int n, int top, parts *p) {
  int v[4];
  for (int k = 0; k < n; k++)
    if (face[k] == top) return;
  if (n == 3) {
    add_part(p, 4, (int[]){face[0], face[2], face[1], top});
    return;
  }
  begin_at_lowest(face, v);
  add_part(p, 4, (int[]){v[0], v[2], v[1], top});
  add_part(p, 4, (int[]){v[0], v[3], v[2], top});
}

static void cut_solid(corot_draft_kind kind, const int *corner, int ncorner, parts *p) {
  int top = corner[0];
  for (int k = 1; k < ncorner; k++)
    if (corner[k] < top) top = corner[k];
  for (int f = 0; f < shapes[kind].nface; f++) {
    int face[4], n = 0;
    for (; n < 4 && shapes[kind].face[f][n] >= 0; n++) face[n] = corner[shapes[kind].face[f][n]];
    add_cone(face, n, top, p);
  }
}

/* Formats differ in the hand of a prism: all tets of a solid that is left-handed are turned. One
   that has tets of both hands is noted. */
static void turn_parts(corot_draft *d, const corot_draft_element *e, parts *p) {
  const double(*x)[3] = (const double(*)[3])d->x;
  int nleft = 0;
  for (int i = 0; i < p->n; i++) nleft += corot_tet_volume(x, p->node[i]) < 0;
  if (nleft == 0) return;
  for (int i = 0; i < p->n && nleft == p->n; i++) {
    int swap = p->node[i][0];
    p->node[i][0] = p->node[i][1];
    p->node[i][1] = swap;
  }
  if (nleft == p->n) return;
  corot_draft_note(d, d->element_file, e->at,
                   "element %lld is a %s that is folded: %d of the %d tets that it is cut into "
                   "are left-handed",
                   (long long)e->tag, words[e->kind][0], nleft, p->n);
  p->n = 0;
}

/* Remembers the quads of a solid, but those that have a corner twice. */
static corot_status add_quads(corot_draft *d, const corot_draft_element *e, const int *corner) {
  for (int f = 0; f < shapes[e->kind].nface; f++) {
    const int *local = shapes[e->kind].face[f];
    corot_draft_quad q = {.tag = e->tag, .at = e->at};
    void *items = d->quad;
    parts halves = {0};
    if (local[3] < 0) continue;
    const int face[4] = {corner[local[0]], corner[local[1]], corner[local[2]], corner[local[3]]};
    cut_quad(face, &halves);
    if (halves.n < 2) continue;
    begin_at_lowest(face, q.v);
    COROT_TRY(corot_make_room(&items, d->nquad, &d->quad_room, sizeof q));
    d->quad = items;
    d->quad[d->nquad++] = q;
  }
  return COROT_OK;
}

void corot_draft_match_quads(corot_draft *d, int nface, const corot_face *face) {
  for (size_t i = 0; i < d->nquad; i++) {
    const corot_draft_quad *q = &d->quad[i];
    const int *v = q->v;
    if (corot_face_find(nface, face, (int[]){v[1], v[2], v[3]}) < 0 &&
        corot_face_find(nface, face, (int[]){v[3], v[0], v[1]}) < 0)
      continue;
    corot_draft_note(d, d->element_file, q->at,
                     "element %lld: tets at its face %lld %lld %lld %lld have the other diagonal: "
                     "they do not match without pyramids between",
                     (long long)q->tag, (long long)d->node[v[0]].tag, (long long)d->node[v[1]].tag,
                     (long long)d->node[v[2]].tag, (long long)d->node[v[3]].tag);
  }
}

static corot_status cut_element(corot_draft *d, const corot_draft_element *e, parts *p) {
  int corner[8] = {0}, n = corot_draft_ncorner(e);
  p->n = 0;
  if (corot_draft_is_broken(d, e)) return COROT_OK;
  for (int k = 0; k < n; k++) corner[k] = k < 4 ? e->node[k] : d->middle[e->middle - 1 + k - 4];
  if (e->kind == DRAFT_QUAD) {
    cut_quad(corner, p);
    return COROT_OK;
  }
  cut_solid(e->kind, corner, n, p);
  if (p->n > 0)
    turn_parts(d, e, p);
  else
    corot_draft_note(d, d->element_file, e->at, "element %lld is a %s of too few different corners",
                     (long long)e->tag, words[e->kind][0]);
  return p->n > 0 ? add_quads(d, e, corner) : COROT_OK;
}

/* --- Counts --- */

/* A solid by its corners, ascending; -1 where it has fewer. */
typedef struct solid {
  int v[8], element;
} solid;

static int compare_ints(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

static int compare_solids(const void *a, const void *b) {
  const solid *p = a, *q = b;
  for (int i = 0; i < 8; i++)
    if (p->v[i] != q->v[i]) return p->v[i] < q->v[i] ? -1 : 1;
  return (p->element > q->element) - (p->element < q->element);
}

static bool is_same_solid(const solid *a, const solid *b) {
  return memcmp(a->v, b->v, sizeof a->v) == 0;
}

/* Solids of each kind, those that a file repeats for each of their groups being one; once
   [nelement] is whether an element is the first of these. */
static corot_status count_once(const corot_draft *d, size_t nsolid[DRAFT_KINDS], char *once) {
  solid *s;
  size_t n = 0;
  COROT_TRY(COROT_ALLOC(s, d->nelement));
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    int ncorner = corot_draft_ncorner(e);
    if (e->dim != 3) continue;
    s[n].element = (int)i;
    for (int k = 0; k < 8; k++)
      s[n].v[k] = k >= ncorner ? -1 : k < 4 ? e->node[k] : d->middle[e->middle - 1 + k - 4];
    qsort(s[n].v, 8, sizeof *s->v, compare_ints);
    n++;
  }
  if (d->repeats) qsort(s, n, sizeof *s, compare_solids);
  for (size_t i = 0; i < n; i++) {
    if (d->repeats && i > 0 && is_same_solid(&s[i - 1], &s[i])) continue;
    once[s[i].element] = 1;
    nsolid[d->element[s[i].element].kind]++;
  }
  free(s);
  return COROT_OK;
}

/* "3 prisms and 1 hexahedron" */
static const char *list_solids(const size_t nsolid[DRAFT_KINDS], size_t size, char *text) {
  int left = 0;
  size_t used = 0;
  for (int k = DRAFT_PYRAMID; k < DRAFT_KINDS; k++) left += nsolid[k] > 0;
  text[0] = 0;
  for (int k = DRAFT_PYRAMID; k < DRAFT_KINDS; k++) {
    if (nsolid[k] == 0) continue;
    used += (size_t)snprintf(text + used, size - used, "%s%zu %s",
                             !used       ? ""
                             : left == 1 ? " and "
                                         : ", ",
                             nsolid[k], words[k][nsolid[k] != 1]);
    left--;
  }
  return text;
}

/* The elements that come of a draft's, and where those of each begin. */
typedef struct cutting {
  corot_draft_element *element;
  size_t n, room;
  size_t *first; /* [nelement + 1] */
} cutting;

static corot_status append(cutting *c, const corot_draft_element *e) {
  void *items = c->element;
  COROT_TRY(corot_make_room(&items, c->n, &c->room, sizeof *e));
  c->element = items;
  if (c->n > INT_MAX - 8) return corot_fail(COROT_ENOMEM, "too many elements: %zu", c->n);
  c->element[c->n++] = *e;
  return COROT_OK;
}

static corot_status cut_elements(corot_draft *d, cutting *c) {
  COROT_TRY(COROT_ALLOC(c->first, d->nelement + 1));
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    corot_draft_element part = {.tag = e->tag, .at = e->at, .dim = e->dim};
    parts p;
    c->first[i] = c->n;
    if (!e->kind) {
      COROT_TRY(append(c, e));
      continue;
    }
    COROT_TRY(cut_element(d, e, &p));
    for (int k = 0; k < p.n; k++) {
      memcpy(part.node, p.node[k], sizeof part.node);
      COROT_TRY(append(c, &part));
    }
  }
  c->first[d->nelement] = c->n;
  return COROT_OK;
}

/* The parts of a member are members. */
static corot_status cut_members(corot_draft *d, const cutting *c) {
  corot_draft_member *old = d->member;
  size_t n = d->nmember;
  corot_status status = COROT_OK;
  d->member = NULL;
  d->nmember = d->member_room = 0;
  for (size_t i = 0; i < n && !status; i++)
    for (size_t k = c->first[old[i].element]; k < c->first[old[i].element + 1] && !status; k++)
      status = corot_draft_add_member(d, (int)k, old[i].physical);
  free(old);
  return status;
}

/* `once` as above; *ntet of what is no tet come of these. */
static corot_status cut_all(corot_draft *d, const char *once, size_t *ntet) {
  cutting c = {0};
  corot_status status = cut_elements(d, &c);
  for (size_t i = 0; i < d->nelement && !status; i++)
    if (once[i] && d->element[i].kind) *ntet += c.first[i + 1] - c.first[i];
  if (!status) status = cut_members(d, &c);
  free(c.first);
  if (status) {
    free(c.element);
    return status;
  }
  free(d->element);
  d->element = c.element;
  d->nelement = c.n;
  d->element_room = c.room;
  return COROT_OK;
}

static corot_status cut(corot_draft *d, const size_t nsolid[DRAFT_KINDS], size_t nother,
                        const char *once) {
  char text[120];
  size_t ntet = 0;
  COROT_TRY(cut_all(d, once, &ntet));
  if (nother == 0) return COROT_OK;
  return corot_draft_remark(d, COROT_MENDED_CUT, (int)ntet,
                            "%s of the mesh file %s cut into %zu tets, each face by the diagonal "
                            "from its corner of the lowest number",
                            list_solids(nsolid, sizeof text, text), nother == 1 ? "is" : "are",
                            ntet);
}

static void note_solids(corot_draft *d, const size_t nsolid[DRAFT_KINDS]) {
  char text[120];
  corot_fail(COROT_EFORMAT,
             "%s: the file has %s beside %zu tet%s: only tets are supported; mesh.cut: true of a "
             "scenario, or --cut of corot mesh convert, cuts them into tets",
             d->element_file->path, list_solids(nsolid, sizeof text, text), nsolid[DRAFT_SIMPLEX],
             nsolid[DRAFT_SIMPLEX] == 1 ? "" : "s");
  corot_faults_add(&d->faults);
}

/* Readers take those only that are in groups. */
static void note_quads(corot_draft *d) {
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    if (e->kind == DRAFT_QUAD)
      corot_draft_note(d, corot_draft_file(d, e), e->at,
                       "%s %lld of a physical group is a 4-node quadrangle: mesh.cut: true of a "
                       "scenario, or --cut of corot mesh convert, cuts it into triangles",
                       corot_draft_word(d, e), (long long)e->tag);
  }
}

corot_status corot_draft_cut(corot_draft *d) {
  size_t nsolid[DRAFT_KINDS] = {0}, nother = 0, nquad = 0;
  char *once;
  for (size_t i = 0; i < d->nelement; i++) {
    nother += d->element[i].dim == 3 && d->element[i].kind;
    nquad += d->element[i].kind == DRAFT_QUAD;
  }
  if (nother + nquad == 0) return COROT_OK;
  COROT_TRY(COROT_ALLOC(once, d->nelement));
  corot_status status = count_once(d, nsolid, once);
  if (!status && d->how && d->how->cuts)
    status = cut(d, nsolid, nother, once);
  else if (!status && nother > 0)
    note_solids(d, nsolid);
  else if (!status)
    note_quads(d);
  free(once);
  return status;
}
