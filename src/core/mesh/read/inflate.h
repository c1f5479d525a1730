/* What zlib has compressed (RFC 1950 and 1951), made whole again: the core needs no library for it.
 */
#ifndef COROT_CORE_MESH_READ_INFLATE_H
#define COROT_CORE_MESH_READ_INFLATE_H

#include <stdbool.h>
#include <stddef.h>

/* to [nto] = what from [nfrom] stands for; false: it is damaged, or of another length. */
bool corot_inflate(const unsigned char *from, size_t nfrom, unsigned char *to, size_t nto);

#endif
