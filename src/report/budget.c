#include "budget.h"

#include <math.h>

#include "lookup.h"
#include "markup.h"
#include "page.h"

/* A row: what, between which two runs, how much, and how much of the largest part. */
static void write_row(const char *part, const char *pair, double error, double largest, FILE *out) {
  double share = largest > 0 && isfinite(error) ? 100 * fmin(1, fabs(error) / largest) : 0;
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, part);
  fputs("</th><td>", out);
  markup_text(out, pair);
  if (isfinite(error))
    fprintf(out, "</td><td class=\"number\">%.2e</td>", error);
  else
    fputs("</td><td class=\"number\">not known</td>", out);
  fprintf(out, "<td class=\"share\"><div style=\"width:%.1f%%\"></div></td></tr>\n", share);
}

void budget_write(const json_t *budget, FILE *out) {
  const json_t *parts = lookup(budget, "parts");
  double largest = 0, total = lookup_number(budget, "total");
  double interaction = lookup_number(budget, "interaction");
  for (size_t i = 0; i < json_array_size(parts); i++)
    largest = fmax(largest, fabs(lookup_number(json_array_get(parts, i), "error")));
  page_section("budget", "Error budget", out);
  if (*lookup_text(budget, "first"))
    page_element(out, "p class=\"answer\"", "%s", lookup_text(budget, "first"));
  if (*lookup_text(budget, "measure")) page_element(out, "p", "%s", lookup_text(budget, "measure"));
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>part</th><th>runs compared</th>"
      "<th class=\"number\">error</th><th></th></tr></thead>\n<tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(parts); i++) {
    const json_t *part = json_array_get(parts, i);
    write_row(lookup_text(part, "part"), lookup_text(part, "pair"), lookup_number(part, "error"),
              largest, out);
  }
  if (isfinite(total)) write_row("total", "all of them at once", total, largest, out);
  if (isfinite(interaction))
    write_row("interaction", "total less the parts", interaction, largest, out);
  fputs("</tbody></table></div>\n", out);
  page_section_end(out);
}
