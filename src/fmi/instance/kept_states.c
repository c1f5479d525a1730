/* States of an instance that the importer keeps: bytes, which it may also store and bring back in
   another process.

     magic     8 bytes, "corotFMU"
     order     8 bytes, a number that reads otherwise in another byte order
     format    8 bytes, the version of what follows
     token     64 bytes, the instantiation token: version of corot, scenario, mesh
     ...       what exchange_all() says
     checksum  8 bytes, of all before it */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "instance.h"

#define FORMAT UINT64_C(1)

static const char magic[8] = {'c', 'o', 'r', 'o', 't', 'F', 'M', 'U'};
enum { TOKEN = HASH_SIZE - 1, HEAD = 24 + TOKEN, SUM = 8 };

/* One that the importer holds. */
typedef struct kept {
  struct kept *next;
  unsigned char *data; /* [bytes] */
  size_t bytes;
} kept;

/* --- What a state consists of --- */

/* What was set, and how far the simulation is: from the instance, or to be put there. */
typedef struct settings {
  int mode;
  bool settled;
  double rtol, stop, entered, next_kink;
  corot_material *material;
  double *value;
  moment now; /* u and v [ndof] where it is settled */
} settings;

static settings settings_of(const instance *in) {
  return (settings){.mode = in->mode,
                    .settled = in->settled,
                    .rtol = in->rtol,
                    .stop = in->stop,
                    .entered = in->entered,
                    .next_kink = in->next_kink,
                    .material = in->body.material,
                    .value = in->body.value,
                    .now = in->now};
}

static void exchange_head(pack *p, const instance *in) {
  uint64_t order = COROT_BYTE_ORDER, format = FORMAT;
  char head[8], token[TOKEN];
  memcpy(head, magic, sizeof head);
  memcpy(token, in->body.hashes.run, TOKEN);
  corot_pack_bytes(p, head, sizeof head);
  corot_pack_bytes(p, &order, sizeof order);
  corot_pack_bytes(p, &format, sizeof format);
  corot_pack_bytes(p, token, TOKEN);
}

static void exchange_settings(pack *p, const instance *in, settings *s) {
  corot_pack_same(p, in->exchange, "the kind of interface");
  corot_pack_int(p, &s->mode);
  corot_pack_bool(p, &s->settled);
  corot_pack_double(p, &s->rtol);
  corot_pack_double(p, &s->stop);
  corot_pack_double(p, &s->entered);
  corot_pack_double(p, &s->next_kink);
  for (int k = 0; k < in->body.used.model.nmaterial; k++)
    for (int i = 0; i < BODY_MATERIAL; i++)
      corot_pack_double(p, body_material_at(&s->material[k], i));
  corot_pack_doubles(p, s->value, (size_t)in->body.used.ninput);
  if (!s->settled) return;
  size_t n = (size_t)corot_model_ndof(in->body.model);
  corot_pack_double(p, &s->now.t);
  corot_pack_double(p, &s->now.dissipated);
  corot_pack_double(p, &s->now.external_work);
  corot_pack_double(p, &s->now.frame_energy);
  corot_pack_double(p, &s->now.energy_at_start);
  corot_pack_doubles(p, s->now.u, n);
  corot_pack_doubles(p, s->now.v, n);
}

/* --- Get --- */

/* Outputs are found before: an integrator that begins anew has other frames, if they are held. */
static corot_status write(instance *in, pack *p) {
  exchange_head(p, in);
  settings s = settings_of(in);
  exchange_settings(p, in, &s);
  if (in->settled && in->stepping) COROT_TRY(stepping_exchange(in->stepping, p, &in->now));
  uint64_t sum = corot_checksum(COROT_CHECKSUM, p->data, p->bytes);
  corot_pack_bytes(p, &sum, sizeof sum);
  return corot_pack_status(p);
}

/* The place of a pointer that the importer holds; NULL: it is none of this instance's. */
static kept **find(instance *in, fmi3FMUState state) {
  for (kept **k = &in->kept; *k; k = &(*k)->next)
    if (*k == state) return k;
  return NULL;
}

static corot_status find_given(instance *in, fmi3FMUState state, kept **out) {
  kept **found = find(in, state);
  if (!found)
    return corot_fail(COROT_EINVAL,
                      "this is not a state of this instance, or it has been freed already");
  *out = *found;
  return COROT_OK;
}

