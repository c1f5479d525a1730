/* Head, style and scripts, which are compiled into the program, around the sections. */
#include "html.h"

#include <corot/base.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "app/folder/folder_owner.h"
#include "assets.h"
#include "markup.h"

/* Nothing may be fetched, whatever the data say. */
static const char policy[] =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">\n";

void page_begin(const char *title, const char *kind, FILE *out) {
  fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n", out);
  fputs(policy, out);
  fputs(FOLDER_PAGE_MARK "\n", out);
  fputs(
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>",
      out);
  markup_text(out, title);
  fputs("</title>\n<style>\n", out);
  fwrite(asset_page_css, 1, asset_page_css_size, out);
  fputs("</style>\n</head>\n<body>\n<header><p class=\"kind\">corot ", out);
  markup_text(out, kind);
  fputs("</p><h1>", out);
  markup_text(out, title);
  fputs(
      "</h1></header>\n<main>\n<noscript><p class=\"warning\">The charts need JavaScript. All of "
      "it is in this file; nothing is fetched.</p></noscript>\n",
      out);
}

void page_end(FILE *out) {
  fprintf(out,
          "</main>\n<footer>Written by corot %s. One file; nothing in it is fetched from "
          "elsewhere.</footer>\n<script>\n'use strict';\n(() => {\n",
          corot_version());
  for (int i = 0; i < asset_nscript; i++)
    fwrite(asset_script[i].text, 1, asset_script[i].size, out);
  fputs("})();\n</script>\n</body>\n</html>\n", out);
}

void page_section(const char *id, const char *heading, FILE *out) {
  fputs("<section id=\"", out);
  markup_text(out, id);
  fputs("\"><h2>", out);
  markup_text(out, heading);
  fputs("</h2>\n", out);
}

void page_section_end(FILE *out) { fputs("</section>\n", out); }

void page_hint(FILE *out) {
  fputs(
      "<p class=\"note\">Charts: drag to zoom, shift and drag to move, double click for all. A "
      "click on a name hides its line.</p>\n",
      out);
}

static void print(FILE *out, const char *format, va_list arguments) {
  char text[1024];
  vsnprintf(text, sizeof text, format, arguments);
  markup_text(out, text);
}

void page_text(FILE *out, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  print(out, format, arguments);
  va_end(arguments);
}

void page_warning(const char *text, FILE *out) {
  if (!*text) return;
  fputs("<p class=\"warning\">", out);
  markup_text(out, text);
  fputs("</p>\n", out);
}

void page_number(FILE *out, double x, int digits) {
  fputs("<td class=\"number\">", out);
  if (isfinite(x)) fprintf(out, "%.*g", digits, x);
  fputs("</td>", out);
}

void page_fact(FILE *out, const char *name, const char *format, ...) {
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, name);
  fputs("</th><td>", out);
  va_list arguments;
  va_start(arguments, format);
  print(out, format, arguments);
  va_end(arguments);
  fputs("</td></tr>\n", out);
}

void page_element(FILE *out, const char *tag, const char *format, ...) {
  fprintf(out, "<%s>", tag);
  va_list arguments;
  va_start(arguments, format);
  print(out, format, arguments);
  va_end(arguments);
  fprintf(out, "</%.*s>\n", (int)strcspn(tag, " "), tag);
}
