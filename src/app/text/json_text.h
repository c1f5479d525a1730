/* JSON text that YAML readers of either version take for the same values: they read 1e-6 as a
   word, so numbers that are not whole are written as 1.0e-06. */
#ifndef COROT_APP_TEXT_JSON_TEXT_H
#define COROT_APP_TEXT_JSON_TEXT_H

#include <corot/base.h>
#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The shortest text that reads back as the same number, with a point. */
void json_text_number(double x, size_t size, char *text);

/* Sets a member of an object to a value that it takes over, and hands the object on. Where either
   is NULL for lack of memory, the other is given up and the answer is NULL: a chain of calls needs
   one check at its end. */
json_t *json_text_with(json_t *object, const char *key, json_t *value);

/* The same for a list, to which it appends. */
json_t *json_text_push(json_t *list, json_t *value);

/* A string; bytes that are not UTF-8, as file names may have, become '?'. */
json_t *json_text_string(const char *s);

/* As json_dumps of any value, but NULL for want of memory, where jansson may leave something out
   and say nothing. The caller's to free. */
char *json_text_dump_plain(const json_t *value, size_t flags);

/* The same; the control characters that YAML does not allow as they are, are
   escaped. The caller's to free; NULL: no memory. */
char *json_text_dump(const json_t *value, size_t flags);

/* Whether jansson has been refused memory on this thread since the last call: it does not always
   say so. Those who write what was built ask before they call it whole. */
bool json_text_starved(void);

/* Has json_text_starved() say so: for writers of parts that have no status of their own. */
void json_text_starve(void);

/* Reads a value; `path` is for the message. COROT_EFORMAT, or COROT_ENOMEM, which jansson itself
   reports as one or another error of the text. The caller's to json_decref. */
corot_status json_text_parse(const char *path, const char *text, size_t size, json_t **out);

/* Writes it to stdout, where the program looks at errors of the stream in the end. NULL, which is
   what a failed json_pack gives: COROT_ENOMEM. */
corot_status json_text_show(const json_t *value);

/* A string in quotes, as JSON and YAML read it. COROT_ENOMEM; errors of the stream are left in it.
 */
corot_status json_text_quote(const char *s, FILE *out);

/* A number, or null for what is not finite. */
json_t *json_text_real(double x);

/* Writes a value in lines indented by two; lists of plain values stay on one. COROT_ENOMEM; errors
   of the stream are left in it. */
corot_status json_text_write(const json_t *value, FILE *out);

#endif
