/* The answer first, then why: the meshes, the parts of the error, and all runs. */
#include "report_goal.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "goal_answer.h"
#include "goal_figures.h"
#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/page/save.h"
#include "report/read/lookup.h"

/* The parts of an error, by their keys in solve.json. */
typedef struct part {
  const char *key, *name, *how;
  const char *between; /* the runs that it was found by */
} part;

static const part parts[] = {
    {"space", "space", "finer meshes of ten-node tets", "; "},
    {"time", "time",
     "a second method and smaller tolerances on four-node tets, ten times the tolerance on "
     "ten-node "
     "ones",
     "; "},
    {"algebra", "algebra", "a hundred times smaller tolerances of all equations", " against "},
    {"frames", "frames", "none: frames are found in every evaluation, without a hierarchy", ""},
    {"tail", "tail", "what a later extreme could add, after the end of the runs on finer meshes",
     " against "},
    {"model", "strain measure", "the same with strain green", " against "},
};
enum { PARTS = sizeof parts / sizeof *parts };

/* --- The answer --- */

static void write_outcome(const json_t *solved, FILE *out) {
  bool met = json_is_true(lookup(solved, "met"));
  char asked[GOAL_AMOUNT_SIZE], answer[GOAL_ANSWER_SIZE];
  goal_asked(solved, asked);
  goal_answer(solved, "±", answer);
  fprintf(out, "<p class=\"outcome %s\"><b>%s</b> ", met ? "good" : "bad", met ? "met" : "not met");
  page_text(out, "%s%s within %s", lookup_text(solved, "goal"),
            json_is_true(lookup(solved, "static")) ? " of the equilibrium" : "", asked);
  fputs("</p>\n", out);
  page_element(out, "p class=\"answer\"", "%s", answer);
}

static void write_obstacle(const json_t *solved, FILE *out) {
  const char *obstacle = lookup_text(solved, "obstacle"), *advice = lookup_text(solved, "advice");
  if (*obstacle) page_element(out, "p class=\"warning\"", "What stands in the way: %s.", obstacle);
  if (*advice) page_element(out, "p class=\"warning\"", "Advice: %s.", advice);
}

static void write_facts(const json_t *solved, FILE *out) {
  const char *scenario = lookup_text(solved, "scenario"), *why = lookup_text(solved, "why_not");
  double order = lookup_number(solved, "order"), cpu = lookup_number(solved, "cpu_s"),
         overhead = lookup_number(solved, "overhead");
  size_t nrun = json_array_size(lookup(solved, "attempts"));
  fputs("<table class=\"facts\">\n", out);
  if (*scenario) page_fact(out, "scenario", "%s", scenario);
  if (isfinite(order)) page_fact(out, "observed order", "%.2f", order);
  if (json_is_true(lookup(solved, "asymptotic")))
    page_fact(out, "asymptotic", "yes");
  else if (*why && isfinite(lookup_number(solved, "value")))
    page_fact(out, "asymptotic", "no: %s", why);
  if (isfinite(cpu))
    page_fact(out, "cost", "%.3g s of CPU time in %zu run%s", cpu, nrun, nrun == 1 ? "" : "s");
  if (isfinite(overhead))
    page_fact(out, "price of certainty", "%.3g times the cost of the run on the last mesh",
              overhead);
  fputs("</table>\n", out);
}

static void write_answer(const json_t *solved, FILE *out) {
  page_section("answer", "Answer", out);
  write_outcome(solved, out);
  write_obstacle(solved, out);
  write_facts(solved, out);
  page_section_end(out);
}

/* --- Parts --- */

/* A bar, of which `full` is the longest, and the number. */
static void share_cell(double share, double full, FILE *out) {
  fputs("<td class=\"share\">", out);
  if (isfinite(share)) fprintf(out, "<div style=\"width:%.1f%%\"></div>", 100 * share / full);
  if (share > 0 && share < 1e-3)
    fputs("&lt; 0.1 %", out);
  else if (share > 10)
    fprintf(out, "%.3g times", share);
  else if (isfinite(share))
    fprintf(out, "%.*f %%", share > 0 && share < 0.1 ? 1 : 0, 100 * share);
  fputs("</td>", out);
}

static void amount_cell(const json_t *solved, double error, FILE *out) {
  char amount[GOAL_AMOUNT_SIZE] = "";
  if (isfinite(error)) goal_amount(solved, error, amount);
  fputs("<td class=\"number\">", out);
  markup_text(out, isfinite(error) ? amount : "not known");
  fputs("</td>", out);
}

/* How it was found, and by which runs where these are few. */
static void how_cell(const json_t *solved, const part *p, FILE *out) {
  const json_t *runs = lookup(lookup(solved, "measured"), p->key);
  size_t n = json_array_size(runs);
  bool alone = json_array_size(lookup(solved, "levels")) == 1 && strcmp(p->key, "space") == 0;
  fputs("<td>", out);
  markup_text(out, alone ? "ten-node tets in place of four-node ones" : p->how);
  if (n > 0) fputs("<br><span class=\"advice\">", out);
  for (size_t i = 0; i < n && n <= 3; i++) {
    const char *label = json_string_value(json_array_get(runs, i));
    page_text(out, "%s%s", i ? p->between : "", label ? label : "");
  }
  if (n > 3) fprintf(out, "%zu runs", n);
  if (n > 0) fputs("</span>", out);
  fputs("</td></tr>\n", out);
}

