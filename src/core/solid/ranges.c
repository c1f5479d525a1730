/* Shares chunks out, and finds what several ranges add to. The plan is for the build of the kernels
   that is in use now. */
#include "ranges.h"

#include <stdlib.h>

#include "core/lanes/widths.h"

/* Ranges of about the same number of chunks. A tet of a coarser level may be above `together`
   elements, which add to what it has: they stay in one range. */
static corot_status share_chunks(const pattern *p, int n, int together, range_plan *r) {
  int unit = together / (W * CHUNK) > 1 ? together / (W * CHUNK) : 1;
  int nunit = (p->nchunk + unit - 1) / unit;
  r->n = n < nunit ? n : nunit;
  r->chunk = malloc((r->n + 1) * sizeof *r->chunk);
  if (!r->chunk) return corot_fail(COROT_ENOMEM, "no memory for %d ranges", r->n);
  for (int k = 0; k <= r->n; k++) {
    int at = (int)((long long)nunit * k / r->n) * unit;
    r->chunk[k] = at < p->nchunk ? at : p->nchunk;
  }
  return COROT_OK;
}

/* Whose something is, beside the number of a range: as yet nobody's, or that of several. */
enum { NOBODY = -1, MANY = -2 };

static void note(int range, int *owner) {
  if (*owner == NOBODY)
    *owner = range;
  else if (*owner != range)
    *owner = MANY;
}

/* The blocks of elements of range k end before this. */
static int end_block(const element_set *t, const range_plan *r, int k) {
  int end = r->chunk[k + 1] * CHUNK;
  return end < t->nblock ? end : t->nblock;
}

/* of_node [nnode] and of_block [pattern.nblock], blocks of matrices: the range that adds to each.
 */
static void find_owners(int nnode, const element_set *t, const pattern *p, const range_plan *r,
                        int *of_node, int *of_block) {
  for (int n = 0; n < nnode; n++) of_node[n] = NOBODY;
  for (int b = 0; b < p->nblock; b++) of_block[b] = NOBODY;
  for (int k = 0; k < r->n; k++)
    for (int b = r->chunk[k] * CHUNK; b < end_block(t, r, k); b++)
      for (int l = 0; l < W; l++) {
        for (int a = 0; a < t->kind->nnode; a++) note(k, &of_node[nodes_at(t, b, a)[l]]);
        for (int i = 0; i < t->kind->npair; i++)
          note(k, &of_block[p->place[b * t->kind->npair + i][l]]);
      }
}

/* The nodes that are done with each chunk, without those of the seams; and these. */
static corot_status part_nodes(int nnode, const pattern *p, const int *owner, range_plan *r) {
  int *due = malloc((p->nchunk + 1) * sizeof *due), *turn = malloc(nnode * sizeof *turn), n = 0;
  r->due = due, r->turn = turn;
  for (int i = 0; i < nnode; i++) r->nseam += owner[i] == MANY;
  r->seam = malloc((r->nseam + 1) * sizeof *r->seam);
  if (!due || !turn || !r->seam)
    return corot_fail(COROT_ENOMEM, "no memory for the seams of %d nodes", nnode);
  for (int c = 0; c < p->nchunk; c++) {
    due[c] = n;
    for (int k = p->due[c]; k < p->due[c + 1]; k++)
      if (owner[p->turn[k]] != MANY) turn[n++] = p->turn[k];
  }
  due[p->nchunk] = n;
  for (int i = 0, k = 0; i < nnode; i++)
    if (owner[i] == MANY) r->seam[k++] = i;
  return COROT_OK;
}

/* The forces on nodes of seams: owner [nnode] of these becomes MANY - their number. */
static corot_status list_forces(const element_set *t, const pattern *p, int *owner, range_plan *r) {
  int nnode = t->kind->nnode, size = nnode * 3 * W, *next;
  r->force_first = calloc(r->nseam + 2, sizeof *r->force_first);
  r->copy_first = malloc((p->nchunk + 1) * sizeof *r->copy_first);
  if (!r->force_first || !r->copy_first)
    return corot_fail(COROT_ENOMEM, "no memory for %d nodes of seams", r->nseam);
  for (int s = 0; s < r->nseam; s++) {
    int n = r->seam[s];
    r->force_first[s + 1] = r->force_first[s] + p->first[n + 1] - p->first[n];
    owner[n] = MANY - s;
  }
  r->copy = malloc((r->force_first[r->nseam] + 1) * sizeof *r->copy);
  next = malloc((r->nseam + 1) * sizeof *next);
  if (!r->copy || !next) {
    free(next);
    return corot_fail(COROT_ENOMEM, "no memory for %d nodes of seams", r->nseam);
  }
  memcpy(next, r->force_first, (r->nseam + 1) * sizeof *next);
  for (int b = 0, n = 0; b < t->nblock; b++) {
    if (b % CHUNK == 0) r->copy_first[b / CHUNK] = n;
    for (int a = 0; a < nnode; a++) /* as the pattern lists a node's slots */
      for (int l = 0; l < t->block[b].n; l++) {
        int of = owner[nodes_at(t, b, a)[l]];
        if (of > MANY) continue;
        r->copy[n++] = (force_copy){b % p->window * size + a * 3 * W + l, next[MANY - of]++};
      }
  }
  r->copy_first[p->nchunk] = r->force_first[r->nseam];
  free(next);
  return COROT_OK;
}

