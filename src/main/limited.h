/* Programs whose address space is limited (ulimit -v). */
#ifndef COROT_MAIN_LIMITED_H
#define COROT_MAIN_LIMITED_H

#include <stdbool.h>

bool is_limited(void);

/* Where it is, the libraries are given little time to begin, and the program ends with a message if
   they do not: call this first in main. */
void libraries_are_loaded(void);

#endif
