/* The message of the last failure and what it is about, for each thread. */
#include <corot/base.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "fault.h"

static _Thread_local char message[4096]; /* holds ten faults of a mesh with their places */
static _Thread_local corot_fault fault;
static _Thread_local long count;

const char *corot_error(void) { return message; }

/* Puts "BEFORE TEXT AFTER" in the message's place; *length of the text that is left of it. */
static void set_message(const char *before, const char *after, const char *format, va_list args,
                        int *length) {
  char text[sizeof message]; /* the old message may be an argument */
  size_t size = sizeof text, begin = (size_t)snprintf(text, size, "%s", before);
  vsnprintf(text + begin, size - begin, format, args);
  size_t end = strlen(text);
  snprintf(text + end, size - end, "%s", after);
  memcpy(message, text, size);
  count++;
  *length = (int)(end - begin);
}

corot_status corot_fail(corot_status status, const char *format, ...) {
  int length;
  va_list args;
  va_start(args, format);
  set_message("", "", format, args, &length);
  va_end(args);
  fault = (corot_fault){0};
  return status;
}

static corot_status fail_about(const corot_fault *about, const char *format, va_list args) {
  char before[64] = "", after[64] = "";
  if (strcmp(about->entry, "hierarchy") == 0)
    snprintf(before, sizeof before, "hierarchy: ");
  else if (strcmp(about->entry, "model") != 0)
    snprintf(before, sizeof before, "%s %d: ", about->entry, about->index);
  if (about->other) snprintf(after, sizeof after, " (%s %d)", about->other, about->other_index);
  corot_fault f = *about;
  set_message(before, after, format, args, &f.length);
  f.reason = message + strlen(before);
  fault = f;
  return COROT_EINVAL;
}

corot_status corot_fail_about(const corot_fault *about, const char *format, ...) {
  va_list args;
  va_start(args, format);
  corot_status status = fail_about(about, format, args);
  va_end(args);
  return status;
}

corot_status corot_fail_at(const char *entry, int index, const char *field, const char *format,
                           ...) {
  corot_fault about = {.entry = entry, .index = index, .field = field};
  va_list args;
  va_start(args, format);
  corot_status status = fail_about(&about, format, args);
  va_end(args);
  return status;
}

long corot_fail_count(void) { return count; }

corot_fault corot_fault_last(void) { return fault; }

const char *corot_version(void) { return COROT_VERSION; }
