/* Sentences first, then the tables of facts. */
#include "run_summary.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/text_stream.h"
#include "findings.h"
#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/read/lookup.h"

/* "finished", or what ended it. */
static void write_outcome(const run_folder *run, FILE *out) {
  const json_t *r = run->result;
  const char *status = lookup_text(r, "status"), *reason = lookup_text(r, "reason");
  bool ok = strcmp(status, "ok") == 0;
  double t = lookup_number(r, "t_reached"), end = lookup_number(r, "t_end");
  fprintf(out, "<p class=\"outcome %s\"><b>", ok ? "good" : "bad");
  markup_text(out, ok ? "finished" : status);
  fputs("</b> ", out);
  if (!ok && run_folder_is_static(run))
    fprintf(out, "at load factor %.6g: ", t / run_folder_unit(run));
  else if (!ok)
    fprintf(out, "at t = %.6g s of %.6g s: ", t, end);
  markup_text(out, reason);
  fputs("</p>\n", out);
}

/* Those of order 2 are called by their nodes; runs of earlier versions are of order 1. */
static const char *kind_of_tets(const json_t *result) {
  return lookup_number(result, "mesh.order") == 2 ? "ten-node tets" : "tets";
}

static void write_sentence(const run_folder *run, FILE *out) {
  const json_t *r = run->result;
  double tets = lookup_number(r, "mesh.tets"), dofs = lookup_number(r, "mesh.dofs");
  /* of an equilibrium */
  if (run_folder_is_static(run)) {
    double nstep = lookup_number(r, "statistics.nstep");
    page_element(out, "p class=\"lead\"",
                 "Equilibrium of %.0f %s (%.0f degrees of freedom) with %s strain, in %.0f load "
                 "step%s and %.3g s of CPU time.",
                 tets, kind_of_tets(r), dofs, lookup_text(r, "strain"), nstep,
                 nstep == 1 ? "" : "s", lookup_number(r, "timings.cpu"));
    return;
  }
  /* of a run */
  double step = lookup_number(r, "integrator.step");
  char control[48];
  if (step > 0)
    snprintf(control, sizeof control, "steps of %.4g s", step);
  else
    snprintf(control, sizeof control, "relative tolerance %.3g",
             lookup_number(r, "integrator.rtol"));
  page_element(out, "p class=\"lead\"",
               "%.0f %s (%.0f degrees of freedom) with %s strain, %s frames; %s, %s; %.0f steps "
               "to t = %.6g s in %.3g s of CPU time.",
               tets, kind_of_tets(r), dofs, lookup_text(r, "strain"),
               lookup_text(r, "frames.policy"), lookup_text(r, "integrator.method"), control,
               lookup_number(r, "statistics.nst"), lookup_number(r, "t_reached"),
               lookup_number(r, "timings.cpu"));
}

static void begin_card(const char *title, FILE *out) {
  fputs("<div class=\"card\"><h3>", out);
  markup_text(out, title);
  fputs("</h3><table class=\"facts\">\n", out);
}

static void end_card(FILE *out) { fputs("</table></div>\n", out); }

static void fact_text(const json_t *r, const char *name, const char *path, FILE *out) {
  const char *text = lookup_text(r, path);
  if (*text) page_fact(out, name, "%s", text);
}

static void fact_number(const json_t *r, const char *name, const char *path, const char *unit,
                        FILE *out) {
  double x = lookup_number(r, path);
  if (isfinite(x)) page_fact(out, name, "%.5g%s", x, unit);
}

/* Nothing, where the estimate was not asked for. */
static void write_space_error(const json_t *r, FILE *out) {
  static const char name[] = "space error, estimated";
  const char *left_out = lookup_text(r, "space_error.left_out");
  double relative = lookup_number(r, "space_error.relative");
  if (isfinite(relative))
    page_fact(out, name, "%.2g %% of the displacement at t = %.4g s", 100 * relative,
              lookup_number(r, "space_error.t"));
  else if (*left_out)
    page_fact(out, name, "none: %s", left_out);
}

static void write_solid(const json_t *r, FILE *out) {
  begin_card("Solid", out);
  fact_text(r, "mesh", "mesh.file", out);
  fact_number(r, kind_of_tets(r), "mesh.tets", "", out);
  fact_number(r, "nodes", "mesh.nodes", "", out);
  fact_number(r, "degrees of freedom", "mesh.dofs", "", out);
  fact_text(r, "strain", "strain", out);
  fact_text(r, "frames", "frames.policy", out);
  fact_number(r, "frame interval", "frames.interval", " s", out);
  if (lookup_number(r, "frames.updates") > 0)
    fact_number(r, "updates of frames", "frames.updates", "", out);
  write_space_error(r, out);
  end_card(out);
}

