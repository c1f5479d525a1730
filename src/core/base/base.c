/* The message of the last failure, a text for each thread. */
#include <corot/base.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static _Thread_local char message[1024];

const char *corot_error(void) { return message; }

corot_status corot_fail(corot_status status, const char *format, ...) {
  char text[sizeof message]; /* the old message may be an argument */
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  memcpy(message, text, sizeof message);
  return status;
}

const char *corot_version(void) { return COROT_VERSION; }
