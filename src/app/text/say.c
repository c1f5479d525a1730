/* Text is made whole first and escaped then, so that no argument can be forgotten. */
#include "say.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "colour.h"
#include "escape.h"
#include "no_memory.h"
#include "text_stream.h"

void say_to(FILE *out, const char *format, va_list arguments) {
  char text[2048], *whole = NULL;
  va_list again;
  va_copy(again, arguments);
  int length = vsnprintf(text, sizeof text, format, arguments);
  if (length >= (int)sizeof text) whole = malloc((size_t)length + 1);
  if (whole) vsnprintf(whole, (size_t)length + 1, format, again); /* else it is cut */
  va_end(again);
  if (length >= 0) escape_terminal(whole ? whole : text, out);
  free(whole);
}

void say(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  say_to(stderr, format, arguments);
  va_end(arguments);
}

void show(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  say_to(stdout, format, arguments);
  va_end(arguments);
}

/* The first `length` bytes of a text, in a colour. */
static void put_coloured(colour what, const char *text, size_t length) {
  fputs(colour_of(what, stderr), stderr);
  say("%.*s", (int)length, text);
  fputs(colour_of(COLOUR_END, stderr), stderr);
}

void say_head(const char *head) {
  put_coloured(COLOUR_ERROR, head, strlen(head));
  fputs(": ", stderr);
}

/* A line of a message: what it is about stands before ": "; the lines of a file that it shows, and
   the caret below, are indented. */
static void say_line(const char *line, size_t length) {
  const char *colon = strstr(line, ": ");
  size_t head = line[0] != ' ' && colon && colon < line + length ? (size_t)(colon - line) : 0;
  size_t blanks = strspn(line, " ");
  bool caret = blanks + 1 == length && line[blanks] == '^';
  if (head) put_coloured(COLOUR_ERROR, line, head);
  if (caret)
    put_coloured(COLOUR_PLACE, line, length);
  else
    say("%.*s", (int)(length - head), line + head);
  fputc('\n', stderr);
}

void say_error(void) {
  for (const char *line = corot_error();;) {
    size_t length = strcspn(line, "\n");
    say_line(line, length);
    if (!line[length]) break;
    line += length + 1;
  }
}

corot_status show_all(corot_status (*write)(const void *what, FILE *out), const void *what) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out) return no_memory();
  corot_status status = write(what, out);
  if (text_close(out) != 0 && status == COROT_OK) status = no_memory();
  if (status == COROT_OK) escape_terminal(text, stdout);
  free(text);
  return status;
}
