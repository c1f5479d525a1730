/* The tables of a run, read back. See write_csv.h. */
#ifndef COROT_APP_FOLDER_READ_CSV_H
#define COROT_APP_FOLDER_READ_CSV_H

#include <corot/base.h>

typedef struct csv {
  char *text; /* the file; the cells are in it */
  int ncolumn, nrow;
  char **name; /* [ncolumn] the header */
  char **cell; /* [nrow][ncolumn] */
} csv;

/* Reads DIR/NAME. COROT_EIO: it cannot be read; COROT_EFORMAT: a row has not as many cells as the
   header. A last row that is cut short, as of a program that was killed, is left out. */
corot_status csv_read(const char *dir, const char *name, csv *table);

/* The same, but a file that does not exist gives a table without columns. */
corot_status csv_read_if_there(const char *dir, const char *name, csv *table);

void csv_free(csv *table);

/* -1 where there is none of that name. */
int csv_find(const csv *table, const char *name);

/* The numbers of a column [nrow], NAN where there is none; the caller's to free. */
corot_status csv_numbers(const csv *table, int column, double **number);

/* The same of the column of that name. COROT_EFORMAT: there is none. */
corot_status csv_column(const csv *table, const char *name, double **number);

#endif
