/* The bar as a function, for hosts in other languages: a model is made in C, where its definitions
   are structs that grow, and used through plain pointers, numbers and arrays. */
#include "bar.h"

corot_model *bar_model(void);

corot_model *bar_model(void) { return bar_create(); }
