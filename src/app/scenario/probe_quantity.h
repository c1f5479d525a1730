/* What can be probed: a row for each quantity. */
#ifndef COROT_APP_SCENARIO_PROBE_QUANTITY_H
#define COROT_APP_SCENARIO_PROBE_QUANTITY_H

#include <stdbool.h>

/* In the order of PROBE_WORDS. */
typedef enum probe_of {
  PROBE_DISPLACEMENT,
  PROBE_VELOCITY,
  PROBE_ACCELERATION,
  PROBE_REACTION,
  PROBE_FORCE,
  PROBE_STRESS,
  PROBE_PRINCIPAL,
  PROBE_VON_MISES,
  PROBE_TRACTION,
  PROBE_STRAIN,
  PROBE_FRAME_ANGLE,
  PROBE_DET,
  PROBE_VOLUME,
  PROBE_MOMENTUM,
  PROBE_ANGULAR_MOMENTUM,
  PROBE_ELASTIC,
  PROBE_KINETIC,
  PROBE_DISSIPATED,
  PROBE_EXTERNAL_WORK,
  PROBE_BALANCE,
  PROBE_FRAME_ENERGY,
  NPROBE_OF
} probe_of;

#define PROBE_WORDS                                                                            \
  "displacement|velocity|acceleration|reaction|force|stress|principal|von_mises|traction|"     \
  "strain|"                                                                                    \
  "frame_angle|det|volume|momentum|angular_momentum|elastic|kinetic|dissipated|external_work|" \
  "balance|frame_energy"

typedef enum probe_take { TAKE_UNSAID, TAKE_MEAN, TAKE_SUM, TAKE_MAX, TAKE_MIN } probe_take;
typedef enum probe_part {
  PART_TOTAL,
  PART_INTERNAL,
  PART_VISCOUS,
  PART_INERTIAL,
  PART_LOAD
} probe_part;

/* Each list is indexed by the enumerators, and ends with NULL; "" stands for what is not said. */
extern const char *const probe_takes[];
extern const char *const probe_parts[];

/* The words of `component`, after "" for all: of vectors, of tensors, of eigenvalues. */
extern const char *const probe_components[];
enum { COMPONENT_VECTOR = 1, COMPONENT_MAGNITUDE = 4, COMPONENT_TENSOR, COMPONENT_VALUE = 11 };
#define PROBE_COMPONENTS "x|y|z|magnitude|xx|yy|zz|xy|yz|zx|1|2|3"

/* Who has such a quantity. */
typedef enum probe_carrier {
  OF_NODES,       /* each node, and any point between */
  OF_TETS,        /* each point of a tet */
  OF_FACES,       /* each point of a group's faces */
  SUM_OVER_NODES, /* a set of nodes as a whole */
  SUM_OVER_TETS,  /* a set of tets as a whole */
  OF_BODY,        /* the whole body alone */
} probe_carrier;

typedef struct probe_quantity {
  const char *word;
  probe_carrier carrier;
  int n;                          /* columns */
  const char *column[6];          /* [n] */
  const char *unit, *moment_unit; /* of the columns; of the second three of six, or NULL */
  int component;                  /* the first of its words in probe_components; 0: none */
  const char *length;             /* what the length of the vector is called; NULL: none has one */
  bool about;                     /* it has moments */
} probe_quantity;

extern const probe_quantity probe_quantities[NPROBE_OF];

#endif
