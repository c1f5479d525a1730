/* Feeds meshes, files and texts to SHA-256 (libmd). */
#include "hash.h"

#include <errno.h>
#include <sha2.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/text/json_text.h"

static void add_integers(SHA2_CTX *sum, const int *data, size_t n) {
  SHA256Update(sum, (const uint8_t *)data, n * sizeof *data);
}

void hash_mesh(const corot_mesh *mesh, char digest[HASH_SIZE]) {
  SHA2_CTX sum;
  SHA256Init(&sum);
  add_integers(&sum, (const int[3]){mesh->nnode, mesh->ntet, mesh->ngroup}, 3);
  SHA256Update(&sum, (const uint8_t *)mesh->x, (size_t)mesh->nnode * sizeof *mesh->x);
  add_integers(&sum, &mesh->tet[0][0], 4 * (size_t)mesh->ntet);
  if (mesh->mid) add_integers(&sum, &mesh->mid[0][0], 6 * (size_t)mesh->ntet);
  for (int i = 0; i < mesh->ngroup; i++) {
    const corot_group *g = &mesh->group[i];
    SHA256Update(&sum, (const uint8_t *)g->name, strlen(g->name) + 1);
    add_integers(&sum, (const int[3]){g->nnode, g->ntri, g->ntet}, 3);
    if (g->nnode > 0) add_integers(&sum, g->node, (size_t)g->nnode);
    if (g->ntri > 0) add_integers(&sum, &g->tri[0][0], 3 * (size_t)g->ntri);
    if (g->ntet > 0) add_integers(&sum, g->tet, (size_t)g->ntet);
  }
  SHA256End(&sum, digest);
}

void hash_bytes(const char *data, size_t size, char digest[HASH_SIZE]) {
  SHA256Data((const uint8_t *)data, size, digest);
}

corot_status hash_file(int fd, const char *path, long long *size, char digest[HASH_SIZE]) {
  SHA2_CTX sum;
  uint8_t buffer[16384];
  ssize_t got;
  *size = 0;
  SHA256Init(&sum);
  while ((got = pread(fd, buffer, sizeof buffer, *size)) != 0) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
    SHA256Update(&sum, buffer, (size_t)got);
    *size += got;
  }
  SHA256End(&sum, digest);
  return COROT_OK;
}

void hash_text(const char *text, char digest[HASH_SIZE]) { hash_bytes(text, strlen(text), digest); }

/* A map with all but one key, whose value may be replaced (or NULL), which is taken over; values
   are shared. NULL: no memory, of which json_copy says nothing. */
static json_t *with_other(const json_t *map, const char *other, json_t *replacement) {
  json_t *made = json_object(), *value;
  const char *key;
  json_object_foreach((json_t *)map, key, value) /* jansson's iteration wants it so */
      if (strcmp(key, other) != 0) made = json_text_with(made, key, json_incref(value));
  return replacement ? json_text_with(made, other, replacement) : made;
}

/* How often a checkpoint is written changes nothing of an answer. */
static json_t *without_clock(const json_t *resolved) {
  const json_t *checkpoint = json_object_get(resolved, "checkpoint");
  if (!checkpoint) return json_incref((json_t *)resolved);
  json_t *bare = with_other(checkpoint, "every", NULL);
  return bare ? with_other(resolved, "checkpoint", bare) : NULL;
}

static corot_status hash_scenario(const json_t *resolved, char digest[HASH_SIZE]) {
  json_t *bare = without_clock(resolved);
  char *text =
      bare ? json_text_dump_plain(bare, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17))
           : NULL;
  json_decref(bare);
  if (!text) return corot_fail(COROT_ENOMEM, "the hash of the scenario: out of memory");
  hash_text(text, digest);
  free(text);
  return COROT_OK;
}

corot_status hash_solution(const json_t *resolved, char digest[HASH_SIZE]) {
  json_t *bare = json_object(), *value;
  const char *key;
  bool complete = bare != NULL;
  json_object_foreach((json_t *)resolved, key, value) { /* jansson's iteration wants it so */
    bool counts =
        strcmp(key, "title") != 0 && strcmp(key, "output") != 0 && strcmp(key, "quantities") != 0;
    if (complete && counts) complete = json_object_set(bare, key, value) == 0;
  }
  corot_status status = complete ? hash_scenario(bare, digest)
                                 : corot_fail(COROT_ENOMEM, "the hash of the scenario: no memory");
  json_decref(bare);
  return status;
}

static void hash_run(const char scenario[HASH_SIZE], const char mesh[HASH_SIZE],
                     char digest[HASH_SIZE]) {
  char identity[256];
  snprintf(identity, sizeof identity, "corot %s\n%s\n%s\n", corot_version(), scenario, mesh);
  hash_text(identity, digest);
}

corot_status hashes_with(const json_t *resolved, const char mesh[HASH_SIZE], hashes *out) {
  hashes h;
  char alone[HASH_SIZE];
  json_t *bare = with_other(resolved, "threads", NULL);
  corot_status status = bare ? hash_scenario(bare, alone)
                             : corot_fail(COROT_ENOMEM, "the hash of the scenario: no memory");
  json_decref(bare);
  COROT_TRY(status);
  COROT_TRY(hash_scenario(resolved, h.scenario));
  memcpy(h.mesh, mesh, HASH_SIZE);
  hash_run(h.scenario, h.mesh, h.run);
  hash_run(alone, h.mesh, h.answer);
  *out = h;
  return COROT_OK;
}

static void rename_work(hashes *h, const char *work) {
  char identity[HASH_SIZE + 16];
  snprintf(identity, sizeof identity, "%s\n%s\n", work, h->run);
  hash_text(identity, h->run);
}

void hashes_static(hashes *h) { rename_work(h, "static"); }
void hashes_modes(hashes *h) { rename_work(h, "modes"); }

corot_status hashes_of(const json_t *resolved, const corot_mesh *mesh, hashes *out) {
  char digest[HASH_SIZE];
  hash_mesh(mesh, digest);
  return hashes_with(resolved, digest, out);
}
