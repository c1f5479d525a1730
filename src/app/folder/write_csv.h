/* The tables of a run. Commas, a point for decimals, one header line, numbers with 17 significant
   digits (they read back to the same bits), an empty cell where there is nothing to say.

   Each row (of history.csv, a few dozen) is handed to the system as a whole as soon as it is made,
   so that a program that is killed leaves whole rows (but for the very last, which the system may
   cut at a page). A row that did not fit on the disk is taken back. `dir` is the run's folder. */
#ifndef COROT_APP_FOLDER_WRITE_CSV_H
#define COROT_APP_FOLDER_WRITE_CSV_H

#include <corot/integrate.h>
#include <corot/modes.h>

#include "growth.h"

typedef struct table table;

/* probes.csv: what the probes say, one row an output time

     t         [s]
     NAME.ux, NAME.uy, NAME.uz ...  the columns of each probe: app/probe/probe.h */

/* name: [ncolumn] with the component, "corner.ux" */
corot_status probes_open(const char *dir, int ncolumn, const char *const *name, table **probes);

/* value: [ncolumn] */
corot_status probes_row(table *probes, double t, int ncolumn, const double *value);

/* energy.csv: where the energy went, one row an output time. At a time where a load jumps, rows of
   this table and of the others are those of just before; nothing in them jumps with it.

     t              [s]
     kinetic        at t [J]
     elastic        at t [J]
     dissipated     by damping, from the start to t [J]
     external_work  by loads and moving supports, from the start to t [J]; of statics, by the
                    trapezoidal rule over the load steps, to which `balance` then belongs
     balance        kinetic + elastic + dissipated - external_work - frame_energy, less what there
                    was at the start [J]: the integration's error in energy
     frame_energy   put in by the updates of held frames, from the start to t [J]: an error of the
                    model, not of the integration
     px, py, pz     momentum [kg m/s]
     lx, ly, lz     angular momentum about the origin [kg m^2/s] */

typedef struct ledger {
  double t, kinetic, elastic, dissipated, external_work, balance, frame_energy;
  double momentum[3], angular_momentum[3];
} ledger;

/* The columns in this order, but for t: their names, separated by commas, and their values. */
extern const char ledger_columns[];
enum { LEDGER_COLUMNS = 12 };
void ledger_values(const ledger *row, double value[LEDGER_COLUMNS]);

corot_status energy_open(const char *dir, table **energy);
corot_status energy_row(table *energy, const ledger *row);

/* history.csv (history.h): both, at the end of every step. */
corot_status history_table_open(const char *dir, int ncolumn, const char *const *name,
                                table **history);
corot_status history_row(table *history, const ledger *row, int ncolumn, const double *value);

/* steps.csv: one row a step of the integrator, so that the h add up to the last t

     t, h           reached, and the step's length [s]
     order          of the method
     error          estimated local error over the tolerance
     newton         nonlinear iterations
     event          what happened at t, after the step: nothing (empty), or words joined by '+':
                      kink      an amplitude bends or jumps there, or a motion begins or stops
                                (there, or within a step of constant length)
                      frames    the held or extrapolated frames were updated
                      restart   the integrator dropped its history
                      failed    the update failed, and the run ended
                      rejected  longer steps were tried before, and refused (statics)
                      checkpoint  the integrator began anew, so that a run can go on from there
     angle_max, angle_mean       largest and mean turn of a frame in that update [rad]
     frame_energy   elastic energy that update put in [J]
     reason         of the update: step, interval, angle, cap (as far as an extrapolation may
                    go) or hook; the last four are empty without one

   Of more than 10 000 steps not all have a row: app/run/steps_kept.h, and steps_csv in result.json.
 */

enum {
  EVENT_KINK = 1,
  EVENT_FRAMES = 2,
  EVENT_RESTART = 4,
  EVENT_FAILED = 8,
  EVENT_REJECTED = 16,
  EVENT_CHECKPOINT = 32,
};

typedef struct step_row {
  double t, h;
  int order;
  double error;
  int newton;
  unsigned events;          /* a sum of EVENT_s */
  corot_frame_event update; /* read where events has EVENT_FRAMES */
} step_row;

/* The word for each reason, by its number; NULL for none. */
extern const char *const frame_reason_words[];
enum { FRAME_REASONS = COROT_FRAMES_BY_HOOK + 1 };

corot_status steps_open(const char *dir, table **steps);
corot_status steps_add(table *steps, const step_row *row);

/* compare.csv: internal forces of strain measures against those of green, one row an output time

     t           [s]
     M.total, M.pressure, M.shear   for each measure M, with frames of its own found at t:
                 |f_M - f_green| / |f_green|, Euclidean norm over all nodes, of the whole force, of
                 its lambda term and of its mu term; empty where green's is zero, as at rest, or
                 where an element is inverted */

typedef struct force_error {
  double total, pressure, shear;
} force_error;

corot_status compare_open(const char *dir, int nmeasure, const char *const *measure,
                          table **compare);

/* error: [nmeasure] */
corot_status compare_row(table *compare, double t, int nmeasure, const force_error *error);

/* reactions.csv: the forces of the supports on the body, one row an equilibrium of statics

     t           load factor times end time [s]
     GROUP.fx, GROUP.fy, GROUP.fz   for each group that a support holds: the elastic force on its
                 nodes less the loads there, summed over the components that are held [N] */

corot_status reactions_open(const char *dir, int ngroup, const char *const *name,
                            table **reactions);

/* force: [ngroup] */
corot_status reactions_row(table *reactions, double t, int ngroup, const double (*force)[3]);

/* modes.csv: one row a mode, by ascending w^2

     mode               from 1
     frequency          w / 2 pi [Hz]; 0: a rigid motion, or an unstable mode
     angular_frequency  w [rad/s]
     growth             of an unstable mode, as e^(growth t) [1/s]; else 0
     eigenvalue         w^2 [1/s^2]
     mass_x, mass_y, mass_z   effective mass along each axis [kg]
     residual           |K x - w^2 M x| / |K x|, see corot/modes.h */

corot_status modes_open(const char *dir, table **modes);
corot_status modes_row(table *modes, int number, const corot_mode *mode);

/* How far it has come, with all rows so far handed to the system. Then the table of DIR/NAME as it
   was, which changes nothing of the file until table_cut() takes away the rows since; failures as
   of growth_reopen. And that what is in the file is on the disk. */
corot_status table_pack(table *table, pack *p);
corot_status table_resume(const char *dir, const char *name, pack *p, table **table);
corot_status table_cut(table *table);
corot_status table_synchronise(table *table);

/* Reports an error that shows up on closing. Takes NULL; the table is gone either way. */
corot_status table_close(table *table);

#endif
