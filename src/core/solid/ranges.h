/* The elements of a solid shared out among threads: each takes a range of chunks, with a window of
   element forces of its own. Nodes and blocks of a matrix that several ranges add to get nothing
   from them at first: what the elements have for these is set aside, and added up at the end in the
   order of the elements. So every sum is that of one thread, to the last bit. */
#ifndef COROT_CORE_SOLID_RANGES_H
#define COROT_CORE_SOLID_RANGES_H

#include "pattern.h"

/* One force to be set aside: from where in a window of element forces, and as which one. */
typedef struct force_copy {
  int from, to;
} force_copy;

/* The plan. Of one range it is the pattern's own. */
typedef struct range_plan {
  int n;
  int *chunk; /* [n + 1] range k has chunks chunk[k] to chunk[k + 1] - 1 */

  /* Nodes whose elements are all in one range, as the pattern's due and turn; */
  const int *due;  /* [nchunk + 1] */
  const int *turn; /* [due[nchunk]] */
  /* the others, and their forces, one node's after the other's, in the order of the elements: */
  int nseam;
  int *seam;        /* [nseam] ascending */
  int *force_first; /* [nseam + 1] */
  int *copy_first;  /* [nchunk + 1] each chunk's part of `copy` */
  force_copy *copy; /* [force_first[nseam]] */

  /* Blocks of matrices that several ranges add to, and their parts in the same way; */
  int nshared;
  int *shared;     /* [nshared] ascending */
  int *part_first; /* [nshared + 1] */
  /* and for each block of elements with some, where all its parts go: as pattern.place, or to part
     -1 - place. */
  int *detour; /* [elements.nblock] -1: as the pattern says; else where in `place` */
  int ndetour;
  int (*place)[W]; /* [ndetour][kind->npair] */
} range_plan;

/* What a range has met. */
typedef struct range_result {
  int tet;      /* the first inverted one, or -1 */
  double check; /* of its sums of forces: finite only if they are */
} range_result;

/* What the ranges write to. */
typedef struct solid_ranges {
  range_plan plan;
  bool windowed;          /* each range has a window of its own; else one buffer has all elements */
  block_vd (**force)[3];  /* [n] windows [window][kind->nnode], the first being the state's own */
  range_result *told;     /* [n] */
  double (**gathered)[3]; /* [n] [nnode] zero between uses; NULL unless dilatations are averaged */
  double (*aside)[3]; /* [force_first[nseam]] forces set aside; NULL, as the next, of one range */
  double (*aside_K)[9], (*aside_D)[9]; /* [part_first[nshared]] parts of K and D; of D, NULL unless
                                          it is damped */
} solid_ranges;

/* `n` ranges, or as many as there are chunks; `together` elements, as many as have a tet of a
   coarser level above them, stay in one range. */
corot_status corot_ranges_create(const corot_mesh *mesh, const element_set *t, const pattern *p,
                                 int n, int together, bool damped, bool averaged,
                                 block_vd (*force)[3], solid_ranges *out);
void corot_ranges_clear(solid_ranges *r);
size_t corot_ranges_bytes(const solid_ranges *r, const element_set *t, const pattern *p);

#endif
