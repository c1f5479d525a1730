/* Colours of messages: on a terminal that can show them, and where nobody has asked for none. */
#ifndef COROT_APP_TEXT_COLOUR_H
#define COROT_APP_TEXT_COLOUR_H

#include <stdio.h>

typedef enum colour { COLOUR_ERROR, COLOUR_WARNING, COLOUR_PLACE, COLOUR_END } colour;

/* What to write to `out` so that the following is shown so, COLOUR_END for as before: "" where
   `out` is no terminal, NO_COLOR is set to anything but "", or TERM is not set, "" or "dumb". */
const char *colour_of(colour what, FILE *out);

#endif
