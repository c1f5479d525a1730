/* Which model a state belongs to. */
#ifndef COROT_CORE_MODEL_IDENTITY_H
#define COROT_CORE_MODEL_IDENTITY_H

#include <corot/model.h>
#include <stdint.h>

#include "core/base/sisters.h"

/* A checksum of all that the equation of motion is made of: mesh, materials, mass, supports, loads.
   Models made of equal definitions have equal ones, in whatever process; those that differ in a
   single number have others, but for one chance in 2^64. */
COROT_SISTERS uint64_t corot_model_identity(const corot_model *model);

#endif
