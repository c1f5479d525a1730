/* A study's table for people. */
#ifndef COROT_STUDY_TABLES_TABLE_TEXT_H
#define COROT_STUDY_TABLES_TABLE_TEXT_H

#include <corot/base.h>
#include <jansson.h>
#include <stdio.h>

/* Cells in aligned columns, then what is known of references, fits and rankings. Errors that are
   not rated stand in parentheses. COROT_EFORMAT: it is not a table. */
corot_status table_print(const json_t *table, FILE *out);

#endif