static void write_method(const json_t *r, FILE *out) {
  begin_card("Method", out);
  fact_text(r, "integrator", "integrator.method", out);
  fact_text(r, "table", "integrator.table", out);
  fact_number(r, "relative tolerance", "integrator.rtol", "", out);
  fact_number(r, "absolute, displacement", "integrator.atol_displacement", " m", out);
  fact_number(r, "absolute, velocity", "integrator.atol_velocity", " m/s", out);
  if (lookup_number(r, "integrator.max_order") > 0)
    fact_number(r, "highest order", "integrator.max_order", "", out);
  fact_number(r, "step", "integrator.step", " s", out);
  fact_text(r, "linear solver", "integrator.linear_solver", out);
  fact_text(r, "linear solver", "statics.linear_solver", out);
  fact_number(r, "force tolerance", "statics.tolerance", "", out);
  fact_text(r, "SUNDIALS", "versions.sundials", out);
  end_card(out);
}

static void write_counts(const json_t *r, FILE *out) {
  static const struct {
    const char *name, *path;
    bool always;
  } count[] = {
      {"steps", "statistics.nst", true},
      {"load steps", "statistics.nstep", true},
      {"right-hand sides", "statistics.nfe", true},
      {"error test failures", "statistics.netf", true},
      {"nonlinear iterations", "statistics.nni", true},
      {"nonlinear failures", "statistics.ncfn", true},
      {"assemblies", "statistics.nje", true},
      {"factorisations", "statistics.nfactor", true},
      {"solves", "statistics.nsolve", true},
      {"linear iterations", "statistics.nli", false},
      {"failed solves", "statistics.nlsfail", false},
      {"restarts", "statistics.nrestart", false},
      {"indefinite matrices", "statistics.nindefinite", false},
  };
  begin_card("Counts", out);
  for (size_t i = 0; i < sizeof count / sizeof *count; i++) {
    double n = lookup_number(r, count[i].path);
    if (n > 0 || (count[i].always && n == 0)) page_fact(out, count[i].name, "%.0f", n);
  }
  double peak = lookup_number(r, "memory.peak");
  if (peak > 0) page_fact(out, "largest memory", "%.1f MB", 1e-6 * peak);
  end_card(out);
}

static void write_energy(const run_folder *run, FILE *out) {
  const json_t *r = run->result;
  double work = lookup_number(r, "energy.external_work");
  double elastic = lookup_number(r, "energy.elastic"), kinetic = lookup_number(r, "energy.kinetic");
  double dissipated = lookup_number(r, "energy.dissipated");
  double balance = lookup_number(r, "energy.balance");
  double size = fmax(fmax(fabs(work), elastic), fmax(kinetic, dissipated));
  if (!(size >= 0)) return;
  begin_card("Energy at the end", out);
  page_fact(out, "work of loads and supports", "%.6g J", work);
  page_fact(out, "elastic", "%.6g J", elastic);
  if (!run_folder_is_static(run)) {
    page_fact(out, "kinetic", "%.4g J", kinetic);
    page_fact(out, "dissipated", "%.4g J", dissipated);
  }
  if (size > 0 && !run_folder_is_static(run))
    page_fact(out, "off balance by", "%.2g J, %.2g of the largest", balance, fabs(balance) / size);
  end_card(out);
}

/* The values of a probe that is no displacement, a line each. */
static void write_values(const char *name, json_t *probe, FILE *out) {
  json_t *values = json_object_get(probe, "value"), *value;
  const json_t *units = json_object_get(probe, "unit");
  const char *component;
  json_object_foreach(values, component, value) {
    const char *unit = json_string_value(json_object_get(units, component));
    char title[160];
    snprintf(title, sizeof title, "%.100s.%.40s", name, component);
    page_fact(out, title, "%.5g %s", json_number_value(value), unit ? unit : "");
  }
}

static void write_probes(const json_t *r, FILE *out) {
  json_t *probes = (json_t *)lookup(r, "probes"); /* jansson's iteration wants it so */
  if (json_object_size(probes) == 0) return;
  begin_card("Probes at the end", out);
  const char *name;
  json_t *probe;
  json_object_foreach(probes, name, probe) {
    double u[3];
    if (json_object_get(probe, "of")) {
      write_values(name, probe, out);
      continue;
    }
    for (size_t i = 0; i < 3; i++)
      u[i] = json_number_value(json_array_get(json_object_get(probe, "u"), i));
    page_fact(out, name, "%.5g, %.5g, %.5g m", u[0], u[1], u[2]);
  }
  end_card(out);
}

