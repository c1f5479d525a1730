/* Scripts that draw a work-precision diagram from its CSV. */
#ifndef COROT_REPORT_CHART_PRECISION_SCRIPTS_H
#define COROT_REPORT_CHART_PRECISION_SCRIPTS_H

#include <stdio.h>

#include "precision.h"

typedef struct precision_script {
  const precision *diagram;
  const char *name; /* of CSV and script, without folder and suffix */
} precision_script;

/* Each is a save_writer and takes a precision_script. */
corot_status precision_gnuplot(const void *script, FILE *out);
corot_status precision_matplotlib(const void *script, FILE *out);

#endif
