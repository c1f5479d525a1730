/* Hands the columns of each step to the meter. */
#include "quantities.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/write_csv.h"
#include "app/quantity/meter.h"
#include "app/scenario/scenario_quantities.h"
#include "app/text/json_text.h"
#include "app/text/say.h"

struct quantities {
  const scenario *scenario;
  int nprobed;       /* columns of the probes */
  const char **unit; /* [nquantity] of its column */
  meter *meter;
  const probes *probes;
  double *value, *rate; /* [nprobed + LEDGER_COLUMNS] of a row; and their derivatives, of the
                           ledger's NaN */
};

/* --- The columns --- */

/* What the ledger's columns are measured in. */
static const char *const ledger_units[LEDGER_COLUMNS] = {
    "J", "J", "J", "J", "J", "J", "kg m/s", "kg m/s", "kg m/s", "kg m^2/s", "kg m^2/s", "kg m^2/s",
};

/* The names of all columns, the probes' and then the ledger's. */
typedef struct columns {
  int n, nprobed;
  const char **name;                /* [n] */
  char text[sizeof "kinetic" * 32]; /* the ledger's names */
} columns;

static corot_status list_columns(const probes *p, columns *c) {
  c->nprobed = probes_ncolumn(p);
  c->name = malloc(((size_t)c->nprobed + LEDGER_COLUMNS) * sizeof *c->name);
  if (!c->name) return corot_fail(COROT_ENOMEM, "quantities: out of memory");
  for (c->n = 0; c->n < c->nprobed; c->n++) c->name[c->n] = probes_columns(p)[c->n];
  snprintf(c->text, sizeof c->text, "%s", ledger_columns);
  for (char *name = c->text; name; c->n++) {
    c->name[c->n] = name;
    name = strchr(name, ',');
    if (name) *name++ = '\0';
  }
  return COROT_OK;
}

static corot_status resolve(const scenario *s, const columns *c, int i, quantity *q) {
  size_t at;
  *q = s->quantity[i].quantity;
  corot_status status = quantity_resolve(q, c->n, c->name, &at);
  return status == COROT_OK ? COROT_OK : scenario_quantity_fail(&s->quantity[i], at);
}

static corot_status check_statics(const quantity_def *def) {
  if (def->quantity.operation != QUANTITY_PERIOD) return COROT_OK;
  corot_fail(COROT_EFORMAT, "an equilibrium has no period: its load grows once, in steps");
  return scenario_quantity_fail(def, def->quantity.operation_at);
}

corot_status quantities_check(const scenario *s, const corot_model *model, bool statics) {
  probes *p = NULL;
  columns c = {0};
  if (s->nquantity == 0) return COROT_OK;
  corot_status status = probes_create(s, model, &p);
  if (status == COROT_OK) status = list_columns(p, &c);
  for (int i = 0; status == COROT_OK && i < s->nquantity; i++) {
    quantity q;
    status = resolve(s, &c, i, &q);
    if (status == COROT_OK && statics) status = check_statics(&s->quantity[i]);
  }
  free(c.name);
  probes_destroy(p);
  return status;
}

/* --- Their life --- */

void quantities_destroy(quantities *q) {
  if (!q) return;
  meter_destroy(q->meter);
  free(q->unit);
  free(q->value);
  free(q);
}

static corot_status make(quantities *q, const probes *p, const columns *c) {
  const scenario *s = q->scenario;
  quantity *of = malloc(((size_t)s->nquantity + 1) * sizeof *of);
  q->unit = malloc(((size_t)s->nquantity + 1) * sizeof *q->unit);
  q->probes = p;
  q->value = malloc(2 * (size_t)c->n * sizeof *q->value);
  corot_status status = of && q->unit && q->value ? COROT_OK : COROT_ENOMEM;
  if (status != COROT_OK) corot_fail(status, "quantities: out of memory");
  q->rate = q->value ? q->value + c->n : NULL;
  for (int i = 0; q->rate && i < c->n; i++) q->rate[i] = NAN;
  for (int i = 0; status == COROT_OK && i < s->nquantity; i++) {
    status = resolve(s, c, i, &of[i]);
    if (status != COROT_OK) break;
    int column = of[i].column;
    q->unit[i] = column < c->nprobed ? probes_unit(p, column) : ledger_units[column - c->nprobed];
  }
  if (status == COROT_OK) status = meter_create(s->nquantity, of, s->t_end, &q->meter);
  free(of);
  return status;
}

