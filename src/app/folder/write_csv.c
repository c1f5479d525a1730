/* One function opens each table with its header, another adds a row. */
#include "write_csv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "app/text/escape.h"
#include "app/text/no_memory.h"
#include "app/text/number_text.h"
#include "app/text/text_stream.h"
#include "folder.h"

enum {
  CELL = NUMBER_TEXT, /* with its comma */
  ROW = 1024,         /* a row of a fixed number of columns, to spare */
  BATCH = 8192        /* bytes of rows of every step that are handed on together */
};

struct table {
  int fd;
  char *path;
  char *row; /* rows not handed on, and the one in the making: a comma follows each cell */
  size_t length, capacity;
  size_t batch; /* rows are handed on when they are this long together; 0: each */
  growth whole; /* the file's whole rows */
};

/* Hands whole rows to the system. */
static corot_status flush(table *t) {
  corot_status status = file_write(t->fd, t->path, t->row, t->length);
  if (status == COROT_OK)
    growth_add(&t->whole, t->row, t->length);
  else if (ftruncate(t->fd, t->whole.size) == 0) /* fails where there is no length: a terminal */
    lseek(t->fd, t->whole.size, SEEK_SET);
  t->length = 0;
  return status;
}

corot_status table_close(table *t) {
  if (!t) return COROT_OK;
  corot_status status = t->length > 0 ? flush(t) : COROT_OK;
  corot_status closed = file_close(t->fd, t->path);
  if (status == COROT_OK) status = closed;
  free(t->path);
  free(t->row);
  free(t);
  return status;
}

/* Without its file. */
static corot_status table_create(const char *dir, const char *name, size_t capacity, table **out) {
  table *t = calloc(1, sizeof *t);
  if (!t) return corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
  t->fd = -1;
  t->path = folder_path(dir, name);
  t->row = malloc(capacity);
  t->capacity = capacity;
  t->whole = growth_begin();
  *out = t;
  if (t->path && t->row) return COROT_OK;
  table_close(t);
  return corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
}

static corot_status table_open(const char *dir, const char *name, size_t capacity, table **out) {
  table *t = NULL;
  COROT_TRY(table_create(dir, name, capacity, &t));
  corot_status status = file_create(t->path, &t->fd);
  if (status != COROT_OK) {
    table_close(t);
    return status;
  }
  *out = t;
  return COROT_OK;
}

corot_status table_pack(table *t, pack *p) {
  if (t->length > 0) COROT_TRY(flush(t));
  long capacity = (long)t->capacity, batch = (long)t->batch;
  corot_pack_long(p, &capacity);
  corot_pack_long(p, &batch);
  growth_exchange(p, &t->whole);
  return corot_pack_status(p);
}

corot_status table_resume(const char *dir, const char *name, pack *p, table **out) {
  long capacity = 0, batch = 0;
  growth whole = growth_begin();
  table *t = NULL;
  corot_pack_long(p, &capacity);
  corot_pack_long(p, &batch);
  growth_exchange(p, &whole);
  COROT_TRY(corot_pack_status(p));
  COROT_TRY(table_create(dir, name, (size_t)capacity, &t));
  t->batch = (size_t)batch;
  t->whole = whole;
  corot_status status = growth_reopen(t->path, &whole, &t->fd);
  if (status == COROT_OK)
    *out = t;
  else
    table_close(t);
  return status;
}

corot_status table_cut(table *t) { return growth_cut(t->fd, t->path, &t->whole); }

corot_status table_synchronise(table *t) { return file_synchronise(t->fd, t->path); }

/* A cell as it is. The capacity given to table_open has room for all cells of a row. */
static void add_text(table *t, const char *text) {
  size_t length = strlen(text);
  memcpy(t->row + t->length, text, length);
  t->row[t->length + length] = ',';
  t->length += length + 1;
}

static void add_number(table *t, double x) {
  t->length += number_text(x, t->row + t->length);
  t->row[t->length++] = ',';
}

static void add_integer(table *t, int i) {
  char cell[CELL];
  snprintf(cell, sizeof cell, "%d", i);
  add_text(t, cell);
}

