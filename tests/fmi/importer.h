/* A small importer of FMUs, for the tests: it loads the shared object of one that has been
   unpacked, finds every function of the interface by its name, and reads of modelDescription.xml
   what it needs: the token, and the references of variables. */
#ifndef COROT_TESTS_FMI_IMPORTER_H
#define COROT_TESTS_FMI_IMPORTER_H

#include "fmi/interface/fmi3.h"

/* The functions that the tests call, each under its name without fmi3. */
/* clang-format off */
#define FMU_FUNCTIONS(X)                                                                          \
  X(GetVersion) X(SetDebugLogging) X(InstantiateModelExchange) X(InstantiateCoSimulation)         \
  X(InstantiateScheduledExecution) X(FreeInstance) X(EnterInitializationMode)                     \
  X(ExitInitializationMode) X(EnterEventMode) X(Terminate) X(Reset) X(GetFloat64) X(SetFloat64)   \
  X(GetFloat32) X(SetString) X(GetDirectionalDerivative) X(GetAdjointDerivative) X(GetFMUState)   \
  X(SetFMUState) X(FreeFMUState) X(SerializedFMUStateSize) X(SerializeFMUState)                   \
  X(DeserializeFMUState) X(UpdateDiscreteStates) X(EnterContinuousTimeMode)                       \
  X(CompletedIntegratorStep) X(SetTime) X(SetContinuousStates) X(GetContinuousStateDerivatives)   \
  X(GetEventIndicators) X(GetContinuousStates) X(GetNominalsOfContinuousStates)                   \
  X(GetNumberOfEventIndicators) X(GetNumberOfContinuousStates) X(EnterStepMode)                   \
  X(GetOutputDerivatives) X(DoStep) X(EnterConfigurationMode) X(GetClock)
/* clang-format on */

typedef struct fmu {
  char *folder, *resources, *description;
  char token[128], identifier[128];
  void *library;
#define MEMBER(name) __typeof__(&fmi3##name) name;
  FMU_FUNCTIONS(MEMBER)
#undef MEMBER
} fmu;

/* Ends the test where anything is missing. */
fmu *fmu_load(const char *folder);
void fmu_unload(fmu *f);

/* The reference of a variable; ends the test if there is none. */
fmi3ValueReference fmu_reference(const fmu *f, const char *name);

/* Numbers of a variable: 1, or the size of the array. */
size_t fmu_size(const fmu *f, const char *name);

/* What the FMU has logged last, and how often. */
typedef struct fmu_log {
  int count;
  fmi3Status status;
  char category[64], message[2048];
} fmu_log;
void fmu_take_message(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                      fmi3String message);

/* Instances whose messages go to the log, in Initialization Mode. stop: stopTime; 0: none. */
fmi3Instance fmu_simulation(const fmu *f, fmu_log *log);
fmi3Instance fmu_exchange(const fmu *f, fmu_log *log);

/* One number. */
double fmu_get(const fmu *f, fmi3Instance instance, const char *name);
void fmu_set(const fmu *f, fmi3Instance instance, const char *name, double value);

/* A step that has to succeed; returns what lastSuccessfulTime says. */
double fmu_step(const fmu *f, fmi3Instance instance, double t, double step);

/* A table of numbers with a line of names, as probes.csv. */
typedef struct fmu_table {
  int nrow, ncolumn;
  char **name;   /* [ncolumn] */
  double *value; /* [nrow][ncolumn] */
} fmu_table;
fmu_table fmu_read_table(const char *path);
void fmu_free_table(fmu_table *t);

/* DIR/NAME, where the tests' FMUs lie; in a buffer of its own, of which there are four. */
const char *fmu_path(const char *name);

#endif