/* The blocks that are shared: owner [pattern.nblock] of these becomes MANY - their number. */
static corot_status list_shared(const element_set *t, const pattern *p, int *owner, range_plan *r) {
  int npair = t->kind->npair;
  for (int k = 0; k < p->nblock; k++) r->nshared += owner[k] == MANY;
  r->shared = malloc((r->nshared + 1) * sizeof *r->shared);
  r->part_first = calloc(r->nshared + 2, sizeof *r->part_first);
  r->detour = malloc(t->nblock * sizeof *r->detour);
  if (!r->shared || !r->part_first || !r->detour)
    return corot_fail(COROT_ENOMEM, "no memory for %d blocks of seams", r->nshared);
  for (int k = 0, s = 0; k < p->nblock; k++)
    if (owner[k] == MANY) {
      r->shared[s] = k;
      owner[k] = MANY - s++;
    }
  /* count: part_first is shifted by one until parts are placed */
  for (int b = 0; b < t->nblock; b++) {
    bool any = false;
    for (int i = 0; i < npair; i++)
      for (int l = 0; l < W; l++) {
        int of = owner[p->place[b * npair + i][l]];
        if (of > MANY) continue;
        any = true;
        r->part_first[MANY - of + 2]++;
      }
    r->detour[b] = any ? r->ndetour++ : -1;
  }
  for (int s = 0; s < r->nshared; s++) r->part_first[s + 1] += r->part_first[s];
  return COROT_OK;
}

/* In the order in which one thread adds them up: by parts of blocks, pairs, and lanes. */
static corot_status place_parts(const element_set *t, const pattern *p, const int *owner,
                                range_plan *r) {
  int npair = t->kind->npair, lanes = corot_lanes_in_use();
  r->place = malloc(((size_t)r->ndetour * npair + 1) * sizeof *r->place);
  if (!r->place) return corot_fail(COROT_ENOMEM, "no memory for %d detours", r->ndetour);
  int *next = r->part_first + 1;
  for (int b = 0; b < t->nblock; b++) {
    if (r->detour[b] < 0) continue;
    for (int k = 0; k < npair * W; k++) {
      int i = k / lanes % npair, l = k / (lanes * npair) * lanes + k % lanes;
      int at = p->place[b * npair + i][l], of = owner[at];
      r->place[r->detour[b] * npair + i][l] = of > MANY ? at : -1 - next[MANY - of]++;
    }
  }
  return COROT_OK;
}

static corot_status find_seams(int nnode, const element_set *t, const pattern *p, range_plan *r) {
  int *of_node = malloc(nnode * sizeof *of_node), *of_block = malloc(p->nblock * sizeof *of_block);
  corot_status status = COROT_OK;
  if (!of_node || !of_block)
    status = corot_fail(COROT_ENOMEM, "no memory for the seams of %d nodes", nnode);
  if (!status) {
    find_owners(nnode, t, p, r, of_node, of_block);
    status = part_nodes(nnode, p, of_node, r);
  }
  if (!status) status = list_forces(t, p, of_node, r);
  if (!status) status = list_shared(t, p, of_block, r);
  if (!status) status = place_parts(t, p, of_block, r);
  free(of_node), free(of_block);
  return status;
}

/* There is one at least. */
static size_t count(const solid_ranges *r) { return r->plan.n > 1 ? (size_t)r->plan.n : 1; }

/* A buffer for all blocks serves all ranges; else each has a window of its own, the first that of
   the state. */