static corot_status end_row(table *t) {
  t->row[t->length - 1] = '\n';
  return t->length < t->batch ? COROT_OK : flush(t);
}

/* The columns of a name: itself, or one for each component. */
static int columns_of(const char *const *component) { return component ? 3 : 1; }

/* "t", NAME.COMPONENT for each name and component (or just NAME, where there are none), and the
   columns that `after` lists, if any; the caller's to free. */
static corot_status make_header(int n, const char *const *name, const char *const *component,
                                const char *after, char **header) {
  char *title = NULL;
  size_t size = 0, longest = 0;
  for (int i = 0; i < n; i++) longest = strlen(name[i]) > longest ? strlen(name[i]) : longest;
  title = malloc(longest + CELL);
  FILE *out = title ? text_open(header, &size) : NULL;
  if (out) fputc('t', out);
  for (int i = 0; out && i < n; i++)
    for (int c = 0; c < columns_of(component); c++) {
      snprintf(title, longest + CELL, "%s%s%s", name[i], component ? "." : "",
               component ? component[c] : "");
      fputc(',', out);
      escape_csv(title, out);
    }
  if (out && *after) fprintf(out, ",%s", after);
  free(title);
  if (out && text_close(out) == 0) return COROT_OK;
  free(*header);
  *header = NULL;
  return no_memory();
}

/* Opens a table with this header, for rows of up to `capacity` bytes. */
static corot_status open_with_header(const char *dir, const char *name, const char *header,
                                     size_t capacity, table **out) {
  table *t = NULL;
  size_t needed = strlen(header) + 2;
  COROT_TRY(table_open(dir, name, BATCH + (needed > capacity ? needed : capacity), &t));
  add_text(t, header);
  corot_status status = end_row(t);
  if (status != COROT_OK) {
    table_close(t);
    return status;
  }
  *out = t;
  return COROT_OK;
}

/* Bytes for t, n numbers, and those of the columns `after`. */
static size_t room_for(int n, const char *after) {
  size_t cells = 1 + (size_t)n;
  for (const char *c = after; *c; c++) cells += *c == ',';
  return CELL * (*after ? cells + 1 : cells);
}

/* Opens a table of t, the columns of each name, and those that `after` lists, if any. */
static corot_status open_with_names(const char *dir, const char *file, int n,
                                    const char *const *name, const char *const *component,
                                    const char *after, table **out) {
  char *header = NULL;
  COROT_TRY(make_header(n, name, component, after, &header));
  corot_status status =
      open_with_header(dir, file, header, room_for(n * columns_of(component), after), out);
  free(header);
  return status;
}

#define ENERGY_COLUMNS \
  "kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,lx,ly,lz"

corot_status probes_open(const char *dir, int ncolumn, const char *const *name, table **probes) {
  return open_with_names(dir, "probes.csv", ncolumn, name, NULL, "", probes);
}

corot_status history_table_open(const char *dir, int ncolumn, const char *const *name,
                                table **history) {
  COROT_TRY(open_with_names(dir, "history.csv", ncolumn, name, NULL, ENERGY_COLUMNS, history));
  (*history)->batch = BATCH;
  return COROT_OK;
}

static void add_numbers(table *t, int n, const double *x) {
  for (int i = 0; i < n; i++) add_number(t, x[i]);
}

corot_status probes_row(table *probes, double t, int ncolumn, const double *value) {
  add_number(probes, t);
  add_numbers(probes, ncolumn, value);
  return end_row(probes);
}

corot_status compare_open(const char *dir, int nmeasure, const char *const *measure,
                          table **compare) {
  static const char *const part[] = {"total", "pressure", "shear"};
  return open_with_names(dir, "compare.csv", nmeasure, measure, part, "", compare);
}

corot_status reactions_open(const char *dir, int ngroup, const char *const *name,
                            table **reactions) {
  static const char *const component[] = {"fx", "fy", "fz"};
  return open_with_names(dir, "reactions.csv", ngroup, name, component, "", reactions);
}

corot_status reactions_row(table *reactions, double t, int ngroup, const double (*force)[3]) {
  add_number(reactions, t);
  for (int i = 0; i < ngroup; i++) add_numbers(reactions, 3, force[i]);
  return end_row(reactions);
}

