/* What a refusal is about: which entry of a definition and which of its fields, beside the message.

   A rule stands once, where it is known. Who has read the definition from a file tells it with the
   place there, and in the file's own words: from the fault it knows the key. Whoever has made the
   definition in memory is served by the message, which names entry and index ("material 1: mu = 0
   is not positive"); so this header is not a public one. */
#ifndef COROT_CORE_BASE_FAULT_H
#define COROT_CORE_BASE_FAULT_H

#include <corot/base.h>

/* Names are those of the definition's structures, and live as long as the program. */
typedef struct corot_fault {
  const char *entry; /* "material", "fix", "motion", "load": of a list; "model", "hierarchy"; NULL:
                        the last failure is about no entry */
  int index;         /* in the list */
  const char *field; /* "mu"; of an amplitude "amplitude.frequency"; "": the entry as a whole */
  int point;         /* of "amplitude.time" and "amplitude.value", from 0 */
  const char *other; /* a list, of which an entry does not go with this one; NULL: none */
  int other_index;
  const char *reason; /* the message without entry and other, [length]; it is there as long as */
  int length;         /* the message is */
} corot_fault;

/* Fails with COROT_EINVAL, as corot_fail does, about `about`, of which reason and length are not
   looked at. The message is "ENTRY INDEX: TEXT", and after it " (OTHER INDEX)" if there is another;
   of the hierarchy "hierarchy: TEXT", of the model the text alone. */
corot_status corot_fail_about(const corot_fault *about, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The same where field and index say it all. */
corot_status corot_fail_at(const char *entry, int index, const char *field, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* What the last failure on this thread is about. Another failure takes its place. */
corot_fault corot_fault_last(void);

/* How many failures this thread has had: tells whether a function of a host has said why it failed.
 */
long corot_fail_count(void);

#endif
