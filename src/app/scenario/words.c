/* A table a choice: reading and telling both look here. */
#include "words.h"

#include <corot/integrate.h>
#include <string.h>

const char *const words_box_split[] = {
    [COROT_BOX_KUHN] = "kuhn",
    [COROT_BOX_ALTERNATING] = "alternating",
    [COROT_BOX_SYMMETRIC] = "symmetric",
    NULL,
};

const char *const words_diagonal[] = {
    [COROT_DIAGONAL_CONSISTENT] = "consistent",
    [COROT_DIAGONAL_SHORTEST] = "shortest",
    NULL,
};

const char *const words_length[] = {"m", "km", "cm", "mm", "um", "nm", "in", "ft", NULL};

double length_in_metres(int unit) {
  static const double metres[] = {1, 1e3, 1e-2, 1e-3, 1e-6, 1e-9, 0.0254, 0.3048};
  return metres[unit];
}

const char *const words_viscosity[] = {
    [COROT_COROTATED] = "corotated",
    [COROT_OBJECTIVE] = "objective",
    [COROT_VISCOSITY_AUTO] = "auto",
    NULL,
};

const char *const words_mass[] = {
    [COROT_MASS_LUMPED] = "lumped",
    [COROT_MASS_CONSISTENT] = "consistent",
    [COROT_MASS_AUTO] = "auto",
    NULL,
};

const char *const words_dilatation[] = {
    [COROT_DILATATION_LOCAL] = "local",
    [COROT_DILATATION_NODAL] = "nodal",
    [COROT_DILATATION_ELEMENT] = "element",
    NULL,
};

const char *const words_coupling[] = {
    [COROT_COUPLING_MEAN] = "mean",
    [COROT_COUPLING_NODES] = "nodes",
    [COROT_COUPLING_ONE_WAY] = "one-way",
    NULL,
};

const char *const words_load[] = {
    [COROT_TRACTION] = "traction",
    [COROT_GRAVITY] = "gravity",
    [COROT_FORCE] = "force",
    [COROT_PRESSURE] = "pressure",
    NULL,
};

const char *const words_solution[] = {
    [COROT_SOLUTION_NEWTON] = "newton",
    [COROT_SOLUTION_LINEAR] = "linear",
    NULL,
};

const char *const words_tangent[] = {
    [COROT_TANGENT_HELD] = "held",
    [COROT_TANGENT_EXACT] = "exact",
    [COROT_TANGENT_CLAMPED] = "clamped",
    NULL,
};

const char *const words_frame_history[] = {
    [COROT_HISTORY_AUTO] = "auto",
    [COROT_HISTORY_KEEP] = "keep",
    [COROT_HISTORY_RESTART] = "restart",
    NULL,
};

const char *const words_statics_frames[] = {
    [COROT_FRAMES_EXACT] = "exact",
    [COROT_FRAMES_HELD] = "held",
    NULL,
};

int words_find(const char *const *words, const char *word) {
  for (int i = 0; words[i]; i++)
    if (strcmp(words[i], word) == 0) return i;
  return -1;
}
