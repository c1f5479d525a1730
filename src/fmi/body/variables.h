/* The variables of an FMU, in the order of their value references, which are their places in the
   list: time, parameters, inputs, outputs and, where Model Exchange is possible, the states u and v
   with their derivatives, each an array. */
#ifndef COROT_FMI_BODY_VARIABLES_H
#define COROT_FMI_BODY_VARIABLES_H

#include "fmu_body.h"

typedef enum variable_kind {
  VARIABLE_TIME,
  VARIABLE_PARAMETER, /* until the end of initialization */
  VARIABLE_LOAD,      /* an input: factor of a load, at any time */
  VARIABLE_STIFFNESS, /* an input: factor of a material, between steps */
  VARIABLE_OUTPUT,
  VARIABLE_STATE,
  VARIABLE_SLOPE, /* derivative of a state */
} variable_kind;

typedef struct variable {
  variable_kind kind;
  int index; /* of a parameter BODY_MATERIAL k + number; of an input or an output its own; of states
                and slopes 0: u, 1: v */
  int size;  /* numbers */
  char *name, *about, *unit; /* a unit of "": none */
} variable;

/* What an output depends on directly, as a sum. */
enum {
  DEPENDS_TIME = 1,
  DEPENDS_U = 2,
  DEPENDS_V = 4,
  DEPENDS_LOADS = 8,
  DEPENDS_MATERIALS = 16,
  DEPENDS_ALL = 31
};

typedef struct variables {
  int n;
  variable *all;     /* [n] */
  unsigned *depends; /* [noutput] */
  int nparameter, ninput, noutput;
  int input, output, state, slope; /* the first of each; of states and slopes -1: there are none */
} variables;

/* The body must outlive them. COROT_EFORMAT: two would have one name. COROT_ENOMEM. */
corot_status variables_create(const body *b, variables *v);
void variables_clear(variables *v);

static inline bool variable_is_input(const variable *v) {
  return v->kind == VARIABLE_LOAD || v->kind == VARIABLE_STIFFNESS;
}

/* The value before anything is set; of a parameter or an input. */
double variable_start(const body *b, const variable *v);

#endif
