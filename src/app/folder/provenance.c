/* Which build this is, and what it runs on. */
#define _GNU_SOURCE /* dl_iterate_phdr */
#include "provenance.h"

#include <corot/solve.h>
#include <link.h>
#include <stdio.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "core/lanes/widths.h"
#include "solve/linsol/libraries.h"

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#elif defined(__GNUC__)
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "unknown"
#endif

const char *const provenance_compiler = COMPILER;

/* --- The linker's identity --- */

enum { ID_BYTES = 32 };

static size_t aligned(size_t size) { return (size + 3) & ~(size_t)3; }

/* Looks for the note of the identity among notes, each a head, a name and what it says. */
static void find_id(const char *at, size_t size, size_t room, char *digits) {
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    memcpy(&head, at, sizeof head);
    size_t name = sizeof head, id = name + aligned(head.n_namesz);
    size_t next = id + aligned(head.n_descsz);
    if (next > size) return;
    bool found =
        head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && memcmp(at + name, "GNU", 4) == 0;
    for (size_t i = 0; found && i < head.n_descsz && 2 * i + 3 <= room; i++)
      snprintf(digits + 2 * i, 3, "%02x", (unsigned char)at[id + i]);
    at += next;
    size -= next;
  }
}

/* The first object is the program. */
static int look_at_program(struct dl_phdr_info *info, size_t size, void *digits) {
  (void)size;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *part = &info->dlpi_phdr[i];
    union {
      ElfW(Addr) number;
      const char *notes;
    } address = {info->dlpi_addr + part->p_vaddr};
    if (part->p_type == PT_NOTE) find_id(address.notes, part->p_memsz, 2 * ID_BYTES + 1, digits);
  }
  return 1;
}

/* --- All of it --- */

static json_t *known(const char *text) {
  return text && *text ? json_text_string(text) : json_null();
}

static json_t *blas_json(const corot_libraries *l) {
  if (!*l->blas) return json_null();
  return json_pack("{s:o, s:o, s:o, s:o}", "library", known(l->blas), "config",
                   known(l->blas_config), "core", known(l->blas_core), "threads",
                   l->blas_threads > 0 ? json_integer(l->blas_threads) : json_null());
}

corot_status provenance_make(json_t **out) {
  corot_libraries l;
  char build[2 * ID_BYTES + 1] = "";
  COROT_TRY(corot_libraries_find(&l));
  dl_iterate_phdr(look_at_program, build);
  *out = json_pack("{s:o, s:o, s:s, s:s, s:{s:o, s:o, s:o}, s:o, s:s, s:s}", "commit",
                   known(provenance_commit), "build", known(build), "corot", corot_version(),
                   "sundials", corot_sundials_version(), "suitesparse", "version",
                   known(l.suitesparse), "klu", known(l.klu), "cholmod", known(l.cholmod), "blas",
                   blas_json(&l), "compiler", provenance_compiler, "processor",
                   corot_lanes_instruction_set());
  return *out ? COROT_OK : no_memory();
}

/* --- Comparison --- */

static const struct {
  const char *words, *group, *key;
  int most; /* characters that tell two apart */
} fields[PROVENANCE_FIELDS] = {
    {"commit", NULL, "commit", 60},
    {"build", NULL, "build", 12},
    {"corot", NULL, "corot", 40},
    {"SUNDIALS", NULL, "sundials", 40},
    {"SuiteSparse", "suitesparse", "version", 40},
    {"KLU", "suitesparse", "klu", 40},
    {"CHOLMOD", "suitesparse", "cholmod", 40},
    {"BLAS", "blas", "library", 100},
    {"BLAS", "blas", "config", 80},
    {"BLAS for", "blas", "core", 40},
    {"compiler", NULL, "compiler", 60},
    {"processor", NULL, "processor", 40},
};

/* NULL: it is not said. */
static const char *value_of(const json_t *provenance, int field) {
  const char *group = fields[field].group;
  const json_t *in = group ? json_object_get(provenance, group) : provenance;
  return json_string_value(json_object_get(in, fields[field].key));
}

bool provenance_same(const json_t *a, const json_t *b, int field) {
  const char *one = value_of(a, field), *other = value_of(b, field);
  return one && other ? strcmp(one, other) == 0 : one == other;
}

bool provenance_equal(const json_t *a, const json_t *b) {
  for (int i = 0; i < PROVENANCE_FIELDS; i++)
    if (!provenance_same(a, b, i)) return false;
  return true;
}

/* Twelve digits tell commits apart; whether they are dirty matters, too. */
static void shorten_commit(const char *commit, size_t size, char *text) {
  int digits = (int)strspn(commit, "0123456789abcdef");
  snprintf(text, size, "%.*s%.20s", digits > 12 ? 12 : digits, commit, commit + digits);
}

void provenance_words(const json_t *provenance, int field, size_t size, char *text) {
  const char *value = value_of(provenance, field);
  char commit[40];
  if (value && field == 0) {
    shorten_commit(value, sizeof commit, commit);
    value = commit;
  }
  snprintf(text, size, "%s %.*s", fields[field].words, fields[field].most,
           value ? value : "unknown");
}
