/* Writes the description, part by part in the order that the standard's schema has. */
#include "description.h"

#include <math.h>
#include <string.h>

#include "app/text/escape.h"
#include "app/text/json_text.h"
#include "units.h"

static void attribute(const char *name, const char *text, FILE *out) {
  fprintf(out, " %s=\"", name);
  escape_markup(text, out);
  fputc('"', out);
}

static void number(const char *name, double x, FILE *out) {
  char text[64];
  json_text_number(x, sizeof text, text);
  attribute(name, text, out);
}

/* --- What the FMU can do --- */

static void write_exchange(const description *d, FILE *out) {
  fputs("  <ModelExchange", out);
  attribute("modelIdentifier", d->identifier, out);
  fputs(
      " needsCompletedIntegratorStep=\"false\" canGetAndSetFMUState=\"true\""
      " canSerializeFMUState=\"true\" providesDirectionalDerivatives=\"true\"/>\n",
      out);
}

static void write_simulation(const description *d, FILE *out) {
  double step = d->body->used.integrator.step;
  fputs("  <CoSimulation", out);
  attribute("modelIdentifier", d->identifier, out);
  fputs(
      " canHandleVariableCommunicationStepSize=\"true\" canGetAndSetFMUState=\"true\""
      " canSerializeFMUState=\"true\" providesIntermediateUpdate=\"true\""
      " canReturnEarlyAfterIntermediateUpdate=\"true\"",
      out);
  if (step > 0) number("fixedInternalStepSize", step, out);
  fputs("/>\n", out);
}

/* --- Units --- */

static void write_unit(const char *unit, FILE *out) {
  int power[UNIT_BASES];
  fputs("    <Unit", out);
  attribute("name", unit, out);
  if (!unit_powers(unit, power)) {
    fputs("/>\n", out);
    return;
  }
  fputs("><BaseUnit", out);
  for (int k = 0; k < UNIT_BASES; k++)
    if (power[k]) fprintf(out, " %s=\"%d\"", unit_bases[k], power[k]);
  fputs("/></Unit>\n", out);
}

static bool is_new_unit(const variables *v, int i) {
  for (int k = 0; k < i; k++)
    if (strcmp(v->all[k].unit, v->all[i].unit) == 0) return false;
  return *v->all[i].unit != '\0';
}

static void write_units(const variables *v, FILE *out) {
  fputs("  <UnitDefinitions>\n", out);
  for (int i = 0; i < v->n; i++)
    if (is_new_unit(v, i)) write_unit(v->all[i].unit, out);
  fputs("  </UnitDefinitions>\n", out);
}

/* --- Variables --- */

static const struct {
  const char *causality, *variability, *initial; /* NULL: the standard's default */
} kinds[] = {
    [VARIABLE_TIME] = {"independent", "continuous", NULL},
    [VARIABLE_PARAMETER] = {"parameter", "fixed", "exact"},
    [VARIABLE_LOAD] = {"input", "continuous", NULL},
    [VARIABLE_STIFFNESS] = {"input", "discrete", NULL},
    [VARIABLE_OUTPUT] = {"output", "continuous", "calculated"},
    [VARIABLE_STATE] = {"local", "continuous", "calculated"},
    [VARIABLE_SLOPE] = {"local", "continuous", "calculated"},
};

static double nominal(const corot_model *m, const variable *v) {
  double length = corot_model_length(m);
  return v->index == 0 ? length : length * corot_model_frequency(m);
}

static void write_variable(const description *d, int i, FILE *out) {
  const variable *v = &d->variables->all[i];
  fputs("    <Float64", out);
  attribute("name", v->name, out);
  fprintf(out, " valueReference=\"%d\"", i);
  attribute("causality", kinds[v->kind].causality, out);
  attribute("variability", kinds[v->kind].variability, out);
  if (kinds[v->kind].initial) attribute("initial", kinds[v->kind].initial, out);
  if (*v->unit) attribute("unit", v->unit, out);
  if (v->kind == VARIABLE_PARAMETER || variable_is_input(v))
    number("start", variable_start(d->body, v), out);
  if (v->kind == VARIABLE_OUTPUT && d->simulation) fputs(" intermediateUpdate=\"true\"", out);
  if (v->kind == VARIABLE_STATE) number("nominal", nominal(d->body->model, v), out);
  if (v->kind == VARIABLE_SLOPE) fprintf(out, " derivative=\"%d\"", d->variables->state + v->index);
  attribute("description", v->about, out);
  if (v->size == 1)
    fputs("/>\n", out);
  else
    fprintf(out, "><Dimension start=\"%d\"/></Float64>\n", v->size);
}

