/* The state of an integration as bytes. Saving packs it and then takes it in again, as restoring
   does: the two go on from the same numbers by construction, whatever a method or a linear solver
   remembers beside them.

   A blob is a header and what it is a header of:

     magic     8 bytes, "corot" and zeros
     order     8 bytes, a number that reads otherwise in another byte order
     format    8 bytes, the version of all that follows
     bytes     8 bytes, of what follows the header
     checksum  8 bytes, of that
     model, definition   8 bytes each, checksums of what the state is one of */
#include <corot/checkpoint.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "core/model/identity.h"
#include "core/ode/state.h"
#include "core/ode/state_exchange.h"
#include "integrator.h"

#define FORMAT UINT64_C(1)

enum { HEADER = 56 };

typedef struct header {
  char magic[8];
  uint64_t order, format, bytes, checksum, model, definition;
} header;
_Static_assert(sizeof(header) == HEADER, "a header has no gaps");

static const char magic[8] = "corot";

/* --- What a state consists of ---------------------------------------------------------------- */

static void add_word(uint64_t *sum, const char *word) {
  const char *given = word && strcmp(word, "auto") != 0 ? word : "";
  *sum = corot_checksum(*sum, given, strlen(given) + 1);
}

uint64_t corot_integrator_sum_of(const corot_integrator_def *d) {
  uint64_t sum = COROT_CHECKSUM;
  const corot_linear_def *l = &d->linear;
  const char *const word[] = {d->method,   d->table,  l->solver,
                              l->ordering, l->factor, l->preconditioner};
  const double number[] = {
      d->rtol,       d->atol_displacement, d->atol_velocity,     d->max_order,       d->order,
      d->predictor,  d->first_step,        d->min_step,          d->max_step,        d->tangent,
      d->reassembly, d->refactorisation,   d->gamma_change,      d->convergence,     d->step,
      d->solution,   d->newton_tolerance,  d->newton_iterations, d->spectral_radius, l->tolerance,
      l->role,       l->refinement != NULL};
  for (size_t k = 0; k < sizeof word / sizeof *word; k++) add_word(&sum, word[k]);
  return corot_checksum(sum, number, sizeof number);
}

/* What was chosen, which may depend on what the inputs were when the integrator was made. */
static void exchange_choices(pack *p, corot_integrator_def *d) {
  int tangent = d->tangent;
  int *const whole[] = {&d->max_order, &d->order,      &d->predictor,
                        &tangent,      &d->reassembly, &d->refactorisation};
  double *const number[] = {&d->atol_displacement, &d->atol_velocity, &d->gamma_change,
                            &d->convergence};
  for (size_t k = 0; k < sizeof whole / sizeof *whole; k++) corot_pack_int(p, whole[k]);
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) corot_pack_double(p, number[k]);
  d->tangent = (corot_tangent)tangent;
}

/* The method's counts so far. */
static void exchange_counts(pack *p, corot_integrator *self) {
  corot_statistics s = corot_integrator_statistics(self), *c = &self->carried;
  long *const from[] = {&s.nfe, &s.nsetups, &s.netf, &s.nni, &s.ncfn, &s.nfeQ, &s.nrestart};
  long *const to[] = {&c->nfe, &c->nsetups, &c->netf, &c->nni, &c->ncfn, &c->nfeQ, &c->nrestart};
  for (size_t k = 0; k < sizeof from / sizeof *from; k++) {
    corot_pack_long(p, from[k]);
    if (p->reading) *to[k] = *from[k];
  }
}

static void exchange_books(pack *p, corot_integrator *self) {
  double *const number[] = {&self->t,      &self->hlast, &self->force_s,      &self->work_s,
                            &self->step_s, &self->given, &self->given_before, &self->t_given};
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) corot_pack_double(p, number[k]);
  corot_pack_int(p, &self->qlast);
  corot_pack_long(p, &self->nst);
}

