/* Factors of loads and materials that come in while a run goes on. */
#include <stdio.h>

#include "core/base/fault.h"
#include "core/model/amplitude.h"
#include "scenario_fault.h"
#include "scenario_parts.h"

/* At point i of the values. */
static corot_status fail_at(const scenario *s, int input, int point, const char *reason) {
  const corot_fault at = {
      .entry = "input", .index = input, .field = "amplitude.time", .point = point};
  return scenario_told(s, NULL, corot_fail_about(&at, "%s", reason));
}

static corot_status check_index(const config_node *node, int n, const char *what) {
  if (node->number < n) return COROT_OK;
  return config_fail(node, "there is no %s %.0f: there are %d, counted from 0", what, node->number,
                     n);
}

/* What the values have to be beyond an amplitude's points. */
static corot_status check_values(const scenario *s, int i) {
  const input_def *in = &s->input[i];
  double h = s->integrator.step;
  for (int k = 0; k < in->values.n; k++) {
    double t = in->values.time[k], off = h > 0 ? fabs(t - h * round(t / h)) : 0;
    char reason[160];
    if (in->of == INPUT_MATERIAL && !(in->values.value[k] > 0)) {
      snprintf(reason, sizeof reason, "a factor of a material is above 0, not %g",
               in->values.value[k]);
      return fail_at(s, i, k, reason);
    }
    if (t > 0 && t < s->t_end && off > 1e-9 * h) {
      snprintf(reason, sizeof reason,
               "t = %g s is not at the end of a step of %g s, and a constant "
               "step is not cut",
               t, h);
      return fail_at(s, i, k, reason);
    }
  }
  return COROT_OK;
}

static corot_status read_input(scenario *s, config_node *node, input_def *in) {
  config_node *load = config_find(node, "load"), *of = load ? load : config_find(node, "material");
  *in = (input_def){.name = node->key, .node = node, .of = load ? INPUT_LOAD : INPUT_MATERIAL};
  if (load)
    COROT_TRY(check_index(of, s->model.nload, "load"));
  else
    COROT_TRY(check_index(of, s->model.nmaterial, "material"));
  in->index = (int)of->number;
  for (const input_def *before = s->input; before < in; before++)
    if (before->of == in->of && before->index == in->index)
      return config_fail(of, "inputs.%s is of the same %s", before->name, of->key);
  return scenario_read_amplitude(s, config_find(node, "values"), &in->values);
}

corot_status scenario_read_inputs(scenario *s) {
  config_node *map = config_find(s->source->root, "inputs");
  if (!map || map->nchild == 0) return COROT_OK;
  input_def *input = config_alloc(s->source, (size_t)map->nchild, sizeof *input);
  if (!input) return no_memory();
  s->input = input;
  for (config_node *c = map->child; c; c = c->next) {
    int i = s->ninput;
    amplitude made;
    COROT_TRY(read_input(s, c, &input[i]));
    COROT_TRY(scenario_told(s, NULL, corot_amplitude_create(&input[i].values, "input", i, &made)));
    corot_amplitude_clear(&made);
    s->ninput++;
    COROT_TRY(check_values(s, i));
  }
  return s->ncompare ? scenario_refuse_inputs(s, "compare") : COROT_OK;
}

corot_status scenario_refuse_inputs(const scenario *s, const char *what) {
  if (s->ninput == 0) return COROT_OK;
  return config_fail_key(s->input[0].node, "%s knows nothing of inputs", what);
}
