/* The fields of a run, read back from fields.pvd and the files it lists: those that
   app/folder/write_vtu.c writes, on a machine of this byte order, and no others. */
#ifndef COROT_REPORT_READ_FIELDS_FILE_H
#define COROT_REPORT_READ_FIELDS_FILE_H

#include <corot/base.h>
#include <jansson.h>

typedef struct fields {
  const char *dir;
  const json_t
      *result; /* what frames are to be as it lists them; NULL: they are taken as they are */
  int nframe;
  double *t;   /* [nframe] [s] */
  char **file; /* [nframe] relative to dir */
  char *text;  /* of fields.pvd; the names are in it */
  int nnode, ntet;
  double (*x)[3]; /* [nnode] at rest [m] */
  int (*tet)[4];  /* [ntet] the corners */
  int (*mid)[6];  /* [ntet] the nodes on their edges, as in corot_mesh; NULL: of order 1 */
} fields;

/* One frame; the arrays are the caller's. Of tets of order 2 there are values at their four points
   of integration, too (see app/folder/write_vtu.h); else these are NULL. */
typedef struct fields_frame {
  double (*displacement)[3], (*velocity)[3]; /* [nnode] */
  double (*frame)[9];                        /* [ntet] */
  double *von_mises, *det;                   /* [ntet] */
  double (*frame_at)[4][9];                  /* [ntet] */
  double (*von_mises_at)[4], (*det_at)[4];   /* [ntet] */
} fields_frame;

/* Reads the list, and mesh and sizes from the first frame. `dir` must outlive the fields. Without
   a fields.pvd, or with an empty one, nframe is 0. COROT_EFORMAT: not what the run writes. */
corot_status fields_open(const char *dir, fields *f);

/* COROT_EFORMAT: not what the run writes, or has written. */
corot_status fields_read(const fields *f, int i, fields_frame *frame);

void fields_close(fields *f);

/* Memory for a frame of these fields, and its end. */
corot_status fields_frame_create(const fields *f, fields_frame *frame);
void fields_frame_free(fields_frame *frame);

#endif
