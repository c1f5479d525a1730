/* Long curves made short without a change that is seen. */
#ifndef COROT_REPORT_CHART_THIN_H
#define COROT_REPORT_CHART_THIN_H

/* A curve of more points than THIN_MOST is cut into THIN_BINS pieces, of each of which four points
   stay: the first, the lowest, the highest and the last. A piece is as long in x and in number of
   points together, so that neither a dense part nor a sparse part of the curve is lost. */
enum { THIN_BINS = 1000, THIN_MOST = 4 * THIN_BINS };

/* keep [THIN_MOST, or n if that is less] = the numbers of the points that stay, ascending; returns
   how many. x ascends; y may have NANs, which are neither lowest nor highest. */
int thin(int n, const double *x, const double *y, int *keep);

#endif
