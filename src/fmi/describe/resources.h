/* What an FMU brings with it: its scenario, resolved, and the files that it refers to, under names
   of their own beside it, so that the FMU may be moved. */
#ifndef COROT_FMI_DESCRIBE_RESOURCES_H
#define COROT_FMI_DESCRIBE_RESOURCES_H

#include "app/scenario/scenario.h"

typedef struct resource {
  char *path; /* where it is */
  char *name; /* in the folder of resources */
  char *data; /* [size] what is to be in it; NULL: what is in the file */
  size_t size;
} resource;

typedef struct resources {
  int n, room;
  resource *file; /* [n]; the scenario is not among them */
  char *scenario; /* its text, JSON */
} resources;

/* Of what is only for runs nothing is kept: quantities, compare and output. COROT_ENOMEM. */
corot_status resources_find(const scenario *s, resources *r);
void resources_clear(resources *r);

/* Makes the folder, or uses what a process that was killed has left of it: DIR/scenario.json, and
   links to the files. COROT_EIO; COROT_ENOMEM. */
corot_status resources_lay_out(const resources *r, const char *dir);

/* Removes these, and the folder. COROT_EIO. */
corot_status resources_take_away(const resources *r, const char *dir);

/* The same as far as it goes, with the message as it was. */
void resources_abandon(const resources *r, const char *dir);

#endif
