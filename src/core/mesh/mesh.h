/* What the files of the mesh module share. */
#ifndef COROT_CORE_MESH_MESH_H
#define COROT_CORE_MESH_MESH_H

#include <corot/mesh.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "core/base/sized.h"

/* p = zeroed array of n >= 0 items; the value is a status. An empty array is not NULL. */
#define COROT_ALLOC(p, n)                                 \
  (((p) = calloc((n) > 0 ? (size_t)(n) : 1, sizeof *(p))) \
       ? COROT_OK                                         \
       : corot_fail(COROT_ENOMEM, "out of memory: %zu times %zu bytes", (size_t)(n), sizeof *(p)))

/* Local nodes of the face opposite to node k, winding outward. */
extern const int corot_tet_face[4][3];

/* The ends of the edges, in the order of corot_mesh.mid. */
extern COROT_SISTERS const int corot_tet_edge[6][2];

/* A face of a tet. */
typedef struct corot_face {
  int v[3]; /* nodes, ascending */
  int side; /* 4 * tet + k, k the tet's node opposite to the face */
} corot_face;

/* The 4 * ntet faces in ascending order of their nodes, then of their tets. The caller frees. */
corot_status corot_faces_sort(int nnode, int ntet, const int (*tet)[4], corot_face **face);

/* By nodes alone: negative, 0 or positive. */
int corot_face_compare(const corot_face *a, const corot_face *b);

/* The nodes of a face, winding outward from its tet. */
void corot_face_outward(const corot_face *face, const int (*tet)[4], int tri[3]);

/* Of sorted faces, the first that has a triangle's nodes; -1: there is none. */
int corot_face_find(int nface, const corot_face *face, const int tri[3]);

/* A triangle that is face f of the sorted faces, as a group has it: on the boundary outward, inside
   the mesh as it is, or the other way round if it is `reversed`. */
void corot_face_orient(const corot_mesh *mesh, const corot_face *face, int f, bool reversed,
                       int tri[3]);

/* Sorts `a` [*n] and drops what occurs again. */
void corot_ints_unique(int *n, int *a);

/* Adds a remark, of which it keeps a copy. COROT_ENOMEM. */
corot_status corot_report_add(corot_mesh_report *report, corot_mended what, int count,
                              const char *text);

/* Of the mesh and all it holds. */
size_t corot_mesh_bytes(const corot_mesh *mesh);

/* Whether a triangle's nodes ascend, up to a rotation: two windings of one triangle differ in it.
 */
bool corot_tri_ascends(const int tri[3]);

/* The faces among `face` [nface] that no other tet shares, as triangles that wind outward. */
corot_status corot_faces_boundary(int nface, const corot_face *face, const int (*tet)[4], int *ntri,
                                  int (**tri)[3]);

/* The tets at each corner: first [nnode + 1], zero before, is each node's part of tet [4 ntet]. */
COROT_SISTERS void corot_corner_tets(const corot_mesh *mesh, int *first, int *tet);

#define COROT_GROUP_NAME_MAX 127 /* bytes; gmsh's limit */

/* What is found wrong with a mesh: how much, and the first few in words, a line each. */
typedef struct corot_mesh_faults {
  int n;
  size_t length;
  char text[3000];
} corot_mesh_faults;

/* Whether one more would still be told, in words. */
bool corot_faults_tell(const corot_mesh_faults *faults);

/* Takes corot_error() as one more fault, where it is still told; counts it in any case. */
void corot_faults_add(corot_mesh_faults *faults);

/* COROT_OK if there is none; else `status`, all of them being the message. */
corot_status corot_faults_fail(const corot_mesh_faults *faults, corot_status status);

/* What is in a file, by place: a node, a tet, or the mesh as a whole. */
typedef enum corot_mesh_place { PLACE_MESH, PLACE_NODE, PLACE_TET } corot_mesh_place;

/* How messages call the nodes and tets of a mesh: by index, or by their numbers in a file. */
typedef struct corot_mesh_names {
  const char *tet;         /* "tet" or "element" */
  const int64_t *node_tag; /* [nnode] NULL: the index */
  const int64_t *tet_tag;  /* [ntet] NULL: the index */
  const char *unused_hint; /* what to say about a node in no tet; NULL: nothing more */
  const char *known;       /* [nnode] not 0: the node is in what has been refused; NULL: none is */

  /* Makes `text` the message, with the place in the file before it; NULL: there is no file. */
  void (*locate)(const void *file, corot_mesh_place place, int index, const char *text);
  const void *file;
} corot_mesh_names;

/* Whether there are tets, and 3 * nnode and 4 * ntet fit an int. */
corot_status corot_mesh_check_counts(int nnode, int ntet);