/* The states are there for who integrates them. */
static bool is_written(const description *d, const variable *v) {
  return d->exchange || (v->kind != VARIABLE_STATE && v->kind != VARIABLE_SLOPE);
}

static void write_variables(const description *d, FILE *out) {
  fputs("  <ModelVariables>\n", out);
  for (int i = 0; i < d->variables->n; i++)
    if (is_written(d, &d->variables->all[i])) write_variable(d, i, out);
  fputs("  </ModelVariables>\n", out);
}

/* --- Structure --- */

static void add(int reference, bool *first, FILE *out) {
  fprintf(out, "%s%d", *first ? "" : " ", reference);
  *first = false;
}

/* The references that a sum of DEPENDS_ stands for; nothing is said of what may depend on all. */
static void write_dependencies(const description *d, unsigned depends, FILE *out) {
  const variables *v = d->variables;
  bool first = true;
  if (depends == DEPENDS_ALL) return;
  fputs(" dependencies=\"", out);
  if (depends & DEPENDS_TIME) add(0, &first, out);
  for (int i = v->input; i < v->input + v->ninput; i++) {
    unsigned kind = v->all[i].kind == VARIABLE_LOAD ? DEPENDS_LOADS : DEPENDS_MATERIALS;
    if (depends & kind) add(i, &first, out);
  }
  if (d->exchange && depends & DEPENDS_U) add(v->state, &first, out);
  if (d->exchange && depends & DEPENDS_V) add(v->state + 1, &first, out);
  fputc('"', out);
}

static void write_unknown(const description *d, const char *element, int reference,
                          unsigned depends, FILE *out) {
  fprintf(out, "    <%s valueReference=\"%d\"", element, reference);
  write_dependencies(d, depends, out);
  fputs("/>\n", out);
}

static void write_structure(const description *d, FILE *out) {
  const variables *v = d->variables;
  fputs("  <ModelStructure>\n", out);
  for (int c = 0; c < v->noutput; c++)
    write_unknown(d, "Output", v->output + c, v->depends[c], out);
  if (d->exchange) {
    write_unknown(d, "ContinuousStateDerivative", v->slope, DEPENDS_V, out);
    write_unknown(d, "ContinuousStateDerivative", v->slope + 1, DEPENDS_ALL, out);
  }
  /* at the start all that is calculated may depend on all that can be set */
  for (int c = 0; c < v->noutput; c++)
    write_unknown(d, "InitialUnknown", v->output + c, DEPENDS_ALL, out);
  for (int i = 0; d->exchange && i < 4; i++)
    write_unknown(d, "InitialUnknown", v->state + i, DEPENDS_ALL, out);
  fputs("  </ModelStructure>\n", out);
}

/* --- All of it --- */

static void write_experiment(const scenario *s, FILE *out) {
  fputs("  <DefaultExperiment startTime=\"0\"", out);
  number("stopTime", s->t_end, out);
  if (!(s->integrator.step > 0)) number("tolerance", s->integrator.rtol, out);
  number("stepSize", s->output_step, out);
  fputs("/>\n", out);
}

void description_write(const description *d, FILE *out) {
  const scenario *s = d->body->scenario;
  fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\"", out);
  attribute("modelName", d->name, out);
  attribute("instantiationToken", d->body->hashes.run, out);
  if (s->title) attribute("description", s->title, out);
  attribute("license", "BSD-3-Clause AND MIT AND LGPL-2.1-or-later", out);
  fprintf(out, " generationTool=\"corot %s\" variableNamingConvention=\"flat\">\n",
          corot_version());
  if (d->exchange) write_exchange(d, out);
  if (d->simulation) write_simulation(d, out);
  write_units(d->variables, out);
  fputs(
      "  <LogCategories>\n"
      "    <Category name=\"logStatusError\" description=\"a call was refused, or failed\"/>\n"
      "    <Category name=\"logStatusDiscard\" description=\"a state cannot be evaluated\"/>\n"
      "  </LogCategories>\n",
      out);
  write_experiment(s, out);
  write_variables(d, out);
  write_structure(d, out);
  fputs("</fmiModelDescription>\n", out);
}
