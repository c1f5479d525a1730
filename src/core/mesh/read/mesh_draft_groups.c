/* The groups of a draft: members gathered, named, and turned into nodes, triangles and tets. */
#include "mesh_draft.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

/* Members of one dimension and number, which are a range of the sorted members. */
typedef struct part {
  int dim, physical;
  size_t first, count;
  int order; /* of the group it becomes */
  char name[COROT_GROUP_NAME_MAX + 1];
} part;

typedef struct gather {
  corot_draft *d;
  const int *tet; /* [nelement] */
  const corot_face *face;
  corot_mesh *mesh;
  part *part;
  size_t npart;
  int *node_seen; /* [nnode] the last pass that took the node, passes counted from 1 */
  int *face_seen; /* [4 * ntet] */
  int pass;
} gather;

/* A member with what it is sorted by. */
typedef struct sorted {
  int dim, physical; /* > 0 */
  corot_draft_member member;
} sorted;

static int compare_sorted(const void *a, const void *b) {
  const sorted *p = a, *q = b;
  if (p->dim != q->dim) return p->dim < q->dim ? -1 : 1;
  if (p->physical != q->physical) return p->physical < q->physical ? -1 : 1;
  return (p->member.element > q->member.element) - (p->member.element < q->member.element);
}

static int magnitude(int physical) { return physical == INT_MIN ? INT_MAX : abs(physical); }

/* Sorts the members and lists the parts they fall into. */
static corot_status find_parts(gather *g) {
  corot_draft *d = g->d;
  sorted *s;
  COROT_TRY(COROT_ALLOC(s, d->nmember));
  for (size_t i = 0; i < d->nmember; i++) {
    corot_draft_member m = d->member[i];
    s[i] = (sorted){d->element[m.element].dim, magnitude(m.physical), m};
  }
  qsort(s, d->nmember, sizeof *s, compare_sorted);

  size_t n = 0;
  for (size_t i = 0; i < d->nmember; i++) {
    d->member[i] = s[i].member;
    n += i == 0 || s[i].dim != s[i - 1].dim || s[i].physical != s[i - 1].physical;
  }
  corot_status status = COROT_ALLOC(g->part, n);
  for (size_t i = 0; i < d->nmember && !status; i++) {
    if (i == 0 || s[i].dim != s[i - 1].dim || s[i].physical != s[i - 1].physical)
      g->part[g->npart++] = (part){.dim = s[i].dim, .physical = s[i].physical, .first = i};
    g->part[g->npart - 1].count++;
  }
  free(s);
  return status;
}

static int compare_names(const void *a, const void *b) {
  const corot_draft_name *p = a, *q = b;
  if (p->dim != q->dim) return p->dim < q->dim ? -1 : 1;
  return (p->physical > q->physical) - (p->physical < q->physical);
}

static const corot_draft_name *find_name(const corot_draft *d, int dim, int physical) {
  const corot_draft_name key = {.dim = dim, .physical = physical};
  if (d->nname == 0) return NULL;
  return bsearch(&key, d->name, d->nname, sizeof key, compare_names);
}

static int compare_parts(const void *a, const void *b) {
  const part *p = a, *q = b;
  if (p->dim != q->dim) return p->dim < q->dim ? -1 : 1;
  return (p->physical > q->physical) - (p->physical < q->physical);
}

/* Whether another dimension has a nameless part of the same number. */
static bool is_ambiguous(const gather *g, const part *p) {
  for (int dim = 0; dim < 4; dim++) {
    const part key = {.dim = dim, .physical = p->physical};
    if (dim != p->dim && !find_name(g->d, dim, p->physical) &&
        bsearch(&key, g->part, g->npart, sizeof key, compare_parts))
      return true;
  }
  return false;
}

static corot_status sort_names(corot_draft *d) {
  if (d->nname == 0) return COROT_OK;
  qsort(d->name, d->nname, sizeof *d->name, compare_names);
  for (size_t i = 1; i < d->nname; i++) {
    const corot_draft_name *a = &d->name[i - 1], *b = &d->name[i];
    if (compare_names(a, b) == 0)
      return corot_fail(COROT_EFORMAT,
                        "%s: physical group %d of dimension %d is named '%s' and '%s'",
                        d->element_file->path, a->physical, a->dim, a->text, b->text);
  }
  return COROT_OK;
}