/* Keeps bytes that it takes over, in the place of those that *state was. */
static corot_status keep(instance *in, unsigned char *data, size_t bytes, fmi3FMUState *state) {
  kept *k = NULL;
  if (*state) {
    k = *find(in, *state);
    free(k->data);
  } else {
    k = calloc(1, sizeof *k);
    if (!k) {
      free(data);
      return no_memory();
    }
    k->next = in->kept;
    in->kept = k;
  }
  k->data = data;
  k->bytes = bytes;
  *state = k;
  return COROT_OK;
}

static corot_status check_place(instance *in, const fmi3FMUState *state) {
  kept *k = NULL;
  COROT_TRY(instance_given(state, "FMUState"));
  return *state ? find_given(in, *state, &k) : COROT_OK;
}

static corot_status get(instance *in, fmi3FMUState *state) {
  COROT_TRY(check_place(in, state));
  pack p = {0};
  corot_status status = write(in, &p);
  if (status) {
    corot_pack_clear(&p);
    return status;
  }
  return keep(in, p.data, p.bytes, state);
}

enum { SAVED = INSTANTIATED | INITIALIZATION | STEP | EVENT | CONTINUOUS };

fmi3Status fmi3GetFMUState(fmi3Instance instance_, fmi3FMUState *state) {
  FMI3_CALL(instance_, SAVED, get(in, state));
}

/* --- Set --- */

static bool is_as_set(const instance *in, const settings *s) {
  const body *b = &in->body;
  size_t nmaterial = (size_t)b->used.model.nmaterial;
  return in->settled && in->rtol == s->rtol && in->stop == s->stop &&
         memcmp(b->material, s->material, nmaterial * sizeof *b->material) == 0;
}

/* Puts what was set in place. What is there is of the same materials and experiment, or it is made
   anew for them. */
static corot_status prepare(instance *in, const settings *s) {
  body *b = &in->body;
  size_t nmaterial = (size_t)b->used.model.nmaterial;
  memcpy(b->value, s->value, (size_t)b->used.ninput * sizeof *b->value);
  if (s->settled && is_as_set(in, s)) return COROT_OK;
  instance_unsettle(in);
  if (memcmp(b->material, s->material, nmaterial * sizeof *b->material) != 0) b->built = false;
  memcpy(b->material, s->material, nmaterial * sizeof *b->material);
  in->rtol = s->rtol;
  in->stop = s->stop;
  return s->settled ? instance_settle(in) : COROT_OK;
}

static void take_moment(instance *in, const moment *from) {
  moment to = *from;
  size_t n = (size_t)corot_model_ndof(in->body.model);
  to.u = in->now.u, to.v = in->now.v;
  memcpy(to.u, from->u, n * sizeof *to.u);
  memcpy(to.v, from->v, n * sizeof *to.v);
  in->now = to;
}

/* The simulation as the state has it. */
static corot_status take(instance *in, pack *p, const settings *s) {
  COROT_TRY(prepare(in, s));
  if (s->settled && in->stepping) COROT_TRY(stepping_exchange(in->stepping, p, &in->now));
  if (s->settled) take_moment(in, &s->now);
  if (s->settled && in->exchange) {
    for (int i = 0; i < in->body.used.ninput; i++) COROT_TRY(instance_apply_input(in, i));
    corot_state_enter(in->state, s->entered);
    in->entered = s->entered;
    in->next_kink = s->next_kink;
  }
  in->seen = false;
  in->mode = (mode)s->mode;
  return COROT_OK;
}

/* Where it fails, the values are those of before; a simulation that was given up for another one
   has failed. */
static corot_status take_or_leave(instance *in, pack *p, const settings *s, double *before) {
  size_t ninput = (size_t)in->body.used.ninput;
  bool fits = s->settled && is_as_set(in, s);
  memcpy(before, in->body.value, ninput * sizeof *before);
  corot_status status = take(in, p, s);
  if (!status) return COROT_OK;
  if (fits)
    memcpy(in->body.value, before, ninput * sizeof *before);
  else
    in->mode = FAILED;
  return status;
}

