/* The measures by name and number, and what they are like. */
#include "measures.h"

#include <corot/model.h>
#include <string.h>

#include "core/base/names.h"
#include "core/element/strain.h"

#define TRAITS(index, word, pressure_basis, shear_basis, frame_rule)                    \
  [index] = {.name = word,                                                              \
             .frames = frame_rule != FRAME_IDENTITY,                                    \
             .polar = frame_rule == FRAME_POLAR,                                        \
             .linear_in_frames = pressure_basis == BY_FRAME && shear_basis == BY_FRAME, \
             .linear = pressure_basis == BY_FRAME && shear_basis == BY_FRAME &&         \
                       frame_rule == FRAME_IDENTITY,                                    \
             .exact = pressure_basis == BY_GRADIENT && shear_basis == BY_GRADIENT},
static const corot_strain_kind strain_kinds[] = {STRAIN_MEASURES(TRAITS)};

const corot_strain_kind *corot_strain_traits(int i) {
  return i >= 0 && i < NSTRAIN ? &strain_kinds[i] : NULL;
}

const corot_strain_kind *corot_strain_find(const char *name) {
  for (int k = 0; name && k < NSTRAIN; k++)
    if (strcmp(name, strain_kinds[k].name) == 0) return &strain_kinds[k];
  return NULL;
}

static const char *name_of(int i) { return i < NSTRAIN ? strain_kinds[i].name : NULL; }

corot_status corot_strain_index(const char *name, int *strain) {
  const corot_strain_kind *found = corot_strain_find(name);
  char all[NAMES_SIZE];
  if (!found)
    return corot_fail(COROT_EINVAL, "no strain measure '%s': %s", name ? name : "",
                      names_list(name_of, all));
  *strain = (int)(found - strain_kinds);
  return COROT_OK;
}
