/* What the interface has and this FMU has not: each function says so. */
#include "instance.h"

static corot_status absent(const char *what) {
  return corot_fail(COROT_EINVAL, "this FMU has no %s", what);
}

/* --- Values of other types --- */

#define ABSENT_VALUES(type)                                                              \
  fmi3Status fmi3Get##type(fmi3Instance instance_, const fmi3ValueReference reference[], \
                           size_t nreference, fmi3##type value[], size_t nvalue) {       \
    (void)reference, (void)value;                                                        \
    FMI3_CALL(instance_, ALIVE,                                                          \
              nreference + nvalue == 0 ? COROT_OK : absent("variables of type " #type)); \
  }                                                                                      \
  fmi3Status fmi3Set##type(fmi3Instance instance_, const fmi3ValueReference reference[], \
                           size_t nreference, const fmi3##type value[], size_t nvalue) { \
    (void)reference, (void)value;                                                        \
    FMI3_CALL(instance_, ALIVE,                                                          \
              nreference + nvalue == 0 ? COROT_OK : absent("variables of type " #type)); \
  }
ABSENT_VALUES(Float32)
ABSENT_VALUES(Int8)
ABSENT_VALUES(UInt8)
ABSENT_VALUES(Int16)
ABSENT_VALUES(UInt16)
ABSENT_VALUES(Int32)
ABSENT_VALUES(UInt32)
ABSENT_VALUES(Int64)
ABSENT_VALUES(UInt64)
ABSENT_VALUES(Boolean)
ABSENT_VALUES(String)

fmi3Status fmi3GetBinary(fmi3Instance instance_, const fmi3ValueReference reference[],
                         size_t nreference, size_t size[], fmi3Binary value[], size_t nvalue) {
  (void)reference, (void)size, (void)value;
  FMI3_CALL(instance_, ALIVE,
            nreference + nvalue == 0 ? COROT_OK : absent("variables of type Binary"));
}

fmi3Status fmi3SetBinary(fmi3Instance instance_, const fmi3ValueReference reference[],
                         size_t nreference, const size_t size[], const fmi3Binary value[],
                         size_t nvalue) {
  (void)reference, (void)size, (void)value;
  FMI3_CALL(instance_, ALIVE,
            nreference + nvalue == 0 ? COROT_OK : absent("variables of type Binary"));
}

/* --- Clocks --- */

#define ABSENT_CLOCK(name, ...)                                                                    \
  fmi3Status name(fmi3Instance instance_, const fmi3ValueReference reference[], size_t nreference, \
                  __VA_ARGS__) {                                                                   \
    (void)reference;                                                                               \
    FMI3_CALL(instance_, ALIVE, nreference == 0 ? COROT_OK : absent("clocks"));                    \
  }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
ABSENT_CLOCK(fmi3GetClock, fmi3Clock value[])
ABSENT_CLOCK(fmi3SetClock, const fmi3Clock value[])
ABSENT_CLOCK(fmi3GetIntervalDecimal, fmi3Float64 interval[], fmi3IntervalQualifier qualifier[])
ABSENT_CLOCK(fmi3GetIntervalFraction, fmi3UInt64 counter[], fmi3UInt64 resolution[],
             fmi3IntervalQualifier qualifier[])
ABSENT_CLOCK(fmi3GetShiftDecimal, fmi3Float64 shift[])
ABSENT_CLOCK(fmi3GetShiftFraction, fmi3UInt64 counter[], fmi3UInt64 resolution[])
ABSENT_CLOCK(fmi3SetIntervalDecimal, const fmi3Float64 interval[])
ABSENT_CLOCK(fmi3SetIntervalFraction, const fmi3UInt64 counter[], const fmi3UInt64 resolution[])
ABSENT_CLOCK(fmi3SetShiftDecimal, const fmi3Float64 shift[])
ABSENT_CLOCK(fmi3SetShiftFraction, const fmi3UInt64 counter[], const fmi3UInt64 resolution[])
#pragma GCC diagnostic pop

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance_, fmi3ValueReference clock,
                                      fmi3Float64 time) {
  (void)clock, (void)time;
  FMI3_CALL(instance_, ALIVE, absent("clocks"));
}

/* --- Derivatives --- */

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance_, const fmi3ValueReference unknown[],
                                    size_t nunknown, const fmi3ValueReference known[],
                                    size_t nknown, const fmi3Float64 seed[], size_t nseed,
                                    fmi3Float64 sensitivity[], size_t nsensitivity) {
  (void)unknown, (void)nunknown, (void)known, (void)nknown, (void)seed, (void)nseed;
  (void)sensitivity, (void)nsensitivity;
  FMI3_CALL(instance_, ALIVE, absent("adjoint derivatives"));
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance_, const fmi3ValueReference reference[],
                                    size_t nreference, const fmi3Int32 order[], fmi3Float64 value[],
                                    size_t nvalue) {
  (void)reference, (void)nreference, (void)order, (void)value, (void)nvalue;
  FMI3_CALL(instance_, ALIVE, absent("derivatives of outputs (maxOutputDerivativeOrder is 0)"));
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance_, fmi3ValueReference reference,
                                               size_t *n) {
  (void)reference, (void)n;
  FMI3_CALL(instance_, ALIVE, absent("dependencies by element"));
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance_, fmi3ValueReference dependent,
                                       size_t element_of_dependent[],
                                       fmi3ValueReference independent[],
                                       size_t element_of_independent[], fmi3DependencyKind kind[],
                                       size_t n) {
  (void)dependent, (void)element_of_dependent, (void)independent, (void)element_of_independent;
  (void)kind, (void)n;
  FMI3_CALL(instance_, ALIVE, absent("dependencies by element"));
}

/* --- Modes --- */

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance_) {
  FMI3_CALL(instance_, ALIVE, absent("structural parameters to configure"));
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance_) {
  FMI3_CALL(instance_, ALIVE, absent("structural parameters to configure"));
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance_) {
  FMI3_CALL(instance_, ALIVE, absent("Event Mode in Co-Simulation to leave"));
}
