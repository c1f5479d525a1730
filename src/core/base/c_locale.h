/* Numbers are read and written in the C locale, whatever the host program has chosen. */
#ifndef COROT_CORE_BASE_C_LOCALE_H
#define COROT_CORE_BASE_C_LOCALE_H

#include <locale.h>

typedef struct corot_c_locale {
  locale_t c, before;
} corot_c_locale;

/* Switches the calling thread to the C locale until corot_c_locale_leave. */
static inline corot_c_locale corot_c_locale_enter(void) {
  corot_c_locale l = {newlocale(LC_ALL_MASK, "C", (locale_t)0), (locale_t)0};
  if (l.c) l.before = uselocale(l.c);
  return l;
}

static inline void corot_c_locale_leave(corot_c_locale l) {
  if (!l.c) return;
  uselocale(l.before);
  freelocale(l.c);
}

#endif