static corot_status make_windows(const element_set *t, const pattern *p, block_vd (*force)[3],
                                 solid_ranges *r) {
  int n = r->plan.n;
  r->force = calloc(count(r), sizeof *r->force);
  r->told = calloc(count(r), sizeof *r->told);
  if (!r->force || !r->told) return corot_fail(COROT_ENOMEM, "no memory for %d ranges", n);
  r->windowed = p->window < t->nblock;
  for (int k = 0; k < n; k++) {
    r->force[k] = force;
    if (k == 0 || !r->windowed) continue;
    r->force[k] = corot_vector_calloc((size_t)p->window * t->kind->nnode, sizeof *r->force[k]);
    if (!r->force[k]) return corot_fail(COROT_ENOMEM, "no memory for range %d of %d", k + 1, n);
  }
  return COROT_OK;
}

static corot_status make_room_aside(bool damped, solid_ranges *r) {
  size_t nforce = r->plan.force_first[r->plan.nseam] + 1;
  size_t npart = r->plan.part_first[r->plan.nshared] + 1;
  r->aside = malloc(nforce * sizeof *r->aside);
  r->aside_K = malloc(npart * sizeof *r->aside_K);
  if (damped) r->aside_D = malloc(npart * sizeof *r->aside_D);
  if (r->aside && r->aside_K && (r->aside_D || !damped)) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for the seams of %d ranges", r->plan.n);
}

static corot_status make_gathered(int nnode, solid_ranges *r) {
  r->gathered = calloc(count(r), sizeof *r->gathered);
  bool room = r->gathered != NULL;
  for (int k = 0; k < r->plan.n && room; k++)
    room = (r->gathered[k] = calloc(nnode, sizeof *r->gathered[k])) != NULL;
  return room ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for averages of %d nodes", nnode);
}

corot_status corot_ranges_create(const corot_mesh *mesh, const element_set *t, const pattern *p,
                                 int n, int together, bool damped, bool averaged,
                                 block_vd (*force)[3], solid_ranges *out) {
  solid_ranges r = {0};
  corot_status status = share_chunks(p, n, together, &r.plan);
  if (r.plan.n == 1) r.plan.due = p->due, r.plan.turn = p->turn;
  if (!status && r.plan.n > 1) status = find_seams(mesh->nnode, t, p, &r.plan);
  if (!status) status = make_windows(t, p, force, &r);
  if (!status && r.plan.n > 1) status = make_room_aside(damped, &r);
  if (!status && averaged) status = make_gathered(mesh->nnode, &r);
  if (status) {
    corot_ranges_clear(&r);
    return status;
  }
  *out = r;
  return COROT_OK;
}

void corot_ranges_clear(solid_ranges *r) {
  range_plan *plan = &r->plan;
  for (int k = 1; r->force && k < plan->n && r->windowed; k++) free(r->force[k]);
  for (int k = 0; r->gathered && k < plan->n; k++) free(r->gathered[k]);
  free(r->gathered);
  if (plan->n > 1) free((int *)plan->due), free((int *)plan->turn);
  free(plan->chunk);
  free(plan->seam), free(plan->force_first), free(plan->copy_first), free(plan->copy);
  free(plan->shared), free(plan->part_first), free(plan->detour), free(plan->place);
  free(r->force), free(r->told);
  free(r->aside), free(r->aside_K), free(r->aside_D);
  *r = (solid_ranges){0};
}

size_t corot_ranges_bytes(const solid_ranges *r, const element_set *t, const pattern *p) {
  const range_plan *plan = &r->plan;
  size_t bytes = (plan->n + 1) * sizeof *plan->chunk;
  bytes += plan->n * (sizeof *r->force + sizeof *r->told);
  if (r->gathered) bytes += plan->n * (sizeof *r->gathered + p->nnode * sizeof **r->gathered);
  if (plan->n == 1) return bytes;
  size_t nforce = plan->force_first[plan->nseam], npart = plan->part_first[plan->nshared];
  if (r->windowed) bytes += (plan->n - 1) * (size_t)p->window * t->kind->nnode * sizeof **r->force;
  bytes += (2 * (size_t)p->nchunk + 2 + plan->due[p->nchunk]) * sizeof *plan->due;
  bytes += 2 * ((size_t)plan->nseam + 1) * sizeof *plan->seam + nforce * sizeof *plan->copy;
  bytes += 2 * ((size_t)plan->nshared + 1) * sizeof *plan->shared;
  bytes += t->nblock * sizeof *plan->detour;
  bytes += (size_t)plan->ndetour * t->kind->npair * sizeof *plan->place;
  return bytes + nforce * sizeof *r->aside + (r->aside_D ? 2 : 1) * npart * sizeof *r->aside_K;
}
