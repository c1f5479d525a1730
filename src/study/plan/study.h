/* A study: one scenario, run many times with some of its keys varied along axes. */
#ifndef COROT_STUDY_PLAN_STUDY_H
#define COROT_STUDY_PLAN_STUDY_H

#include "app/config/schema.h"
#include "app/scenario/scenario.h"

/* What a study file may say. */
extern const schema study_schema;

/* One value along an axis: where it stands in the table's columns, and what it sets. */
typedef struct axis_point {
  int nplace, nset;
  const setting *place; /* [nplace] column and value */
  const setting *set;   /* [nset] keys of the scenario */
} axis_point;

typedef struct axis {
  const config_node *node; /* for messages */
  int npoint;
  const axis_point *point; /* [npoint] at least one */
} axis;

/* All combinations of the points of its axes, but for some. */
typedef struct grid {
  int nset, naxis, nexclude;
  const setting *set;                /* [nset] below what the axes set */
  const axis *axis;                  /* [naxis] */
  const config_node *const *exclude; /* [nexclude] maps: a cell that has all their values is out */
} grid;

/* The errors that are measured of every run with a reference, as collect.h has them. */
#define STUDY_NORMS "displacement|velocity|energy|mixed"

/* A quantity that every run is asked for. */
typedef struct study_quantity {
  const char *text;            /* as quantity_print() writes it */
  const char *name;            /* in the scenario's `quantities` */
  bool known;                  /* its value is, in its own unit: */
  double value, within, scale; /* how far off it may be, >= 0; what errors are relative to, > 0 */
} study_quantity;

/* The error that is the largest of those against known values. */
#define STUDY_TOTAL "total"

/* One run that the study asks for. */
typedef struct cell {
  int nplace, nset;
  const setting *place; /* [nplace] its coordinates, by column in alphabetical order */
  const setting *set;   /* [nset] what it puts in the place of the base's values, in order */
  const char *series;
  const setting *tolerance; /* the coordinate that says how fine it is; NULL: none does */
} cell;

/* Everything it points to lives as long as it does. */
typedef struct study {
  const char *path, *name, *title; /* name: of the file, without folder and ending */
  const char *base;                /* the scenario, resolved against the study's folder */
  const config_node *base_node;
  int nset;
  const setting *set; /* [nset] below those of the grids */
  int ngrid;
  const grid *grid;
  int repeat; /* timed repetitions */
  bool still; /* runs are searches for the equilibrium, as of corot static */

  bool referred;         /* errors are measured, against references */
  double reference_rtol; /* 0: by the tightest cell */
  bool reference_is_own; /* each mesh has its own; else one on the finest, where meshes differ in
                            mesh.refine and mesh.order */
  const char *reference_method[2];
  bool reference_is_open; /* nobody has said these two */
  json_t *pilot; /* by which they were chosen, for study.json: {"methods": two, "cost": {method:
                    s}}; NULL: they were not */
  int nreference_set;
  const setting *reference_set;

  const config_node *tolerance; /* list of keys: the first that is a coordinate of a cell */
  const config_node *group;     /* list of columns that name the series; NULL: all the others */
  const char *cost, *measure;   /* by which cells are compared: a norm, a quantity's text, total */
  bool all_known;               /* all that is measured is a quantity with a known value */
  int nquantity;
  const study_quantity *quantity; /* [nquantity] */

  int ncell;
  cell *cell; /* [ncell] none twice the same coordinates */

  config *tree; /* the file, for the places in messages; owns the memory */
} study;

/* COROT_EIO: it cannot be read. COROT_EFORMAT: the message names the place in the file. */
corot_status study_read(const char *path, study **out);
corot_status study_read_text(const char *path, const char *text, size_t size, study **out);

/* The same from a tree, which is taken over in any case. */
corot_status study_from_tree(config *tree, const char *path, study **out);

/* Takes NULL. */
void study_destroy(study *s);

/* --- Inside of reading --- */

/* The axes of a list. `above` [nabove] are crossed with them: no key may be varied twice. */
corot_status study_read_axes(config *tree, const config_node *list, int nabove, const axis *above,
                             int *naxis, const axis **axes);

/* The keys of a map with their values, in the order of the keys. */
corot_status study_read_settings(config *tree, const config_node *map, int *nset,
                                 const setting **set);

/* measure, quantity with its known value, and the settings that ask for it, after `set`. */
corot_status study_read_measures(study *s);

/* Makes study.cell from study.grid. */
corot_status study_make_cells(study *s);

/* A value as text: what stands behind the '=' of --set, or names a series. The tree's. */
corot_status study_value_text(config *tree, const config_node *value, const char **text);

/* A value as JSON, numbers as such. NULL: no memory. */
json_t *study_value_json(const config_node *value);

/* An order of values by what they mean, as of qsort: numbers before ~ and null before words. */
int study_compare_values(const config_node *a, const config_node *b);

/* What a tolerance amounts to, the smaller the finer: its number; of mesh.refine 2^-number. NaN: it
   is none. */
double study_tolerance(const setting *tolerance);

/* Whether two values mean the same: 1e-3 and 0.001 do, 1 and "1" do not. */
bool study_same_value(const config_node *a, const config_node *b);

#endif
