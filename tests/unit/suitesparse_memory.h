/* Where SuiteSparse takes its memory from: a table that stands in the open before its version 6,
   and behind accessors since. */
#ifndef SUITESPARSE_MEMORY_H
#define SUITESPARSE_MEMORY_H

#include <suitesparse/SuiteSparse_config.h>

typedef struct suitesparse_memory {
  void *(*malloc)(size_t size);
  void *(*calloc)(size_t n, size_t size);
  void *(*realloc)(void *p, size_t size);
  void (*free)(void *p);
} suitesparse_memory;

#if SUITESPARSE_MAIN_VERSION >= 6
static inline suitesparse_memory suitesparse_memory_get(void) {
  return (suitesparse_memory){
      SuiteSparse_config_malloc_func_get(), SuiteSparse_config_calloc_func_get(),
      SuiteSparse_config_realloc_func_get(), SuiteSparse_config_free_func_get()};
}

static inline void suitesparse_memory_set(suitesparse_memory to) {
  SuiteSparse_config_malloc_func_set(to.malloc);
  SuiteSparse_config_calloc_func_set(to.calloc);
  SuiteSparse_config_realloc_func_set(to.realloc);
  SuiteSparse_config_free_func_set(to.free);
}
#else
static inline suitesparse_memory suitesparse_memory_get(void) {
  return (suitesparse_memory){SuiteSparse_config.malloc_func, SuiteSparse_config.calloc_func,
                              SuiteSparse_config.realloc_func, SuiteSparse_config.free_func};
}

static inline void suitesparse_memory_set(suitesparse_memory to) {
  SuiteSparse_config.malloc_func = to.malloc;
  SuiteSparse_config.calloc_func = to.calloc;
  SuiteSparse_config.realloc_func = to.realloc;
  SuiteSparse_config.free_func = to.free;
}
#endif

#endif
