/* The flat table as comma-separated values. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/text/escape.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "app/text/text_stream.h"
#include "study/measure/flat.h"

static corot_status write_value(const json_t *value, FILE *out) {
  if (json_is_integer(value)) {
    fprintf(out, "%lld", (long long)json_integer_value(value));
  } else if (json_is_real(value)) {
    fprintf(out, "%.17g", json_real_value(value));
  } else if (json_is_string(value)) {
    escape_csv(json_string_value(value), out);
  } else if (json_is_boolean(value)) {
    fputs(json_is_true(value) ? "true" : "false", out);
  } else if (value && !json_is_null(value)) {
    char *text = json_text_dump_plain(value, JSON_COMPACT);
    if (!text) return no_memory();
    escape_csv(text, out);
    free(text);
  }
  return COROT_OK;
}

static corot_status write_table(const json_t *table, const flat *f, FILE *out) {
  const json_t *cells = json_object_get(table, "cells");
  for (int k = 0; k < f->n; k++) {
    if (k > 0) fputc(',', out);
    escape_csv(f->column[k].name, out);
  }
  fputc('\n', out);
  for (size_t i = 0; i < json_array_size(cells); i++) {
    for (int k = 0; k < f->n; k++) {
      if (k > 0) fputc(',', out);
      COROT_TRY(write_value(flat_value(json_array_get(cells, i), &f->column[k]), out));
    }
    fputc('\n', out);
  }
  return COROT_OK;
}

corot_status table_write_csv(const json_t *table, const char *dir) {
  flat f;
  COROT_TRY(flat_make(table, &f));
  char *text = NULL, *path = folder_path(dir, "table.csv");
  size_t size = 0;
  FILE *out = path ? text_open(&text, &size) : NULL;
  bool written = out && write_table(table, &f, out) == COROT_OK;
  corot_status status = out && text_close(out) == 0 && written
                            ? file_replace_durably(path, text, size)
                            : corot_fail(COROT_ENOMEM, "%s/table.csv: out of memory", dir);
  free(text);
  free(path);
  flat_free(&f);
  return status;
}
