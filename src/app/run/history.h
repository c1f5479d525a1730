/* Probes and energies at the end of every step: their table, history.csv, their extremes, and what
   they tell of the motion. An output grid sees none of what happens between its times.

   history.csv

     t                          [s], ascending: the start, the end of each step, and in place of a
                                step's end beyond the end of the run, that end
     NAME.ux ...                for each probe, as in probes.csv
     kinetic ... lz             as in energy.csv */
#ifndef COROT_APP_RUN_HISTORY_H
#define COROT_APP_RUN_HISTORY_H

#include <jansson.h>

#include "app/probe/probe.h"

typedef struct history history;

typedef struct extreme {
  double value, t; /* t [s]: when it was first reached */
} extreme;

/* For a model of `ndof` degrees of freedom and probes that outlive it. */
corot_status history_create(const probes *p, int ndof, history **out);

/* Begins DIR/history.csv, or goes on with that of a checkpoint (or NULL); without this call nothing
   is written. */
corot_status history_open(history *h, const char *dir, pack *from);

/* One moment: the ledger, the probes' columns, and u and v [ndof], of which those with the largest
   elastic energy are kept. */
corot_status history_add(history *h, const ledger *now, const double *value, const double *u,
                         const double *v);

/* The probes' columns, lengths of vectors, and the energies, by name:
   {"NAME.ux": {"min": {"value", "t"}, "max": {"value", "t"}}, ..., "NAME.u", "kinetic", ...}; with
   "at" (probe_where_json) where the probe itself is an extreme. The caller's to json_decref; NULL:
   no memory, or no moment. */
json_t *history_extremes(const history *h);

/* What warnings are made of. */
typedef struct history_facts {
  long count;                       /* moments */
  extreme balance_min, balance_max; /* of the energy [J] */
  double balance, dissipated;       /* at the last moment [J] */
  double energy;                    /* the largest of any kinetic, elastic or dissipated energy, and
                                       of the external work [J] */
  double period;    /* of the motion that moves the probes most: twice the mean time between turns,
                       weighted by how far it goes between them; without probes, four times that of the
                       kinetic energy [s]. 0: it does not turn, or hardly */
  double swing;     /* how far that probe's component goes [m]; NaN: without probes */
  double kinetic;   /* the largest kinetic energy [J] */
  double t_elastic; /* when the elastic energy was largest [s] */
  const double *u, *v; /* [ndof] and the displacement and velocity then */
} history_facts;

history_facts history_known(const history *h);

/* Writes or reads what has been seen so far, without the table; of a history of the same probes. */
void history_exchange(pack *p, history *h);
table *history_table(const history *h);

/* Closes the table and reports an error that shows up on closing. */
corot_status history_close(history *h);

/* Takes NULL. */
void history_destroy(history *h);

#endif
