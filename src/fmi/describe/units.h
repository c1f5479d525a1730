/* Units of variables in the terms of the standard: powers of the base units of SI. */
#ifndef COROT_FMI_DESCRIBE_UNITS_H
#define COROT_FMI_DESCRIBE_UNITS_H

#include <stdbool.h>

/* The base units that mechanics has, as the standard calls its attributes. */
enum { UNIT_KG, UNIT_M, UNIT_S, UNIT_RAD, UNIT_BASES };
extern const char *const unit_bases[UNIT_BASES];

/* The powers of a unit such as "kg m^2/s": symbols with a space between, of which those after a
   slash divide. false: it has a symbol that is not known. */
bool unit_powers(const char *unit, int power[UNIT_BASES]);

#endif
