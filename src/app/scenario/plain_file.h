/* Small text files beside a scenario. */
#ifndef COROT_APP_SCENARIO_PLAIN_FILE_H
#define COROT_APP_SCENARIO_PLAIN_FILE_H

#include <corot/base.h>
#include <stddef.h>

/* The whole file, a 0 added behind it; the caller frees. Only what is a file, and not a large one:
   a device may have no end. COROT_EIO: with the path in the message. */
corot_status plain_file_load(const char *path, char **text, size_t *size);

#endif
