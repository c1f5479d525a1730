/* Makes the list; names are those that `--set` and probes.csv have for the same numbers. */
#include "variables.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/words.h"
#include "app/text/no_memory.h"

static char *print(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The caller's; NULL: no memory. */
static char *print(const char *format, ...) {
  va_list one, two;
  va_start(one, format);
  va_copy(two, one);
  int length = vsnprintf(NULL, 0, format, one);
  char *text = length < 0 ? NULL : malloc((size_t)length + 1);
  if (text) vsnprintf(text, (size_t)length + 1, format, two);
  va_end(two);
  va_end(one);
  return text;
}

static void add(variables *v, variable made) { v->all[v->n++] = made; }

static void add_parameters(const body *b, variables *v) {
  const corot_model_def *def = &b->used.model;
  bool list = config_find(b->scenario->source->root, "material")->kind == CONFIG_LIST;
  for (int k = 0; k < def->nmaterial; k++)
    for (int i = 0; i < BODY_MATERIAL; i++) {
      const material_number *number = &body_material_numbers[i];
      const char *group = def->material[k].group;
      char place[32] = "";
      if (list) snprintf(place, sizeof place, "%d.", k);
      add(v, (variable){.kind = VARIABLE_PARAMETER,
                        .index = BODY_MATERIAL * k + i,
                        .size = 1,
                        .name = print("material.%s%s", place, number->key),
                        .about = print("%s%s%s", number->about, group ? " of group " : "",
                                       group ? group : ""),
                        .unit = print("%s", number->unit)});
    }
  v->nparameter = v->n - 1;
}

static void add_inputs(const body *b, variables *v) {
  v->input = v->n;
  for (int i = 0; i < b->used.ninput; i++) {
    const input_def *in = &b->used.input[i];
    bool load = in->of == INPUT_LOAD;
    const corot_load *l = load ? &b->used.model.load[in->index] : NULL;
    add(v,
        (variable){
            .kind = load ? VARIABLE_LOAD : VARIABLE_STIFFNESS,
            .index = i,
            .size = 1,
            .name = print("%s", in->name),
            .about = load ? print("factor of load %d, a %s%s%s", in->index, words_load[l->kind],
                                  l->group ? " on " : "", l->group ? l->group : "")
                          : print("factor of the stiffness and damping of material %d", in->index),
            .unit = print("%s", "")});
  }
  v->ninput = b->used.ninput;
}

/* Stresses are elastic, whatever the damping. */
static unsigned depends_of(probe_of of) {
  switch (of) {
    case PROBE_DISPLACEMENT:
    case PROBE_STRAIN:
    case PROBE_FRAME_ANGLE:
    case PROBE_DET:
    case PROBE_VOLUME:
      return DEPENDS_U;
    case PROBE_STRESS:
    case PROBE_PRINCIPAL:
    case PROBE_VON_MISES:
    case PROBE_TRACTION:
    case PROBE_ELASTIC:
      return DEPENDS_U | DEPENDS_MATERIALS;
    case PROBE_VELOCITY:
    case PROBE_MOMENTUM:
    case PROBE_KINETIC:
      return DEPENDS_V;
    case PROBE_ANGULAR_MOMENTUM:
      return DEPENDS_U | DEPENDS_V;
    default:
      return DEPENDS_ALL;
  }
}

static void add_outputs(const body *b, variables *v) {
  v->output = v->n;
  unsigned moving = corot_model_moves(b->model) ? DEPENDS_TIME : 0;
  for (int i = 0; i < probes_n(b->probes); i++) {
    probe_facts known = probes_known(b->probes, i);
    probe_of of = b->used.probe[i].of;
    for (int c = known.first; c < known.first + known.ncolumn; c++) {
      v->depends[c] = depends_of(of) | moving;
      add(v, (variable){
                 .kind = VARIABLE_OUTPUT,
                 .index = c,
                 .size = 1,
                 .name = print("%s", probes_columns(b->probes)[c]),
                 .about = print("%s, as the probe %s says", probe_quantities[of].word, known.name),
                 .unit = print("%s", probes_unit(b->probes, c))});
    }
  }
  v->noutput = probes_ncolumn(b->probes);
}

static void add_states(const body *b, variables *v) {
  int n = corot_model_ndof(b->model);
  v->state = v->n;
  add(v, (variable){VARIABLE_STATE, 0, n, print("body.u"),
                    print("displacement of all degrees of freedom"), print("m")});
  add(v, (variable){VARIABLE_STATE, 1, n, print("body.v"),
                    print("velocity of all degrees of freedom"), print("m/s")});
  v->slope = v->n;
  add(v, (variable){VARIABLE_SLOPE, 0, n, print("der(body.u)"), print("derivative of body.u"),
                    print("m/s")});
  add(v, (variable){VARIABLE_SLOPE, 1, n, print("der(body.v)"), print("derivative of body.v"),
                    print("m/s^2")});
}

static int by_name(const void *a, const void *b) {
  return strcmp((*(const variable *const *)a)->name, (*(const variable *const *)b)->name);
}

/* All have a name and a text, and each name is that of one. */
static corot_status check(const variables *v) {
  for (int i = 0; i < v->n; i++)
    if (!v->all[i].name || !v->all[i].about || !v->all[i].unit) return no_memory();
  const variable **sorted = malloc((size_t)v->n * sizeof *sorted);
  if (!sorted) return no_memory();
  for (int i = 0; i < v->n; i++) sorted[i] = &v->all[i];
  qsort(sorted, (size_t)v->n, sizeof *sorted, by_name);
  const char *twice = NULL;
  for (int i = 1; i < v->n && !twice; i++)
    if (by_name(&sorted[i - 1], &sorted[i]) == 0) twice = sorted[i]->name;
  free(sorted);
  if (!twice) return COROT_OK;
  return corot_fail(COROT_EFORMAT, "two variables of the FMU would be called %s: rename the input",
                    twice);
}

static corot_status make(const body *b, variables *v) {
  size_t noutput = (size_t)probes_ncolumn(b->probes);
  size_t most = 5 + (size_t)(BODY_MATERIAL * b->used.model.nmaterial + b->used.ninput) + noutput;
  v->all = calloc(most, sizeof *v->all);
  v->depends = calloc(noutput + 1, sizeof *v->depends);
  if (!v->all || !v->depends) return no_memory();
  add(v, (variable){VARIABLE_TIME, 0, 1, print("time"), print("time"), print("s")});
  add_parameters(b, v);
  add_inputs(b, v);
  add_outputs(b, v);
  v->state = v->slope = -1;
  if (!body_no_exchange(b)) add_states(b, v);
  return check(v);
}

corot_status variables_create(const body *b, variables *v) {
  *v = (variables){0};
  corot_status status = make(b, v);
  if (status) variables_clear(v);
  return status;
}

void variables_clear(variables *v) {
  for (int i = 0; i < v->n; i++) {
    free(v->all[i].name);
    free(v->all[i].about);
    free(v->all[i].unit);
  }
  free(v->all);
  free(v->depends);
  *v = (variables){0};
}

double variable_start(const body *b, const variable *v) {
  if (variable_is_input(v)) return body_input_start(b, v->index);
  corot_material material = b->scenario->model.material[v->index / BODY_MATERIAL];
  return *body_material_at(&material, v->index % BODY_MATERIAL);
}
