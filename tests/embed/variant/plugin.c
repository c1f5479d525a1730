/* A shared object of a host, with corot in it: it exports its own function and nothing of corot. */
#include <corot/solve.h>

__attribute__((visibility("default"))) corot_status plugin_entry(const corot_model *model,
                                                                 corot_state *state);

corot_status plugin_entry(const corot_model *model, corot_state *state) {
  corot_pencil *pencil;
  COROT_TRY(corot_pencil_create(model, state, NULL, &pencil));
  corot_pencil_destroy(pencil);
  return COROT_OK;
}
