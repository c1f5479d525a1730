/* What a scenario may say, but whoever uses the answer should know. */
#ifndef COROT_APP_WARNINGS_H
#define COROT_APP_WARNINGS_H

#include "scenario.h"

/* A list of texts, the caller's to json_decref; NULL: no memory. */
json_t *warnings_list(const scenario *s);

/* Each on a line of its own to `out`, begun by `head`. */
void warnings_print(const scenario *s, const char *head, FILE *out);

#endif
