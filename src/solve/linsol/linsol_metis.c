/* METIS_NodeND takes SIGTERM for itself while it works, and leaves by a jump out of whatever it is
   in, malloc among it: a request to end corrupts the heap. So this calls METIS_NodeNDP, which finds
   the same order and lets signals alone. That one raises SIGABRT where memory ends (from its own
   wrapper of malloc, with nothing held), which is caught here. What it had allocated by then is
   lost. */
#include "linsol_metis.h"

#include <metis.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdlib.h>

_Static_assert(sizeof(idx_t) == sizeof(int), "METIS with indices of 32 bits is needed");

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;
static struct sigaction before;
static _Thread_local sigjmp_buf *out; /* of METIS, in the thread that is in it */

static void on_abort(int number) {
  if (out) siglongjmp(*out, 1);
  sigaction(number, &before, NULL);
  raise(number);
}

static int dissect(const node_graph *g, int *order, int *place) {
  struct sigaction action = {.sa_handler = on_abort};
  sigjmp_buf here;
  int size[1]; /* of one part: all nodes */
  volatile int result = METIS_ERROR_MEMORY;
  sigemptyset(&action.sa_mask);
  pthread_mutex_lock(&one_at_a_time);
  sigaction(SIGABRT, &action, &before);
  out = &here;
  if (sigsetjmp(here, 1) == 0)
    result = METIS_NodeNDP(g->n, g->colptr, g->row, NULL, 1, NULL, order, place, size);
  out = NULL;
  sigaction(SIGABRT, &before, NULL);
  pthread_mutex_unlock(&one_at_a_time);
  return result;
}

corot_status corot_graph_order_metis(const node_graph *g, int *order) {
  int *place = malloc(g->n * sizeof *place), result = METIS_OK;
  if (!place) return corot_fail(COROT_ENOMEM, "metis: no memory to order %d nodes", g->n);
  for (int i = 0; i < g->n; i++) order[i] = i; /* and no more where no node has a neighbour */
  if (g->colptr[g->n] > 0) result = dissect(g, order, place);
  free(place);
  if (result == METIS_OK) return COROT_OK;
  if (result == METIS_ERROR_MEMORY)
    return corot_fail(COROT_ENOMEM, "metis: no memory to order %d nodes", g->n);
  return corot_fail(COROT_EINVAL, "metis: cannot order %d nodes", g->n);
}
