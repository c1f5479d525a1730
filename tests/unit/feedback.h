/* Feedbacks for the tests of what comes in while a run goes on. */
#ifndef FEEDBACK_H
#define FEEDBACK_H

#include <corot/inputs.h>

#include "solid.h"

/* Between two nodes a spring that stiffens and a dashpot, and on the first a force B u that no
   potential has. */
typedef struct tie {
  int node[2];
  double k, q, c; /* [N/m], [N/m^3], [N s/m] */
  double B[9];    /* [N/m] */
} tie;

static inline void tie_difference(const tie *s, const double (*x)[3], double d[3]) {
  for (int c = 0; c < 3; c++) d[c] = x[s->node[0]][c] - x[s->node[1]][c];
}

static inline double dot_3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static corot_status tie_force(void *data, double t, const double (*u)[3], const double (*v)[3],
                              double (*f)[3]) {
  const tie *s = data;
  double d[3], rate[3], Bu[3];
  (void)t;
  tie_difference(s, u, d), tie_difference(s, v, rate);
  apply(s->B, u[s->node[0]], Bu);
  for (int c = 0; c < 3; c++) {
    double part = -(s->k + s->q * dot_3(d, d)) * d[c] - s->c * rate[c];
    f[s->node[0]][c] += part + Bu[c];
    f[s->node[1]][c] -= part;
  }
  return COROT_OK;
}

/* k I + q (d.d I + 2 d d') between the nodes, and - B. */
static corot_status tie_blocks(void *data, double t, const double (*u)[3], const double (*v)[3],
                               corot_blocks *blocks) {
  const tie *s = data;
  double d[3], K[9], D[9], sign[2] = {1, -1};
  (void)t, (void)v;
  tie_difference(s, u, d);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      for (int a = 0; a < 9; a++) {
        double same = a % 4 == 0, with = sign[i] * sign[j];
        K[a] = with * (same * (s->k + s->q * dot_3(d, d)) + 2 * s->q * d[a / 3] * d[a % 3]);
        D[a] = with * same * s->c;
        if (i == 0 && j == 0) K[a] -= s->B[a];
      }
      COROT_TRY(corot_blocks_add(blocks, s->node[i], s->node[j], K, D));
    }
  return COROT_OK;
}

static corot_status tie_change(void *data, double t, const double (*u)[3], const double (*v)[3],
                               const double (*du)[3], const double (*dv)[3], double (*df)[3]) {
  const tie *s = data;
  double d[3], e[3], rate[3], Bdu[3];
  (void)t, (void)v;
  tie_difference(s, u, d), tie_difference(s, du, e), tie_difference(s, dv, rate);
  apply(s->B, du[s->node[0]], Bdu);
  for (int c = 0; c < 3; c++) {
    double part =
        -(s->k + s->q * dot_3(d, d)) * e[c] - 2 * s->q * dot_3(d, e) * d[c] - s->c * rate[c];
    df[s->node[0]][c] += part + Bdu[c];
    df[s->node[1]][c] -= part;
  }
  return COROT_OK;
}

/* Springs from some nodes to the ground. */
typedef struct foundation {
  int n;
  const int *node;     /* [n] */
  const double *share; /* [n] of k; NULL: all the same, k each */
  double k;            /* [N/m] */
  corot_status status; /* with which it answers, after `good` more evaluations */
  int good, bad;       /* it answers so `bad` times; -1: always */
  const char *why;     /* or NULL */
  long asked;
} foundation;

static inline corot_status foundation_answer(foundation *s) {
  s->asked++;
  if (s->status == COROT_OK || s->bad == 0 || s->good-- > 0) return COROT_OK;
  if (s->bad > 0) s->bad--;
  s->good = 0;
  return s->why ? corot_fail(s->status, "%s", s->why) : s->status;
}

static corot_status foundation_force(void *data, double t, const double (*u)[3],
                                     const double (*v)[3], double (*f)[3]) {
  foundation *s = data;
  (void)t, (void)v;
  for (int i = 0; i < s->n; i++)
    for (int c = 0; c < 3; c++)
      f[s->node[i]][c] -= s->k * (s->share ? s->share[i] : 1) * u[s->node[i]][c];
  return foundation_answer(s);
}

static corot_status foundation_blocks(void *data, double t, const double (*u)[3],
                                      const double (*v)[3], corot_blocks *blocks) {
  const foundation *s = data;
  (void)t, (void)u, (void)v;
  for (int i = 0; i < s->n; i++) {
    double K[9] = {0};
    K[0] = K[4] = K[8] = s->k * (s->share ? s->share[i] : 1);
    COROT_TRY(corot_blocks_add(blocks, s->node[i], s->node[i], K, NULL));
  }
  return COROT_OK;
}

static inline corot_feedback feedback_of_tie(tie *s, bool change) {
  return (corot_feedback){"tie", s, tie_force, tie_blocks, change ? tie_change : NULL};
}

static inline corot_feedback feedback_of_foundation(foundation *s) {
  return (corot_feedback){"foundation", s, foundation_force, foundation_blocks, NULL};
}

#endif
