/* What a result was made by: the build of this program, the libraries it has found at run time, and
   the instructions that its kernels take.

     commit       of the sources, "-dirty" after it where they were changed; null: not known
     build        the linker's identity of the program, in hexadecimal; null: it has none. It
                  differs where code, compiler or options do, and so between two builds of one
                  dirty commit
     corot, sundials
     suitesparse  {version, klu, cholmod}; klu is what was compiled against where the library does
                  not say (before 7.4), cholmod null where it is not used
     blas         {library: the file it is in, config, core: the processor it takes its kernels
                  for, threads}; the last three are OpenBLAS's, null of another; null: none is
                  loaded
     compiler
     processor    of the kernels: x86-64-v4 (AVX-512), x86-64-v3 (AVX2), x86-64, or as built */
#ifndef COROT_APP_FOLDER_PROVENANCE_H
#define COROT_APP_FOLDER_PROVENANCE_H

#include <corot/base.h>
#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

extern const char *const provenance_commit; /* NULL: not known */

/* The compiler, and its version. */
extern const char *const provenance_compiler;

/* *out is the caller's to json_decref. COROT_EIO: the system does not say what it has loaded. */
corot_status provenance_make(json_t **out);

/* In which two may differ, so that their numbers or times may: all of the above but the threads of
   the BLAS, which studies and users set. NULL for either stands for a result that says nothing. */
enum {
  PROVENANCE_OF_CODE = 4, /* the first: commit, build, corot and SUNDIALS */
  PROVENANCE_FIELDS = 12,
  PROVENANCE_COROT = 2,   /* corot's own version */
  PROVENANCE_KERNELS = 9, /* of the BLAS: known where something is factored */
};
bool provenance_same(const json_t *a, const json_t *b, int field);
bool provenance_equal(const json_t *a, const json_t *b);

/* A field in words, "commit 0123456789ab"; long values are cut. */
void provenance_words(const json_t *provenance, int field, size_t size, char *text);

#endif
