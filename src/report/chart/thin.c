/* Long curves made short: a few points of each piece, its extremes among them. */
#include "thin.h"

#include <math.h>
#include <stdbool.h>

typedef struct piece {
  int bin, first, low, high, last; /* low, high: -1 where no value is a number */
} piece;

/* Where in the curve point i is: 0 to below 1. */
static double place(int i, int n, const double *x) {
  double along = (x[i] - x[0]) / (x[n - 1] - x[0]);
  double count = (double)i / n;
  return along >= 0 && along <= 1 ? 0.5 * (along + count) : count;
}

static void extend(piece *p, int i, const double *y) {
  p->last = i;
  if (isnan(y[i])) return;
  if (p->low < 0 || y[i] < y[p->low]) p->low = i;
  if (p->high < 0 || y[i] > y[p->high]) p->high = i;
}

/* Appends what stays of a piece, in order and once each. */
static int flush(const piece *p, int nkeep, int *keep) {
  bool rising = p->low < p->high;
  int chosen[] = {p->first, rising ? p->low : p->high, rising ? p->high : p->low, p->last};
  int before = p->first - 1;
  for (int k = 0; k < 4; k++) {
    if (chosen[k] <= before) continue;
    before = keep[nkeep++] = chosen[k];
  }
  return nkeep;
}

int thin(int n, const double *x, const double *y, int *keep) {
  if (n <= THIN_MOST) {
    for (int i = 0; i < n; i++) keep[i] = i;
    return n;
  }
  int nkeep = 0;
  piece p = {0};
  for (int i = 0; i < n; i++) {
    int bin = (int)(THIN_BINS * place(i, n, x));
    if (bin >= THIN_BINS) bin = THIN_BINS - 1;
    if (i > 0 && bin > p.bin) nkeep = flush(&p, nkeep, keep);
    if (i == 0 || bin > p.bin) p = (piece){bin, i, -1, -1, i};
    extend(&p, i, y);
  }
  return flush(&p, nkeep, keep);
}
