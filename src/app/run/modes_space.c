/* A mode x of the frequency w as a motion that stands still in its turning point: the space error
   leaves K2 y = w^2 M2 x on ten-node tets, which is nearly (w / w2)^2 x. */
#include "modes_space.h"

#include <corot/space.h>
#include <math.h>
#include <stdlib.h>

#define MOST_TOO_FAST 0.05
#define SMALL 1e-6 /* of the body's length: displacements that every measure takes for linear */

/* -1: there is none. */
static int first_swinging(const corot_modes *modes) {
  for (int i = 0; i < corot_modes_count(modes); i++)
    if (corot_modes_at(modes, i).frequency > 0) return i;
  return -1;
}

/* The same body without loads, which modes about rest have not. */
static corot_status make_bare(const scenario *s, const corot_model *model, corot_model_def *def,
                              corot_model **bare) {
  *def = s->model;
  def->mesh = corot_model_mesh(model);
  def->nload = 0;
  return corot_model_create(def, bare);
}

static corot_status estimate(const scenario *s, const corot_model *model, const double *shape,
                             corot_space_estimate *out) {
  int n = corot_model_ndof(model);
  corot_model_def def;
  corot_model *bare = NULL;
  double *u = calloc(2 * (size_t)n + 1, sizeof *u), most = 0;
  corot_status status = u ? COROT_OK : corot_fail(COROT_ENOMEM, "the space error: out of memory");
  for (int i = 0; u && i < n; i++) most = fmax(most, fabs(shape[i]));
  for (int i = 0; u && i < n; i++) u[i] = SMALL * corot_model_length(model) / most * shape[i];
  if (status == COROT_OK) status = make_bare(s, model, &def, &bare);
  corot_space_moment at = {.u = u, .v = u ? u + n : NULL};
  if (status == COROT_OK) status = corot_space_error(&def, bare, &at, NULL, NULL, out);
  corot_model_destroy(bare);
  free(u);
  return status;
}

corot_status modes_space_warn(const scenario *s, const corot_model *model, const corot_modes *modes,
                              warnings *w) {
  int k = first_swinging(modes);
  corot_space_estimate e;
  bool has_none = s->model.hierarchy || corot_mesh_order(corot_model_mesh(model)) != 1;
  if (k < 0 || has_none || s->space_error == SPACE_ERROR_OFF) return COROT_OK;
  corot_mode mode = corot_modes_at(modes, k);
  corot_status status = estimate(s, model, mode.shape, &e);
  if (status != COROT_OK) return status == COROT_ENOMEM ? status : COROT_OK;
  double slower = sqrt(fmax(0, 1 - e.relative)); /* w2 / w */
  if (!(slower * (1 + MOST_TOO_FAST) < 1)) return COROT_OK;
  return warnings_add(
      w, WARNING_SPACE,
      "the mesh is too coarse: its four-node tets are too stiff, and mode %d, at "
      "%.4g Hz, would be near %.2g Hz on ten-node ones, as one linear solve says (%g "
      "%% would pass); mesh.order: 2 tells",
      k + 1, mode.frequency, slower * mode.frequency, 100 * MOST_TOO_FAST);
}
