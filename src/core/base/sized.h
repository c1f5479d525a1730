/* Arguments that a host gives: what must be there, and definitions that know their size. A host
   that was compiled with headers of another version has definitions of another size; it is told so,
   and nothing beyond what it has is read or written. */
#ifndef COROT_CORE_BASE_SIZED_H
#define COROT_CORE_BASE_SIZED_H

#include <stddef.h>

#include "sisters.h"

/* A status: COROT_EINVAL names the function and what it was not given, as the header calls it. */
#define COROT_GIVEN_AS(pointer, name) \
  ((pointer) ? COROT_OK : corot_fail(COROT_EINVAL, "%s: '%s' is NULL", __func__, name))
#define COROT_GIVEN(pointer) COROT_GIVEN_AS(pointer, #pointer)

/* Defaults, `ours` of `size` bytes, into a definition of `bytes`, the first member of both being
   that number; what does not fit is left out, what we do not know is zero. */
COROT_SISTERS void corot_sized_fill(void *def, size_t bytes, const void *ours, size_t size);

/* COROT_EINVAL: there is no definition (of that type), or it is of another size. One whose first
   member is 0 was written down, not filled: it is taken for one of our headers. */
COROT_SISTERS corot_status corot_sized_check(const void *def, size_t size, const char *type);

/* The same of the parameter `def`. */
#define COROT_DEFINED(def, type) corot_sized_check(def, sizeof(type), #type)

#endif