/* All but the method's own; u and v [n] are where the body is. */
static void exchange(pack *p, corot_integrator *self, double *u, double *v) {
  size_t n = corot_model_ndof(self->model);
  corot_state_exchange(p, self->state);
  corot_pack_same(p, self->clock != NULL, "the number of frame clocks");
  if (self->clock) corot_frame_clock_exchange(p, self->clock);
  exchange_choices(p, &self->def);
  exchange_counts(p, self);
  exchange_books(p, self);
  if (self->pencil) corot_pencil_exchange(p, self->pencil);
  corot_pack_doubles(p, u, n);
  corot_pack_doubles(p, v, n);
}

/* --- A new beginning ------------------------------------------------------------------------- */

/* A new method in the place of the old one, which is in *old until the caller has no more use for
   it. After a failure it is back. */
static corot_status begin(corot_integrator *self, const double *u, const double *v, pack *p,
                          void **old) {
  *old = self->method;
  self->method = NULL;
  self->before = self->t;
  self->def.table = self->table;
  corot_status status = self->ops->create(self, u, v);
  self->def.table = NULL;
  if (!status) {
    self->ops->exchange(self, p);
    status = corot_pack_status(p);
  }
  if (!status && corot_pack_left(p) > 0)
    status = corot_fail(COROT_EINVAL, "the state is another one: %zu bytes are left of it",
                        corot_pack_left(p));
  if (!status) return COROT_OK;
  if (self->method) self->ops->destroy(self->method);
  self->method = *old;
  return status;
}

/* After a failure the caller puts back what `exchange` has changed. */
static corot_status take_in(corot_integrator *self, pack *p, double *u, double *v) {
  void *old;
  exchange(p, self, u, v);
  COROT_TRY(corot_pack_status(p));
  COROT_TRY(begin(self, u, v, p, &old));
  self->ops->destroy(old);
  if (self->pencil) {
    corot_pencil_forget(self->pencil);
    corot_pencil_use(self->pencil, self->def.tangent);
  }
  self->t_energies = NAN;
  corot_materials_settle(self->state);
  self->seen = corot_state_stamp(self->state);
  return COROT_OK;
}

/* Puts another state in the place of the present one, which stands in `present` as `exchange` has
   written it, and to which it returns after a failure. u and v [n] are room. */
static corot_status replace(corot_integrator *self, pack *p, pack present, double *u, double *v) {
  double before = self->before, t_energies = self->t_energies;
  corot_energies energies = self->energies;
  corot_statistics carried = self->carried;
  corot_status status = take_in(self, p, u, v);
  if (!status) return COROT_OK;
  exchange(&present, self, u, v);
  self->before = before, self->t_energies = t_energies, self->energies = energies;
  self->carried = carried;
  self->seen = corot_state_stamp(self->state);
  return status;
}

/* --- Blobs ----------------------------------------------------------------------------------- */

static uint64_t identity_of(corot_integrator *self) {
  if (self->identity == 0) self->identity = corot_model_identity(self->model);
  return self->identity;
}

static corot_status check_blob(corot_integrator *self, const void *blob, size_t bytes) {
  header h;
  if (bytes < HEADER)
    return corot_fail(COROT_EINVAL, "a state of %zu bytes is cut short: its header has %d", bytes,
                      HEADER);
  memcpy(&h, blob, sizeof h);
  if (memcmp(h.magic, magic, sizeof magic) != 0)
    return corot_fail(COROT_EINVAL, "this is no state of corot");
  if (h.order != COROT_BYTE_ORDER)
    return corot_fail(COROT_EINVAL, "the state is of a machine of another byte order, or damaged");
  if (h.format != FORMAT)
    return corot_fail(COROT_EINVAL, "the state is of format %llu, this library reads format %llu",
                      (unsigned long long)h.format, (unsigned long long)FORMAT);
  if (h.bytes != bytes - HEADER)
    return corot_fail(COROT_EINVAL, "the state has %zu bytes where %llu belong: it is cut short",
                      bytes - HEADER, (unsigned long long)h.bytes);
  if (h.checksum != corot_checksum(COROT_CHECKSUM, (const char *)blob + HEADER, bytes - HEADER))
    return corot_fail(COROT_EINVAL, "the state is damaged: its checksum is another");
  if (h.model != identity_of(self))
    return corot_fail(COROT_EINVAL,
                      "the state is of another model: its mesh, materials, supports, "
                      "or loads differ");
  if (h.definition != self->asked)
    return corot_fail(COROT_EINVAL, "the state is of an integrator of another definition");
  return COROT_OK;
}

