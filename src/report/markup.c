#include "markup.h"

#include <stdbool.h>
#include <string.h>

int markup_character(const char *text) {
  const unsigned char *s = (const unsigned char *)text;
  if (s[0] < 0x80) return s[0] >= 0x20 && s[0] != 0x7f ? 1 : s[0] == '\t' || s[0] == '\n';
  int length = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
  if (s[0] < 0xc2 || s[0] > 0xf4) return 0;
  for (int i = 1; i < length; i++)
    if ((s[i] & 0xc0) != 0x80) return 0;
  /* too long a spelling, surrogates, beyond U+10FFFF, and the two that are no characters */
  if (s[0] == 0xe0 && s[1] < 0xa0) return 0;
  if (s[0] == 0xed && s[1] > 0x9f) return 0;
  if (s[0] == 0xf0 && s[1] < 0x90) return 0;
  if (s[0] == 0xf4 && s[1] > 0x8f) return 0;
  if (s[0] == 0xef && s[1] == 0xbf && s[2] > 0xbd) return 0;
  return length;
}

/* Writes one character and returns what is behind it. */
static const char *put(FILE *out, const char *s) {
  static const char special[] = "&<>\"'";
  static const char *const entity[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  int length = markup_character(s);
  const char *found = strchr(special, *s);
  if (!length)
    fputc('?', out);
  else if (found)
    fputs(entity[found - special], out);
  else
    fwrite(s, 1, (size_t)length, out);
  return s + (length ? length : 1);
}

int markup_length(const char *text) {
  int n = 0;
  for (const char *s = text ? text : ""; *s; n++) {
    int length = markup_character(s);
    s += length ? length : 1;
  }
  return n;
}

void markup_text_cut(FILE *out, const char *text, int most) {
  bool cut = markup_length(text) > most;
  const char *s = text ? text : "";
  for (int n = cut ? 1 : 0; *s && n < most; n++) s = put(out, s);
  if (cut) fputs("\xe2\x80\xa6", out);
}

void markup_text(FILE *out, const char *text) {
  for (const char *s = text ? text : ""; *s;) s = put(out, s);
}