/* Forces on the body at the last equilibrium. */
static void write_reactions(const json_t *r, FILE *out) {
  json_t *reactions = (json_t *)lookup(r, "statics.reactions");
  if (json_object_size(reactions) == 0) return;
  begin_card("Reactions at the end", out);
  const char *name;
  json_t *force;
  json_object_foreach(reactions, name, force) {
    double f[3], size = 0;
    for (size_t i = 0; i < 3; i++) {
      f[i] = json_number_value(json_array_get(force, i));
      size = fmax(size, fabs(f[i]));
    }
    for (int i = 0; i < 3; i++) /* sums of forces that cancel leave their rounding */
      if (fabs(f[i]) < 1e-10 * size) f[i] = 0;
    page_fact(out, name, "%.5g, %.5g, %.5g N", f[0], f[1], f[2]);
  }
  end_card(out);
}

/* Where the time went, as one bar and its legend. */
static void write_cost(const json_t *r, FILE *out) {
  static const struct {
    const char *key, *name;
  } phase[] = {
      {"setup", "set-up"},         {"force", "forces"},
      {"assembly", "assembly"},    {"combine", "combining matrices"},
      {"factor", "factorisation"}, {"solve", "solves"},
      {"work", "energy ledger"},   {"integrator", "integrator's own"},
      {"frames", "frame updates"}, {"output", "output"},
      {"other", "other"},
  };
  enum { NPHASE = sizeof phase / sizeof *phase };
  double s[NPHASE], sum = 0;
  for (int k = 0; k < NPHASE; k++) {
    char path[64];
    snprintf(path, sizeof path, "timings.%s", phase[k].key);
    s[k] = fmax(0, lookup_number(r, path));
    sum += s[k];
  }
  if (!(sum > 0)) return;
  fprintf(out, "<div class=\"card\" id=\"cost\"><h3>Where %.3g s went</h3><div class=\"bar\">",
          lookup_number(r, "timings.wall"));
  for (int k = 0; k < NPHASE; k++)
    if (s[k] > 0)
      fprintf(out, "<div class=\"p%d\" style=\"width:%.2f%%\"></div>", k, 100 * s[k] / sum);
  fputs("</div><ul class=\"key\">", out);
  for (int k = 0; k < NPHASE; k++)
    if (s[k] >= 0.005 * sum)
      fprintf(out, "<li><i class=\"p%d\"></i>%s %.3g s (%.0f %%)</li>\n", k, phase[k].name, s[k],
              100 * s[k] / sum);
  fputs("</ul></div>\n", out);
}

void run_summary_write(const run_folder *run, FILE *out) {
  const json_t *r = run->result;
  page_section("summary", "Summary", out);
  write_outcome(run, out);
  findings_warnings(run, out);
  write_sentence(run, out);
  fputs("<div class=\"cards\">\n", out);
  write_solid(r, out);
  write_method(r, out);
  write_counts(r, out);
  write_energy(run, out);
  write_probes(r, out);
  write_reactions(r, out);
  write_cost(r, out);
  fputs("</div>\n", out);
  findings_quantities(run, out);
  findings_extremes(run, out);
  page_section_end(out);
}

void run_summary_scenario(const run_folder *run, FILE *out) {
  const json_t *r = run->result;
  char *text = NULL;
  size_t size = 0;
  FILE *memory = text_open(&text, &size);
  const json_t *said = lookup(r, "scenario");
  bool whole = memory && (!said || json_text_write(said, memory) == COROT_OK);
  whole &= text_close(memory) == 0;
  if (!whole) {
    json_text_starve();
    free(text);
    return;
  }
  page_section("scenario", "Scenario", out);
  fputs("<details><summary>all keys, defaults included</summary><pre>", out);
  markup_text(out, text);
  fputs("</pre></details>\n<table class=\"facts\">\n", out);
  fact_text(r, "corot", "versions.corot", out);
  fact_text(r, "compiler", "versions.compiler", out);
  fact_text(r, "commit", "provenance.commit", out);
  fact_text(r, "build", "provenance.build", out);
  fact_text(r, "CHOLMOD", "provenance.suitesparse.cholmod", out);
  fact_text(r, "BLAS", "provenance.blas.config", out);
  fact_text(r, "kernels", "provenance.processor", out);
  fact_text(r, "run", "hashes.run", out);
  fputs("</table>\n", out);
  page_section_end(out);
  free(text);
}
