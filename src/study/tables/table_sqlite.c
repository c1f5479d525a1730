/* The flat table in a database, written beside its place and moved there. */
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/text/escape.h"
#include "app/text/json_text.h"
#include "app/text/text_stream.h"
#include "study/measure/flat.h"

/* `code` may be of our own making, which SQLite's message does not know. */
static corot_status complain(int code, const char *path) {
  corot_status status = code == SQLITE_NOMEM ? COROT_ENOMEM : COROT_EIO;
  return corot_fail(status, "%s: %s", path, sqlite3_errstr(code));
}

/* The statements that make the table and fill a row of it; the caller's to free. */
static corot_status make_statements(const flat *f, char **create, char **insert) {
  size_t size;
  FILE *out = text_open(create, &size);
  if (!out) return corot_fail(COROT_ENOMEM, "out of memory");
  fputs("create table runs (", out);
  for (int k = 0; k < f->n; k++) {
    if (k > 0) fputs(", ", out);
    escape_sql_name(f->column[k].name, out);
  }
  fputs(")", out);
  if (text_close(out) != 0) return corot_fail(COROT_ENOMEM, "out of memory");

  out = text_open(insert, &size);
  if (!out) return corot_fail(COROT_ENOMEM, "out of memory");
  fputs("insert into runs values (", out);
  for (int k = 0; k < f->n; k++) fputs(k > 0 ? ", ?" : "?", out);
  fputs(")", out);
  return text_close(out) == 0 ? COROT_OK : corot_fail(COROT_ENOMEM, "out of memory");
}

static int bind_value(sqlite3_stmt *row, int at, const json_t *value) {
  if (json_is_integer(value)) return sqlite3_bind_int64(row, at, json_integer_value(value));
  if (json_is_real(value)) return sqlite3_bind_double(row, at, json_real_value(value));
  if (json_is_boolean(value)) return sqlite3_bind_int(row, at, json_is_true(value));
  if (json_is_string(value))
    return sqlite3_bind_text(row, at, json_string_value(value), -1, SQLITE_TRANSIENT);
  if (!value || json_is_null(value)) return sqlite3_bind_null(row, at);
  char *text = json_text_dump_plain(value, JSON_COMPACT);
  int code = text ? sqlite3_bind_text(row, at, text, -1, SQLITE_TRANSIENT) : SQLITE_NOMEM;
  free(text);
  return code;
}

static int insert_cell(sqlite3_stmt *row, const flat *f, const json_t *cell) {
  int code = sqlite3_reset(row);
  for (int k = 0; k < f->n && code == SQLITE_OK; k++)
    code = bind_value(row, k + 1, flat_value(cell, &f->column[k]));
  if (code != SQLITE_OK) return code;
  code = sqlite3_step(row);
  return code == SQLITE_DONE ? SQLITE_OK : code;
}

static int fill(sqlite3 *db, const flat *f, const json_t *cells, const char *create,
                const char *insert) {
  sqlite3_stmt *row = NULL;
  int code = sqlite3_exec(db, "begin", NULL, NULL, NULL);
  if (code == SQLITE_OK) code = sqlite3_exec(db, create, NULL, NULL, NULL);
  if (code == SQLITE_OK) code = sqlite3_prepare_v2(db, insert, -1, &row, NULL);
  for (size_t i = 0; i < json_array_size(cells) && code == SQLITE_OK; i++)
    code = insert_cell(row, f, json_array_get(cells, i));
  sqlite3_finalize(row);
  if (code == SQLITE_OK) code = sqlite3_exec(db, "commit", NULL, NULL, NULL);
  return code;
}

/* An index can be made again at any time: it need not survive a failure of power. */
static corot_status write_database(const flat *f, const json_t *cells, const char *path) {
  static const char unsafe[] = "pragma synchronous = off; pragma journal_mode = off";
  char *create = NULL, *insert = NULL;
  sqlite3 *db = NULL;
  corot_status status = make_statements(f, &create, &insert);
  if (status == COROT_OK) {
    int code = sqlite3_open(path, &db);
    if (code == SQLITE_OK) code = sqlite3_exec(db, unsafe, NULL, NULL, NULL);
    if (code == SQLITE_OK) code = fill(db, f, cells, create, insert);
    if (code != SQLITE_OK) status = complain(code, path);
  }
  if (sqlite3_close(db) != SQLITE_OK && status == COROT_OK)
    status = corot_fail(COROT_EIO, "%s: cannot be closed", path);
  free(create);
  free(insert);
  return status;
}

corot_status table_write_sqlite(const json_t *table, const char *dir) {
  flat f;
  COROT_TRY(flat_make(table, &f));
  char *path = folder_path(dir, "index.sqlite"), *temporary = folder_path(dir, "index.sqlite.tmp");
  corot_status status = path && temporary ? COROT_OK : COROT_ENOMEM;
  if (status == COROT_OK) {
    unlink(temporary);
    status = write_database(&f, json_object_get(table, "cells"), temporary);
  }
  if (status == COROT_OK)
    status = file_put_in_place(temporary, path);
  else if (temporary)
    unlink(temporary);
  free(path);
  free(temporary);
  flat_free(&f);
  return status;
}
