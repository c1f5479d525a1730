/* A study's table as comma-separated values. */
#ifndef COROT_STUDY_TABLES_TABLE_CSV_H
#define COROT_STUDY_TABLES_TABLE_CSV_H

#include <corot/base.h>
#include <jansson.h>

/* DIR/table.csv: one line a cell, numbers with 17 digits, empty where there is nothing to say. */
corot_status table_write_csv(const json_t *table, const char *dir);

#endif
