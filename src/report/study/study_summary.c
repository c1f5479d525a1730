/* Sentences first, then the table of cells. */
#include "study_summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/read/lookup.h"

static void write_outcome(const study_table *t, FILE *out) {
  int count[3] = {0};
  for (int i = 0; i < t->ncell; i++) count[t->cell[i].status]++;
  bool all = count[STUDY_DONE] == t->ncell;
  fprintf(out, "<p class=\"outcome %s\"><b>%s</b></p>\n", all ? "good" : "bad",
          count[STUDY_MISSING] ? "unfinished"
          : all                ? "finished"
                               : "finished, with failures");
  char label[160] = "";
  if (t->nerror > 0) study_error_label(t->error_name[t->measure], sizeof label, label);
  page_element(out, "p class=\"lead\"",
               "%d runs in %d series: %d done, %d failed, %d missing.%s%s%s", t->ncell, t->nseries,
               count[STUDY_DONE], count[STUDY_FAILED], count[STUDY_MISSING],
               *label ? " Compared by the " : "", label, *label ? "." : "");
}

/* What errors against known values are held against. */
static void write_known(const study_table *t, FILE *out) {
  const json_t *known = lookup(t->root, "known");
  for (size_t i = 0; i < json_array_size(known); i++) {
    const json_t *k = json_array_get(known, i);
    double value = lookup_number(k, "value"), scale = lookup_number(k, "scale");
    char within[48] = "", relative[48] = "";
    if (lookup_number(k, "within") > 0)
      snprintf(within, sizeof within, " within %.3g", lookup_number(k, "within"));
    if (scale != fabs(value)) snprintf(relative, sizeof relative, " to %.6g", scale);
    page_element(out, "p", "Known: %s is %.6g%s; its errors are total, signed and relative%s.",
                 lookup_text(k, "measure"), value, within, relative);
  }
}

static void write_references(const study_table *t, FILE *out) {
  const json_t *references = lookup(t->root, "references");
  const char *shared = lookup_text(t->root, "shared");
  if (*shared) page_element(out, "p", "%s", shared);
  page_warning(lookup_text(t->root, "mixed"), out);
  /* how far each is to be trusted */
  for (size_t i = 0; i < json_array_size(references); i++) {
    const json_t *r = json_array_get(references, i);
    const json_t *agree = lookup(r, "agree");
    const char *note = lookup_text(r, "note"), *reason = lookup_text(r, "reason");
    bool bad = json_is_false(agree) || *reason;
    page_element(out, bad ? "p class=\"warning\"" : "p", "Reference%s%s%s%s", *note ? ": " : "",
                 note, *reason ? ": " : "", reason);
  }
  /* what the meshes do, which no reference knows of */
  const json_t *space = lookup(t->root, "space");
  for (size_t i = 0; i < json_array_size(space); i++) {
    const json_t *s = json_array_get(space, i);
    const char *measure = lookup_text(s, "measure");
    bool quantity = strpbrk(measure, "(@") != NULL;
    page_element(out, "p", "Error of the mesh at mesh.refine %.0f, relative%s%s: %s.",
                 lookup_number(s, "refine"), quantity ? ", of " : "", quantity ? measure : "",
                 lookup_text(s, "verdict"));
  }
  write_known(t, out);
  if (t->nerror > 0 && !t->known[t->measure] && isfinite(t->floor[t->measure]))
    page_element(out, "p",
                 "Errors below %.1e, ten times what the references differ by, are not rated.",
                 STUDY_FLOOR_FACTOR * t->floor[t->measure]);
}

/* "ida (integrator.rtol 0.001)" and its cost. */
static void write_best(const json_t *best, FILE *out) {
  markup_text(out, lookup_text(best, "series"));
  double tolerance = lookup_number(best, "tolerance");
  if (!isfinite(tolerance)) return;
  const char *key = lookup_text(best, "tolerance_key");
  fputs(" <span class=\"soft\">", out);
  markup_text(out, *key ? key : "tolerance");
  fprintf(out, " %.3g</span>", tolerance);
}

/* "0.012 s of CPU time", "531 right-hand sides". */
static void write_cost(study_cost kind, double cost, FILE *out) {
  const char *label = study_cost_label[kind];
  if (kind == STUDY_CPU || kind == STUDY_WALL)
    fprintf(out, "%.3g s of %.*s", cost, (int)strcspn(label, "["), label);
  else
    fprintf(out, "%.0f %s", cost, label);
}

