/* Frames at equal distances, the first and the last always. */
#include "field_frames.h"

#include <math.h>
#include <stdio.h>

#include "app/folder/write_vtu.h"

/* As the schedule has them: every output_step, and the end. */
static long count_times(const scenario *s) {
  double n = ceil(s->t_end / s->output_step * (1 - 1e-12));
  return 1 + (long)fmin(1e15, fmax(1, n));
}

/* So many of n as make at most FIELDS_MOST, but two at least. */
static int thin(long n, double bytes) {
  double most = fmax(2, floor(FIELDS_MOST / bytes));
  if ((double)n <= most) return 1;
  return (int)fmin(1e9, ceil((double)(n - 1) / (most - 1)));
}

field_frames field_frames_of(const scenario *s, const corot_mesh *mesh) {
  if (!s->write_fields) return (field_frames){.every = 1};
  field_frames f = {.ntime = count_times(s), .bytes = (double)vtu_bytes(mesh)};
  f.every = s->field_every > 0 ? s->field_every : thin(f.ntime, f.bytes);
  f.thinned = s->field_every == 0 && f.every > 1;
  f.n = 1 + (f.ntime - 1 + f.every - 1) / f.every;
  return f;
}

static const char *ending(int n) {
  if (n / 10 % 10 == 1) return "th";
  return n % 10 == 1 ? "st" : n % 10 == 2 ? "nd" : n % 10 == 3 ? "rd" : "th";
}

void field_frames_words(const field_frames *f, size_t size, char *text) {
  text[0] = '\0';
  if (!f->thinned) return;
  snprintf(text, size,
           "of every %d%s output time and the last, %ld frames of %.3g MB; output.every: 1 writes "
           "all %ld",
           f->every, ending(f->every), f->n, f->bytes / 1e6, f->ntime);
}
