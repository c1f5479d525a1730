/* Edit distance by rows, as in Wagner & Fischer, with swaps of neighbours. */
#include "suggest.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 40, FAR = 1000, NEAR = 3 };

static int least(int a, int b) { return a < b ? a : b; }

static int same(char a, char b) { return tolower((unsigned char)a) == tolower((unsigned char)b); }

int suggest_distance(const char *a, const char *b) {
  size_t n = strlen(a), m = strlen(b);
  if (n > LONGEST || m > LONGEST) return FAR;
  int d[LONGEST + 1][LONGEST + 1];
  for (size_t i = 0; i <= n; i++) d[i][0] = (int)i;
  for (size_t j = 0; j <= m; j++) d[0][j] = (int)j;
  for (size_t i = 1; i <= n; i++) {
    for (size_t j = 1; j <= m; j++) {
      d[i][j] = least(d[i - 1][j], d[i][j - 1]) + 1;
      d[i][j] = least(d[i][j], d[i - 1][j - 1] + !same(a[i - 1], b[j - 1]));
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[n][m];
}

/* A distance to be meant at most: a third of the word, so that "E" suggests nothing. */
static int tolerance(const char *typed) {
  int third = ((int)strlen(typed) + 1) / 3;
  return third < NEAR ? third : NEAR;
}

const char *suggest(const char *typed, int nword, const char *const *word) {
  const char *best = NULL;
  int nearest = tolerance(typed) + 1;
  for (int i = 0; i < nword; i++) {
    int distance = suggest_distance(typed, word[i]);
    if (distance < nearest) nearest = distance, best = word[i];
  }
  return best;
}

void suggest_among(const char *typed, const char *words, int size, char *found) {
  int nearest = tolerance(typed) + 1;
  found[0] = '\0';
  while (*words) {
    char word[LONGEST + 1];
    int length = (int)strcspn(words, "|");
    snprintf(word, sizeof word, "%.*s", length, words);
    int distance = suggest_distance(typed, word);
    if (distance < nearest) {
      nearest = distance;
      snprintf(found, (size_t)size, "%s", word);
    }
    words += length + (words[length] == '|');
  }
}
