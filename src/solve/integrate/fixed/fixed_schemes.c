/* The formulas of the methods of constant step. */
#include <string.h>

#include "fixed.h"

/* Constant-step BDF; until enough states are known, backward Euler (as the paper starts). */
static void bdf_prepare(fixed *f, stage *g) {
  static const double past[4][3] = {
      {0}, {1}, {4.0 / 3, -1.0 / 3}, {18.0 / 11, -9.0 / 11, 2.0 / 11}};
  static const double next[4] = {0, 1, 2.0 / 3, 6.0 / 11};
  int order = f->depth >= f->scheme->order ? f->scheme->order : 1;
  for (int i = 0; i < f->n; i++) {
    f->U[i] = f->W[i] = f->V[i] = 0;
    for (int j = 0; j < order; j++) {
      f->U[i] += past[order][j] * f->u[j][i];
      f->W[i] += past[order][j] * f->v[j][i];
    }
    f->w[i] = f->v[0][i];
  }
  double gamma = next[order] * f->h;
  *g = (stage){f->t0 + (f->count + 1) * f->h, 1, gamma, gamma, 1};
}

static void bdf_finish(fixed *f) {
  for (int i = 0; i < f->n; i++) {
    f->u[0][i] = f->U[i] + f->factored.p * f->w[i];
    f->v[0][i] = f->w[i];
  }
}

static void midpoint_prepare(fixed *f, stage *g) {
  for (int i = 0; i < f->n; i++) {
    f->U[i] = f->u[0][i];
    f->W[i] = f->w[i] = f->v[0][i];
    f->V[i] = 0;
  }
  *g = (stage){f->t0 + (f->count + 0.5) * f->h, 1, f->h / 2, f->h / 2, 1};
}

static void midpoint_finish(fixed *f) {
  for (int i = 0; i < f->n; i++) {
    f->u[0][i] = f->u[1][i] + f->h * f->w[i];
    f->v[0][i] = 2 * f->w[i] - f->v[1][i];
  }
}

static void newmark_prepare(fixed *f, stage *g) {
  double h = f->h, am = f->am, af = f->af;
  for (int i = 0; i < f->n; i++) {
    double u = f->u[0][i], v = f->v[0][i], a = f->a[i];
    f->U[i] = u + (1 - af) * (h * v + h * h * (0.5 - f->beta) * a);
    f->V[i] = v + (1 - af) * h * (1 - f->gamma) * a;
    f->W[i] = -am / (1 - am) * a;
    f->w[i] = a;
  }
  *g = (stage){f->t0 + (f->count + 1 - af) * h, 1 - am, 1, (1 - af) * f->beta * h * h,
               (1 - af) * f->gamma * h};
}

static void newmark_finish(fixed *f) {
  double h = f->h;
  for (int i = 0; i < f->n; i++) {
    double a0 = f->a[i], a1 = f->w[i];
    f->u[0][i] = f->u[1][i] + h * f->v[1][i] + h * h * ((0.5 - f->beta) * a0 + f->beta * a1);
    f->v[0][i] = f->v[1][i] + h * ((1 - f->gamma) * a0 + f->gamma * a1);
  }
}

/* What the Newmark family's mean of accelerations and of forces is (am, af) to have the spectral
   radius rho at infinite frequency. */
static void hht_means(fixed *f, double rho) { f->af = (1 - rho) / (1 + rho); }

static void generalized_alpha_means(fixed *f, double rho) {
  f->am = (2 * rho - 1) / (rho + 1);
  f->af = rho / (rho + 1);
}

#define BDF(word, its_order) \
  { .name = word, .order = its_order, .prepare = bdf_prepare, .finish = bdf_finish }
#define NEWMARK(word, its_means)                                          \
  {                                                                       \
    .name = word, .needs_acceleration = true, .prepare = newmark_prepare, \
    .finish = newmark_finish, .means = its_means                          \
  }

static const scheme schemes[] = {
    BDF("backward-euler", 1),
    BDF("bdf2", 2),
    BDF("bdf3", 3),
    {.name = "midpoint", .prepare = midpoint_prepare, .finish = midpoint_finish},
    NEWMARK("newmark", NULL),
    NEWMARK("hht", hht_means),
    NEWMARK("generalized-alpha", generalized_alpha_means),
};

const scheme *corot_scheme_find(const char *name) {
  for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++)
    if (strcmp(name, schemes[k].name) == 0) return &schemes[k];
  return NULL;
}

void corot_scheme_set_family(fixed *f, double rho) {
  if (f->scheme->means) f->scheme->means(f, rho);
  double less = f->am - f->af;
  f->gamma = 0.5 - less;
  f->beta = 0.25 * (1 - less) * (1 - less);
}
