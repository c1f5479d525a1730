/* Inside of an FMU: one instance of it, and what the functions of the interface share.

   Each function of the interface is a pair: the one that an importer calls asks whether there is an
   instance and whether the call is allowed in its mode, and tells what went wrong through the
   importer's logger; the other does the work and returns a corot_status. A call that is refused
   changes nothing. */
#ifndef COROT_FMI_INSTANCE_INSTANCE_H
#define COROT_FMI_INSTANCE_INSTANCE_H

#include "fmi/body/slopes.h"
#include "fmi/body/stepping.h"
#include "fmi/body/variables.h"
#include "fmi/interface/fmi3.h"

/* The states of the standard's state machines; sums of them say where a call is allowed. */
typedef enum mode {
  INSTANTIATED = 1,
  INITIALIZATION = 2,
  STEP = 4,         /* Co-Simulation, between communication points */
  INTERMEDIATE = 8, /* while the importer is asked within such a step */
  EVENT = 16,       /* Model Exchange */
  CONTINUOUS = 32,
  TERMINATED = 64,
  FAILED = 128, /* the integration has ended: what it reached can be read */
} mode;

enum {
  CALCULATED = INITIALIZATION | STEP | INTERMEDIATE | EVENT | CONTINUOUS | TERMINATED | FAILED,
  ALIVE = CALCULATED | INSTANTIATED,
};

typedef struct instance {
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;                         /* or NULL */
  fmi3IntermediateUpdateCallback intermediate_update; /* or NULL */
  bool early_return_allowed;
  bool exchange; /* Model Exchange, else Co-Simulation */
  mode mode;
  body body;
  variables variables;

  /* the experiment */
  double rtol; /* 0: the scenario's */
  double stop; /* [s] INFINITY: not known */

  /* the simulation, of what has been set: there if it is settled */
  bool settled;
  moment now;
  corot_state *state;
  corot_inputs *inputs; /* NULL: there are none */
  stepping *stepping;   /* of Co-Simulation */
  slopes slopes;        /* made where it is asked for: has a body then */
  sight sight;
  bool seen; /* the outputs have been found for the moment and the inputs as they are */
  double entered, next_kink; /* of Model Exchange [s] */

  struct kept *kept; /* states that the importer holds: see kept_states.c */
} instance;

/* --- Calls --- */

/* Whether the function may be called in this mode. COROT_EINVAL. */
corot_status instance_allow(const instance *in, unsigned modes);

/* The status of FMI, after a message for any but COROT_OK. COROT_RETRY is fmi3Discard: another
   state, nearer to the last, may be evaluated. */
fmi3Status instance_told(const instance *in, const char *function, corot_status status);

/* A message of a function that has no instance. */
void instance_say(fmi3LogMessageCallback log, fmi3InstanceEnvironment environment,
                  fmi3Status status, const char *function, const char *message);

/* Body of a function of the interface: `work` runs where it may. */
#define FMI3_CALL(instance_, modes, work)                                         \
  do {                                                                            \
    instance *in = (instance_);                                                   \
    if (!in) return fmi3Error;                                                    \
    corot_status allowed_ = instance_allow(in, (modes));                          \
    return instance_told(in, __func__, allowed_ == COROT_OK ? (work) : allowed_); \
  } while (0)

/* --- The simulation --- */

/* Makes it of what has been set, at the start. Failures as of scenario_build, static_start,
   corot_integrator_create; then it is not there. */
corot_status instance_settle(instance *in);
void instance_unsettle(instance *in);

/* Hands the value of input i to the simulation, if it is there. COROT_EINVAL. */
corot_status instance_apply_input(instance *in, int i);

/* Finds what may be needed of the moment: the outputs, the slopes. COROT_RETRY, COROT_ENOMEM. */
corot_status instance_look(instance *in);
corot_status instance_slopes(instance *in);

/* Enters the time of the moment, and finds the next kink (Model Exchange). */
void instance_enter(instance *in);

/* The variable of a reference. COROT_EINVAL: there is none. */
corot_status instance_variable(const instance *in, fmi3ValueReference reference,
                               const variable **found);

/* Frees the states that the importer has not freed. */
void instance_forget_states(instance *in);

/* COROT_EINVAL where a pointer that has to be given is NULL. */
corot_status instance_given(const void *pointer, const char *name);

#endif
