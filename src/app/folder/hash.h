/* What identifies a run: SHA-256 sums, in hexadecimal. Two runs of equal sums do the same work. */
#ifndef COROT_APP_FOLDER_HASH_H
#define COROT_APP_FOLDER_HASH_H

#include <corot/mesh.h>
#include <jansson.h>

enum { HASH_SIZE = 65 }; /* 64 digits and a terminator */

typedef struct hashes {
  char scenario[HASH_SIZE]; /* of the resolved scenario as compact JSON with sorted keys, without
                               checkpoint.every */
  char mesh[HASH_SIZE];     /* of counts, coordinates, tets and groups as they stand in memory */
  char run[HASH_SIZE];    /* of "corot VERSION\nSCENARIO\nMESH\n"; of a search for the equilibrium,
                             of "static\nRUN\n" with that sum; of modes, of "modes\nRUN\n" */
  char answer[HASH_SIZE]; /* of a run, as `run`, but without `threads`, on which only what it costs
                             depends: so one with other threads may go on from its checkpoint */
} hashes;

corot_status hashes_of(const json_t *resolved, const corot_mesh *mesh, hashes *out);

/* Of a resolved scenario without its title, its quantities, and without what is written of it: what
   its solution depends on, beside the mesh. */
corot_status hash_solution(const json_t *resolved, char digest[HASH_SIZE]);

/* Makes the identity of a run that of corot static of the same scenario and mesh, which is other
   work. */
void hashes_static(hashes *h);
void hashes_modes(hashes *h);

/* The same in parts, for who has many scenarios of one mesh. */
void hash_mesh(const corot_mesh *mesh, char digest[HASH_SIZE]);
corot_status hashes_with(const json_t *resolved, const char mesh[HASH_SIZE], hashes *out);

void hash_bytes(const char *data, size_t size, char digest[HASH_SIZE]);
/* Of an open file from its beginning; `path` is for the message. */
corot_status hash_file(int fd, const char *path, long long *size, char digest[HASH_SIZE]);

void hash_text(const char *text, char digest[HASH_SIZE]);

#endif
