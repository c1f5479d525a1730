/* Asks the libraries themselves, as what is loaded need not be what was compiled against. */
#define _GNU_SOURCE /* RTLD_DEFAULT, dladdr */
#include "libraries.h"

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/klu.h>

typedef union found {
  void *object;
  int (*version)(int version[3]);
  void (*klu_version)(int version[3]);
  char *(*text)(void);
  int (*number)(void);
} found;

static found find(const char *name) { return (found){dlsym(RTLD_DEFAULT, name)}; }

static void write_version(const int version[3], size_t size, char *text) {
  snprintf(text, size, "%d.%d.%d", version[0], version[1], version[2]);
}

/* SuiteSparse_version and cholmod_version are of one kind. */
static void ask_version(const char *function, size_t size, char *text) {
  int version[3] = {0};
  found f = find(function);
  if (!f.object) return;
  f.version(version);
  write_version(version, size, text);
}

/* KLU says it since SuiteSparse 7.4. */
static void ask_klu(size_t size, char *text) {
  int version[3] = {KLU_MAIN_VERSION, KLU_SUB_VERSION, KLU_SUBSUB_VERSION};
  found f = find("klu_version");
  if (f.object) f.klu_version(version);
  write_version(version, size, text);
}

static void ask_text(const char *function, size_t size, char *text) {
  found f = find(function);
  const char *said = f.object ? f.text() : NULL;
  if (said) snprintf(text, size, "%s", said);
  for (size_t n = strlen(text); n > 0 && text[n - 1] == ' ';) text[--n] = '\0';
}

/* Debian's libblas.so.3 is a link of its alternatives. A file that has been replaced since is known
   by the name it had. */
static corot_status find_file(const char *function, size_t size, char *text) {
  Dl_info info;
  found f = find(function);
  if (!f.object || !dladdr(f.object, &info) || !info.dli_fname) return COROT_OK;
  char path[PATH_MAX];
  const char *real = realpath(info.dli_fname, path);
  if (!real && errno != ENOENT && errno != ENOTDIR)
    return corot_fail(COROT_EIO, "%s: cannot be looked at: %s", info.dli_fname, strerror(errno));
  snprintf(text, size, "%s", real ? real : info.dli_fname);
  return COROT_OK;
}

corot_status corot_libraries_find(corot_libraries *libraries) {
  corot_libraries l = {.blas_threads = 0};
  ask_version("SuiteSparse_version", sizeof l.suitesparse, l.suitesparse);
  ask_klu(sizeof l.klu, l.klu);
#ifdef COROT_HAVE_CHOLMOD
  ask_version("cholmod_version", sizeof l.cholmod, l.cholmod);
#endif
  COROT_TRY(find_file("dgemm_", sizeof l.blas, l.blas));
  if (*l.blas) {
    ask_text("openblas_get_config", sizeof l.blas_config, l.blas_config);
    ask_text("openblas_get_corename", sizeof l.blas_core, l.blas_core);
    found threads = find("openblas_get_num_threads");
    if (threads.object) l.blas_threads = threads.number();
  }
  *libraries = l;
  return COROT_OK;
}
