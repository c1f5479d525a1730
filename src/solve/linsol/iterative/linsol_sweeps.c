/* Products and sweeps by blocks, domain by domain; vectors of nodes have a fourth component that is
   zero. Down from the last node to the first, the nodes between domains come first, up they come
   last. */
#include <string.h>

#include "linsol_blocks.h"
#include "linsol_nodes.h"

/* What a loop works on: x to y, by way of the rows of A->work. */
typedef struct sweep {
  node_matrix *A;
  const double *x;
  double *y;
  double sign; /* of what is gathered */
} sweep;

COROT_INLINE double (*lower_work(const node_matrix *A))[4] { return A->work; }
COROT_INLINE double (*upper_work(const node_matrix *A))[4] { return A->work + A->n; }

COROT_INLINE block_column column(const node_matrix *A, int j) {
  return block_column_of(A->n, A->colptr, A->row, A->value, j);
}

/* Of a column, the rows that its sums go to at once: all, but for those between domains. */
COROT_INLINE block_column inner_column(const node_matrix *A, int j) {
  block_column c = column(A, j);
  if (A->inner && j < A->parts.first[A->parts.n]) c.end = A->row + A->inner[j];
  return c;
}

COROT_INLINE void output(double *y, vd4 a) { y[0] = a[0], y[1] = a[1], y[2] = a[2]; }

/* --- Who does what ---------------------------------------------------------------------------- */

typedef void sweep_nodes(const sweep *s, int from, int end);

typedef struct shared_sweep {
  const sweep *s;
  sweep_nodes *of;
  int first;
} shared_sweep;

static void domain_part(void *work, int k) {
  const shared_sweep *p = work;
  const int *first = p->s->A->parts.first;
  p->of(p->s, first[k], first[k + 1]);
}

static void each_domain(const sweep *s, sweep_nodes *of) {
  shared_sweep p = {.s = s, .of = of};
  corot_team_run(s->A->team, s->A->parts.n, domain_part, &p);
}

static void node_part(void *work, int from, int end) {
  const shared_sweep *p = work;
  p->of(p->s, p->first + from, p->first + end);
}

/* Nodes that need nothing of each other. */
static void each_node(const sweep *s, int first, sweep_nodes *of) {
  shared_sweep p = {s, of, first};
  corot_team_loop(s->A->team, s->A->n - first, node_part, &p);
}

static int first_between(const sweep *s) { return s->A->parts.first[s->A->parts.n]; }

static void between(const sweep *s, sweep_nodes *of) { of(s, first_between(s), s->A->n); }

/* --- Loops ------------------------------------------------------------------------------------ */

/* To the rows between domains: the upper work += sign times the blocks left of them times what `in`
   has on the domains. */
COROT_INLINE void gather(const sweep *s, const double (*in)[4], int from, int end) {
  const node_matrix *A = s->A;
  const double *L = A->value + 9 * (size_t)A->n;
  int first = first_between(s);
  double(*w)[4] = upper_work(A);
  for (int i = from; i < end; i++) {
    vd4 sum = {0};
    for (int k = A->left_first[i - first]; k < A->left_first[i - first + 1]; k++) {
      const double *x = in[A->left_node[k]];
      sum += block_times(L + 9 * (size_t)A->left[k], vd4_padded(x));
    }
    vd4_store(w[i], vd4_load(w[i]) + s->sign * sum);
  }
}

static COROT_CLONES void gather_upper(const sweep *s, int from, int end) {
  gather(s, (const double(*)[4])upper_work(s->A), from, end);
}

static COROT_CLONES void gather_lower(const sweep *s, int from, int end) {
  gather(s, (const double(*)[4])lower_work(s->A), from, end);
}

/* Of a product: x into the lower work, D x into the upper. */
static COROT_CLONES void begin_product(const sweep *s, int from, int end) {
  const node_matrix *A = s->A;
  for (int i = from; i < end; i++) {
    vd4 xi = vd4_padded(s->x + 3 * i);
    vd4_store(lower_work(A)[i], xi);
    vd4_store(upper_work(A)[i], block_times(&A->value[9 * i], xi));
  }
}

