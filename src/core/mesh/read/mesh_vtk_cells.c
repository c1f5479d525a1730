/* Cells and groups of VTK's formats. */
#include "mesh_vtk.h"

#include <stdio.h>
#include <string.h>

enum { FIRST = 1000000001 }; /* number of the first named group; numbers of others are below */

/* --- Groups --- */

static int digit(char c) {
  const char *digits = "0123456789ABCDEF", *at = c ? strchr(digits, c) : NULL;
  return at ? (int)(at - digits) : -1;
}

bool corot_vtk_is_group(const char *array, char name[COROT_GROUP_NAME_MAX + 1]) {
  static const char before[] = "group:";
  size_t n = 0;
  if (strncmp(array, before, sizeof before - 1) != 0) return false;
  for (const char *p = array + sizeof before - 1; *p; p++) {
    if (n == COROT_GROUP_NAME_MAX) return false;
    bool escaped = *p == '%' && digit(p[1]) >= 0 && digit(p[2]) >= 0;
    name[n++] = escaped ? (char)(16 * digit(p[1]) + digit(p[2])) : *p;
    if (escaped) p += 2;
  }
  name[n] = 0;
  return strlen(name) == n && corot_group_name_check(name) == COROT_OK;
}

bool corot_vtk_has_numbers(const char *array) {
  return strcmp(array, "CellEntityIds") == 0 || strcmp(array, "gmsh:physical") == 0 ||
         strcmp(array, "medit:ref") == 0;
}

/* Arrays of cells and of points that have one name are one group. */
static size_t first_of_name(const corot_vtk_groups *g, size_t i) {
  size_t first = 0;
  while (strcmp(g->group[first].name, g->group[i].name) != 0) first++;
  return first;
}

static int number_of(const corot_vtk_groups *g, size_t i) { return FIRST + g->group[i].first; }

corot_status corot_vtk_add_group(corot_vtk_groups *g, const char *name, bool of_points, int n) {
  void *items = g->group;
  COROT_TRY(corot_make_room(&items, g->n, &g->room, sizeof *g->group));
  g->group = items;
  corot_vtk_group *group = &g->group[g->n];
  COROT_TRY(COROT_ALLOC(group->member, n));
  strcpy(group->name, name);
  group->of_points = of_points;
  group->first = (int)first_of_name(g, g->n);
  g->n++;
  return COROT_OK;
}

corot_status corot_vtk_begin_groups(const corot_vtk_groups *g, corot_draft *d) {
  static const int dims[3] = {0, 2, 3};
  for (size_t i = 0; i < g->n; i++)
    for (int k = 0; k < 3 && g->group[i].first == (int)i; k++)
      COROT_TRY(corot_draft_add_name(d, dims[k], FIRST + (int)i, g->group[i].name));
  for (size_t i = 0; i < g->n; i++)
    for (int p = 0; p < d->nnode && g->group[i].of_points; p++) {
      const corot_draft_element point = {.tag = p, .at = d->node[p].at, .node = {p}};
      if (!g->group[i].member[p]) continue;
      COROT_TRY(corot_draft_add_element(d, &point, NULL));
      COROT_TRY(corot_draft_add_member(d, (int)d->nelement - 1, number_of(g, i)));
    }
  return COROT_OK;
}

void corot_vtk_groups_clear(corot_vtk_groups *g) {
  for (size_t i = 0; i < g->n; i++) free(g->group[i].member);
  free(g->group);
  free(g->number);
  memset(g, 0, sizeof *g);
}

/* --- Cells --- */

corot_vtk_type corot_vtk_find_type(int type) {
  static const corot_vtk_type cells[] = {
      {5, 2, 3, DRAFT_SIMPLEX},  {22, 2, 6, DRAFT_SIMPLEX}, {8, 2, 4, DRAFT_QUAD},
      {9, 2, 4, DRAFT_QUAD},     {10, 3, 4, DRAFT_SIMPLEX}, {24, 3, 10, DRAFT_SIMPLEX},
      {11, 3, 8, DRAFT_HEX},     {12, 3, 8, DRAFT_HEX},     {13, 3, 6, DRAFT_PRISM},
      {14, 3, 5, DRAFT_PYRAMID},
  };
  for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
    if (cells[i].number == type) return cells[i];
  bool solid = type == 15 || type == 16 || (type >= 25 && type <= 27) || type == 29 ||
               (type >= 31 && type <= 33) || type == 37 || type == 42 || (type >= 71 && type <= 74);
  return (corot_vtk_type){type, solid ? 3 : 0, 0, DRAFT_SIMPLEX};
}

/* Pixels and voxels have their corners line by line. */
static int place_of(int type, int k) {
  static const int place[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  return type == 8 || type == 11 ? place[k] : k;
}

static bool in_group(const corot_vtk_groups *groups, int cell) {
  if (groups->number && groups->number[cell]) return true;
  for (size_t i = 0; i < groups->n; i++)
    if (!groups->group[i].of_points && groups->group[i].member[cell]) return true;
  return false;
}

corot_status corot_vtk_add_cell(corot_draft *d, int number, size_t at, int type, int64_t n,
                                const int64_t *node, const corot_vtk_groups *groups) {
  corot_vtk_type t = corot_vtk_find_type(type);
  corot_draft_element e = {.tag = number, .at = at, .dim = t.dim, .kind = t.kind};
  int middle[NMIDDLE_MAX];
  if (t.dim == 3 && t.nnode == 0)
    return corot_draft_fail(d, &e,
                            "cell %d is a solid of type %d: only tets of 4 or 10 nodes (types 10 "
                            "and 24) are supported, and other solids of first order, to be cut "
                            "into tets",
                            number, type);
  if (t.dim == 0 || (t.dim == 2 && !in_group(groups, number))) return COROT_OK;
  if (n != t.nnode)
    return corot_draft_fail(d, &e, "cell %d has %lld nodes, but is of type %d", number,
                            (long long)n, type);
  for (int k = 0; k < t.nnode; k++)
    corot_draft_find_node(d, &e, node[k], corot_draft_slot(&e, middle, place_of(type, k)));
  bool more = t.kind ? t.nnode > 4 : t.nnode > t.dim + 1;
  COROT_TRY(corot_draft_add_element(d, &e, more ? middle : NULL));
  int element = (int)d->nelement - 1;
  if (groups->number) COROT_TRY(corot_draft_add_member(d, element, groups->number[number]));
  for (size_t i = 0; i < groups->n; i++)
    if (!groups->group[i].of_points && groups->group[i].member[number])
      COROT_TRY(corot_draft_add_member(d, element, number_of(groups, i)));
  return COROT_OK;
}
