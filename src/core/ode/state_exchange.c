/* A state as bytes. Frames stand as they do in memory, in the blocks of the elements: what reads
   them has the same elements in the same order. */
#include "state_exchange.h"

#include "state.h"

/* Those of all terms, of which some have no use for theirs. */
static void exchange_frames(pack *p, corot_state *s) {
  const solid_system *y = &s->model->system;
  int frames = s->system.frames;
  corot_pack_int(p, &frames);
  s->system.frames = (corot_frames)frames;
  corot_pack_double(p, &s->t_update);
  if (frames == COROT_FRAMES_EXACT) return;
  for (int k = 0; k < y->nterm; k++) {
    solid_state *of = &s->system.of[k];
    size_t npoint = points_of(&y->term[k].body.elements);
    corot_pack_bytes(p, of->R, of->R ? npoint * sizeof *of->R : 0);
    if (frames == COROT_FRAMES_EXTRAPOLATED)
      corot_pack_bytes(p, of->spin, of->spin ? npoint * sizeof *of->spin : 0);
  }
}

void corot_state_exchange(pack *p, corot_state *s) {
  exchange_frames(p, s);
  corot_pack_double(p, &s->side);
  corot_pack_bool(p, &s->still);
  corot_pack_double(p, &s->load_time);
  corot_pack_double(p, &s->load_factor);
  corot_pack_same(p, s->inputs != NULL, "the number of inputs of the state");
  if (s->inputs) corot_inputs_exchange(p, s->inputs);
  if (p->reading) s->changes++;
}
