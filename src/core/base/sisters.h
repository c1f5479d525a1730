/* What one library of ours uses of another and a host cannot: a shared library has to export it,
   too, but under a version of its own (src/install/library.cmake), which fits the same release
   alone. */
#ifndef COROT_CORE_BASE_SISTERS_H
#define COROT_CORE_BASE_SISTERS_H

#include <corot/base.h>

#define COROT_SISTERS COROT_API

#endif
