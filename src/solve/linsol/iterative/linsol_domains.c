/* Recursive bisection of the graph of the nodes. */
#include "linsol_domains.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A domain has at least so many nodes: with fewer, more of them stand between domains, and threads
   wait longer for each other than a sweep takes. */
enum { LEAST_NODES = 1000 };

enum { BETWEEN = -1 };

typedef struct bisection {
  const node_graph *g;
  int *part;  /* [n] the part that a node is in, or BETWEEN */
  int *seen;  /* [n] mark of the last search that met a node */
  int *queue; /* [n] */
  int mark;
} bisection;

/* Searches part `part` from a node on: the queue is filled from `filled` on. Returns its end. */
static int search(bisection *b, int part, int from, int filled) {
  const node_graph *g = b->g;
  b->queue[filled] = from, b->seen[from] = b->mark;
  int end = filled + 1;
  for (int k = filled; k < end; k++)
    for (int p = g->colptr[b->queue[k]]; p < g->colptr[b->queue[k] + 1]; p++) {
      int i = g->row[p];
      if (b->part[i] != part || b->seen[i] == b->mark) continue;
      b->seen[i] = b->mark;
      b->queue[end++] = i;
    }
  return end;
}

/* All nodes of a part in the order of a search that begins at an end of it, piece by piece where it
   has several. Returns how many. */
static int search_all(bisection *b, int part) {
  int filled = 0;
  b->mark++;
  for (int i = 0; i < b->g->n; i++) {
    if (b->part[i] != part || b->seen[i] == b->mark) continue;
    int end = search(b, part, i, filled), last = b->queue[end - 1];
    /* once more, from what was farthest away */
    for (int k = filled; k < end; k++) b->seen[b->queue[k]] = b->mark - 1;
    filled = search(b, part, last, filled);
  }
  return filled;
}

/* The second half becomes part `other`, but for its nodes that touch the first: these are between.
 */
static void bisect(bisection *b, int part, int other) {
  const node_graph *g = b->g;
  int n = search_all(b, part);
  for (int k = n / 2; k < n; k++) b->part[b->queue[k]] = other;
  for (int k = n / 2; k < n; k++) {
    int i = b->queue[k];
    bool touches = false;
    for (int p = g->colptr[i]; p < g->colptr[i + 1] && !touches; p++)
      touches = b->part[g->row[p]] == part;
    if (touches) b->part[i] = BETWEEN;
  }
}

static void sort_parts(const bisection *b, int n, int *order, domains *d) {
  int at = 0;
  d->n = n;
  for (int k = 0; k <= n; k++) {
    d->first[k] = at;
    for (int i = 0; i < b->g->n; i++)
      if (b->part[i] == (k < n ? k : BETWEEN)) order[at++] = i;
  }
}

corot_status corot_domains_find(node_graph *g, int *order, domains *d) {
  bisection b = {.g = g};
  int n = 1;
  b.part = calloc((size_t)g->n + 1, sizeof *b.part);
  b.seen = calloc((size_t)g->n + 1, sizeof *b.seen);
  b.queue = malloc(((size_t)g->n + 1) * sizeof *b.queue);
  bool room = b.part && b.seen && b.queue;
  for (; room && n < MOST_DOMAINS && g->n / (2 * n) >= LEAST_NODES; n *= 2)
    for (int k = 0; k < n; k++) bisect(&b, k, n + k);
  if (room) sort_parts(&b, n, order, d);
  free(b.part), free(b.seen), free(b.queue);
  return room ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for domains of %d nodes", g->n);
}
