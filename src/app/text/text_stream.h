/* A stream into memory that says when memory ran out. The GNU C library's open_memstream does not:
   what it found no room for is missing, and neither ferror nor fclose knows. */
#ifndef COROT_APP_TEXT_TEXT_STREAM_H
#define COROT_APP_TEXT_TEXT_STREAM_H

#include <stddef.h>
#include <stdio.h>

/* A stream whose text is the caller's to free once it is closed, whether or not all is there; NULL:
   no memory, and *text is NULL. `size` is without the NUL that ends the text. */
FILE *text_open(char **text, size_t *size);

/* 0: all that was written is there. `out` may be NULL, which is a failure. */
int text_close(FILE *out);

#endif
