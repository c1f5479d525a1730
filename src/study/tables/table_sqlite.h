/* A study's table as a database. */
#ifndef COROT_STUDY_TABLES_TABLE_SQLITE_H
#define COROT_STUDY_TABLES_TABLE_SQLITE_H

#include <corot/base.h>
#include <jansson.h>

/* DIR/index.sqlite: the same as the table `runs` of a database. */
corot_status table_write_sqlite(const json_t *table, const char *dir);

#endif