/* Writes the header into its place at the beginning. */
static void finish(corot_integrator *self, pack *p) {
  header h = {.order = COROT_BYTE_ORDER,
              .format = FORMAT,
              .bytes = p->bytes - HEADER,
              .checksum = corot_checksum(COROT_CHECKSUM, p->data + HEADER, p->bytes - HEADER),
              .model = identity_of(self),
              .definition = self->asked};
  memcpy(h.magic, magic, sizeof magic);
  memcpy(p->data, &h, sizeof h);
}

static bool same_stamp(const state_stamp *a, const state_stamp *b) {
  return a->inputs == b->inputs && a->moves == b->moves && a->feedback == b->feedback &&
         a->frames == b->frames && a->loads == b->loads && a->paths == b->paths &&
         a->matrices == b->matrices;
}

/* *p = the whole blob; u and v [n] are room. */
static corot_status write_blob(corot_integrator *self, double *u, double *v, pack *p) {
  char room[HEADER] = {0};
  if (self->ops->settle) COROT_TRY(self->ops->settle(self));
  COROT_TRY(self->ops->at(self, self->t, u, v));
  corot_pack_bytes(p, room, sizeof room);
  exchange(p, self, u, v);
  self->ops->exchange(self, p);
  COROT_TRY(corot_pack_status(p));
  finish(self, p);
  return COROT_OK;
}

static corot_status save(corot_integrator *self, double *u, double *v, pack *p) {
  COROT_TRY(write_blob(self, u, v, p));
  pack again = corot_pack_reader(p->data + HEADER, p->bytes - HEADER);
  return replace(self, &again, again, u, v);
}

static corot_status restore(corot_integrator *self, pack *p, double *u, double *v) {
  pack written = {0};
  exchange(&written, self, u, v);
  corot_status status = corot_pack_status(&written);
  if (!status) status = replace(self, p, corot_pack_reader(written.data, written.bytes), u, v);
  corot_pack_clear(&written);
  return status;
}

corot_status corot_integrator_save(corot_integrator *self, void **blob, size_t *bytes) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  COROT_TRY(COROT_GIVEN(blob));
  COROT_TRY(COROT_GIVEN(bytes));
  state_stamp now = corot_state_stamp(self->state);
  if (!same_stamp(&now, &self->seen))
    return corot_fail(COROT_EINVAL,
                      "corot_integrator_save: frames or inputs have changed, and the "
                      "integrator was not told (corot_integrator_changed)");
  size_t n = corot_model_ndof(self->model);
  double *u = malloc(2 * n * sizeof *u);
  if (!u) return corot_fail(COROT_ENOMEM, "no memory for a state of %zu unknowns", n);
  pack p = {0};
  corot_status status = save(self, u, u + n, &p);
  free(u);
  if (status) {
    corot_pack_clear(&p);
    return status;
  }
  *blob = p.data;
  *bytes = p.bytes;
  return COROT_OK;
}

corot_status corot_integrator_restore(corot_integrator *self, const void *blob, size_t bytes) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  COROT_TRY(COROT_GIVEN(blob));
  COROT_TRY(check_blob(self, blob, bytes));
  size_t n = corot_model_ndof(self->model);
  double *u = calloc(2 * n, sizeof *u);
  if (!u) return corot_fail(COROT_ENOMEM, "no memory for a state of %zu unknowns", n);
  pack p = corot_pack_reader((const char *)blob + HEADER, bytes - HEADER);
  corot_status status = restore(self, &p, u, u + n);
  free(u);
  return status;
}

void corot_blob_free(void *blob) { free(blob); }
