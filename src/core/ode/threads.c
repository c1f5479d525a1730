/* Who shares out the evaluations of a state. */
#include <corot/ode.h>

#include "core/base/processors.h"
#include "state.h"

_Static_assert((int)TEAM_MOST == COROT_MOST_THREADS, "the header says how many");

/* A thread pays from so many points of integration on (corot-bench threads): with fewer it takes
   longer to wake it than it saves. */
enum { POINTS_A_THREAD = 4000 };

int corot_processors(void) { return corot_processor_count(); }

int corot_model_threads(const corot_model *m) {
  const element_set *t = &solid_of(m)->elements;
  int n = points_of(t) * W / POINTS_A_THREAD, most = corot_processor_count();
  if (n > most) n = most;
  if (n > TEAM_MOST) n = TEAM_MOST;
  return n < 1 ? 1 : n;
}

/* The state gets the team, NULL being none; that before it goes. */
static corot_status take(corot_state *s, team *by) {
  size_t before = corot_system_state_bytes(&s->model->system, &s->system);
  team *leaving = s->system.team;
  corot_status status = corot_system_state_share(&s->model->system, by, &s->system);
  corot_team_destroy(status ? by : leaving);
  if (!status) s->bytes += corot_system_state_bytes(&s->model->system, &s->system) - before;
  return status;
}

static corot_status share_among(corot_state *s, int n) {
  team *by = NULL;
  if (n > 1) COROT_TRY(corot_team_create(n, &by));
  return take(s, by);
}

corot_status corot_state_threads(corot_state *s, int n) {
  COROT_TRY(COROT_GIVEN_AS(s, "state"));
  if (n < 0 || n > COROT_MOST_THREADS)
    return corot_fail(COROT_EINVAL, "threads: %d is not from 0 to %d", n, COROT_MOST_THREADS);
  if (n > 0) return share_among(s, n);
  corot_status status = COROT_ENOMEM;
  for (n = corot_model_threads(s->model); n > 1 && status == COROT_ENOMEM; n /= 2)
    status = share_among(s, n);
  return status == COROT_ENOMEM ? share_among(s, 1) : status;
}

corot_status corot_state_parallel(corot_state *s, int n, corot_parallel_for *run, void *host) {
  team *by = NULL;
  COROT_TRY(COROT_GIVEN_AS(s, "state"));
  COROT_TRY(COROT_GIVEN(run));
  COROT_TRY(corot_team_of_host(n, run, host, &by));
  return take(s, by);
}

int corot_state_thread_count(const corot_state *s) { return corot_team_size(s->system.team); }