/* Whether nodes and tets are sound, as <corot/mesh.h> promises; groups are not looked at.
   COROT_OK: what is wrong has been added to `faults`; if there are none of them, the sorted faces
   are the caller's to free, otherwise *face is NULL. COROT_ENOMEM. */
corot_status corot_mesh_check(const corot_mesh *mesh, const corot_mesh_names *names,
                              corot_mesh_faults *faults, corot_face **face);

/* Whether a tet with these corners has no volume to speak of. */
bool corot_tet_is_flat(const double (*x)[3], const int v[4]);

/* Whether all tets have a positive volume and are not flat, nor turned inside out. */
corot_status corot_mesh_check_volumes(const corot_mesh *mesh);

/* Whether a group may be called so: 1 to 127 bytes, no double quotes, no control characters. */
corot_status corot_group_name_check(const char *name);

/* Whether a group may be added by that name. */
corot_status corot_mesh_check_new_group(const corot_mesh *mesh, const char *name);

/* Unless `status` is a failure already, `g`, which has no name yet, becomes the mesh's last group;
   after a failure it is cleared. */
corot_status corot_mesh_add_group(corot_status status, corot_mesh *mesh, const char *name,
                                  corot_group *g);

/* Adds the group of the marked nodes (`mark` [nnode], non-zero), with the triangles among
   `boundary` [ntri] and the tets whose nodes are all marked. */
corot_status corot_mesh_group_marked(corot_mesh *mesh, const char *name, const char *mark, int ntri,
                                     const int (*boundary)[3]);

/* The same of the mesh's own boundary. */
corot_status corot_mesh_add_marked(corot_mesh *mesh, const char *name, const char *mark);

/* A millionth of the diagonal: what a tolerance of 0 stands for [m]. */
double corot_mesh_near(const corot_mesh *mesh);

/* unit = along / |along|; COROT_EINVAL: it has no direction. `what` it is of group `name`. */
corot_status corot_mesh_unit(const char *name, const char *what, const double along[3],
                             double unit[3]);

void corot_group_clear(corot_group *group);

/* slope[a] = dX / dl_a of the map by the ten shape functions, at the volume coordinates `at` and of
   positions relative to corner 0. */
COROT_SISTERS void corot_curved_slopes(const double (*x)[3], const int v[4], const int mid[6],
                                       const double at[4], double slope[4][3]);

/* Nodes, weights and position of a location of which the tet and `at` are set. */
void corot_location_weigh(const corot_mesh *mesh, corot_location *here);

/* The Jacobian determinant, at barycentric coordinates `at`, of the map by the ten shape functions
   from the tet with corners 0, e_x, e_y, e_z; and the volume, which is that of the image. */
double corot_curved_determinant(const double (*x)[3], const int v[4], const int mid[6],
                                const double at[4]);
COROT_SISTERS double corot_curved_volume(const double (*x)[3], const int v[4], const int mid[6]);

/* 3 inradius / circumradius of tet e by its corners, 1 of a regular one: the radius ratio (Liu and
   Joe 1994). */
double corot_mesh_shape(const corot_mesh *mesh, int e);

/* The body as seen from a triangle of its surface, straight inward to the other side. */
typedef struct corot_crossing {
  int tet;       /* at the triangle */
  double length; /* of the way [m]; 0: it was lost at an edge */
  double ntet; /* how many tets it passes: each counts with the part of its own extent along the way
                  that is passed, so that cells in a row are counted however they are cut */
} corot_crossing;

/* One for each triangle of corot_mesh_boundary, in its order; curved edges count as straight ones.
 *crossing is the caller's to free. COROT_ENOMEM. */
corot_status corot_mesh_cross(const corot_mesh *mesh, corot_crossing **crossing);

/* The box that holds all nodes. */
void corot_mesh_bounds(const corot_mesh *mesh, double min[3], double max[3]);

/* Signed volume of the tet with these corners. */
static inline double corot_tet_volume(const double (*x)[3], const int v[4]) {
  double a[3], b[3], c[3];
  for (int i = 0; i < 3; i++) {
    a[i] = x[v[1]][i] - x[v[0]][i];
    b[i] = x[v[2]][i] - x[v[0]][i];
    c[i] = x[v[3]][i] - x[v[0]][i];
  }
  return ((a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
          (a[0] * b[1] - a[1] * b[0]) * c[2]) /
         6;
}

/* Volume of tet e, of either order. */
static inline double corot_mesh_volume_of(const corot_mesh *mesh, int e) {
  const double(*x)[3] = (const double(*)[3])mesh->x;
  return mesh->mid ? corot_curved_volume(x, mesh->tet[e], mesh->mid[e])
                   : corot_tet_volume(x, mesh->tet[e]);
}

#endif
