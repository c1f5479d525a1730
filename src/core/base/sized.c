/* Definitions of another size than ours. */
#include "sized.h"

#include <string.h>

void corot_sized_fill(void *def, size_t bytes, const void *ours, size_t size) {
  memset(def, 0, bytes);
  memcpy(def, ours, bytes < size ? bytes : size);
  if (bytes >= sizeof bytes) memcpy(def, &bytes, sizeof bytes);
}

corot_status corot_sized_check(const void *def, size_t size, const char *type) {
  size_t bytes;
  if (!def) return corot_fail(COROT_EINVAL, "there is no %s: the pointer is NULL", type);
  memcpy(&bytes, def, sizeof bytes);
  if (bytes == 0 || bytes == size) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "a %s of %zu bytes, where corot %s has %zu: the program was compiled with "
                    "headers of another version",
                    type, bytes, corot_version(), size);
}
