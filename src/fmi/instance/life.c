/* From instantiation to the end: modes, and what each transition does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "instance.h"

const char *fmi3GetVersion(void) { return "3.0"; }

/* --- Instantiation --- */

static corot_status open_body(instance *in, const char *resources) {
  size_t length = strlen(resources);
  bool slash = length > 0 && resources[length - 1] == '/';
  char *path = malloc(length + 32);
  if (!path) return no_memory();
  snprintf(path, length + 32, "%s%sscenario.json", resources, slash ? "" : "/");
  corot_status status = body_open(path, &in->body);
  free(path);
  return status;
}

static corot_status check_token(const instance *in, const char *token) {
  if (strcmp(token, in->body.hashes.run) == 0) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "the instantiation token is not that of these resources, which is %s: "
                    "modelDescription.xml and resources are of two exports, or were changed",
                    in->body.hashes.run);
}

static corot_status check_exchange(const instance *in) {
  const char *reason = in->exchange ? body_no_exchange(&in->body) : NULL;
  if (!reason) return COROT_OK;
  return corot_fail(COROT_EINVAL, "Model Exchange is not possible: %s", reason);
}

static corot_status open_instance(instance *in, const char *name, const char *token,
                                  const char *resources) {
  COROT_TRY(instance_given(name, "instanceName"));
  COROT_TRY(instance_given(token, "instantiationToken"));
  COROT_TRY(instance_given(resources, "resourcePath"));
  COROT_TRY(open_body(in, resources));
  COROT_TRY(check_token(in, token));
  COROT_TRY(check_exchange(in));
  return variables_create(&in->body, &in->variables);
}

static void close_instance(instance *in) {
  instance_forget_states(in);
  instance_unsettle(in);
  variables_clear(&in->variables);
  body_close(&in->body);
  free(in);
}

/* NULL after a message. */
static instance *instantiate(const char *function, const char *name, const char *token,
                             const char *resources, const instance *with) {
  instance *in = calloc(1, sizeof *in);
  corot_status status = in ? COROT_OK : no_memory();
  if (in) {
    *in = *with;
    in->mode = INSTANTIATED;
    in->stop = INFINITY;
    status = open_instance(in, name, token, resources);
  }
  if (status == COROT_OK) return in;
  instance_say(with->log, with->environment, fmi3Error, function, corot_error());
  if (in) close_instance(in);
  return NULL;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log) {
  (void)visible, (void)logging;
  const instance with = {.environment = environment, .log = log, .exchange = true};
  return instantiate(__func__, name, token, resources, &with);
}

/* What the importer will ask for within steps has to be outputs. */
static corot_status check_required(const instance *in, const fmi3ValueReference required[],
                                   size_t n) {
  if (n > 0) COROT_TRY(instance_given(required, "requiredIntermediateVariables"));
  for (size_t i = 0; i < n; i++) {
    const variable *v;
    COROT_TRY(instance_variable(in, required[i], &v));
    if (v->kind != VARIABLE_OUTPUT)
      return corot_fail(COROT_EINVAL, "%s is not an output: it has no values within a step",
                        v->name);
  }
  return COROT_OK;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging,
                                         fmi3Boolean event_mode_used,
                                         fmi3Boolean early_return_allowed,
                                         const fmi3ValueReference required_intermediate[],
                                         size_t nrequired, fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback intermediate_update) {
  (void)visible, (void)logging;
  const instance with = {.environment = environment,
                         .log = log,
                         .intermediate_update = intermediate_update,
                         .early_return_allowed = early_return_allowed};
  if (event_mode_used) {
    instance_say(log, environment, fmi3Error, __func__,
                 "there is no Event Mode in Co-Simulation (hasEventMode is false)");
    return NULL;
  }
  instance *in = instantiate(__func__, name, token, resources, &with);
  if (in && check_required(in, required_intermediate, nrequired) != COROT_OK) {
    instance_told(in, __func__, COROT_EINVAL);
    close_instance(in);
    in = NULL;
  }
  return in;
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback clock_update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging;
  (void)clock_update, (void)lock, (void)unlock;
  instance_say(log, environment, fmi3Error, __func__,
               "this FMU has no Scheduled Execution: it has Co-Simulation");
  return NULL;
}

