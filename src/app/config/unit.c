/* The names of units, and products of them. */
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/suggest.h"

static const double pi = 3.14159265358979323846;
static const double inch = 0.0254, pound_force = 4.4482216152605;

typedef struct name {
  const char *word;
  bool prefix; /* with one before it, too */
  int power[4];
  double mantissa;
  int exponent;
} name;

/* clang-format off */
static const name names[] = {
  /*          prefix  kg   m   s rad */
  {"m",       true,  { 0,  1,  0, 0}, 1, 0},
  {"s",       true,  { 0,  0,  1, 0}, 1, 0},
  {"g",       true,  { 1,  0,  0, 0}, 1, -3},
  {"N",       true,  { 1,  1, -2, 0}, 1, 0},
  {"Pa",      true,  { 1, -1, -2, 0}, 1, 0},
  {"bar",     true,  { 1, -1, -2, 0}, 1, 5},
  {"J",       true,  { 1,  2, -2, 0}, 1, 0},
  {"W",       true,  { 1,  2, -3, 0}, 1, 0},
  {"Hz",      true,  { 0,  0, -1, 0}, 1, 0},
  {"rad",     true,  { 0,  0,  0, 1}, 1, 0},
  {"deg",     false, { 0,  0,  0, 1}, pi / 180, 0},
  {"rev",     false, { 0,  0,  0, 1}, 2 * pi, 0},
  {"rpm",     false, { 0,  0, -1, 1}, pi / 30, 0},
  {"min",     false, { 0,  0,  1, 0}, 60, 0},
  {"h",       false, { 0,  0,  1, 0}, 3600, 0},
  {"t",       false, { 1,  0,  0, 0}, 1, 3},
  {"l",       false, { 0,  3,  0, 0}, 1, -3},
  {"P",       false, { 1, -1, -1, 0}, 1, -1},
  {"cP",      false, { 1, -1, -1, 0}, 1, -3},
  {"in",      false, { 0,  1,  0, 0}, inch, 0},
  {"ft",      false, { 0,  1,  0, 0}, 12 * inch, 0},
  {"lb",      false, { 1,  0,  0, 0}, 0.45359237, 0},
  {"lbf",     false, { 1,  1, -2, 0}, pound_force, 0},
  {"psi",     false, { 1, -1, -2, 0}, pound_force / (inch * inch), 0},
};
/* clang-format on */

static const struct {
  const char *word;
  int exponent;
} prefixes[] = {{"n", -9}, {"u", -6}, {"\xc2\xb5", -6}, {"m", -3}, {"c", -2},
                {"d", -1}, {"k", 3},  {"M", 6},         {"G", 9},  {"T", 12}};

enum { NNAME = sizeof names / sizeof *names, NPREFIX = sizeof prefixes / sizeof *prefixes };

static const name *find(const char *word) {
  for (int i = 0; i < NNAME; i++)
    if (strcmp(names[i].word, word) == 0) return &names[i];
  return NULL;
}

/* A name, or a prefix and a name; *exponent is what the prefix stands for. */
static const name *find_prefixed(const char *word, int *exponent) {
  *exponent = 0;
  const name *found = find(word);
  for (int i = 0; i < NPREFIX && !found; i++) {
    size_t length = strlen(prefixes[i].word);
    if (strncmp(word, prefixes[i].word, length) != 0) continue;
    found = find(word + length);
    if (found && !found->prefix) found = NULL;
    if (found) *exponent = prefixes[i].exponent;
  }
  return found;
}

static void multiply(measured_unit *u, const name *n, int exponent, int power) {
  for (int k = 0; k < 4; k++) u->power[k] += power * n->power[k];
  for (int i = 0; i < abs(power); i++)
    u->mantissa = power > 0 ? u->mantissa * n->mantissa : u->mantissa / n->mantissa;
  u->exponent += power * (n->exponent + exponent);
}

/* "^N", "^-N", or nothing, which is 1; 0: something else. */
static int take_power(const char **text) {
  const char *s = *text;
  if (*s != '^') return 1;
  int sign = s[1] == '-' ? -1 : 1;
  s += sign < 0 ? 2 : 1;
  if (*s < '1' || *s > '9') return 0;
  *text = s + 1;
  return sign * (*s - '0');
}

