/* Inside of probes: one of them, on its part of the mesh. */
#ifndef COROT_APP_PROBE_PROBE_PARTS_H
#define COROT_APP_PROBE_PROBE_PARTS_H

#include "probe_fields.h"

/* Where a quantity is looked at: rows of a field, by their numbers. */
typedef struct samples {
  int n;
  const int *row;      /* [n] nodes, or tets; NULL: 0, 1, ... */
  int per;             /* rows that follow one another of each: points of a tet */
  double *weight;      /* [n] NULL: the same for all; */
  bool by_volume;      /* or the volume of each tet */
  const double *value; /* the first row; of nodes that of the moment */
  int stride;
  /* places in tets that are looked at by themselves */
  corot_points *points; /* or NULL */
  corot_point_fields at;
  corot_location *place; /* [n] */
  int *side;             /* [n] of those on faces: 4 tet + the corner opposite; NULL */
  double (*traction)[3]; /* [n] there, of the moment; else NULL */
} samples;

typedef struct probe {
  const probe_def *def;
  const probe_quantity *quantity;
  corot_location at; /* of a point or a node */
  samples samples;   /* of a point or a node, too */
  int first, n;      /* columns */
  probe_where where[6];
} probe;

struct probes {
  const corot_model *model;
  int n, ncolumn;
  probe *probe;  /* [n] */
  char **column; /* [ncolumn] names, with the component */
  char **unit;   /* [ncolumn] */
  bool any;      /* fields are needed beside the displacement */
  probe_fields fields;
};

/* The samples of a probe, whose location is known. COROT_ENOMEM. */
corot_status samples_create(const corot_model *model, probe *p, probe_fields *f);
void samples_clear(samples *s);

/* The row and, of several at a tet, the place of sample i. */
probe_where samples_where(const probe *p, const corot_mesh *mesh, int i);

/* The outward normal of a side, as long as its area would be if it were alike all over, where it is
   at rest (NULL) or displaced [nnode]. */
void side_normal(const corot_mesh *mesh, const double (*displacement)[3], int side,
                 const double at[4], double normal[3]);

/* The tractions of a moment whose stresses at the places were found, and as weights the areas. */
void samples_find_tractions(samples *s, const corot_model *model, const double (*displacement)[3]);

/* What of the fields the probe needs. */
unsigned probe_needs(const probe_def *p);

/* value [p->n] of the moment whose fields were found; sets p->where. */
corot_status probe_value(probe *p, const probe_fields *f, const probe_moment *now, double *value);

#endif