static void add_if_number(table *t, double x) {
  if (x == x)
    add_number(t, x);
  else
    add_text(t, "");
}

corot_status compare_row(table *compare, double t, int nmeasure, const force_error *error) {
  add_number(compare, t);
  for (int i = 0; i < nmeasure; i++) {
    add_if_number(compare, error[i].total);
    add_if_number(compare, error[i].pressure);
    add_if_number(compare, error[i].shear);
  }
  return end_row(compare);
}

corot_status energy_open(const char *dir, table **energy) {
  return open_with_header(dir, "energy.csv", "t," ENERGY_COLUMNS, ROW, energy);
}

const char ledger_columns[] = ENERGY_COLUMNS;

void ledger_values(const ledger *row, double value[LEDGER_COLUMNS]) {
  const double energy[] = {row->kinetic,       row->elastic, row->dissipated,
                           row->external_work, row->balance, row->frame_energy};
  memcpy(value, energy, sizeof energy);
  memcpy(value + 6, row->momentum, sizeof row->momentum);
  memcpy(value + 9, row->angular_momentum, sizeof row->angular_momentum);
}

static void add_energies(table *t, const ledger *row) {
  double value[LEDGER_COLUMNS];
  ledger_values(row, value);
  add_numbers(t, LEDGER_COLUMNS, value);
}

corot_status energy_row(table *energy, const ledger *row) {
  add_number(energy, row->t);
  add_energies(energy, row);
  return end_row(energy);
}

corot_status history_row(table *history, const ledger *row, int ncolumn, const double *value) {
  add_number(history, row->t);
  add_numbers(history, ncolumn, value);
  add_energies(history, row);
  return end_row(history);
}

corot_status steps_open(const char *dir, table **steps) {
  return open_with_header(dir, "steps.csv",
                          "t,h,order,error,newton,event,angle_max,angle_mean,frame_energy,reason",
                          ROW, steps);
}

const char *const frame_reason_words[FRAME_REASONS] = {
    [COROT_FRAMES_BY_STEP] = "step",   [COROT_FRAMES_BY_INTERVAL] = "interval",
    [COROT_FRAMES_BY_ANGLE] = "angle", [COROT_FRAMES_BY_CAP] = "cap",
    [COROT_FRAMES_BY_HOOK] = "hook",
};

static void add_events(table *t, unsigned events) {
  static const char *const word[] = {"kink",   "frames",   "restart",
                                     "failed", "rejected", "checkpoint"};
  char cell[64] = "";
  for (int i = 0; i < 6; i++) {
    if (!(events & 1u << i)) continue;
    if (cell[0]) strcat(cell, "+");
    strcat(cell, word[i]);
  }
  add_text(t, cell);
}

corot_status steps_add(table *steps, const step_row *row) {
  add_number(steps, row->t);
  add_number(steps, row->h);
  add_integer(steps, row->order);
  add_number(steps, row->error);
  add_integer(steps, row->newton);
  add_events(steps, row->events);
  if (row->events & EVENT_FRAMES) {
    add_number(steps, row->update.change.angle_max);
    add_number(steps, row->update.change.angle_mean);
    add_number(steps, row->update.change.energy);
    add_text(steps, frame_reason_words[row->update.reason]);
  } else {
    for (int i = 0; i < 4; i++) add_text(steps, "");
  }
  return end_row(steps);
}

corot_status modes_open(const char *dir, table **modes) {
  return open_with_header(dir, "modes.csv",
                          "mode,frequency,angular_frequency,growth,eigenvalue,mass_x,mass_y,"
                          "mass_z,residual",
                          ROW, modes);
}

corot_status modes_row(table *modes, int number, const corot_mode *mode) {
  add_integer(modes, number);
  add_number(modes, mode->frequency);
  add_number(modes, mode->eigenvalue > 0 ? sqrt(mode->eigenvalue) : 0);
  add_number(modes, mode->growth);
  add_number(modes, mode->eigenvalue);
  for (int c = 0; c < 3; c++) add_number(modes, mode->effective_mass[c]);
  add_number(modes, mode->residual);
  return end_row(modes);
}
