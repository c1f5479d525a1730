/* A kernel under its plain name, which calls the build for this processor (kernel_names.h). */
#ifndef COROT_CORE_SOLID_KERNEL_CHOOSE_H
#define COROT_CORE_SOLID_KERNEL_CHOOSE_H

#include "core/lanes/widths.h"

#define CHOOSE(result, name, parameters, arguments)                \
  extern __typeof__(name) name##_v1, name##_v3, name##_v4;         \
  result name parameters {                                         \
    int lanes = corot_lanes_in_use();                              \
    if (lanes == 8) return name##_v4 arguments;                    \
    return lanes == 4 ? name##_v3 arguments : name##_v1 arguments; \
  }

#endif
