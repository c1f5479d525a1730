/* Inside of holding a tree against a table: its numbers. All fail with COROT_EFORMAT and the place.
 */
#ifndef COROT_APP_CONFIG_SCHEMA_NUMBER_H
#define COROT_APP_CONFIG_SCHEMA_NUMBER_H

#include "schema.h"

/* What the table asks of a number. */
typedef struct schema_demand {
  schema_range range;
  const char *unit; /* as in the table */
} schema_demand;

/* "expected WHAT, found ..." */
corot_status schema_expected(const config_node *node, const char *what);

/* Set the number of a node, in the unit of the table. */
corot_status schema_check_number(config_node *node, schema_demand wanted);
corot_status schema_check_integer(config_node *node, schema_demand wanted);

/* A number of seconds, or one with its unit behind it. */
corot_status schema_check_duration(config_node *node, schema_range range);

/* What stands behind the digits of a number, "ms" of 20 ms; NULL: nothing that could be a unit. The
   number takes *digits characters. */
const char *schema_unit_behind(const config_node *node, size_t *digits);

#endif
