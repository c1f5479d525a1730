/* The nodes on edges in a draft: of one order with the tets, and on the edges where they should be.

   Writers disagree about the order in which a tet lists them. Geometry tells: where each of the six
   is nearest to the middle of another edge, these edges are the order of the file. A node that is
   only far from its middle, on an edge that is strongly curved, does not give such a permutation.
 */
#include <string.h>

#include "mesh_draft.h"

void corot_draft_check_orders(corot_draft *d) {
  static const char *const name[4][2] = {
      {"", ""}, {"2-node line", "3-node line"}, {"3-node triangle", "6-node triangle"}, {"", ""}};
  for (size_t i = 0; i < d->nmember && d->order; i++) {
    const corot_draft_element *e = &d->element[d->member[i].element];
    int order = e->middle ? 2 : 1;
    if (e->dim == 0 || e->kind || order == d->order) continue;
    if (e->dim == 2 && order == 1 && d->raises) continue;
    corot_draft_note(
        d, d->element_file, e->at,
        "element %lld of a physical group is a %s, but the tets have %d nodes: orders do not mix",
        (long long)e->tag, name[e->dim][order - 1], d->order == 2 ? 10 : 4);
  }
}

/* The square of the distance of node m from the middle of edge k. */
static double distance(const corot_draft *d, const corot_draft_element *e, int m, int k) {
  const double *a = d->x[e->node[corot_tet_edge[k][0]]], *b = d->x[e->node[corot_tet_edge[k][1]]];
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    double off = d->x[m][i] - (a[i] + b[i]) / 2;
    sum += off * off;
  }
  return sum;
}

/* edge[k] = the edge to whose middle node k of the six is nearest, k itself in a tie. The value is
   whether each edge is there once. */
static bool nearest_edges(const corot_draft *d, const corot_draft_element *e, int edge[6]) {
  int seen = 0;
  for (int k = 0; k < 6; k++) {
    int m = d->middle[e->middle - 1 + k];
    edge[k] = k;
    for (int j = 0; j < 6; j++)
      if (distance(d, e, m, j) < distance(d, e, m, edge[k])) edge[k] = j;
    seen |= 1 << edge[k];
  }
  return seen == 63;
}

void corot_draft_check_middles(corot_draft *d) {
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    int edge[6], k = 0;
    if (e->dim != 3 || corot_draft_is_broken(d, e) || !nearest_edges(d, e, edge)) continue;
    while (k < 6 && edge[k] == k) k++;
    if (k == 6) continue;
    const int *is = corot_tet_edge[edge[k]], *should = corot_tet_edge[k];
    corot_draft_note(
        d, d->element_file, e->at,
        "element %lld: node %lld is on the edge %lld %lld, in the place of the node on %lld %lld: "
        "the order of its nodes is not known",
        (long long)e->tag, (long long)d->node[d->middle[e->middle - 1 + k]].tag,
        (long long)d->node[e->node[is[0]]].tag, (long long)d->node[e->node[is[1]]].tag,
        (long long)d->node[e->node[should[0]]].tag, (long long)d->node[e->node[should[1]]].tag);
  }
}

corot_status corot_draft_order_middles(corot_draft *d) {
  int first[6], edge[6], sorted[6];
  bool any = false;
  for (size_t i = 0; i < d->nelement; i++) {
    const corot_draft_element *e = &d->element[i];
    if (e->dim != 3 || corot_draft_is_broken(d, e)) continue;
    if (!nearest_edges(d, e, edge))
      return corot_reader_fail(d->element_file, e->at,
                               "element %lld: its last six nodes are not on an edge each",
                               (long long)e->tag);
    if (!any) memcpy(first, edge, sizeof first);
    any = true;
    if (memcmp(first, edge, sizeof first) != 0)
      return corot_reader_fail(d->element_file, e->at,
                               "element %lld has the nodes on its edges in another order than the "
                               "first one",
                               (long long)e->tag);
    int *middle = d->middle + e->middle - 1;
    for (int k = 0; k < 6; k++) sorted[edge[k]] = middle[k];
    memcpy(middle, sorted, sizeof sorted);
  }
  return COROT_OK;
}
