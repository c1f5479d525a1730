/* A team of POSIX threads, which wait a moment for the next work before they sleep. */
#include "team.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A member waits so many turns, some 20 microseconds, before it sleeps: that is longer than an
   integrator takes from one evaluation to the next, and shorter than it takes to wake. */
enum { TURNS = 1000, STACK_BYTES = 1 << 20 };

typedef struct member {
  team *of;
  int number; /* from 1 */
  pthread_t thread;
} member;

struct team {
  int n, nstarted;
  pid_t process;
  team_host *run; /* a host's; then there are no members */
  void *host;
  member *member; /* [n - 1] */

  /* the work, which does not change while `left` is above zero */
  team_part *part;
  void *work;
  int nparts;
  atomic_uint round; /* goes up with each work */
  atomic_int left;   /* members that are not done yet */
  atomic_bool over;

  /* for those who sleep */
  atomic_int asleep; /* members */
  atomic_bool caller_asleep;
  pthread_mutex_t mutex;
  pthread_cond_t begun, done;
};

static inline void take_turn(void) {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

/* --- A member --- */

static void wait_for_work(team *t, unsigned before) {
  for (int k = 0; k < TURNS; k++) {
    if (atomic_load(&t->round) != before) return;
    take_turn();
  }
  pthread_mutex_lock(&t->mutex);
  atomic_fetch_add(&t->asleep, 1);
  while (atomic_load(&t->round) == before) pthread_cond_wait(&t->begun, &t->mutex);
  atomic_fetch_sub(&t->asleep, 1);
  pthread_mutex_unlock(&t->mutex);
}

/* Parts `first`, first + n, ... */
static void do_parts(const team *t, int first) {
  for (int k = first; k < t->nparts; k += t->n) t->part(t->work, k);
}

static void report(team *t) {
  if (atomic_fetch_sub(&t->left, 1) > 1 || !atomic_load(&t->caller_asleep)) return;
  pthread_mutex_lock(&t->mutex);
  pthread_cond_signal(&t->done);
  pthread_mutex_unlock(&t->mutex);
}

static void *live(void *of) {
  member *m = of;
  team *t = m->of;
  for (unsigned round = 0;; round++) {
    wait_for_work(t, round);
    if (atomic_load(&t->over)) return NULL;
    do_parts(t, m->number);
    report(t);
  }
}

/* --- The team --- */

static bool in_this_process(const team *t) { return t->process == getpid(); }

/* Signals are for the threads of the program. */
static int start(pthread_attr_t *how, member *m) {
  sigset_t all, before;
  sigfillset(&all);
  sigdelset(&all, SIGSEGV), sigdelset(&all, SIGBUS);
  sigdelset(&all, SIGFPE), sigdelset(&all, SIGILL);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  int failed = pthread_create(&m->thread, how, live, m);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return failed;
}

static corot_status start_all(team *t) {
  pthread_attr_t how;
  int failed = pthread_attr_init(&how);
  if (failed) return corot_fail(COROT_ENOMEM, "no memory for threads");
  pthread_attr_setstacksize(&how, STACK_BYTES);
  for (; t->nstarted < t->n - 1 && !failed; t->nstarted += !failed) {
    member *m = &t->member[t->nstarted];
    *m = (member){.of = t, .number = t->nstarted + 1};
    failed = start(&how, m);
  }
  pthread_attr_destroy(&how);
  if (!failed) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "thread %d of %d could not be started: %s", t->nstarted + 2, t->n,
                    strerror(failed));
}

static corot_status make(int n, team **out) {
  if (n < 1 || n > TEAM_MOST)
    return corot_fail(COROT_EINVAL, "threads: %d is not from 1 to %d", n, TEAM_MOST);
  team *t = calloc(1, sizeof *t);
  if (!t) return corot_fail(COROT_ENOMEM, "no memory for %d threads", n);
  t->n = n;
  t->process = getpid();
  pthread_mutex_init(&t->mutex, NULL);
  pthread_cond_init(&t->begun, NULL);
  pthread_cond_init(&t->done, NULL);
  *out = t;
  return COROT_OK;
}

corot_status corot_team_create(int n, team **out) {
  team *t = NULL;
  COROT_TRY(make(n, &t));
  corot_status status = COROT_OK;
  t->member = calloc(n, sizeof *t->member);
  if (!t->member)
    status = corot_fail(COROT_ENOMEM, "no memory for %d threads", n);
  else
    status = start_all(t);
  if (status) {
    corot_team_destroy(t);
    return status;
  }
  *out = t;
  return COROT_OK;
}

corot_status corot_team_of_host(int n, team_host *run, void *host, team **out) {
  COROT_TRY(make(n, out));
  (*out)->run = run;
  (*out)->host = host;
  return COROT_OK;
}

/* Begins a round: what was set before it is seen by all members. */
static void begin(team *t) {
  atomic_fetch_add(&t->round, 1);
  if (atomic_load(&t->asleep) == 0) return;
  pthread_mutex_lock(&t->mutex);
  pthread_cond_broadcast(&t->begun);
  pthread_mutex_unlock(&t->mutex);
}

void corot_team_destroy(team *t) {
  if (!t) return;
  if (in_this_process(t)) {
    atomic_store(&t->over, true);
    begin(t);
    for (int k = 0; k < t->nstarted; k++) pthread_join(t->member[k].thread, NULL);
    pthread_mutex_destroy(&t->mutex);
    pthread_cond_destroy(&t->begun);
    pthread_cond_destroy(&t->done);
  }
  free(t->member);
  free(t);
}

int corot_team_size(const team *t) { return t ? t->n : 1; }

static void wait_for_members(team *t) {
  for (int k = 0; k < TURNS; k++) {
    if (atomic_load(&t->left) == 0) return;
    take_turn();
  }
  pthread_mutex_lock(&t->mutex);
  atomic_store(&t->caller_asleep, true);
  while (atomic_load(&t->left) > 0) pthread_cond_wait(&t->done, &t->mutex);
  atomic_store(&t->caller_asleep, false);
  pthread_mutex_unlock(&t->mutex);
}

void corot_team_run(team *t, int nparts, team_part *part, void *work) {
  if (t && t->run && t->n > 1 && nparts > 1) {
    t->run(t->host, nparts, part, work);
    return;
  }
  if (!t || t->n == 1 || nparts < 2 || !in_this_process(t)) {
    for (int k = 0; k < nparts; k++) part(work, k);
    return;
  }
  t->part = part;
  t->work = work;
  t->nparts = nparts;
  atomic_store(&t->left, t->n - 1);
  begin(t);
  do_parts(t, 0);
  wait_for_members(t);
}

typedef struct shared_loop {
  team_loop *loop;
  void *work;
  int count, nparts;
} shared_loop;

static void loop_part(void *of, int k) {
  const shared_loop *l = of;
  l->loop(l->work, team_share(l->count, l->nparts, k), team_share(l->count, l->nparts, k + 1));
}

void corot_team_loop(team *t, int count, team_loop *loop, void *work) {
  shared_loop l = {loop, work, count, corot_team_size(t)};
  if (count > 0) corot_team_run(t, l.nparts, loop_part, &l);
}
