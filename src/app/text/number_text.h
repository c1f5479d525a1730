/* Numbers as text, as fast as tables of every step want them. */
#ifndef COROT_APP_TEXT_NUMBER_TEXT_H
#define COROT_APP_TEXT_NUMBER_TEXT_H

#include <stddef.h>

enum { NUMBER_TEXT = 32 }; /* room for the longest, and to spare */

/* Writes what printf's "%.17g" would in the C locale, to the last character, and returns its
   length. Seventeen digits read back as the same number. */
size_t number_text(double x, char text[NUMBER_TEXT]);

#endif
