/* gmsh 4.1 ASCII. An element is in the groups of its entity there: tets that are in the same groups
   are of one volume, and each group has a surface and a point of its own. */
#include "mesh_write.h"

/* Sets of groups, made by adding one group after the other to the empty set, number 0. */
typedef struct sets {
  int n, room;
  struct {
    int parent, group; /* the set is the parent with this group added */
    int volume;        /* of its tets, from 1; 0: it has none */
  } * set;
  int *of;                 /* [ntet] the set of a tet */
  int nvolume, *of_volume; /* [nvolume] the set of a volume */
} sets;

static corot_status add_set(sets *s, int parent, int group) {
  if (s->n == s->room) {
    int room = s->room ? 2 * s->room : 16;
    void *more = realloc(s->set, (size_t)room * sizeof *s->set);
    if (!more) return corot_fail(COROT_ENOMEM, "out of memory: %d sets of groups", room);
    s->set = more;
    s->room = room;
  }
  s->set[s->n].parent = parent;
  s->set[s->n].group = group;
  s->set[s->n++].volume = 0;
  return COROT_OK;
}

/* Adds group g to the sets of its tets; sets from `first` on are of this group. */
static corot_status add_group(const corot_group *group, int g, int *next, sets *s) {
  int first = s->n;
  for (int i = 0; i < first; i++) next[i] = -1;
  for (int i = 0; i < group->ntet; i++) {
    int *of = &s->of[group->tet[i]];
    if (next[*of] < 0) {
      next[*of] = s->n;
      COROT_TRY(add_set(s, *of, g));
    }
    *of = next[*of];
  }
  return COROT_OK;
}

static corot_status find_sets(const corot_mesh *mesh, sets *s) {
  int *next = NULL, nnext = 0;
  COROT_TRY(COROT_ALLOC(s->of, mesh->ntet));
  corot_status status = add_set(s, -1, -1);
  for (int g = 0; g < mesh->ngroup && !status; g++) {
    if (s->n > nnext) {
      int *more = realloc(next, (size_t)(nnext = 2 * s->n) * sizeof *more);
      if (!more) status = corot_fail(COROT_ENOMEM, "out of memory: %d sets of groups", nnext);
      if (more) next = more;
    }
    if (!status) status = add_group(&mesh->group[g], g, next, s);
  }
  free(next);
  for (int e = 0; e < mesh->ntet && !status; e++)
    if (s->set[s->of[e]].volume == 0) s->set[s->of[e]].volume = ++s->nvolume;
  if (!status) status = COROT_ALLOC(s->of_volume, s->nvolume);
  for (int i = 0; i < s->n && !status; i++)
    if (s->set[i].volume > 0) s->of_volume[s->set[i].volume - 1] = i;
  return status;
}

/* The nodes of groups that are of none of their elements: [ngroup + 1] first, and these. */
typedef struct points {
  int *first, *node;
  int n, npoint; /* nodes, and groups that have some */
} points;

static corot_status find_points(const corot_writing *w, points *p) {
  const corot_mesh *mesh = w->mesh;
  char *mark = NULL;
  int *loose = NULL;
  size_t all = 0;
  for (int g = 0; g < mesh->ngroup; g++) all += (size_t)mesh->group[g].nnode;
  corot_status status = COROT_ALLOC(p->first, (size_t)mesh->ngroup + 1);
  if (!status) status = COROT_ALLOC(p->node, all);
  if (!status) status = COROT_ALLOC(mark, mesh->nnode);
  for (int g = 0; g < mesh->ngroup && !status; g++) {
    loose = p->node + p->n;
    p->n += corot_writing_loose(w, &mesh->group[g], mark, loose);
    p->first[g + 1] = p->n;
    p->npoint += p->first[g + 1] > p->first[g];
  }
  free(mark);
  return status;
}

static bool has_points(const points *p, int g) { return p->first[g + 1] > p->first[g]; }

static void write_names(const corot_writing *w, const points *p) {
  const corot_mesh *mesh = w->mesh;
  int n = p->npoint;
  for (int g = 0; g < mesh->ngroup; g++) n += (mesh->group[g].ntri > 0) + (mesh->group[g].ntet > 0);
  if (n == 0) return;
  fprintf(w->file, "$PhysicalNames\n%d\n", n);
  for (int g = 0; g < mesh->ngroup; g++) {
    const corot_group *group = &mesh->group[g];
    if (has_points(p, g)) fprintf(w->file, "0 %d \"%s\"\n", g + 1, group->name);
    if (group->ntri > 0) fprintf(w->file, "2 %d \"%s\"\n", g + 1, group->name);
    if (group->ntet > 0) fprintf(w->file, "3 %d \"%s\"\n", g + 1, group->name);
  }
  fprintf(w->file, "$EndPhysicalNames\n");
}

/* The groups of a set, from the last to the first. */
static void write_set(FILE *f, const sets *s, int set) {
  int n = 0;
  for (int i = set; i > 0; i = s->set[i].parent) n++;
  fprintf(f, " %d", n);
  for (int i = set; i > 0; i = s->set[i].parent) fprintf(f, " %d", s->set[i].group + 1);
}