static corot_status set_bytes(instance *in, const unsigned char *data, size_t bytes) {
  const body *b = &in->body;
  size_t n = (size_t)corot_model_ndof(b->model), ninput = (size_t)b->used.ninput;
  size_t nmaterial = (size_t)b->used.model.nmaterial;
  settings s = {0};
  double *room = calloc(2 * n + 2 * ninput + 1, sizeof *room);
  s.material = calloc(nmaterial + 1, sizeof *s.material);
  corot_status status = room && s.material ? COROT_OK : no_memory();
  if (status == COROT_OK) {
    memcpy(s.material, b->material, nmaterial * sizeof *s.material); /* for the groups */
    s.now.u = room, s.now.v = room + n, s.value = room + 2 * n;
    pack p = corot_pack_reader(data + HEAD, bytes - HEAD - SUM);
    exchange_settings(&p, in, &s);
    status = corot_pack_status(&p);
    if (status == COROT_OK) status = take_or_leave(in, &p, &s, s.value + ninput);
  }
  free(s.material);
  free(room);
  return status;
}

static corot_status set(instance *in, fmi3FMUState state) {
  kept *k = NULL;
  COROT_TRY(find_given(in, state, &k));
  return set_bytes(in, k->data, k->bytes);
}

fmi3Status fmi3SetFMUState(fmi3Instance instance_, fmi3FMUState state) {
  FMI3_CALL(instance_, ALIVE & ~INTERMEDIATE, set(in, state));
}

/* --- Free --- */

static corot_status forget(instance *in, fmi3FMUState *state) {
  kept *k = NULL;
  if (!state || !*state) return COROT_OK;
  COROT_TRY(find_given(in, *state, &k));
  *find(in, *state) = k->next;
  free(k->data);
  free(k);
  *state = NULL;
  return COROT_OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance_, fmi3FMUState *state) {
  FMI3_CALL(instance_, ALIVE, forget(in, state));
}

void instance_forget_states(instance *in) {
  while (in->kept) {
    fmi3FMUState first = in->kept;
    forget(in, &first);
  }
}

/* --- As bytes of the importer's --- */

static corot_status measure(instance *in, fmi3FMUState state, size_t *size) {
  kept *k = NULL;
  COROT_TRY(instance_given(size, "size"));
  COROT_TRY(find_given(in, state, &k));
  *size = k->bytes;
  return COROT_OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance_, fmi3FMUState state, size_t *size) {
  FMI3_CALL(instance_, ALIVE, measure(in, state, size));
}

static corot_status serialize(instance *in, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
  kept *k = NULL;
  COROT_TRY(instance_given(bytes, "serializedState"));
  COROT_TRY(find_given(in, state, &k));
  if (size < k->bytes)
    return corot_fail(COROT_EINVAL, "the state has %zu bytes, and there is room for %zu", k->bytes,
                      size);
  memcpy(bytes, k->data, k->bytes);
  return COROT_OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance_, fmi3FMUState state, fmi3Byte bytes[],
                                 size_t size) {
  FMI3_CALL(instance_, ALIVE, serialize(in, state, bytes, size));
}

/* Whether the bytes are whole, and of this FMU. */
static corot_status check_bytes(const instance *in, const fmi3Byte *bytes, size_t size) {
  uint64_t sum, order, format;
  if (size < HEAD + SUM || memcmp(bytes, magic, sizeof magic) != 0)
    return corot_fail(COROT_EINVAL, "these %zu bytes are not a state of a corot FMU", size);
  memcpy(&order, bytes + 8, sizeof order);
  memcpy(&format, bytes + 16, sizeof format);
  if (order != COROT_BYTE_ORDER || format != FORMAT)
    return corot_fail(COROT_EINVAL,
                      "the state is of another version of corot, or of another kind of machine");
  memcpy(&sum, bytes + size - SUM, sizeof sum);
  if (sum != corot_checksum(COROT_CHECKSUM, bytes, size - SUM))
    return corot_fail(COROT_EINVAL, "the state is cut short or damaged");
  if (memcmp(bytes + 24, in->body.hashes.run, TOKEN) != 0)
    return corot_fail(COROT_EINVAL, "the state is one of another FMU");
  return COROT_OK;
}

static corot_status deserialize(instance *in, const fmi3Byte bytes[], size_t size,
                                fmi3FMUState *state) {
  COROT_TRY(check_place(in, state));
  COROT_TRY(instance_given(bytes, "serializedState"));
  COROT_TRY(check_bytes(in, bytes, size));
  unsigned char *copy = malloc(size);
  if (!copy) return no_memory();
  memcpy(copy, bytes, size);
  return keep(in, copy, size, state);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance_, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state) {
  FMI3_CALL(instance_, ALIVE, deserialize(in, bytes, size, state));
}
