/* Programs whose address space is limited (ulimit -v). */
#ifndef COROT_MAIN_LIMITED_H
#define COROT_MAIN_LIMITED_H

#include <stdbool.h>

bool is_limited(void);

#endif
