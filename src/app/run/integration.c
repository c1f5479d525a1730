/* The blob of an integrator within a pack. */
#include "integration.h"

static corot_status save(pack *p, corot_integrator *integrator) {
  void *blob;
  size_t bytes;
  COROT_TRY(corot_integrator_save(integrator, &blob, &bytes));
  const void *block = blob;
  corot_pack_block(p, &block, &bytes);
  corot_blob_free(blob);
  return corot_pack_status(p);
}

corot_status integration_exchange(pack *p, corot_integrator *integrator) {
  const void *blob = NULL;
  size_t bytes = 0;
  if (!p->reading) return save(p, integrator);
  corot_pack_block(p, &blob, &bytes);
  COROT_TRY(corot_pack_status(p));
  return corot_integrator_restore(integrator, blob, bytes);
}
