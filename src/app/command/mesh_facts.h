/* What `corot mesh info` knows of a mesh, for text, JSON and pictures. */
#ifndef COROT_APP_COMMAND_MESH_FACTS_H
#define COROT_APP_COMMAND_MESH_FACTS_H

#include <corot/mesh.h>
#include <jansson.h>
#include <stdio.h>

#include "app/scenario/warnings.h"
#include "solve/statics/rigid.h"

enum { SHAPE_BINS = 10 };

/* Of a group. */
typedef struct group_size {
  double area;      /* of its triangles [m^2] */
  double normal[3]; /* the mean of theirs, of length 1; 0: they face all ways alike */
  double volume;    /* of its tets [m^3] */
} group_size;

/* Of a part of the body. */
typedef struct part_size {
  int ntet;
  double volume; /* [m^3] */
} part_size;

typedef struct mesh_facts {
  const char *path;
  const corot_mesh *mesh;
  corot_mesh_quality quality;
  int ncorner; /* nodes that are corners of tets; the others are on edges */
  int npart;
  corot_part *part;       /* [npart] */
  part_size *size;        /* [npart] */
  int shapes[SHAPE_BINS]; /* how many tets have a shape up to 0.1, 0.2, ... 1 */
  group_size *group;      /* [ngroup] */
  int ntri, (*tri)[3];    /* the surface */
  int *at_tet;            /* [ntri] the tet of each of its triangles */
  double area;            /* of the surface, by corners and nodes on edges [m^2] */
  double through_min;     /* tets through the thickness: the fewest, */
  double through_median;  /* as many as half of the surface has at least, */
  double through_thin;    /* and the part of the surface that has fewer than two */
  warnings warnings;
} mesh_facts;

/* Finds all but the warnings of the file's report. What has been found by a failure is freed by
   mesh_facts_free, too. */
corot_status mesh_facts_find(const char *path, const corot_mesh *mesh, mesh_facts *f);
void mesh_facts_free(mesh_facts *f);

/* Adds a triangle's area, as a vector along its normal and as a number: of its corners, or, with
   its six nodes, of the four triangles that these make. `six` may be NULL. */
void triangle_area(const corot_mesh *mesh, const int tri[3], const int *six, double vector[3],
                   double *area);

/* Lines of text. `what` is a mesh_facts. */
corot_status mesh_facts_print(const void *what, FILE *out);

/* The caller's to json_decref; NULL: no memory. */
json_t *mesh_facts_json(const mesh_facts *f);

#endif
