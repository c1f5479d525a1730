/* One line, written over itself, where standard error is a terminal. */
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

#include "run_clock.h"

progress progress_start(bool wanted, double end) {
  double now = wall_clock();
  bool on = wanted && isatty(STDERR_FILENO);
  return (progress){.on = on, .end = end, .started = now, .shown = now};
}

void progress_show(progress *p, const corot_step *step) {
  if (!p->on) return;
  double now = wall_clock();
  if (now - p->shown < 0.2) return;
  p->shown = now;
  double done = step->t / p->end;
  double left = (now - p->started) * (p->end - step->t) / (step->t - p->from);
  fprintf(stderr, "\r\033[Kt = %.4g of %.4g s  h = %.2e s  order %d  %3.0f %%  %.0f s left",
          step->t, p->end, step->h, step->order, 100 * done, left);
  fflush(stderr);
}

void progress_clear(progress *p) {
  if (!p->on) return;
  fputs("\r\033[K", stderr);
  fflush(stderr);
}
