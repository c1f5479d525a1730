/* A file in memory, read from front to back as text or as binary numbers; failures say where.

   In text, values stand on lines: no value is taken from the next line, and a line must be
   finished by corot_reader_end_line before the next is begun. */
#ifndef COROT_CORE_MESH_READ_READER_H
#define COROT_CORE_MESH_READ_READER_H

#include <corot/base.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where text of a file begins in what is read. */
typedef struct corot_reader_piece {
  size_t start;
  const char *path;
  long line;
} corot_reader_piece;

typedef struct corot_reader {
  const char *path; /* as messages call it */
  const char *data; /* data[size] is 0 */
  size_t size;
  size_t at;
  size_t npiece;
  const corot_reader_piece *piece; /* [npiece] ascending; none: all is of the file `path` */
  char comment;                    /* from here to the end of its line; 0: none */
  char separator;                  /* a value ends before it; 0: blanks only separate */
  const char *stops; /* values end before any of these, too, where the reader stays; NULL: none */
  bool flows;        /* a value may stand on a later line; the ends of lines mean nothing */
  bool bytes;        /* messages give the byte instead of the line */
  bool binary;       /* the values that follow are binary */
  bool swap;         /* and of the other byte order */
  bool narrow;       /* whole numbers have 4 bytes there, a long as well */
  bool single;       /* reals have 4 bytes there */
} corot_reader;

/* The whole file, a 0 added behind it; the caller frees. COROT_EIO: it cannot be read. */
corot_status corot_file_load(const char *path, char **data, size_t *size);

/* The same of a mesh file, as the readers want it: without a byte order mark, and with an end of
   line that they know, where there is none but CR. COROT_EFORMAT: it is UTF-16. */
corot_status corot_reader_load(const char *path, char **data, size_t *size);

/* COROT_EFORMAT with "FILE:LINE: " or "FILE: byte N: " before the message. */
corot_status corot_reader_fail(const corot_reader *r, size_t at, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* Goes past blanks, blank lines and comments. */
void corot_reader_skip_lines(corot_reader *r);

/* Goes to the next non-blank on this line; false if there is none. */
bool corot_reader_more(corot_reader *r);

/* The rest of the line must be blank; goes to the next line that is not. Nothing in binary. */
corot_status corot_reader_end_line(corot_reader *r);

/* Goes past the next `\n`. */
void corot_reader_skip_line(corot_reader *r);

/* Whether the text here is the whole word `word`; if so, goes past it. */
bool corot_reader_word(corot_reader *r, const char *word);

/* The word must be here. */
corot_status corot_reader_expect(corot_reader *r, const char *word);

/* Goes past blanks and one separator; false if there is none on this line. */
bool corot_reader_separator(corot_reader *r);

/* One value, decimal in text, 4 or 8 bytes in binary. A real may have Fortran's exponent, 1D-3.
 * `what` it is, for messages. */
corot_status corot_reader_int(corot_reader *r, const char *what, int *value);
corot_status corot_reader_long(corot_reader *r, const char *what, int64_t *value);
corot_status corot_reader_real(corot_reader *r, const char *what, double *value);
corot_status corot_reader_point(corot_reader *r, double x[3]);

/* A number of items that are still to come, each of at least `bytes` bytes: not negative, and not
   more than the file can hold. As a long in binary. */
corot_status corot_reader_count(corot_reader *r, const char *what, size_t bytes, int *value);

/* Of text: such a number on the next line that is not empty, with nothing behind it. */
corot_status corot_reader_count_line(corot_reader *r, const char *what, size_t bytes, int *value);

#endif