/* The names are sorted. */
static void name_parts(gather *g) {
  static const char *const word[4] = {"point", "line", "surface", "volume"};
  for (size_t i = 0; i < g->npart; i++) {
    part *p = &g->part[i];
    const corot_draft_name *name = find_name(g->d, p->dim, p->physical);
    p->order = name ? name->order : (int)(g->d->nname + i);
    if (name)
      strcpy(p->name, name->text);
    else if (is_ambiguous(g, p))
      snprintf(p->name, sizeof p->name, "%s-%d", word[p->dim], p->physical);
    else
      snprintf(p->name, sizeof p->name, "%d", p->physical);
  }
}

static int compare_by_name(const void *a, const void *b) {
  const part *p = a, *q = b;
  int c = strcmp(p->name, q->name);
  return c ? c : (p->order > q->order) - (p->order < q->order);
}

static int compare_by_order(const void *a, const void *b) {
  const part *p = a, *q = b;
  if (p->order != q->order) return p->order < q->order ? -1 : 1;
  return compare_parts(a, b);
}

/* Parts of the same name get the lowest order among them and come to stand side by side; the value
   is the number of different names. */
static int merge_parts(gather *g) {
  int n = 0;
  qsort(g->part, g->npart, sizeof *g->part, compare_by_name);
  for (size_t i = 0; i < g->npart; i++)
    if (i > 0 && strcmp(g->part[i].name, g->part[i - 1].name) == 0)
      g->part[i].order = g->part[i - 1].order;
    else
      n++;
  qsort(g->part, g->npart, sizeof *g->part, compare_by_order);
  return n;
}

static const corot_draft_element *element(const gather *g, const part *p, size_t i) {
  return &g->d->element[g->d->member[p->first + i].element];
}

/* Takes each node of the parts once: into `node`, or only counts them if that is NULL. */
static int take_nodes(gather *g, const part *p, size_t npart, int *node) {
  int n = 0;
  g->pass++;
  for (size_t k = 0; k < npart; k++)
    for (size_t i = 0; i < p[k].count; i++) {
      const corot_draft_element *e = element(g, &p[k], i);
      int nnode = e->dim + 1 + (e->middle ? corot_draft_nedge(e->dim) : 0);
      for (int j = 0; j < nnode; j++) {
        int v = j <= e->dim ? e->node[j] : g->d->middle[e->middle - 1 + j - e->dim - 1];
        if (v < 0 || g->node_seen[v] == g->pass) continue; /* -1: it has been left out */
        g->node_seen[v] = g->pass;
        if (node) node[n] = v;
        n++;
      }
    }
  return n;
}

/* The node of a tet on the edge between two of its corners. */
static int tet_middle(const corot_mesh *mesh, int e, int a, int b) {
  const int *v = mesh->tet[e];
  int k = 0;
  for (int i = 0; i < 6; i++) {
    int p = v[corot_tet_edge[i][0]], q = v[corot_tet_edge[i][1]];
    if ((p == a && q == b) || (p == b && q == a)) k = i;
  }
  return mesh->mid[e][k];
}

/* Notes a six-node triangle that has not the nodes on edges of the tet at face f. */
static void check_middles(const gather *g, const corot_draft_element *t, int f) {
  for (int k = 0; k < 3; k++) {
    int a = t->node[k], b = t->node[(k + 1) % 3], m = g->d->middle[t->middle - 1 + k];
    if (m != tet_middle(g->mesh, g->face[f].side / 4, a, b))
      corot_draft_note(g->d, corot_draft_file(g->d, t), t->at,
                       "element %lld has node %lld on the edge %lld %lld, the tets have another",
                       (long long)t->tag, (long long)g->d->node[m].tag,
                       (long long)g->d->node[a].tag, (long long)g->d->node[b].tag);
  }
}

/* Adds the nodes on the edges of a triangle that is face f of a ten-node tet. */
static void take_middles(const gather *g, const int tri[3], int f, corot_group *group) {
  for (int k = 0; k < 3; k++)
    group->node[group->nnode++] =
        tet_middle(g->mesh, g->face[f].side / 4, tri[k], tri[(k + 1) % 3]);
}

