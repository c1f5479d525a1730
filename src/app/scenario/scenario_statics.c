/* How equilibria are found. */
#include "scenario_parts.h"

/* A fraction of the load, which the table knows to be positive. */
static corot_status read_fraction(config_node *node, const char *key, double *value) {
  const config_node *found = config_find(node, key);
  *value = found->number;
  if (found->number <= 1) return COROT_OK;
  return config_fail(found, "must be > 0, at most 1, found %s", found->text);
}

corot_status scenario_read_statics(scenario *s) {
  config_node *root = s->source->root, *node = config_find(root, "statics");
  corot_statics_def def = corot_statics_defaults();
  def.linear = s->integrator.linear;
  def.frames = (corot_frames)choice_at(node, "frames", words_statics_frames);
  def.tolerance = number_at(node, "tolerance");
  def.max_iterations = (int)number_at(node, "max_iterations");
  COROT_TRY(read_fraction(node, "first_step", &def.first_step));
  COROT_TRY(read_fraction(node, "min_step", &def.min_step));
  COROT_TRY(read_fraction(node, "max_step", &def.max_step));
  if (def.min_step > def.max_step)
    return config_fail(config_find(node, "min_step"), "larger than max_step");
  s->statics = def;
  return COROT_OK;
}