void fmi3FreeInstance(fmi3Instance instance_) {
  if (instance_) close_instance(instance_);
}

/* --- Messages --- */

static corot_status set_logging(size_t n, const fmi3String category[]) {
  if (n > 0) COROT_TRY(instance_given(category, "categories"));
  for (size_t i = 0; i < n; i++) {
    const char *name = category[i] ? category[i] : "";
    if (strcmp(name, "logStatusError") != 0 && strcmp(name, "logStatusDiscard") != 0)
      return corot_fail(COROT_EINVAL,
                        "there is no category '%.100s': there are logStatusError and "
                        "logStatusDiscard",
                        name);
  }
  return COROT_OK;
}

/* What went wrong is told in any case; there is nothing else to tell. */
fmi3Status fmi3SetDebugLogging(fmi3Instance instance_, fmi3Boolean on, size_t ncategory,
                               const fmi3String category[]) {
  (void)on;
  FMI3_CALL(instance_, ALIVE, set_logging(ncategory, category));
}

/* --- Initialization --- */

static corot_status begin(instance *in, bool tolerance_defined, double tolerance, double start,
                          bool stop_defined, double stop) {
  if (start != 0)
    return corot_fail(COROT_EINVAL,
                      "startTime is %g s: the model's loads and supports begin at t = 0", start);
  if (stop_defined && !(stop > 0 && isfinite(stop)))
    return corot_fail(COROT_EINVAL, "stopTime is %g s, and not after startTime", stop);
  if (tolerance_defined && !(tolerance > 0 && tolerance < 1))
    return corot_fail(COROT_EINVAL, "tolerance is %g, and not between 0 and 1", tolerance);
  if (stop_defined && !in->exchange) COROT_TRY(stepping_check(&in->body, stop));
  in->stop = stop_defined ? stop : INFINITY;
  in->rtol = tolerance_defined ? tolerance : 0;
  instance_unsettle(in);
  in->mode = INITIALIZATION;
  return COROT_OK;
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance_, fmi3Boolean tolerance_defined,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stop_defined, fmi3Float64 stop) {
  FMI3_CALL(instance_, INSTANTIATED,
            begin(in, tolerance_defined, tolerance, start, stop_defined, stop));
}

static corot_status go(instance *in) {
  COROT_TRY(instance_settle(in));
  in->mode = in->exchange ? EVENT : STEP;
  return COROT_OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance_) {
  FMI3_CALL(instance_, INITIALIZATION, go(in));
}

/* --- The end --- */

static corot_status change_mode(instance *in, mode to) {
  in->mode = to;
  return COROT_OK;
}

fmi3Status fmi3Terminate(fmi3Instance instance_) {
  FMI3_CALL(instance_, STEP | EVENT | CONTINUOUS | FAILED, change_mode(in, TERMINATED));
}

static corot_status reset(instance *in) {
  instance_unsettle(in);
  body_forget(&in->body);
  in->stop = INFINITY;
  in->rtol = 0;
  in->mode = INSTANTIATED;
  return COROT_OK;
}

fmi3Status fmi3Reset(fmi3Instance instance_) {
  FMI3_CALL(instance_, ALIVE & ~INTERMEDIATE, reset(in));
}

/* --- Modes of Model Exchange --- */

fmi3Status fmi3EnterEventMode(fmi3Instance instance_) {
  FMI3_CALL(instance_, CONTINUOUS, change_mode(in, EVENT));
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance_) {
  FMI3_CALL(instance_, EVENT, change_mode(in, CONTINUOUS));
}
