/* From a status to the words of "failure". */
#include "failure.h"

json_t *run_failure_json(run_failure failure) {
  if (!failure.kind) return json_null();
  return json_pack("{s:s, s:b}", "kind", failure.kind, "retry", (int)failure.retry);
}