static void write_entities(const corot_writing *w, const points *p, const sets *s) {
  const corot_mesh *mesh = w->mesh;
  FILE *f = w->file;
  double min[3], max[3];
  int nsurface = 0;
  corot_mesh_bounds(mesh, min, max);
  for (int g = 0; g < mesh->ngroup; g++) nsurface += mesh->group[g].ntri > 0;
  fprintf(f, "$Entities\n%d 0 %d %d\n", p->npoint, nsurface, s->nvolume);
  for (int g = 0; g < mesh->ngroup; g++) {
    if (!has_points(p, g)) continue;
    const double *x = mesh->x[p->node[p->first[g]]];
    fprintf(f, "%d %.17g %.17g %.17g 1 %d\n", g + 1, x[0], x[1], x[2], g + 1);
  }
  for (int g = 0; g < mesh->ngroup; g++)
    if (mesh->group[g].ntri > 0)
      fprintf(f, "%d %.17g %.17g %.17g %.17g %.17g %.17g 1 %d 0\n", g + 1, min[0], min[1], min[2],
              max[0], max[1], max[2], g + 1);
  for (int v = 1; v <= s->nvolume; v++) {
    fprintf(f, "%d %.17g %.17g %.17g %.17g %.17g %.17g", v, min[0], min[1], min[2], max[0], max[1],
            max[2]);
    write_set(f, s, s->of_volume[v - 1]);
    fprintf(f, " 0\n");
  }
  fprintf(f, "$EndEntities\n");
}

static void write_nodes(const corot_writing *w) {
  const corot_mesh *mesh = w->mesh;
  fprintf(w->file, "$Nodes\n1 %d 1 %d\n3 1 0 %d\n", mesh->nnode, mesh->nnode, mesh->nnode);
  for (int i = 0; i < mesh->nnode; i++) fprintf(w->file, "%d\n", i + 1);
  for (int i = 0; i < mesh->nnode; i++)
    fprintf(w->file, "%.17g %.17g %.17g\n", mesh->x[i][0], mesh->x[i][1], mesh->x[i][2]);
  fprintf(w->file, "$EndNodes\n");
}

static void write_element(FILE *f, long long *number, int n, const int *node) {
  fprintf(f, "%lld", ++*number);
  for (int i = 0; i < n; i++) fprintf(f, " %d", node[i] + 1);
  fprintf(f, "\n");
}

/* gmsh has the nodes of a tet on the edges 01 12 02 03 23 13. */
static void write_tet(const corot_writing *w, int e, long long *number) {
  int v[10], n = corot_writing_tet(w, e, v), swap = v[n - 1];
  if (n == 10) {
    v[9] = v[8];
    v[8] = swap;
  }
  write_element(w->file, number, n, v);
}

/* How many tets from e on are of one volume, side by side in the order of the mesh. */
static int run_length(const corot_mesh *mesh, const sets *s, int e) {
  int end = e + 1;
  while (end < mesh->ntet && s->of[end] == s->of[e]) end++;
  return end - e;
}

static void write_elements(const corot_writing *w, const points *p, const sets *s) {
  const corot_mesh *mesh = w->mesh;
  FILE *f = w->file;
  long long nblock = p->npoint, n = p->n + (long long)mesh->ntet, number = 0;
  for (int g = 0; g < mesh->ngroup; g++) {
    nblock += mesh->group[g].ntri > 0;
    n += mesh->group[g].ntri;
  }
  for (int e = 0; e < mesh->ntet; e += run_length(mesh, s, e)) nblock++;
  fprintf(f, "$Elements\n%lld %lld 1 %lld\n", nblock, n, n);
  for (int g = 0; g < mesh->ngroup; g++) {
    if (!has_points(p, g)) continue;
    fprintf(f, "0 %d 15 %d\n", g + 1, p->first[g + 1] - p->first[g]);
    for (int i = p->first[g]; i < p->first[g + 1]; i++) write_element(f, &number, 1, &p->node[i]);
  }
  for (int g = 0; g < mesh->ngroup; g++) {
    const corot_group *group = &mesh->group[g];
    if (group->ntri == 0) continue;
    fprintf(f, "2 %d %d %d\n", g + 1, mesh->mid ? 9 : 2, group->ntri);
    for (int i = 0; i < group->ntri; i++) {
      int v[6], nv = corot_writing_triangle(w, group->tri[i], v);
      write_element(f, &number, nv, v);
    }
  }
  for (int e = 0, length; e < mesh->ntet; e += length) {
    length = run_length(mesh, s, e);
    fprintf(f, "3 %d %d %d\n", s->set[s->of[e]].volume, mesh->mid ? 11 : 4, length);
    for (int i = e; i < e + length; i++) write_tet(w, i, &number);
  }
  fprintf(f, "$EndElements\n");
}

corot_status corot_write_gmsh_4(corot_writing *w) {
  sets s = {0};
  points p = {0};
  corot_status status = find_sets(w->mesh, &s);
  if (!status) status = find_points(w, &p);
  if (!status) {
    fprintf(w->file, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    write_names(w, &p);
    write_entities(w, &p, &s);
    write_nodes(w);
    write_elements(w, &p, &s);
  }
  free(s.set);
  free(s.of);
  free(s.of_volume);
  free(p.first);
  free(p.node);
  return status;
}
