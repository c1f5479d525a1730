/* The HTML around what a report says: one file that needs no other. Errors are left in the
   stream. */
#ifndef COROT_REPORT_PAGE_HTML_H
#define COROT_REPORT_PAGE_HTML_H

#include <stdio.h>

/* All up to the first section; `kind` is what was done ("run", "study"). */
void page_begin(const char *title, const char *kind, FILE *out);

/* The scripts, and the end. */
void page_end(FILE *out);

/* A section with a heading; `id` is where links lead. */
void page_section(const char *id, const char *heading, FILE *out);
void page_section_end(FILE *out);

/* How charts are handled, for before the first of them. */
void page_hint(FILE *out);

/* A cell of a table: a number of so many digits, or empty where it is not finite. */
void page_number(FILE *out, double x, int digits);

/* Escaped text by the rules of printf, cut at 1023 bytes. */
void page_text(FILE *out, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A paragraph that warns, of any length; nothing for "". */
void page_warning(const char *text, FILE *out);

/* A row of a table of facts: a name, and a value by the rules of printf, escaped. */
void page_fact(FILE *out, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same between <TAG> and </TAG>; the closing tag
   is the first word of `tag`. */
void page_element(FILE *out, const char *tag, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
