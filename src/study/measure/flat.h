/* The cells of table.json as one flat table, the same for CSV and SQL. */
#ifndef COROT_STUDY_MEASURE_FLAT_H
#define COROT_STUDY_MEASURE_FLAT_H

#include <corot/base.h>
#include <jansson.h>

typedef struct flat_column {
  char *name;        /* "cost.cpu"; coordinates have the name of their key */
  const char *group; /* the object of a cell it is in; NULL: the cell itself */
  const char *key;
} flat_column;

typedef struct flat {
  int n;
  flat_column *column; /* [n] */
} flat;

/* The columns of a table, which must outlive them: those that are the same for all studies, and in
   their midst coordinates and errors by name. COROT_EFORMAT: it is not a table. */
corot_status flat_make(const json_t *table, flat *out);
void flat_free(flat *f);

/* NULL or null: nothing to say. */
const json_t *flat_value(const json_t *cell, const flat_column *c);

/* DIR/table.csv: one line a cell, numbers with 17 digits, empty where there is nothing to say. */
corot_status table_write_csv(const json_t *table, const char *dir);

/* DIR/index.sqlite: the same as the table `runs` of a database. */
corot_status table_write_sqlite(const json_t *table, const char *dir);

#endif
