/* What each file takes of a moment or a step. */
#include "writers.h"

#include <stdlib.h>

#include "app/folder/states.h"
#include "history.h"

static corot_status close_table(void *writer) { return table_close(writer); }

/* --- probes.csv --- */

typedef struct probes_table {
  int ncolumn;
  table *table;
} probes_table;

static corot_status close_probes(void *writer) {
  probes_table *p = writer;
  corot_status status = table_close(p->table);
  free(p);
  return status;
}

static corot_status open_probes(const writer_source *source, void **writer) {
  probes_table *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "the probes: out of memory");
  p->ncolumn = probes_ncolumn(source->probes);
  corot_status status =
      probes_open(source->dir, p->ncolumn, probes_columns(source->probes), &p->table);
  if (status == COROT_OK)
    *writer = p;
  else
    free(p);
  return status;
}

static corot_status write_probes(void *writer, const moment *now) {
  const probes_table *p = writer;
  return probes_row(p->table, now->t, p->ncolumn, now->probed);
}

const writer_ops probes_writer = {
    .file = "probes.csv",
    .open = open_probes,
    .moment = write_probes,
    .close = close_probes,
};

/* --- energy.csv --- */

static corot_status open_energy(const writer_source *source, void **writer) {
  table *t = NULL;
  COROT_TRY(energy_open(source->dir, &t));
  *writer = t;
  return COROT_OK;
}

static corot_status write_energy(void *writer, const moment *now) {
  return energy_row(writer, now->ledger);
}

const writer_ops energy_writer = {
    .file = "energy.csv",
    .open = open_energy,
    .moment = write_energy,
    .close = close_table,
};

/* --- steps.csv --- */

typedef struct steps {
  table *table;
  steps_count *count;
  step_row last;
  bool waits; /* the last step has no row yet */
} steps;

static corot_status open_steps(const writer_source *source, void **writer) {
  steps *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "the steps: out of memory");
  corot_status status = steps_open(source->dir, &s->table);
  if (status != COROT_OK) {
    free(s);
    return status;
  }
  s->count = source->steps;
  *s->count = (steps_count){.all = source->scenario->write_all_steps};
  *writer = s;
  return COROT_OK;
}

static corot_status write_step(void *writer, const step_row *row) {
  steps *s = writer;
  s->last = *row;
  long number = ++s->count->steps;
  s->waits = !s->count->all && !thin_keeps(number, row->events);
  if (s->waits) return COROT_OK;
  s->count->rows++;
  return steps_add(s->table, row);
}

static corot_status close_steps(void *writer) {
  steps *s = writer;
  corot_status status = COROT_OK;
  if (s->waits) {
    s->count->rows++;
    status = steps_add(s->table, &s->last);
  }
  corot_status closed = table_close(s->table);
  free(s);
  return status == COROT_OK ? closed : status;
}

const writer_ops steps_writer = {
    .file = "steps.csv",
    .open = open_steps,
    .step = write_step,
    .close = close_steps,
};

/* --- history.csv: by the history itself, at the end of each step --- */

static bool wants_history(const scenario *s) { return s->write_history; }

static corot_status open_history(const writer_source *source, void **writer) {
  COROT_TRY(history_open(source->history, source->dir));
  *writer = source->history;
  return COROT_OK;
}

static corot_status close_history(void *writer) { return history_close(writer); }

const writer_ops history_writer = {
    .file = "history.csv",
    .use = WRITER_OF_RUN,
    .wanted = wants_history,
    .open = open_history,
    .close = close_history,
};

/* --- states.bin --- */

static bool wants_states(const scenario *s) { return s->write_states; }

static corot_status open_states(const writer_source *source, void **writer) {
  state_writer *file = NULL;
  COROT_TRY(states_create(source->dir, source->model, &file));
  *writer = file;
  return COROT_OK;
}

static corot_status write_state(void *writer, const moment *now) {
  return states_add(writer, now->t, now->u, now->v);
}

static corot_status close_states(void *writer) { return states_close(writer); }

const writer_ops states_writer = {
    .file = "states.bin",
    .wanted = wants_states,
    .open = open_states,
    .moment = write_state,
    .close = close_states,
};
