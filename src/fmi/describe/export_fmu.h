/* From a scenario to an FMU. */
#ifndef COROT_FMI_DESCRIBE_EXPORT_FMU_H
#define COROT_FMI_DESCRIBE_EXPORT_FMU_H

#include "app/scenario/scenario.h"

/* What the FMU is to have. AUTO: Co-Simulation, and Model Exchange where it is possible. */
typedef enum export_interface {
  EXPORT_AUTO,
  EXPORT_SIMULATION,
  EXPORT_EXCHANGE,
  EXPORT_BOTH
} export_interface;

typedef struct export_def {
  const scenario *scenario;
  export_interface interface;
  const char *object; /* the file of the shared object */
  const char *to;     /* the FMU */
} export_def;

/* What came of it. */
typedef struct export_facts {
  char identifier[128]; /* of the model */
  char token[65];
  const char *platform; /* as "x86_64-linux" */
  bool simulation, exchange;
  char no_exchange[256]; /* why there is no Model Exchange; "": there is, or it was not asked for */
  int nparameter, ninput, noutput, nstate, nfile;
} export_facts;

/* Packs scenario, files and shared object, and has the body read from what is packed, as an
   instance will. COROT_EFORMAT: the scenario or its mesh is bad, or asks for what no FMU has; Model
   Exchange was asked for and is not possible. COROT_EIO, COROT_ENOMEM. */
corot_status export_fmu(const export_def *def, export_facts *facts);

#endif
