/* Whether the space error is estimated, and what becomes of the estimate. */
#include "space.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/text/json_text.h"
#include "core/base/memory_limit.h"
#include "run_clock.h"

/* --- What it costs --- */

/* Seconds on one core of 2023, for a tet or for the factor of n unknowns: measured with boxes of
   300 to 20 000 tets, right to a factor of two. Elsewhere all of them are slower or faster
   together, and it is only compared. */
#define OF_FORCE 1e-7 /* with what an integrator does beside */
#define OF_ASSEMBLY 5e-7
#define OF_SOLUTION 4e-7
#define OF_ITERATION 5e-8 /* conjugate gradients */
#define OF_ESTIMATE 4e-5
static double of_factor(double n) { return 4e-9 * n * n; }

#define MOST_OF_A_RUN 0.1
#define NEXT_TO_NOTHING 0.05 /* [s] as above: what reading and writing files takes anyway */

bool space_is_cheap(double ntet, double n, const run_work *w) {
  double run = ntet * (OF_FORCE * (double)w->nforce + OF_ASSEMBLY * (double)w->nassembly +
                       OF_SOLUTION * (double)w->nsolve + OF_ITERATION * (double)w->niteration);
  if (w->niteration == 0) run += of_factor(n) * (double)w->nfactor;
  double estimate = OF_ESTIMATE * ntet + of_factor(n);
  return estimate <= NEXT_TO_NOTHING || estimate <= MOST_OF_A_RUN * run;
}

/* Model, state and matrices of ten-node tets, 11.5 kB each (corot-bench phases --order 2), and the
   factor of the four-node ones: as much again for a million of them. */
#define BYTES_PER_TET 25e3

bool space_fits(double ntet, double memory) { return ntet * BYTES_PER_TET <= memory; }

/* NULL: nothing is against it. */
static const char *find_reason(const space_question *q) {
  const scenario *s = q->scenario;
  if (s->space_error == SPACE_ERROR_OFF) return "output.space_error is false";
  if (s->ninput) return "there is no estimate beside inputs";
  if (s->model.hierarchy) return "there is no estimate for a hierarchy";
  if (corot_mesh_order(corot_model_mesh(q->model)) != 1)
    return "there is no estimate for ten-node tets";
  if (!q->ended_well) return "the run has not reached its end";
  if (!space_fits(corot_model_mesh(q->model)->ntet, corot_memory_limits().process))
    return "ten-node tets need more memory than there is";
  if (s->space_error == SPACE_ERROR_ON) return NULL;
  if (q->options->lean) return "option --lean";
  if (!space_is_cheap(corot_model_mesh(q->model)->ntet, corot_model_ndof(q->model), &q->work))
    return "it may take more than a tenth of the run; output.space_error: true makes it";
  return NULL;
}

/* --- The estimate --- */

static void describe_worst(const probes *p, space_seen *seen) {
  double most = 0;
  for (int i = 0; i < probes_n(p); i++) {
    probe_facts probe = probes_known(p, i);
    const double *e = seen->probe + probe.first;
    double square = probe.ncolumn == 3 ? e[0] * e[0] + e[1] * e[1] + e[2] * e[2] : 0;
    if (!(square > most)) continue;
    most = square;
    snprintf(seen->worst, sizeof seen->worst, "; probe %.100s lacks (%.2g, %.2g, %.2g) m",
             probe.name, e[0], e[1], e[2]);
  }
}

static corot_status find_estimate(const space_question *q, double (*correction)[3],
                                  space_seen *seen) {
  const scenario *s = q->scenario;
  corot_space_moment at = {.t = q->t, .u = q->u, .v = q->v, .still = q->statics};
  if (q->statics) at.load_t = s->t_end, at.factor = s->t_end > 0 ? q->t / s->t_end : 1;
  corot_status status =
      corot_space_error(&s->model, q->model, &at, NULL, correction, &seen->estimate);
  if (status == COROT_ENOMEM) return status;
  if (status) {
    seen->left_out = "the linear system has no solution";
    return COROT_OK;
  }
  probes_rates(q->probes, (const double(*)[3])correction, seen->probe); /* as linear as the rates */
  describe_worst(q->probes, seen);
  return COROT_OK;
}

corot_status space_ask(const space_question *q, space_seen *out) {
  double started = wall_clock();
  *out = (space_seen){.left_out = find_reason(q), .t = q->t};
  if (out->left_out) return COROT_OK;
  size_t nnode = (size_t)corot_model_mesh(q->model)->nnode;
  double(*correction)[3] = malloc(nnode * sizeof *correction);
  out->probe = calloc((size_t)probes_ncolumn(q->probes) + 1, sizeof *out->probe);
  corot_status status = correction && out->probe
                            ? find_estimate(q, correction, out)
                            : corot_fail(COROT_ENOMEM, "the space error: out of memory");
  free(correction);
  out->wall_s = wall_clock() - started;
  return status;
}

void space_clear(space_seen *s) {
  free(s->probe);
  *s = (space_seen){0};
}

/* --- Told --- */

void space_words(const space_seen *seen, size_t size, char *text) {
  text[0] = 0;
  if (!seen->left_out) snprintf(text, size, "; space error %.2g %%", 100 * seen->estimate.relative);
}

static json_t *corrections_json(const probes *p, const space_seen *seen) {
  json_t *all = json_object();
  for (int i = 0; i < probes_n(p); i++) {
    probe_facts probe = probes_known(p, i);
    if (isnan(seen->probe[probe.first])) continue;
    json_t *list = json_array();
    for (int c = 0; c < probe.ncolumn; c++)
      list = json_text_push(list, json_text_real(seen->probe[probe.first + c]));
    all = json_text_with(all, probe.name, list);
  }
  return all;
}

json_t *space_json(const probes *p, const space_seen *seen) {
  const corot_space_estimate *e = &seen->estimate;
  if (seen->left_out) return json_pack("{s:s}", "left_out", seen->left_out);
  return json_pack("{s:n, s:o, s:o, s:o, s:o, s:b, s:o}", "left_out", "relative",
                   json_text_real(e->relative), "error", json_text_real(e->error), "displacement",
                   json_text_real(e->displacement), "t", json_text_real(seen->t), "indefinite",
                   e->indefinite, "probes", corrections_json(p, seen));
}
