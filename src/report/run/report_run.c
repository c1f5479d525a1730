/* The sections of the page of a run, in their order. */
#include "report_run.h"

#include "body.h"
#include "budget_section.h"
#include "report/page/html.h"
#include "report/page/save.h"
#include "report/read/fields_file.h"
#include "report/read/lookup.h"
#include "run_figures.h"
#include "run_summary.h"
#include "static_figures.h"

typedef corot_status figures(const run_folder *run, FILE *out);

static corot_status section(const run_folder *run, const char *id, const char *heading,
                            figures *write, FILE *out) {
  page_section(id, heading, out);
  fputs("<div class=\"figures\">\n", out);
  corot_status status = write(run, out);
  fputs("</div>\n", out);
  page_section_end(out);
  return status;
}

/* The body, where the run wrote fields. */
static corot_status write_body(const run_folder *run, FILE *out) {
  fields f;
  COROT_TRY(fields_open(run->dir, &f));
  f.result = run->result;
  corot_status status = f.nframe > 0 ? body_write(&f, run, out) : COROT_OK;
  fields_close(&f);
  return status;
}

/* What is drawn of a motion, and of an equilibrium. */
static corot_status write_motion(const run_folder *run, FILE *out) {
  if (run->probes.ncolumn > 1) COROT_TRY(section(run, "probes", "Probes", run_figures_probes, out));
  if (run->steps.nrow > 0) COROT_TRY(section(run, "steps", "Steps", run_figures_steps, out));
  return COROT_OK;
}

static corot_status write_equilibrium(const run_folder *run, FILE *out) {
  if (run->probes.ncolumn > 1)
    COROT_TRY(section(run, "probes", "Load and displacement", static_figures_probes, out));
  if (run->reactions.ncolumn > 1)
    COROT_TRY(section(run, "reactions", "Reactions", static_figures_reactions, out));
  if (run->steps.nrow > 0)
    COROT_TRY(section(run, "steps", "Load steps", static_figures_steps, out));
  return COROT_OK;
}

static void write_lost(const run_folder *run, FILE *out) {
  for (size_t i = 0; i < json_array_size(run->lost); i++)
    page_element(out, "p class=\"warning\"",
                 "%s is listed in result.json, and is not there any more: it is left out.",
                 json_string_value(json_array_get(run->lost, i)));
}

static corot_status write_run(const void *what, FILE *out) {
  const run_folder *run = what;
  const char *title = lookup_text(run->result, "title");
  bool still = run_folder_is_static(run);
  page_begin(*title ? title : run->dir, still ? "static" : "run", out);
  /* what it came to */
  run_summary_write(run, out);
  write_lost(run, out);
  if (run->budget) budget_write(run->budget, out);
  if (run->stranger)
    page_element(
        out, "p class=\"warning\"",
        "The budget.json in this folder is not of this run, but of another scenario, mesh or "
        "command: it is left out.");
  /* to look at */
  COROT_TRY(write_body(run, out));
  page_hint(out);
  COROT_TRY(still ? write_equilibrium(run, out) : write_motion(run, out));
  if (run->energy.nrow > 0) COROT_TRY(section(run, "energy", "Energy", run_figures_energy, out));
  if (run->compare.nrow > 0)
    COROT_TRY(section(run, "strains", "Strain measures", run_figures_compare, out));
  /* what was asked for */
  run_summary_scenario(run, out);
  page_end(out);
  return COROT_OK;
}

corot_status report_run(const char *dir, const char *path) {
  run_folder run;
  COROT_TRY(run_folder_read(dir, &run));
  corot_status status = save_text(path, write_run, &run);
  run_folder_free(&run);
  return status;
}
