/* Lengths of texts, and texts cut to a length. */
#include "markup.h"

#include <stdbool.h>
#include <string.h>

#include "app/text/escape.h"

/* What is behind the character at `s`, which may be no character. */
static const char *behind(const char *s) {
  int length = escape_character(s);
  return s + (length ? length : 1);
}

int markup_length(const char *text) {
  int n = 0;
  for (const char *s = text ? text : ""; *s; s = behind(s)) n++;
  return n;
}

void markup_text_cut(FILE *out, const char *text, int most) {
  bool cut = markup_length(text) > most;
  const char *s = text ? text : "";
  for (int n = cut ? 1 : 0; *s && n < most; n++) {
    char one[8] = "";
    const char *next = behind(s);
    memcpy(one, s, (size_t)(next - s));
    escape_markup(one, out);
    s = next;
  }
  if (cut) fputs("\xe2\x80\xa6", out);
}

void markup_text(FILE *out, const char *text) { escape_markup(text, out); }
