/* Numbers and text for scripts: JSON that may stand within <script>, and arrays as base64 of their
   little-endian bytes. Errors are left in the stream. */
#ifndef COROT_REPORT_PAGE_ENCODE_H
#define COROT_REPORT_PAGE_ENCODE_H

#include <stdint.h>
#include <stdio.h>

/* A JSON string; what is not UTF-8 becomes '?'. NULL is "". */
void encode_text(const char *text, FILE *out);

/* null where x is not finite. */
void encode_number(double x, FILE *out);

/* JSON strings of base64. */
void encode_doubles(size_t n, const double *x, FILE *out);
void encode_words(size_t n, const uint16_t *x, FILE *out);

#endif