/* One factor: a name and its power, or the 1 of "1/s". */
static bool take_factor(const char **text, int sign, measured_unit *u, size_t size, char *wrong) {
  char word[16];
  size_t length = strcspn(*text, " */^");
  if (length == 0 || length >= sizeof word) return false;
  memcpy(word, *text, length);
  word[length] = '\0';
  *text += length;
  if (strcmp(word, "1") == 0) return true;
  int exponent;
  const name *found = find_prefixed(word, &exponent);
  if (!found) snprintf(wrong, size, "%s", word);
  int power = found ? take_power(text) : 0;
  if (power) multiply(u, found, exponent, sign * power);
  return power;
}

bool unit_parse(const char *text, measured_unit *u, size_t size, char *wrong) {
  enum { MOST = 8 }; /* so that powers stay small */
  measured_unit product = {.mantissa = 1};
  int sign = 1;
  wrong[0] = '\0';
  for (int i = 0; i < MOST; i++) {
    if (!take_factor(&text, sign, &product, size, wrong)) return false;
    size_t blanks = strspn(text, " ");
    text += blanks;
    if (!*text) {
      *u = product;
      return true;
    }
    if (*text != '*' && *text != '/' && !blanks) return false;
    sign = *text == '/' ? -1 : 1;
    if (*text == '*' || *text == '/') text++;
    text += strspn(text, " ");
  }
  return false;
}

bool unit_of_key(const char *text, measured_unit *u) {
  char ignored[16];
  return *text && strcmp(text, "1") != 0 && unit_parse(text, u, sizeof ignored, ignored);
}

bool unit_same(const measured_unit *a, const measured_unit *b) {
  return memcmp(a->power, b->power, sizeof a->power) == 0;
}

double unit_scale(const char *number, size_t length, const measured_unit *u) {
  char digits[128];
  size_t mantissa = strcspn(number, "eE");
  if (mantissa > length) mantissa = length;
  long exponent = mantissa < length ? strtol(number + mantissa + 1, NULL, 10) : 0;
  if (length >= 64) { /* more digits than a number has use for */
    snprintf(digits, sizeof digits, "1e%d", u->exponent);
    return strtod(number, NULL) * strtod(digits, NULL) * u->mantissa;
  }
  if (exponent > 99999 || exponent < -99999) exponent = exponent > 0 ? 99999 : -99999;
  snprintf(digits, sizeof digits, "%.*se%ld", (int)mantissa, number, exponent + u->exponent);
  return strtod(digits, NULL) * u->mantissa;
}

void unit_suggest(const char *wrong, size_t size, char *near) {
  /* what people write most, before the same letters in the other case */
  static const char common[] =
      "m|mm|cm|km|s|ms|min|h|kg|g|N|kN|MN|Pa|kPa|MPa|GPa|bar|J|Hz|kHz|rad|deg|rpm|rev|in|ft|lbf|"
      "psi";
  static const struct {
    const char *word, *meant;
  } long_names[] = {{"sec", "s"},      {"second", "s"},    {"seconds", "s"},    {"minutes", "min"},
                    {"meter", "m"},    {"meters", "m"},    {"metre", "m"},      {"metres", "m"},
                    {"degree", "deg"}, {"degrees", "deg"}, {"\xc2\xb0", "deg"}, {"newton", "N"},
                    {"pascal", "Pa"},  {"hertz", "Hz"},    {"radians", "rad"},  {"inch", "in"},
                    {"hours", "h"},    {"hour", "h"},      {"minute", "min"},   {"kilogram", "kg"}};
  for (size_t i = 0; i < sizeof long_names / sizeof *long_names; i++)
    if (strcmp(long_names[i].word, wrong) == 0) {
      snprintf(near, size, "%s", long_names[i].meant);
      return;
    }
  /* "m3" */
  char word[16];
  size_t last = strlen(wrong) - 1;
  int exponent;
  snprintf(word, sizeof word, "%.*s", (int)last, wrong);
  bool power = last > 0 && strchr("23", wrong[last]) && find_prefixed(word, &exponent);
  if (power)
    snprintf(near, size, "%s^%c", word, wrong[last]);
  else
    suggest_among(wrong, common, (int)size, near);
}
