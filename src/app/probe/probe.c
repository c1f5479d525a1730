/* The columns of a scenario's probes, and what they are at a moment. */
#include "probe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/probe_location.h"
#include "app/text/json_text.h"
#include "probe_parts.h"

void probes_destroy(probes *p) {
  if (!p) return;
  for (int i = 0; i < p->n; i++) samples_clear(&p->probe[i].samples);
  for (int i = 0; i < p->ncolumn; i++) free(p->column[i]), free(p->unit[i]);
  free(p->column);
  free(p->unit);
  free(p->probe);
  probe_fields_clear(&p->fields);
  free(p);
}

static corot_status out_of_memory(void) {
  return corot_fail(COROT_ENOMEM, "the probes: out of memory");
}

/* --- Columns --- */

static int columns_of(const probe_def *def) {
  return def->component ? 1 : probe_quantities[def->of].n;
}

/* Two words with something between them; the caller's to free. */
static char *join(const char *a, const char *between, const char *b) {
  size_t size = strlen(a) + strlen(between) + strlen(b) + 1;
  char *text = malloc(size);
  if (text) snprintf(text, size, "%s%s%s", a, between, b);
  return text;
}

/* What a sum over tets is weighted by; "": nothing is. */
static const char *measure_of(const probe *p) {
  if (p->quantity->carrier != OF_TETS || p->def->take != TAKE_SUM) return "";
  return p->samples.place ? "m^2" : "m^3";
}

static corot_status add_columns(probes *p, const probe *of) {
  const probe_quantity *q = of->quantity;
  const char *measure = measure_of(of);
  for (int c = 0; c < of->n; c++) {
    bool force = q->carrier == OF_FACES && of->def->take == TAKE_SUM;
    const char *unit = force ? "N" : q->moment_unit && c >= 3 ? q->moment_unit : q->unit;
    char **name = &p->column[p->ncolumn], **of_it = &p->unit[p->ncolumn];
    p->ncolumn++;
    *name = join(of->def->name, ".", of->def->component ? "value" : q->column[c]);
    *of_it = join(unit, *unit && *measure ? " " : "", measure);
    if (!*name || !*of_it) return out_of_memory();
  }
  return COROT_OK;
}

/* --- Making them --- */

static corot_status make_probe(probes *p, const probe_def *def) {
  const corot_mesh *mesh = corot_model_mesh(p->model);
  probe *to = &p->probe[p->n++];
  *to = (probe){.def = def,
                .quantity = &probe_quantities[def->of],
                .first = p->ncolumn,
                .n = columns_of(def)};
  if (probe_is_local(def)) COROT_TRY(probe_locate(def, mesh, &to->at));
  COROT_TRY(samples_create(p->model, to, &p->fields));
  return add_columns(p, to);
}

static corot_status make(probes *p, const scenario *s) {
  size_t most = 1;
  for (int i = 0; i < s->nprobe; i++) most += (size_t)columns_of(&s->probe[i]);
  p->probe = calloc((size_t)s->nprobe + 1, sizeof *p->probe);
  p->column = calloc(most, sizeof *p->column);
  p->unit = calloc(most, sizeof *p->unit);
  if (!p->probe || !p->column || !p->unit) return out_of_memory();
  for (int i = 0; i < s->nprobe; i++) {
    p->fields.needs |= probe_needs(&s->probe[i]);
    COROT_TRY(make_probe(p, &s->probe[i]));
  }
  p->any = p->fields.needs || p->fields.of_tets;
  return p->any ? probe_fields_create(&p->fields) : COROT_OK;
}

corot_status probes_create(const scenario *s, const corot_model *model, probes **out) {
  probes *p = calloc(1, sizeof *p);
  if (!p) return out_of_memory();
  p->model = p->fields.model = model;
  corot_status status = make(p, s);
  if (status == COROT_OK)
    *out = p;
  else
    probes_destroy(p);
  return status;
}

/* --- What is known of them --- */

int probes_ncolumn(const probes *p) { return p->ncolumn; }
const char *const *probes_columns(const probes *p) { return (const char *const *)p->column; }
const char *probes_unit(const probes *p, int i) { return p->unit[i]; }
int probes_n(const probes *p) { return p->n; }

probe_facts probes_known(const probes *p, int i) {
  const probe *of = &p->probe[i];
  const probe_def *def = of->def;
  bool extreme = def->take == TAKE_MAX || def->take == TAKE_MIN;
  bool vector = of->n == 3 && !def->component;
  return (probe_facts){
      .name = def->name,
      .first = of->first,
      .ncolumn = of->n,
      .length = vector && !extreme ? of->quantity->length : NULL,
      .moves = vector && def->of == PROBE_DISPLACEMENT && def->take != TAKE_SUM,
  };
}

