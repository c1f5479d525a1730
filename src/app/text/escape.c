/* One function a format. All take text apart by escape_character(). */
#include "escape.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int escape_character(const char *text) {
  const unsigned char *s = (const unsigned char *)text;
  if (s[0] < 0x80) return s[0] >= 0x20 && s[0] != 0x7f ? 1 : s[0] == '\t' || s[0] == '\n';
  int length = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
  if (s[0] < 0xc2 || s[0] > 0xf4) return 0;
  for (int i = 1; i < length; i++)
    if ((s[i] & 0xc0) != 0x80) return 0;
  /* control characters, too long a spelling, surrogates, beyond U+10FFFF, and the two that are no
     characters */
  if (s[0] == 0xc2 && s[1] < 0xa0) return 0;
  if (s[0] == 0xe0 && s[1] < 0xa0) return 0;
  if (s[0] == 0xed && s[1] > 0x9f) return 0;
  if (s[0] == 0xf0 && s[1] < 0x90) return 0;
  if (s[0] == 0xf4 && s[1] > 0x8f) return 0;
  if (s[0] == 0xef && s[1] == 0xbf && s[2] > 0xbd) return 0;
  return length;
}

/* The same for lines that people read: what turns the order of the text around it (U+202A to
   U+202E, U+2066 to U+2069), so that a comment reads as a command, cannot be shown either. */
static int shown_character(const char *s) {
  const unsigned char *u = (const unsigned char *)s;
  bool turns = u[0] == 0xe2 && ((u[1] == 0x80 && u[2] >= 0xaa && u[2] <= 0xae) ||
                                (u[1] == 0x81 && u[2] >= 0xa6 && u[2] <= 0xa9));
  return turns ? 0 : escape_character(s);
}

/* Writes one character, or '?' for a byte that is none; returns what is behind it. */
static const char *put(const char *s, FILE *out) {
  int length = escape_character(s);
  if (length)
    fwrite(s, 1, (size_t)length, out);
  else
    fputc('?', out);
  return s + (length ? length : 1);
}

/* The separators of lines and paragraphs end a line for some readers. */
static bool is_break(const char *s) {
  return *s == '\n' || *s == '\r' || *s == '\t' || strncmp(s, "\xe2\x80\xa8", 3) == 0 ||
         strncmp(s, "\xe2\x80\xa9", 3) == 0;
}

/* The same of what is shown. */
static const char *put_shown(const char *s, FILE *out) {
  if (shown_character(s)) return put(s, out);
  fputc('?', out);
  return s + 1;
}

/* The same, with a space for what would end the line. */
static const char *put_in_line(const char *s, FILE *out) {
  if (!is_break(s)) return put_shown(s, out);
  fputc(' ', out);
  return s + (*s & 0x80 ? 3 : 1);
}

void escape_shell(const char *text, FILE *out) {
  fputc('\'', out);
  for (const char *s = text ? text : ""; *s; s++) {
    if (*s == '\'')
      fputs("'\\''", out);
    else
      fputc(*s, out);
  }
  fputc('\'', out);
}

void escape_line(const char *text, FILE *out) {
  for (const char *s = text ? text : ""; *s;) s = put_in_line(s, out);
}

const char *escape_line_cut(const char *text, size_t size, char *line) {
  static const char more[] = "...";
  size_t n = 0, fits = 0; /* `fits`: with the dots behind it */
  const char *s = text ? text : "";
  for (; *s;) {
    int length = shown_character(s), skip = length ? length : 1;
    bool breaks = is_break(s);
    size_t bytes = breaks || !length ? 1 : (size_t)length;
    if (n + bytes >= size) break;
    if (breaks || !length)
      line[n] = breaks ? ' ' : '?';
    else
      memcpy(line + n, s, bytes);
    s += skip;
    n += bytes;
    if (n + sizeof more <= size) fits = n;
  }
  line[n] = '\0';
  if (*s && size >= sizeof more) memcpy(line + fits, more, sizeof more);
  return line;
}

void escape_name(const char *text, FILE *out) {
  static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  for (const char *s = text ? text : ""; *s; s++) fputc(strchr(plain, *s) ? *s : '_', out);
}

static uint32_t code_point(const char *s, int length) {
  static const unsigned char first[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
  uint32_t code = (unsigned char)s[0] & first[length];
  for (int i = 1; i < length; i++) code = code << 6 | ((unsigned char)s[i] & 0x3f);
  return code;
}

/* A byte of no character is U+DC80 to U+DCFF there: Python's "surrogateescape". */
static const char *put_python(const char *s, FILE *out) {
  unsigned char byte = (unsigned char)*s;
  int length = escape_character(s);
  if (byte == 0xc2 && ((unsigned char)s[1] & 0xe0) == 0x80) length = 2; /* a control character */
  if (byte >= 0x20 && byte < 0x7f) {
    if (byte == '"' || byte == '\\') fputc('\\', out);
    fputc(byte, out);
  } else if (byte < 0x80) {
    fprintf(out, "\\x%02x", byte);
  } else if (length == 0) {
    fprintf(out, "\\udc%02x", byte);
  } else {
    fprintf(out, "\\U%08x", (unsigned)code_point(s, length));
  }
  return s + (length ? length : 1);
}

void escape_python(const char *text, FILE *out) {
  fputc('"', out);
  for (const char *s = text ? text : ""; *s;) s = put_python(s, out);
  fputc('"', out);
}

/* Twice within quotes is once, but gnuplot (5.4) does not see that of two in a row: these stand
   between quotes of the other kind, in which nothing else does. */
void escape_gnuplot(const char *text, FILE *out) {
  fputc('\'', out);
  for (const char *s = text ? text : ""; *s;) {
    size_t run = strspn(s, "'");
    if (run == 1) fputs("''", out);
    if (run > 1) fprintf(out, "'.\"%.*s\".'", (int)run, s);
    s = run ? s + run : put_in_line(s, out);
  }
  fputc('\'', out);
}

static bool is_number(const char *text) {
  char *end;
  return strspn(text, "0123456789.eE+-") == strlen(text) && (strtod(text, &end), *end == '\0');
}

static bool is_formula(const char *text) {
  const char *s = text + strspn(text, "'");
  return *s && strchr("=+-@\t\r", *s) && !is_number(text);
}

void escape_csv(const char *text, FILE *out) {
  const char *s = text ? text : "";
  bool quote = strpbrk(s, ",\"\r\n") != NULL;
  if (quote) fputc('"', out);
  if (is_formula(s)) fputc('\'', out);
  while (*s) {
    if (*s == '"') fputc('"', out);
    s = put(s, out);
  }
  if (quote) fputc('"', out);
}

char *escape_csv_undo(char *field) {
  return *field == '\'' && is_formula(field + 1) ? field + 1 : field;
}

void escape_markup(const char *text, FILE *out) {
  static const char special[] = "&<>\"'";
  static const char *const entity[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  for (const char *s = text ? text : ""; *s;) {
    const char *found = strchr(special, *s);
    if (found)
      fputs(entity[found - special], out), s++;
    else
      s = put(s, out);
  }
}

void escape_sql_name(const char *text, FILE *out) {
  fputc('"', out);
  for (const char *s = text ? text : ""; *s;) {
    if (*s == '"') fputc('"', out);
    s = put_in_line(s, out);
  }
  fputc('"', out);
}

void escape_terminal(const char *text, FILE *out) {
  for (const char *s = text ? text : ""; *s;) s = put_shown(s, out);
}