corot_status quantities_create(const scenario *s, const probes *p, quantities **out) {
  columns c = {0};
  quantities *q = calloc(1, sizeof *q);
  if (!q) return corot_fail(COROT_ENOMEM, "quantities: out of memory");
  q->scenario = s;
  corot_status status = list_columns(p, &c);
  q->nprobed = c.nprobed;
  if (status == COROT_OK) status = make(q, p, &c);
  free(c.name);
  if (status == COROT_OK)
    *out = q;
  else
    quantities_destroy(q);
  return status;
}

/* --- Step by step --- */

bool quantities_wanted(const quantities *q) { return meter_count(q->meter) > 0; }

void quantities_row(quantities *q, const ledger *now, const double *probed,
                    const double (*velocity)[3]) {
  if (!quantities_wanted(q)) return;
  if (velocity) probes_rates(q->probes, velocity, q->rate);
  memcpy(q->value, probed, (size_t)q->nprobed * sizeof *probed);
  ledger_values(now, q->value + q->nprobed);
  meter_row(q->meter, now->t, q->value, velocity ? q->rate : NULL);
}

void quantities_break(quantities *q) { meter_break(q->meter); }

void quantities_exchange(pack *p, quantities *q) { meter_exchange(p, q->meter); }

void quantities_close(quantities *q) { meter_close(q->meter); }

/* --- What has come of them --- */

int quantities_unanswered(const quantities *q) {
  int n = 0;
  for (int i = 0; i < meter_count(q->meter); i++) {
    quantity_value v = meter_value(q->meter, i);
    n += !v.known && v.reached;
  }
  return n;
}

corot_status quantities_warn(const quantities *q, warnings *w) {
  for (int i = 0; i < meter_count(q->meter); i++) {
    const quantity_def *def = &q->scenario->quantity[i];
    quantity_value v = meter_value(q->meter, i);
    if (v.known || !v.reached) continue;
    COROT_TRY(warnings_add(w, WARNING_QUANTITY, "quantities.%s has no value: %s: %s", def->name,
                           def->quantity.text, v.why));
  }
  return COROT_OK;
}

/* An integral is over time, a time in seconds; what is a pure number has no unit. */
static void describe_unit(const quantity *q, const char *column, size_t size, char *unit) {
  bool time = q->when || q->operation == QUANTITY_PERIOD;
  bool integral = q->operation == QUANTITY_INTEGRAL;
  snprintf(unit, size, "%s%s%s", time ? "s" : column, integral && *column ? " " : "",
           integral ? "s" : "");
}

void quantities_tell(const quantities *q) {
  for (int i = 0; i < meter_count(q->meter); i++) {
    const quantity_def *def = &q->scenario->quantity[i];
    quantity_value v = meter_value(q->meter, i);
    char unit[64], when[48] = "";
    describe_unit(&def->quantity, q->unit[i], sizeof unit, unit);
    if (v.t == v.t) snprintf(when, sizeof when, " at t = %.6g s", v.t);
    if (v.known)
      say("  %-14s %.6g %s%s\n", def->name, v.value, unit, when);
    else
      say("  %-14s no value: %s\n", def->name, v.why);
  }
}

static json_t *value_json(const quantity *q, const char *column, quantity_value v) {
  char text[QUANTITY_TEXT], unit[64];
  quantity_print(q, text);
  describe_unit(q, column, sizeof unit, unit);
  json_t *json = json_pack("{s:s, s:o}", "of", text, "value", json_text_real(v.value));
  if (v.t == v.t) json = json_text_with(json, "t", json_text_real(v.t));
  if (*unit) json = json_text_with(json, "unit", json_string(unit));
  return v.known ? json : json_text_with(json, "reason", json_string(v.why));
}

json_t *quantities_json(const quantities *q) {
  json_t *all = json_object();
  for (int i = 0; i < meter_count(q->meter); i++) {
    const quantity_def *def = &q->scenario->quantity[i];
    all = json_text_with(all, def->name,
                         value_json(&def->quantity, q->unit[i], meter_value(q->meter, i)));
  }
  return all;
}