static COROT_CLONES void add_product(const sweep *s, int from, int end) {
  const node_matrix *A = s->A;
  double(*in)[4] = lower_work(A), (*out)[4] = upper_work(A);
  for (int j = from; j < end; j++) {
    vd4 above = column_product(column(A, j), (const double(*)[4])in);
    output(s->y + 3 * j, vd4_load(out[j]) + above);
    add_column(inner_column(A, j), vd4_padded(s->x + 3 * j), out);
  }
}

void corot_nodes_multiply(node_matrix *A, const double *x, double *y) {
  const sweep s = {A, x, y, 1};
  each_node(&s, 0, begin_product);
  each_domain(&s, add_product);
  if (A->parts.n == 1) return;
  each_node(&s, first_between(&s), gather_lower);
  between(&s, add_product);
}

/* The lower work = t, the upper what the sweep up begins with: see corot_nodes_sandwich. */
COROT_INLINE void go_down(const sweep *s, int from, int end) {
  const node_matrix *A = s->A;
  double(*t)[4] = lower_work(A), (*w)[4] = upper_work(A);
  for (int j = end - 1; j >= from; j--) {
    vd4 xj = vd4_padded(s->x + 3 * j);
    vd4 tj = xj - column_product(column(A, j), (const double(*)[4])t);
    vd4_store(t[j], tj);
    vd4_store(w[j], block_times(&A->value[9 * j], tj) - 2 * tj + xj);
  }
}

/* y = t + (I + L)^-1 w */
COROT_INLINE void go_up(const sweep *s, int from, int end) {
  const node_matrix *A = s->A;
  double(*t)[4] = lower_work(A), (*w)[4] = upper_work(A);
  for (int j = from; j < end; j++) {
    vd4 wj = vd4_padded(w[j]);
    output(s->y + 3 * j, vd4_load(t[j]) + wj);
    add_column(inner_column(A, j), -wj, w);
  }
}

static COROT_CLONES void down(const sweep *s, int from, int end) { go_down(s, from, end); }
static COROT_CLONES void up(const sweep *s, int from, int end) { go_up(s, from, end); }

static COROT_CLONES void down_and_up(const sweep *s, int from, int end) {
  go_down(s, from, end);
  go_up(s, from, end);
}

/* With D + L + L' = (I + L) + (I + L') - (2 I - D) and t = (I + L')^-1 x:
   y = t + (I + L)^-1 (x - (2 I - D) t). */
void corot_nodes_sandwich(node_matrix *A, const double *x, double *y) {
  const sweep s = {A, x, y, -1};
  if (A->parts.n > 1) between(&s, down);
  each_domain(&s, down_and_up);
  if (A->parts.n == 1) return;
  each_node(&s, first_between(&s), gather_upper);
  between(&s, up);
}

static COROT_CLONES void begin_forward(const sweep *s, int from, int end) {
  for (int j = from; j < end; j++) vd4_store(upper_work(s->A)[j], vd4_padded(s->x + 3 * j));
}

static COROT_CLONES void forward(const sweep *s, int from, int end) {
  double(*w)[4] = upper_work(s->A);
  for (int j = from; j < end; j++) {
    vd4 wj = vd4_padded(w[j]);
    output(s->y + 3 * j, wj);
    add_column(inner_column(s->A, j), -wj, w);
  }
}

void corot_nodes_forward(node_matrix *A, double *x) {
  const sweep s = {A, x, x, -1};
  each_node(&s, 0, begin_forward);
  each_domain(&s, forward);
  if (A->parts.n == 1) return;
  each_node(&s, first_between(&s), gather_upper);
  between(&s, forward);
}

static COROT_CLONES void backward(const sweep *s, int from, int end) {
  double(*t)[4] = lower_work(s->A);
  for (int j = end - 1; j >= from; j--) {
    vd4 xj = vd4_padded(s->x + 3 * j);
    vd4 tj = xj - column_product(column(s->A, j), (const double(*)[4])t);
    vd4_store(t[j], tj);
    output(s->y + 3 * j, tj);
  }
}

void corot_nodes_backward(node_matrix *A, double *x) {
  const sweep s = {A, x, x, -1};
  if (A->parts.n > 1) between(&s, backward);
  each_domain(&s, backward);
}
