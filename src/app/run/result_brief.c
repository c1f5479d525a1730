/* The short document, from what is known without a run. */
#include "result_brief.h"

#include "app/folder/provenance.h"
#include "app/scenario/warnings.h"
#include "app/text/json_text.h"
#include "stop.h"

/* `t_reached` is taken over. What can be found in it stands first. */
static corot_status make_text(const scenario *s, const brief_result *what, json_t *t_reached,
                              char **text) {
  json_t *result = json_object(), *provenance;
  if (provenance_make(&provenance) != COROT_OK)
    provenance = json_null(); /* the reason matters more */
  result = json_text_with(result, "status", json_string(what->status));
  result = json_text_with(result, "reason", json_text_string(what->reason));
  result = json_text_with(result, "exit_code", json_integer(what->exit_code));
  result = json_text_with(result, "t_reached", t_reached);
  result = json_text_with(result, "failure", run_failure_json(what->failure));
  result = json_text_with(result, "t_end", s ? json_text_real(s->t_end) : json_null());
  result = json_text_with(result, "title", s ? json_text_string(s->title) : json_null());
  result = json_text_with(result, "warnings",
                          what->warnings ? warnings_json(what->warnings) : json_array());
  result = json_text_with(result, "strain", s ? json_string(s->strain) : json_null());
  result = json_text_with(result, "versions", result_versions());
  result = json_text_with(result, "provenance", provenance);
  result = json_text_with(result, "scenario", s ? json_incref(s->resolved) : json_null());
  if (!result) return corot_fail(COROT_ENOMEM, "result.json: out of memory");
  corot_status status = result_text(result, text);
  json_decref(result);
  return status;
}

corot_status result_brief(const scenario *s, const brief_result *what, char **text) {
  return make_text(s, what, json_text_real(what->t_reached), text);
}

corot_status result_for_stop(const scenario *s, char **text) {
  char reason[64];
  snprintf(reason, sizeof reason, "interrupted by signal %d", STOP_NUMBER);
  brief_result what = {.status = "interrupted",
                       .reason = reason,
                       .exit_code = STOP_CODE,
                       .failure = {"interrupted", true}};
  return make_text(s, &what, json_integer(STOP_REACHED), text);
}
