/* "Did you mean": the word of a list that is nearest to one that was mistyped. */
#ifndef COROT_APP_TEXT_SUGGEST_H
#define COROT_APP_TEXT_SUGGEST_H

/* Insertions, deletions, replacements and swaps of neighbours that lead from a to b, in either
   case; long words count as far apart. */
int suggest_distance(const char *a, const char *b);

/* The nearest of `word` [nword]; NULL where none is near enough to have been meant. */
const char *suggest(const char *typed, int nword, const char *const *word);

/* The same among words separated by '|'. Writes it to `found` [size], "" where there is none. */
void suggest_among(const char *typed, const char *words, int size, char *found);

#endif
