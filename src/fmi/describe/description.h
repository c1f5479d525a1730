/* modelDescription.xml of an FMU, by the rules of FMI 3.0. */
#ifndef COROT_FMI_DESCRIBE_DESCRIPTION_H
#define COROT_FMI_DESCRIBE_DESCRIPTION_H

#include <stdio.h>

#include "fmi/body/variables.h"

typedef struct description {
  const body *body;
  const variables *variables;
  const char *name;       /* of the model */
  const char *identifier; /* a C name: that of the shared object */
  bool exchange;          /* Model Exchange, too; needs states among the variables */
  bool simulation;        /* Co-Simulation */
} description;

/* Errors of the stream are left in it. */
void description_write(const description *d, FILE *out);

#endif
