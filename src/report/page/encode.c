/* Escapes for text within a script, and base64 for arrays. */
#include "encode.h"

#include <math.h>
#include <string.h>

#include "app/text/escape.h"

void encode_text(const char *text, FILE *out) {
  fputc('"', out);
  for (const char *s = text ? text : ""; *s;) {
    int length = escape_character(s);
    if (!length)
      fputc('?', out);
    else if (length == 1 && strchr("<>&\"'\\\t\n", *s))
      fprintf(out, "\\u%04x", (unsigned)*s);
    else
      fwrite(s, 1, (size_t)length, out);
    s += length ? length : 1;
  }
  fputc('"', out);
}

void encode_number(double x, FILE *out) {
  if (isfinite(x))
    fprintf(out, "%.17g", x);
  else
    fputs("null", out);
}

/* The bytes that stand between calls, fewer than three. */
typedef struct base64 {
  unsigned char byte[3];
  int n;
  FILE *out;
} base64;

static void put_group(base64 *b) {
  static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  uint32_t bits = (uint32_t)b->byte[0] << 16 | (uint32_t)b->byte[1] << 8 | b->byte[2];
  char group[4];
  for (int i = 0; i < 4; i++) group[i] = i > b->n ? '=' : digit[bits >> (18 - 6 * i) & 63];
  fwrite(group, 1, 4, b->out);
}

static void put_byte(base64 *b, unsigned byte) {
  b->byte[b->n++] = (unsigned char)byte;
  if (b->n < 3) return;
  put_group(b);
  memset(b->byte, 0, sizeof b->byte);
  b->n = 0;
}

static void finish(base64 *b) {
  if (b->n > 0) put_group(b);
}

void encode_doubles(size_t n, const double *x, FILE *out) {
  base64 b = {.out = out};
  fputc('"', out);
  for (size_t i = 0; i < n; i++) {
    uint64_t bits;
    memcpy(&bits, &x[i], sizeof bits);
    for (int k = 0; k < 8; k++) put_byte(&b, bits >> 8 * k & 255);
  }
  finish(&b);
  fputc('"', out);
}

void encode_words(size_t n, const uint16_t *x, FILE *out) {
  base64 b = {.out = out};
  fputc('"', out);
  for (size_t i = 0; i < n; i++) {
    put_byte(&b, x[i] & 255u);
    put_byte(&b, x[i] >> 8);
  }
  finish(&b);
  fputc('"', out);
}
