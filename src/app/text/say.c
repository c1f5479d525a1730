/* Text is made whole first and escaped then, so that no argument can be forgotten. */
#include "say.h"

#include <stdlib.h>

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

void say_error(void) { say("%s\n", corot_error()); }

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