/* --- A moment --- */

corot_status probes_evaluate(probes *p, const probe_moment *now, double *value) {
  if (p->any) COROT_TRY(probe_fields_find(&p->fields, now));
  for (int i = 0; i < p->n; i++)
    COROT_TRY(probe_value(&p->probe[i], &p->fields, now, value + p->probe[i].first));
  return COROT_OK;
}

probe_where probes_where(const probes *p, int i, int c) { return p->probe[i].where[c]; }

/* --- JSON --- */

static json_t *vector(const double x[3]) {
  return json_pack("[o, o, o]", json_text_real(x[0]), json_text_real(x[1]), json_text_real(x[2]));
}

void probe_where_exchange(pack *p, probe_where *where) {
  corot_pack_bool(p, &where->known);
  corot_pack_int(p, &where->node);
  corot_pack_int(p, &where->tet);
  corot_pack_doubles(p, where->x, 3);
}

void probes_exchange(pack *p, probes *all) {
  corot_pack_same(p, (uint64_t)all->ncolumn, "the number of columns of the probes");
  for (int i = 0; i < all->n; i++)
    for (int c = 0; c < all->probe[i].n; c++) probe_where_exchange(p, &all->probe[i].where[c]);
}

json_t *probe_where_json(const probe_where *where) {
  bool node = where->node >= 0;
  return json_pack("{s:i, s:o}", node ? "node" : "tet", node ? where->node : where->tet, "x",
                   vector(where->x));
}

/* Of the place of a displacement. */
static void velocity_of(const probe *p, const double (*velocity)[3], double v[3]) {
  v[0] = v[1] = v[2] = 0;
  for (int k = 0; k < p->at.nnode; k++)
    for (int c = 0; c < 3; c++) v[c] += p->at.weight[k] * velocity[p->at.node[k]][c];
}

void probes_rates(const probes *p, const double (*velocity)[3], double *rate) {
  for (int i = 0; i < p->n; i++) {
    const probe *of = &p->probe[i];
    bool plain = probe_is_plain(of->def);
    if (plain) velocity_of(of, velocity, rate + of->first);
    for (int c = 0; !plain && c < of->n; c++) rate[of->first + c] = NAN;
  }
}

static json_t *plain_json(const probe *p, const double *u, const double (*velocity)[3]) {
  double v[3];
  velocity_of(p, velocity, v);
  bool node = p->at.nnode == 1;
  json_t *j = json_object();
  j = json_text_with(j, "node", node ? json_integer(p->at.node[0]) : json_null());
  if (!node) j = json_text_with(j, "tet", json_integer(p->at.tet));
  if (!node) j = json_text_with(j, "x", vector(p->at.x));
  j = json_text_with(j, "u", vector(u));
  return json_text_with(j, "v", vector(v));
}

static json_t *other_json(const probes *all, const probe *p, const double *value) {
  const probe_def *def = p->def;
  json_t *values = json_object(), *at = json_object(), *units = json_object();
  for (int c = 0; c < p->n; c++) {
    const char *component = strrchr(all->column[p->first + c], '.') + 1;
    values = json_text_with(values, component, json_text_real(value[c]));
    units = json_text_with(units, component, json_text_string(all->unit[p->first + c]));
    if (p->where[c].known) at = json_text_with(at, component, probe_where_json(&p->where[c]));
  }
  json_t *j = json_object();
  j = json_text_with(j, "of", json_text_string(p->quantity->word));
  if (def->group) j = json_text_with(j, "group", json_text_string(def->group));
  if (!probe_is_local(def)) j = json_text_with(j, "take", json_text_string(probe_takes[def->take]));
  if (probe_is_local(def) && p->at.nnode == 1)
    j = json_text_with(j, "node", json_integer(p->at.node[0]));
  if (probe_is_local(def)) j = json_text_with(j, "x", vector(p->at.x));
  j = json_text_with(j, "value", values);
  j = json_text_with(j, "unit", units);
  if (json_object_size(at) > 0) return json_text_with(j, "at", at);
  json_decref(at);
  return j;
}

json_t *probes_json(const probes *p, const double *value, const double (*velocity)[3]) {
  json_t *all = json_object();
  for (int i = 0; i < p->n; i++) {
    const probe *of = &p->probe[i];
    const double *its = value + of->first;
    all = json_text_with(
        all, of->def->name,
        probe_is_plain(of->def) ? plain_json(of, its, velocity) : other_json(p, of, its));
  }
  return all;
}
