/* Which tets to refine: W. Doerfler's marking, SIAM J. Numer. Anal. 33, 1996. */
#include <corot/space.h>
#include <stdlib.h>

#include "core/base/sized.h"

typedef struct share {
  double indicator;
  int tet;
} share;

/* The largest first; of equal ones the lower number. */
static int compare(const void *a, const void *b) {
  const share *p = a, *q = b;
  if (p->indicator != q->indicator) return p->indicator > q->indicator ? -1 : 1;
  return (p->tet > q->tet) - (p->tet < q->tet);
}

static int compare_ints(const void *a, const void *b) {
  int i = *(const int *)a, j = *(const int *)b;
  return (i > j) - (i < j);
}

corot_status corot_space_mark(int n, const double *indicator, double fraction, int *nmark,
                              int *mark) {
  COROT_TRY(COROT_GIVEN(indicator));
  COROT_TRY(COROT_GIVEN(nmark));
  COROT_TRY(COROT_GIVEN(mark));
  double sum = 0, carried = 0;
  int count = 0;
  for (int e = 0; e < n; e++) {
    if (!(indicator[e] >= 0))
      return corot_fail(COROT_EINVAL, "mark: the indicator of tet %d is %g", e, indicator[e]);
    sum += indicator[e];
  }
  if (!(fraction > 0 && fraction <= 1))
    return corot_fail(COROT_EINVAL, "mark: a fraction of %g; it must be above 0, at most 1",
                      fraction);
  share *all = malloc(((size_t)n + 1) * sizeof *all);
  if (!all) return corot_fail(COROT_ENOMEM, "no memory for the indicators of %d tets", n);
  for (int e = 0; e < n; e++) all[e] = (share){indicator[e], e};
  qsort(all, (size_t)n, sizeof *all, compare);
  for (; count < n && all[count].indicator > 0 && carried < fraction * sum; count++)
    carried += all[count].indicator, mark[count] = all[count].tet;
  free(all);
  qsort(mark, (size_t)count, sizeof *mark, compare_ints);
  *nmark = count;
  return COROT_OK;
}
