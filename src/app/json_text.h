/* JSON text that YAML readers of either version take for the same values: they read 1e-6 as a
   word, so numbers that are not whole are written as 1.0e-06. */
#ifndef COROT_APP_JSON_TEXT_H
#define COROT_APP_JSON_TEXT_H

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

/* The shortest text that reads back as the same number, with a point. */
void json_text_number(double x, size_t size, char *text);

/* Sets a member of an object to a value that it takes over, and hands the object on. Where either
   is NULL for lack of memory, the other is given up and the answer is NULL: a chain of calls needs
   one check at its end. */
json_t *json_text_with(json_t *object, const char *key, json_t *value);

/* A string; bytes that are not UTF-8, as file names may have, become '?'. */
json_t *json_text_string(const char *s);

/* A string in quotes, as JSON, YAML and Python read it. */
void json_text_quote(const char *s, FILE *out);

/* A number, or null for what is not finite. */
json_t *json_text_real(double x);

/* Writes a value in lines indented by two; lists of plain values stay on one. Errors are left in
   the stream. */
void json_text_write(const json_t *value, FILE *out);

#endif
