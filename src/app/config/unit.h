/* Quantities with units, "20 ms", in the units that the table of keys has: SI. */
#ifndef COROT_APP_CONFIG_UNIT_H
#define COROT_APP_CONFIG_UNIT_H

#include <stdbool.h>
#include <stddef.h>

/* What a unit measures, and in how many of SI's: mantissa 10^exponent. */
typedef struct measured_unit {
  int power[4]; /* of kg, m, s, rad */
  double mantissa;
  int exponent;
} measured_unit;

/* A product of units with powers, as "kg/m^3", "Pa s", "N*m", "m/s^2" or "1/s", where one name
   stands after each sign; false: it is none, and `wrong` [size] has the name that is not known, or
   "". */
bool unit_parse(const char *text, measured_unit *u, size_t size, char *wrong);

/* The unit that a key has in the table; false: it has none that a number could have behind it. */
bool unit_of_key(const char *text, measured_unit *u);

bool unit_same(const measured_unit *a, const measured_unit *b);

/* `number`, decimal digits, in SI. Powers of ten go into the digits' own, so that 20 ms is what
   0.02 is, to the last bit. */
double unit_scale(const char *number, size_t length, const measured_unit *u);

/* The name of the unit that was meant by a wrong one; "" where none is near. */
void unit_suggest(const char *wrong, size_t size, char *near);

#endif
