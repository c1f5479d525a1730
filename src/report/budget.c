#include "budget.h"

#include <math.h>

#include "lookup.h"
#include "markup.h"
#include "page.h"
#include "save.h"

static void begin_row(const char *part, const char *pair, const char *advice, FILE *out) {
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, part);
  fputs("</th><td>", out);
  markup_text(out, pair);
  if (*advice) {
    fputs("<br><span class=\"advice\">to reduce it: ", out);
    markup_text(out, advice);
    fputs("</span>", out);
  }
  fputs("</td>", out);
}

/* A number, and a bar for its share of the largest. */
static void error_cells(double error, double largest, FILE *out) {
  double share = largest > 0 && isfinite(error) ? 100 * fmin(1, fabs(error) / largest) : 0;
  if (isfinite(error))
    fprintf(out, "<td class=\"number\">%.2e</td>", error);
  else
    fputs("<td class=\"number\">not known</td>", out);
  fprintf(out, "<td class=\"share\"><div style=\"width:%.1f%%\"></div></td>", share);
}

static void write_part(const json_t *part, double largest, FILE *out) {
  begin_row(lookup_text(part, "part"), lookup_text(part, "pair"), lookup_text(part, "advice"), out);
  error_cells(lookup_number(part, "error"), largest, out);
  page_number(out, lookup_number(part, "end"), 3);
  page_number(out, lookup_number(part, "alone"), 3);
  page_number(out, lookup_number(part, "cost"), 3);
  fputs("</tr>\n", out);
}

static void write_sum(const json_t *budget, const char *key, const char *name, const char *what,
                      double largest, FILE *out) {
  double error = lookup_number(budget, key);
  if (!isfinite(error)) return;
  begin_row(name, what, "", out);
  error_cells(error, largest, out);
  fputs("<td></td><td></td><td></td></tr>\n", out);
}

static void write_table(const json_t *budget, FILE *out) {
  const json_t *parts = lookup(budget, "parts");
  double largest = 0;
  for (size_t i = 0; i < json_array_size(parts); i++)
    largest = fmax(largest, fabs(lookup_number(json_array_get(parts, i), "error")));
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>part</th><th>taken away by</th>"
      "<th class=\"number\">error</th><th></th><th class=\"number\">at the end</th>"
      "<th class=\"number\">alone</th><th class=\"number\">times the "
      "cost</th></tr></thead>\n<tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(parts); i++)
    write_part(json_array_get(parts, i), largest, out);
  write_sum(budget, "total", "total", "all of them at once", largest, out);
  write_sum(budget, "sum", "sum of the parts", "", largest, out);
  write_sum(budget, "interaction", "interaction", "total less sum", largest, out);
  write_sum(budget, "check", "check of time", "two independent methods", largest, out);
  fputs("</tbody></table></div>\n", out);
}

void budget_write(const json_t *budget, FILE *out) {
  const char *first = lookup_text(budget, "first"), *measure = lookup_text(budget, "measure");
  page_section("budget", "Error budget", out);
  if (*first) page_element(out, "p class=\"answer\"", "%s", first);
  if (*measure) page_element(out, "p", "Error of the %s.", measure);
  write_table(budget, out);
  page_section_end(out);
}

static corot_status write_page(const void *budget, FILE *out) {
  const char *title = lookup_text(budget, "title");
  page_begin(*title ? title : "Error budget", "budget", out);
  budget_write(budget, out);
  page_end(out);
  return COROT_OK;
}

corot_status report_budget(const char *dir, const char *path) {
  json_t *budget;
  COROT_TRY(lookup_read(dir, "budget.json", &budget));
  corot_status status = save_text(path, write_page, budget);
  json_decref(budget);
  return status;
}
