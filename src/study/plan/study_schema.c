/* The table of all keys of a study file. */
#include "study.h"

#define MAP SCHEMA_MAP
#define NUMBER SCHEMA_NUMBER
#define INTEGER SCHEMA_INTEGER
#define TEXT SCHEMA_TEXT
#define CHOICE SCHEMA_CHOICE
#define OPTIONAL SCHEMA_OPTIONAL
#define REQUIRED SCHEMA_REQUIRED
#define ONE_OF SCHEMA_ONE_OF
#define ANY SCHEMA_ANY
#define POSITIVE SCHEMA_POSITIVE

/* clang-format off */
static const schema_key keys[] = {
  /* path                  type           status    range     unit default  words  doc */
  {"study",                TEXT,          REQUIRED, ANY,      "",  0, 0, "what is asked"},
  {"base",                 TEXT,          REQUIRED, ANY,      "",  0, 0, "the scenario, relative to the study's folder"},
  {"set",                  SCHEMA_OPEN,   OPTIONAL, ANY,      "",  "{}", 0, "keys of the scenario, as with --set, for all runs"},

  {"axes",                 SCHEMA_LIST,   OPTIONAL, ANY,      "",  "[]", 0, "what is varied: all combinations are run, and with all cells of each grid"},
  {"axes[].key",           TEXT,          ONE_OF,   ANY,      "",  0, 0, "a key of the scenario, with values or log"},
  {"axes[].zip",           SCHEMA_OPEN,   ONE_OF,   ANY,      "",  0, 0, "several keys, each with a list of values: the first of each together, the second, ..."},
  {"axes[].variants",      SCHEMA_LIST,   ONE_OF,   ANY,      "",  0, 0, "labelled sets of keys"},
  {"axes[].values",        SCHEMA_VALUES, OPTIONAL, ANY,      "",  0, 0, "of the key"},
  {"axes[].log",           MAP,           OPTIONAL, ANY,      "",  0, 0, "values of the key at equal ratios, at most 1000"},
  {"axes[].log.from",      NUMBER,        REQUIRED, POSITIVE, "",  0, 0, "the first"},
  {"axes[].log.to",        NUMBER,        REQUIRED, POSITIVE, "",  0, 0, "the last, larger or smaller"},
  {"axes[].log.per_decade", INTEGER,      ONE_OF,   POSITIVE, "",  0, 0, "values for each factor of ten; the last is the last of these that does not pass `to`"},
  {"axes[].log.points",    INTEGER,       ONE_OF,   POSITIVE, "",  0, 0, "values in all, `from` and `to` included"},
  {"axes[].name",          TEXT,          OPTIONAL, ANY,      "",  0, 0, "of variants: the column for their labels"},
  {"axes[].variants[].label", TEXT,       REQUIRED, ANY,      "",  0, 0, "how it is called in tables"},
  {"axes[].variants[].set", SCHEMA_OPEN,  REQUIRED, ANY,      "",  0, 0, "keys of the scenario"},
  {"exclude",              SCHEMA_OPENS,  OPTIONAL, ANY,      "",  "[]", 0, "combinations to leave out: those that have all values of an entry"},
  {"grids",                SCHEMA_LIST,   OPTIONAL, ANY,      "",  "[]", 0, "sets of axes, one beside the other, where not all keys go with all others"},
  {"grids[].set",          SCHEMA_OPEN,   OPTIONAL, ANY,      "",  "{}", 0, "as above, for this one"},
  {"grids[].axes",         SCHEMA_LIST,   OPTIONAL, ANY,      "",  "[]", "axes[]", "as above, for this one"},
  {"grids[].exclude",      SCHEMA_OPENS,  OPTIONAL, ANY,      "",  "[]", 0, "as above, for this one"},

  {"static",               CHOICE,        OPTIONAL, ANY,      "",  "false", "true|false", "true: a run is a search for the equilibrium, as of corot static"},
  {"repeat",               INTEGER,       OPTIONAL, SCHEMA_NOT_NEGATIVE, "", "0", 0, "timed repetitions of each run, alone on the machine; 0: times are those of the one run, with others beside it"},
  {"reference",            SCHEMA_SHORT,  OPTIONAL, ANY,      "",  "auto", 0, "what errors are measured against: two tight runs of the same solid; auto or none will do"},
  {"reference.use",        CHOICE,        OPTIONAL, ANY,      "",  "auto", "auto|none", "none: no errors are measured"},
  {"reference.rtol",       NUMBER,        OPTIONAL, SCHEMA_FRACTION, "", "auto", "auto", "of both; auto: 1e-9, or a hundredth of the tightest cell down to 1e-11; of a static study the tolerance, auto: 1e-12"},
  {"reference.methods",    SCHEMA_WORDS,  OPTIONAL, ANY,      "",  "[cvode, arkode]", "cvode|ida|arkode|erk", "two; not given, erk takes the place of the dearer of cvode and arkode where pilots, a fiftieth of the time by each, find it at most half as dear. Cells are held against the first, and it against the second; of a static study both are Newton's, the second in load steps half as long"},
  {"reference.mesh",       CHOICE,        OPTIONAL, ANY,      "",  "finest", "finest|own", "finest: where cells differ in mesh.refine or mesh.order, all are held against one reference on the finest of both, or on what reference.set says, at their nodes, which it must have: errors are those of the mesh, too; own: each mesh has a reference of its own"},
  {"reference.set",        SCHEMA_OPEN,   OPTIONAL, ANY,      "",  "{}", 0, "keys that are the same for all references, such as the strain: errors are then those of the model, too"},

  {"reference.known",      SCHEMA_NAMED_SHORT, OPTIONAL, ANY, "",  "{}", 0, "values that are known, by quantities of measure or by names of the scenario's quantities: {max(corner.ux): 0.1}. Errors of these are total, signed, and need no reference run; where all that is measured is known, none is made unless use, rtol, methods or set is given"},
  {"reference.known.NAME.value", NUMBER,  REQUIRED, ANY,      "",  0, 0, "what it is, in the quantity's unit"},
  {"reference.known.NAME.within", NUMBER, OPTIONAL, SCHEMA_NOT_NEGATIVE, "", "0", 0, "how far off the known value may be, in the same unit; of an error below that it is said what it is at most"},
  {"reference.known.NAME.scale", NUMBER,  OPTIONAL, POSITIVE, "",  "auto", "auto", "what errors are relative to, in the same unit; auto: the value's size"},

  {"tolerance",            SCHEMA_TEXTS,  OPTIONAL, ANY,      "",  "[integrator.rtol, integrator.step, statics.tolerance, mesh.refine]", 0, "the key that makes a run finer along a series; of several, the first that is varied. mesh.refine counts as the size of the tets, 2^-refine"},
  {"group",                SCHEMA_TEXTS,  OPTIONAL, ANY,      "",  0, 0, "the columns that tell series apart; default: all but the tolerance"},
  {"cost",                 CHOICE,        OPTIONAL, ANY,      "",  "cpu", "cpu|wall|steps|rhs|factorisations|solves", "by which runs are compared"},
  {"measure",              SCHEMA_TEXTS,  OPTIONAL, ANY,      "",  "displacement", 0, "the error by which runs are compared: displacement, velocity, energy, mixed, or that of a quantity, such as max(corner.ux), as in quantities of a scenario, or one of its names; total: the largest of those that reference.known has values for, and the default where it has; of several, by the first, and all runs are asked for all quantities"},
};
/* clang-format on */

const schema study_schema = {.key = keys, .nkey = sizeof keys / sizeof *keys};
