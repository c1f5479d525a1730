/* The bar as an object of a shared library, for hosts that load one at run time: as few functions
   as the host needs, of plain pointers, numbers and arrays. corot is linked into it. */
#include "bar.h"

#define EXPORT __attribute__((visibility("default")))

typedef struct bar {
  corot_model *model;
  corot_state *state;
} bar;

EXPORT bar *bar_open(void);
EXPORT int bar_unknowns(const bar *b);
EXPORT int bar_rate(bar *b, double t, const double *y, double *ydot);
EXPORT void bar_corner(const bar *b, const double *y, double u[3]);
EXPORT const char *bar_error(void);
EXPORT void bar_close(bar *b);

bar *bar_open(void) {
  bar *b = calloc(1, sizeof *b);
  if (!b) return NULL;
  b->model = bar_create();
  if (corot_state_create(b->model, &b->state)) bar_close(b), b = NULL;
  return b;
}

int bar_unknowns(const bar *b) { return 2 * corot_model_ndof(b->model); }

int bar_rate(bar *b, double t, const double *y, double *ydot) {
  return corot_rhs(b->model, b->state, t, y, ydot);
}

void bar_corner(const bar *b, const double *y, double u[3]) {
  const double top[] = {0.1, 0.1, 0.6};
  int node = corot_mesh_nearest(corot_model_mesh(b->model), top);
  for (int c = 0; c < 3; c++) u[c] = y[corot_model_dof(b->model)[node][c]];
}

const char *bar_error(void) { return corot_error(); }

void bar_close(bar *b) {
  if (!b) return;
  corot_state_destroy(b->state);
  corot_model_destroy(b->model);
  free(b);
}
