/* What an FMU brings with it: its scenario, resolved, and the files that it refers to, under names
   of their own beside it, so that the FMU may be moved. */
#ifndef COROT_FMI_DESCRIBE_RESOURCES_H
#define COROT_FMI_DESCRIBE_RESOURCES_H

#include "app/scenario/scenario.h"

typedef struct resource {
  char *path; /* where it is */
  char *name; /* in the folder of resources */
} resource;

typedef struct resources {
  int n, room;
  resource *file; /* [n]; the scenario is not among them */
  char *scenario; /* its text, JSON */
} resources;

/* Of what is only for runs nothing is kept: quantities, compare and output. COROT_ENOMEM. */
corot_status resources_find(const scenario *s, resources *r);
void resources_clear(resources *r);

/* Makes DIR/scenario.json, and links to the files. COROT_EIO; COROT_ENOMEM. */
corot_status resources_lay_out(const resources *r, const char *dir);

/* Removes these, and the folder. */
void resources_take_away(const resources *r, const char *dir);

#endif