/* The user chose the strain measure: what it does counts only where that was asked for. */
static void write_part(const json_t *solved, const part *p, double full, FILE *out) {
  double estimate = lookup_number(lookup(solved, "parts"), p->key),
         half = lookup_number(lookup(solved, "half"), p->key),
         allowed = lookup_number(solved, "allowed");
  bool model = strcmp(p->key, "model") == 0, tail = strcmp(p->key, "tail") == 0;
  bool counts = !model || json_is_true(lookup(solved, "model_counts"));
  if (tail && half == 0) return;
  if (strcmp(p->key, "time") == 0 && json_is_true(lookup(solved, "static"))) return;
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, p->name);
  fputs("</th>", out);
  if (tail)
    fputs("<td></td>", out);
  else
    amount_cell(solved, estimate, out);
  if (counts)
    amount_cell(solved, half, out);
  else
    fputs("<td class=\"number\">does not count</td>", out);
  share_cell(counts ? half / allowed : NAN, full, out);
  how_cell(solved, p, out);
}

static double longest_share(const json_t *solved, double sum) {
  double allowed = lookup_number(solved, "allowed"), longest = fmax(1, sum / allowed);
  for (int i = 0; i < PARTS; i++)
    longest = fmax(longest, lookup_number(lookup(solved, "half"), parts[i].key) / allowed);
  return isfinite(longest) ? longest : 1;
}

static void write_parts(const json_t *solved, FILE *out) {
  double half = (lookup_number(solved, "high") - lookup_number(solved, "low")) / 2;
  double full = longest_share(solved, half), allowed = lookup_number(solved, "allowed");
  if (!isfinite(lookup_number(solved, "value"))) return;
  page_section("parts", "What the error consists of", out);
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>part</th><th class=\"number\">estimate</th>"
      "<th class=\"number\">widens the interval by ±</th><th>share of what is allowed</th>"
      "<th>found by</th></tr></thead>\n<tbody>\n",
      out);
  for (int i = 0; i < PARTS; i++) write_part(solved, &parts[i], full, out);
  fputs("<tr><th scope=\"row\">all of them</th><td></td>", out);
  amount_cell(solved, half, out);
  share_cell(half / allowed, full, out);
  fputs("<td>their sum: none is taken to cancel another</td></tr>\n</tbody></table></div>\n", out);
  page_section_end(out);
}

/* --- Runs --- */

/* "mesh 2, space", the parts that the run of that label is for. */
static void uses_cell(const json_t *solved, const char *label, bool first, FILE *out) {
  const json_t *levels = lookup(solved, "levels"), *measured = lookup(solved, "measured");
  const char *separator = "";
  fputs("<td>", out);
  for (size_t i = 0; i < json_array_size(levels); i++) {
    if (strcmp(lookup_text(json_array_get(levels, i), "label"), label) != 0) continue;
    fprintf(out, "%smesh %zu", separator, i + 1);
    separator = ", ";
  }
  for (int i = 0; i < PARTS; i++) {
    if (!lookup_has_text(lookup(measured, parts[i].key), label)) continue;
    fprintf(out, "%s%s", separator, parts[i].name);
    separator = ", ";
  }
  if (first && !*separator) fputs("a first try", out);
  fputs("</td>", out);
}

static void write_attempt(const json_t *solved, size_t i, FILE *out) {
  const json_t *attempt = json_array_get(lookup(solved, "attempts"), i);
  const char *label = lookup_text(attempt, "label"), *status = lookup_text(attempt, "status"),
             *reason = lookup_text(attempt, "reason");
  bool done = strcmp(status, "done") == 0;
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, label);
  fputs("</th>", out);
  uses_cell(solved, label, i == 0, out);
  double tets = lookup_number(attempt, "tets"), dofs = lookup_number(attempt, "dofs");
  page_number(out, tets > 0 ? tets : NAN, 12);
  page_number(out, dofs > 0 ? dofs : NAN, 12);
  page_number(out, lookup_number(attempt, "value"), 8);
  page_number(out, lookup_number(attempt, "cpu_s"), 3);
  fprintf(out, "<td%s>", done && !*reason ? "" : " class=\"failed\"");
  page_text(out, "%s%s%s", status, *reason ? ": " : "", reason);
  fputs("</td><td class=\"soft\">", out);
  markup_text(out, lookup_text(attempt, "id"));
  fputs("</td></tr>\n", out);
}

static void write_attempts(const json_t *solved, FILE *out) {
  const json_t *attempts = lookup(solved, "attempts");
  if (json_array_size(attempts) == 0) return;
  page_section("attempts", "Runs", out);
  fputs(
      "<div class=\"scroll tall\"><table><thead><tr><th>run</th><th>for</th>"
      "<th class=\"number\">tets</th><th class=\"number\">unknowns</th>"
      "<th class=\"number\">value</th><th class=\"number\">CPU [s]</th><th>outcome</th>"
      "<th>folder</th></tr></thead><tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(attempts); i++) write_attempt(solved, i, out);
  fputs("</tbody></table></div>\n", out);
  page_section_end(out);
}

static corot_status write_page(const void *solved, FILE *out) {
  const char *title = lookup_text(solved, "title");
  page_begin(*title ? title : "A goal", "solve", out);
  write_answer(solved, out);
  corot_status status = goal_figures_meshes(solved, out);
  write_parts(solved, out);
  write_attempts(solved, out);
  page_end(out);
  return status;
}

corot_status report_goal(const char *dir, const char *path) {
  json_t *solved;
  COROT_TRY(lookup_read(dir, "solve.json", &solved));
  corot_status status = save_text(path, write_page, solved);
  json_decref(solved);
  return status;
}