/* The questions one comes with, where the study reaches so far. */
static void write_answers(const study_table *t, FILE *out) {
  static const struct {
    double error;
    const char *words;
  } asked[] = {{1e-2, "For 1 % (an error of 1e-2)"}, {1e-6, "For six digits (an error of 1e-6)"}};
  const json_t *rankings = lookup(t->root, "rankings");
  for (int k = 0; k < 2; k++) {
    for (size_t i = 0; i < json_array_size(rankings); i++) {
      const json_t *entry = json_array_get(rankings, i), *list = lookup(entry, "best");
      if (!(fabs(lookup_number(entry, "error") / asked[k].error - 1) < 1e-6)) continue;
      if (json_array_size(list) == 0) continue;
      const json_t *best = json_array_get(list, 0);
      fprintf(out, "<p class=\"answer\">%s: ", asked[k].words);
      write_best(best, out);
      fputs(", ", out);
      write_cost(t->cost, lookup_number(best, "cost"), out);
      fputs("</p>\n", out);
    }
  }
}

static void write_ranking(const json_t *entry, FILE *out) {
  const json_t *list = lookup(entry, "best");
  double cheapest = lookup_number(json_array_get(list, 0), "cost");
  fprintf(out, "<tr><th scope=\"row\">10<sup>%.0f</sup></th><td>",
          log10(lookup_number(entry, "error")));
  size_t n = json_array_size(list);
  if (n > 0)
    write_best(json_array_get(list, 0), out);
  else
    fputs("none", out);
  fputs("</td>", out);
  page_number(out, cheapest, 3);
  fputs("<td>", out);
  for (size_t i = 1; i < n; i++) {
    const json_t *other = json_array_get(list, i);
    if (i > 1) fputs(", ", out);
    markup_text(out, lookup_text(other, "series"));
    if (cheapest > 0) fprintf(out, " × %.2g", lookup_number(other, "cost") / cheapest);
  }
  fputs("</td></tr>\n", out);
}

static void write_rankings(const study_table *t, FILE *out) {
  const json_t *rankings = lookup(t->root, "rankings");
  if (json_array_size(rankings) == 0) return;
  fputs(
      "<div class=\"scroll\" id=\"rankings\"><table><thead><tr><th>error at "
      "most</th><th>cheapest</th>"
      "<th class=\"number\">",
      out);
  markup_text(out, study_cost_label[t->cost]);
  fputs("</th><th>the others, in its cost</th></tr></thead><tbody>\n", out);
  for (size_t i = 0; i < json_array_size(rankings); i++)
    write_ranking(json_array_get(rankings, i), out);
  fputs("</tbody></table></div>\n", out);
}

void study_summary_write(const study_table *t, FILE *out) {
  page_section("summary", "Summary", out);
  write_outcome(t, out);
  write_answers(t, out);
  write_references(t, out);
  write_rankings(t, out);
  page_section_end(out);
}

static void write_error(const study_cell *c, int error, FILE *out) {
  if (isfinite(c->at_most[error]))
    fprintf(out, "<td class=\"number\">at most %.2g</td>", c->at_most[error]);
  else if (!study_cell_rated(c, error) && c->status == STUDY_DONE)
    fprintf(out, "<td class=\"number\">below the floor</td>");
  else
    page_number(out, c->error[error], 2);
}

/* Errors that stand beside the one that runs are compared by. */
static bool is_beside(const study_table *t, int error) {
  return t->known[error] && error != t->measure;
}

static void write_cell(const study_table *t, const study_cell *c, FILE *out) {
  static const char *const word[] = {"done", "failed", "missing"};
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, t->series[c->series]);
  fputs("</th>", out);
  page_number(out, c->tolerance, 3);
  fprintf(out, "<td%s>", c->status == STUDY_DONE ? "" : " class=\"failed\"");
  page_text(out, "%s%s%s", word[c->status], *c->reason ? ": " : "", c->reason);
  fputs("</td>", out);
  if (t->nerror > 0) write_error(c, t->measure, out);
  for (int e = 0; e < t->nerror; e++)
    if (is_beside(t, e)) write_error(c, e, out);
  for (int k = 0; k < STUDY_COSTS; k++)
    page_number(out, c->cost[k], k == STUDY_CPU || k == STUDY_WALL ? 3 : 12);
  fputs("<td class=\"soft\">", out);
  markup_text(out, c->id);
  fputs("</td></tr>\n", out);
}

void study_summary_cells(const study_table *t, FILE *out) {
  page_section("runs", "Runs", out);
  fputs(
      "<div class=\"scroll tall\"><table><thead><tr><th>series</th><th class=\"number\">tolerance"
      "</th><th>outcome</th>",
      out);
  if (t->nerror > 0) fputs("<th class=\"number\">error</th>", out);
  for (int e = 0; e < t->nerror; e++) {
    if (!is_beside(t, e)) continue;
    fputs("<th class=\"number\">", out);
    page_text(out, "error of %s", t->error_name[e]);
    fputs("</th>", out);
  }
  for (int k = 0; k < STUDY_COSTS; k++) {
    fputs("<th class=\"number\">", out);
    markup_text(out, study_cost_label[k]);
    fputs("</th>", out);
  }
  fputs("<th>folder</th></tr></thead><tbody>\n", out);
  for (int i = 0; i < t->ncell; i++) write_cell(t, &t->cell[i], out);
  fputs("</tbody></table></div>\n", out);
  page_section_end(out);
}
