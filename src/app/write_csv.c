#include "write_csv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "escape.h"
#include "folder.h"
#include "no_memory.h"

enum {
  CELL = 32,  /* the longest number with its comma and a terminator, and to spare */
  ROW = 1024, /* a row of a fixed number of columns, to spare */
};

struct table {
  int fd;
  char *path;
  char *row; /* the row in the making: each cell is followed by a comma */
  size_t length;
  off_t size; /* of the file's whole rows */
};

corot_status table_close(table *t) {
  if (!t) return COROT_OK;
  corot_status status = file_close(t->fd, t->path);
  free(t->path);
  free(t->row);
  free(t);
  return status;
}

static corot_status table_open(const char *dir, const char *name, size_t capacity, table **out) {
  table *t = calloc(1, sizeof *t);
  if (!t) return corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
  t->fd = -1;
  t->path = folder_path(dir, name);
  t->row = malloc(capacity);
  corot_status status = COROT_OK;
  if (!t->path || !t->row)
    status = corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
  else
    status = file_create(t->path, &t->fd);
  if (status != COROT_OK) {
    table_close(t);
    return status;
  }
  *out = t;
  return COROT_OK;
}

/* A cell as it is. The capacity given to table_open has room for all cells of a row. */
static void add_text(table *t, const char *text) {
  size_t length = strlen(text);
  memcpy(t->row + t->length, text, length);
  t->row[t->length + length] = ',';
  t->length += length + 1;
}

static void add_number(table *t, double x) {
  char cell[CELL];
  snprintf(cell, sizeof cell, "%.17g", x);
  add_text(t, cell);
}

static void add_integer(table *t, int i) {
  char cell[CELL];
  snprintf(cell, sizeof cell, "%d", i);
  add_text(t, cell);
}

static corot_status end_row(table *t) {
  t->row[t->length - 1] = '\n';
  corot_status status = file_write(t->fd, t->path, t->row, t->length);
  if (status == COROT_OK)
    t->size += (off_t)t->length;
  else if (ftruncate(t->fd, t->size) == 0) /* fails where there is no length, as on a terminal */
    lseek(t->fd, t->size, SEEK_SET);
  t->length = 0;
  return status;
}

/* "t" and NAME.COMPONENT for each name and component; the caller's to free. */
static corot_status make_header(int n, const char *const *name, const char *const component[3],
                                char **header) {
  char *title = NULL;
  size_t size = 0, longest = 0;
  for (int i = 0; i < n; i++) longest = strlen(name[i]) > longest ? strlen(name[i]) : longest;
  title = malloc(longest + CELL);
  FILE *out = title ? open_memstream(header, &size) : NULL;
  if (out) fputc('t', out);
  for (int i = 0; out && i < n; i++)
    for (int c = 0; c < 3; c++) {
      snprintf(title, longest + CELL, "%s.%s", name[i], component[c]);
      fputc(',', out);
      escape_csv(title, out);
    }
  free(title);
  if (out && fclose(out) == 0) return COROT_OK;
  free(*header);
  *header = NULL;
  return no_memory();
}

/* Opens a table with this header, for rows of up to `capacity` bytes. */
static corot_status open_with_header(const char *dir, const char *name, const char *header,
                                     size_t capacity, table **out) {
  table *t = NULL;
  size_t needed = strlen(header) + 2;
  COROT_TRY(table_open(dir, name, needed > capacity ? needed : capacity, &t));
  add_text(t, header);
  corot_status status = end_row(t);
  if (status != COROT_OK) {
    table_close(t);
    return status;
  }
  *out = t;
  return COROT_OK;
}

/* Opens a table of t and three columns for each name. */
static corot_status open_with_names(const char *dir, const char *file, int n,
                                    const char *const *name, const char *const component[3],
                                    table **out) {
  char *header = NULL;
  COROT_TRY(make_header(n, name, component, &header));
  corot_status status = open_with_header(dir, file, header, CELL + 3 * CELL * (size_t)n, out);
  free(header);
  return status;
}

corot_status probes_open(const char *dir, int nprobe, const char *const *name, table **probes) {
  static const char *const component[] = {"ux", "uy", "uz"};
  return open_with_names(dir, "probes.csv", nprobe, name, component, probes);
}

corot_status probes_row(table *probes, double t, int nprobe, const int *node,
                        const double (*displacement)[3]) {
  add_number(probes, t);
  for (int i = 0; i < nprobe; i++)
    for (int c = 0; c < 3; c++) add_number(probes, displacement[node[i]][c]);
  return end_row(probes);
}

corot_status compare_open(const char *dir, int nmeasure, const char *const *measure,
                          table **compare) {
  static const char *const part[] = {"total", "pressure", "shear"};
  return open_with_names(dir, "compare.csv", nmeasure, measure, part, compare);
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
  return open_with_header(dir, "energy.csv",
                          "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,"
                          "px,py,pz,lx,ly,lz",
                          ROW, energy);
}

corot_status energy_row(table *energy, const ledger *row) {
  add_number(energy, row->t);
  add_number(energy, row->kinetic);
  add_number(energy, row->elastic);
  add_number(energy, row->dissipated);
  add_number(energy, row->external_work);
  add_number(energy, row->balance);
  add_number(energy, row->frame_energy);
  for (int c = 0; c < 3; c++) add_number(energy, row->momentum[c]);
  for (int c = 0; c < 3; c++) add_number(energy, row->angular_momentum[c]);
  return end_row(energy);
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
  static const char *const word[] = {"kink", "frames", "restart", "failed", "rejected"};
  char cell[64] = "";
  for (int i = 0; i < 5; i++) {
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
