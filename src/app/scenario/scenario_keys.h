/* The keys of a scenario: their table, and what follows from it. */
#ifndef COROT_APP_SCENARIO_SCENARIO_KEYS_H
#define COROT_APP_SCENARIO_SCENARIO_KEYS_H

#include <jansson.h>

#include "app/config/schema.h"

extern const schema scenario_schema;

/* A checked scenario as JSON, its keys in the order of the table. NULL: no memory. */
json_t *schema_resolve(const config *tree);

/* The table as a JSON Schema, for programs. NULL: no memory. */
json_t *schema_json(void);

#endif
