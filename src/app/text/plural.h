/* Numbers of things in sentences. */
#ifndef COROT_APP_TEXT_PLURAL_H
#define COROT_APP_TEXT_PLURAL_H

/* What a noun ends with behind a number: "1 node", "2 nodes". */
static inline const char *plural(long n) { return n == 1 ? "" : "s"; }

#endif