static void take_triangles(gather *g, const part *p, corot_group *group) {
  for (size_t i = 0; i < p->count; i++) {
    const corot_draft_element *e = element(g, p, i);
    int f = corot_face_find(4 * g->mesh->ntet, g->face, e->node), *tri = group->tri[group->ntri];
    if (f < 0) {
      corot_draft_note(g->d, corot_draft_file(g->d, e), e->at,
                       "%s %lld: the triangle is no face of a tet", corot_draft_word(g->d, e),
                       (long long)e->tag);
      continue;
    }
    if (e->middle) check_middles(g, e, f);
    if (g->face_seen[f] == g->pass) continue;
    if (g->mesh->mid && !e->middle) take_middles(g, e->node, f, group);
    g->face_seen[f] = g->pass;
    memcpy(tri, e->node, sizeof *group->tri);
    bool reversed = g->d->member[p->first + i].physical < 0;
    corot_face_orient(g->mesh, g->face, f, reversed, tri);
    group->ntri++;
  }
}

static void take_tets(const gather *g, const part *p, corot_group *group) {
  for (size_t i = 0; i < p->count; i++)
    group->tet[group->ntet++] = g->tet[g->d->member[p->first + i].element];
}

/* Fills a zeroed group from its parts. */
static corot_status fill_group(gather *g, const part *p, size_t npart, corot_group *group) {
  size_t ntri = 0, ntet = 0;
  for (size_t k = 0; k < npart; k++) {
    if (p[k].dim == 2) ntri += p[k].count;
    if (p[k].dim == 3) ntet += p[k].count;
  }
  group->nnode = take_nodes(g, p, npart, NULL);
  COROT_TRY(COROT_ALLOC(group->name, strlen(p->name) + 1));
  COROT_TRY(COROT_ALLOC(group->node, (size_t)group->nnode + 3 * ntri));
  COROT_TRY(COROT_ALLOC(group->tri, ntri));
  COROT_TRY(COROT_ALLOC(group->tet, ntet));
  strcpy(group->name, p->name);
  take_nodes(g, p, npart, group->node);
  for (size_t k = 0; k < npart; k++) {
    if (p[k].dim == 2) take_triangles(g, &p[k], group);
    if (p[k].dim == 3) take_tets(g, &p[k], group);
  }
  corot_ints_unique(&group->nnode, group->node);
  corot_ints_unique(&group->ntet, group->tet);
  return COROT_OK;
}

/* The last group, all of whose nodes have been left out. */
static corot_status drop_group(gather *g, corot_group *group) {
  corot_status status = corot_draft_remark(g->d, COROT_MENDED_UNUSED, 0,
                                           "group %s of the mesh file has none but nodes that are "
                                           "in no tet, and is left out",
                                           group->name);
  corot_group_clear(group);
  g->mesh->ngroup--;
  return status;
}

static corot_status gather_groups(gather *g) {
  COROT_TRY(find_parts(g));
  COROT_TRY(sort_names(g->d));
  name_parts(g);
  int ngroup = merge_parts(g);
  COROT_TRY(COROT_ALLOC(g->mesh->group, ngroup));
  COROT_TRY(COROT_ALLOC(g->node_seen, g->mesh->nnode));
  COROT_TRY(COROT_ALLOC(g->face_seen, 4 * g->mesh->ntet));
  for (size_t i = 0, end; i < g->npart; i = end) {
    for (end = i + 1; end < g->npart && g->part[end].order == g->part[i].order;) end++;
    corot_group *group = &g->mesh->group[g->mesh->ngroup++];
    COROT_TRY(fill_group(g, &g->part[i], end - i, group));
    if (group->nnode == 0) COROT_TRY(drop_group(g, group));
  }
  return COROT_OK;
}

corot_status corot_draft_groups(corot_draft *d, const int *tet, const corot_face *face,
                                corot_mesh *mesh) {
  gather g = {.d = d, .tet = tet, .face = face, .mesh = mesh};
  corot_status status = gather_groups(&g);
  free(g.part);
  free(g.node_seen);
  free(g.face_seen);
  return status;
}
