/* The measures by name. */
#ifndef COROT_CORE_SOLID_MEASURES_H
#define COROT_CORE_SOLID_MEASURES_H

#include <corot/base.h>

/* Index into strain_measures; COROT_EINVAL: there is none of that name, and which there are. */
corot_status corot_strain_index(const char *name, int *strain);

#endif
