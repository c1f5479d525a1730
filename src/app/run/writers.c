/* What each file takes of a moment or a step. */
#include "writers.h"

#include <stdlib.h>

#include "app/folder/states.h"
#include "history.h"

static corot_status close_table(void *writer) { return table_close(writer); }
static table *table_itself(const void *writer) { return (table *)writer; }

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
      source->from
          ? table_resume(source->dir, probes_writer.file, source->from, &p->table)
          : probes_open(source->dir, p->ncolumn, probes_columns(source->probes), &p->table);
  if (status == COROT_OK)
    *writer = p;
  else
    free(p);
  return status;
}

static table *table_of_probes(const void *writer) { return ((const probes_table *)writer)->table; }

static corot_status write_probes(void *writer, const moment *now) {
  const probes_table *p = writer;
  return probes_row(p->table, now->t, p->ncolumn, now->probed);
}

const writer_ops probes_writer = {
    .file = "probes.csv",
    .open = open_probes,
    .moment = write_probes,
    .table = table_of_probes,
    .close = close_probes,
};

/* --- energy.csv --- */

static corot_status open_energy(const writer_source *source, void **writer) {
  table *t = NULL;
  if (source->from)
    COROT_TRY(table_resume(source->dir, energy_writer.file, source->from, &t));
  else
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
    .table = table_itself,
    .close = close_table,
};

/* --- steps.csv --- */

typedef struct steps {
  table *table;
  steps_count *count;
  step_row last;
  bool waits; /* the last step has no row yet */
} steps;

/* All but the table. */
static void exchange_steps(pack *p, steps *s) {
  corot_pack_long(p, &s->count->steps);
  corot_pack_long(p, &s->count->rows);
  corot_pack_bool(p, &s->waits);
  step_row_exchange(p, &s->last);
}

static corot_status open_table_of_steps(const writer_source *source, steps *s) {
  if (!source->from) return steps_open(source->dir, &s->table);
  exchange_steps(source->from, s);
  return table_resume(source->dir, steps_writer.file, source->from, &s->table);
}

static corot_status open_steps(const writer_source *source, void **writer) {
  steps *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "the steps: out of memory");
  s->count = source->steps;
  *s->count = (steps_count){.all = source->scenario->write_all_steps};
  corot_status status = open_table_of_steps(source, s);
  if (status == COROT_OK)
    *writer = s;
  else
    free(s);
  return status;
}

static corot_status pack_steps(void *writer, pack *p) {
  exchange_steps(p, writer);
  return corot_pack_status(p);
}

static table *table_of_steps(const void *writer) { return ((const steps *)writer)->table; }

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
    .pack = pack_steps,
    .table = table_of_steps,
    .close = close_steps,
};

/* --- history.csv: by the history itself, at the end of each step --- */

static bool wants_history(const scenario *s) { return s->write_history; }

static corot_status open_history(const writer_source *source, void **writer) {
  COROT_TRY(history_open(source->history, source->dir, source->from));
  *writer = source->history;
  return COROT_OK;
}

static table *table_of_history(const void *writer) { return history_table(writer); }

static corot_status close_history(void *writer) { return history_close(writer); }

const writer_ops history_writer = {
    .file = "history.csv",
    .use = WRITER_OF_RUN,
    .wanted = wants_history,
    .open = open_history,
    .table = table_of_history,
    .close = close_history,
};

/* --- states.bin --- */

static bool wants_states(const scenario *s) { return s->write_states; }

static corot_status open_states(const writer_source *source, void **writer) {
  state_writer *file = NULL;
  if (source->from)
    COROT_TRY(states_resume(source->dir, source->model, source->from, &file));
  else
    COROT_TRY(states_create(source->dir, source->model, &file));
  *writer = file;
  return COROT_OK;
}

static corot_status write_state(void *writer, const moment *now) {
  return states_add(writer, now->t, now->u, now->v);
}

static corot_status pack_states(void *writer, pack *p) { return states_pack(writer, p); }

static corot_status synchronise_states(void *writer) { return states_synchronise(writer); }

static corot_status cut_states(void *writer) { return states_cut(writer); }

static corot_status close_states(void *writer) { return states_close(writer); }

const writer_ops states_writer = {
    .file = "states.bin",
    .wanted = wants_states,
    .open = open_states,
    .moment = write_state,
    .pack = pack_states,
    .synchronise = synchronise_states,
    .cut = cut_states,
    .close = close_states,
};
