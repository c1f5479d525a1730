/* The grammar of quantities, read from left to right without looking back. */
#include "quantity.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/config/config.h"
#include "app/text/suggest.h"

const char *const quantity_words[QUANTITY_OPERATIONS] = {
    [QUANTITY_AT] = "@",
    [QUANTITY_MAX] = "max",
    [QUANTITY_MIN] = "min",
    [QUANTITY_MEAN] = "mean",
    [QUANTITY_INTEGRAL] = "integral",
    [QUANTITY_AMPLITUDE] = "amplitude",
    [QUANTITY_PERIOD] = "period",
};

/* What may stand before a parenthesis. */
static const char functions[] = "max|min|mean|integral|amplitude|period|when|abs";

/* The text, and how far it has been read. */
typedef struct reader {
  const char *text;
  size_t at;
} reader;

/* Where a word stands. */
typedef struct span {
  size_t at, length;
} span;

/* --- Words --- */

static corot_status complain(reader *r, size_t at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static corot_status complain(reader *r, size_t at, const char *format, ...) {
  char reason[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(reason, sizeof reason, format, arguments);
  va_end(arguments);
  r->at = at;
  return corot_fail(COROT_EFORMAT, "%s", reason);
}

static char next(reader *r) {
  while (r->text[r->at] == ' ') r->at++;
  return r->text[r->at];
}

static bool take(reader *r, char c) {
  if (next(r) != c) return false;
  r->at++;
  return true;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

static bool is_in_word(char c) {
  return is_letter(c) || is_digit(c) || c == '.' || c == '_' || c == '-';
}

/* A column, a function, or a number, which may have a + in its exponent. Empty: there is none. */
static span word(reader *r) {
  next(r);
  span w = {.at = r->at};
  bool number = is_digit(r->text[w.at]) || r->text[w.at] == '.';
  for (;; r->at++) {
    char c = r->text[r->at], before = r->at > w.at ? r->text[r->at - 1] : '\0';
    bool sign = c == '+' && (r->at == w.at || (number && (before == 'e' || before == 'E')));
    if (!is_in_word(c) && !sign) break;
  }
  w.length = r->at - w.at;
  return w;
}

static bool is_word(const reader *r, span w, const char *what) {
  return strlen(what) == w.length && memcmp(r->text + w.at, what, w.length) == 0;
}

static void copy_word(const reader *r, span w, size_t size, char *copy) {
  snprintf(copy, size, "%.*s", (int)w.length, r->text + w.at);
}

/* What a message shows of what stands where something else was expected. */
static corot_status expected(reader *r, const char *what) {
  char c = next(r);
  if (!c) return complain(r, r->at, "%s is missing at the end", what);
  if (c < ' ' || c > '~') return complain(r, r->at, "expected %s", what);
  return complain(r, r->at, "expected %s, found %c", what, c);
}

/* --- Parts --- */

/* YAML ends a plain text between braces or brackets at a comma. */
static corot_status close(reader *r, bool comma) {
  if (take(r, ')')) return COROT_OK;
  if (!next(r))
    return complain(r, r->at,
                    "a ) is missing at the end; where { } or [ ] stand around it, a text with "
                    "commas wants quotes");
  return expected(r, comma ? ") or a comma" : ")");
}

static corot_status column(reader *r, quantity *q) {
  span w = word(r);
  if (w.length == 0) return expected(r, "a column, such as corner.ux");
  q->column_at = w.at;
  q->column_length = w.length;
  return COROT_OK;
}

/* signal = column | "abs" "(" column ")" */
static corot_status signal(reader *r, quantity *q) {
  COROT_TRY(column(r, q));
  if (next(r) != '(') return COROT_OK;
  span w = {q->column_at, q->column_length};
  char name[64];
  copy_word(r, w, sizeof name, name);
  if (!is_word(r, w, "abs"))
    return complain(r, w.at, "%s(..) is no column: functions are of columns, but for when and abs",
                    name);
  take(r, '(');
  q->magnitude = true;
  COROT_TRY(column(r, q));
  return close(r, false);
}

/* moment = number | "end" */
static corot_status moment(reader *r, double *t, size_t *at) {
  span w = word(r);
  char text[64];
  *at = w.at;
  if (w.length == 0) return expected(r, "a time in seconds, or end");
  copy_word(r, w, sizeof text, text);
  if (is_word(r, w, "end")) {
    *t = INFINITY;
    return COROT_OK;
  }
  config_node node = {.kind = CONFIG_SCALAR, .text = text};
  if (w.length >= sizeof text || !config_parse_number(&node, t))
    return complain(r, w.at, "expected a time in seconds, such as 1.5, or end, found %s", text);
  if (!(*t >= 0)) return complain(r, w.at, "%s s is before the run, which begins at t = 0", text);
  return COROT_OK;
}

/* "(" signal [window] ")" */
static corot_status arguments(reader *r, quantity *q) {
  take(r, '(');
  COROT_TRY(signal(r, q));
  q->from = 0;
  q->to = INFINITY;
  if (take(r, ',')) {
    COROT_TRY(moment(r, &q->from, &q->from_at));
    if (!take(r, ',')) return expected(r, "a comma and the end of the window");
    COROT_TRY(moment(r, &q->to, &q->to_at));
    if (!(q->from < q->to))
      return complain(r, q->to_at, "the window is empty: it begins at %g s and ends at %g s",
                      q->from, q->to);
    return close(r, false);
  }
  return close(r, true);
}

static corot_status unknown_function(reader *r, span w) {
  char name[64], near[32];
  copy_word(r, w, sizeof name, name);
  suggest_among(name, functions, sizeof near, near);
  if (*near) return complain(r, w.at, "there is no function %s; did you mean %s?", name, near);
  return complain(r, w.at,
                  "there is no function %s; there are max, min, mean, integral, amplitude, period, "
                  "when and abs",
                  name);
}

/* The function of this name and what it is of. */
static corot_status operation(reader *r, span w, quantity *q) {
  for (int k = QUANTITY_MAX; k < QUANTITY_OPERATIONS; k++)
    if (is_word(r, w, quantity_words[k])) {
      q->operation = (quantity_operation)k;
      q->operation_at = w.at;
      return arguments(r, q);
    }
  if (is_word(r, w, "when") || is_word(r, w, "abs"))
    return complain(r, w.at, "%.*s cannot stand here", (int)w.length, r->text + w.at);
  return unknown_function(r, w);
}

/* "@" moment, after the column. */
static corot_status at_moment(reader *r, quantity *q) {
  if (next(r) == '@') {
    q->operation = QUANTITY_AT;
    q->operation_at = r->at++;
    COROT_TRY(moment(r, &q->from, &q->from_at));
    q->to = q->from;
    q->to_at = q->from_at;
    return COROT_OK;
  }
  char name[64];
  copy_word(r, (span){q->column_at, q->column_length}, sizeof name, name);
  if (next(r) == '\0')
    return complain(r, r->at,
                    "a column alone is no number: %s@end is its value at the end, max(%s) its "
                    "largest",
                    name, name);
  return expected(r, "@ or ( behind a name");
}

/* "(" extreme ")" */
static corot_status when(reader *r, quantity *q) {
  take(r, '(');
  span w = word(r);
  bool extreme = is_word(r, w, "max") || is_word(r, w, "min");
  if (!extreme || next(r) != '(') return complain(r, w.at, "when is of max(..) or of min(..)");
  q->when = true;
  COROT_TRY(operation(r, w, q));
  return close(r, false);
}

/* "(" column ")" "@" moment, or "(" value ")". */
static corot_status absolute(reader *r, quantity *q) {
  take(r, '(');
  COROT_TRY(column(r, q));
  span w = {q->column_at, q->column_length};
  if (next(r) == ')') {
    q->magnitude = true;
    take(r, ')');
    return at_moment(r, q);
  }
  q->absolute = true;
  if (next(r) == '(')
    COROT_TRY(operation(r, w, q));
  else
    COROT_TRY(at_moment(r, q));
  return close(r, false);
}

/* --- All of it --- */

static corot_status whole(reader *r, quantity *q) {
  if (strlen(r->text) > QUANTITY_MOST)
    return complain(r, QUANTITY_MOST, "a quantity has at most %d characters", QUANTITY_MOST);
  span w = word(r);
  q->column_at = w.at;
  q->column_length = w.length;
  if (w.length == 0) return expected(r, "a quantity, such as max(corner.ux) or corner.ux@end");
  if (next(r) != '(')
    COROT_TRY(at_moment(r, q));
  else if (is_word(r, w, "when"))
    COROT_TRY(when(r, q));
  else if (is_word(r, w, "abs"))
    COROT_TRY(absolute(r, q));
  else
    COROT_TRY(operation(r, w, q));
  if (next(r)) return expected(r, "nothing more");
  return COROT_OK;
}

corot_status quantity_parse(const char *text, quantity *out, size_t *at) {
  reader r = {.text = text};
  quantity q = {.text = text, .column = -1};
  corot_status status = whole(&r, &q);
  *at = r.at;
  if (status == COROT_OK) *out = q;
  return status;
}

/* --- Against what there is --- */

/* "a, b, c, ...", cut to fit. */
static void list_names(int n, const char *const *name, size_t size, char *list) {
  size_t used = 0;
  for (int i = 0; i < n; i++) {
    bool fits = used + strlen(name[i]) + sizeof ", , ..." < size;
    used +=
        (size_t)snprintf(list + used, size - used, "%s%s", i ? ", " : "", fits ? name[i] : "...");
    if (!fits) return;
  }
}

/* The first column of a probe of that name. */
static const char *find_column_of(const char *probe, int n, const char *const *name) {
  size_t length = strlen(probe);
  for (int i = 0; i < n; i++)
    if (strncmp(name[i], probe, length) == 0 && name[i][length] == '.') return name[i];
  return NULL;
}

corot_status quantity_resolve(quantity *q, int n, const char *const *name, size_t *at) {
  char typed[QUANTITY_TEXT], list[320] = "none";
  snprintf(typed, sizeof typed, "%.*s", (int)q->column_length, q->text + q->column_at);
  for (int i = 0; i < n; i++)
    if (strcmp(name[i], typed) == 0) {
      q->column = i;
      return COROT_OK;
    }
  *at = q->column_at;
  const char *near = find_column_of(typed, n, name);
  if (!near) near = suggest(typed, n, name);
  if (near)
    return corot_fail(COROT_EFORMAT, "there is no column %s; did you mean %s?", typed, near);
  list_names(n, name, sizeof list, list);
  return corot_fail(COROT_EFORMAT, "there is no column %s; there are: %s", typed, list);
}

corot_status quantity_check_window(const quantity *q, double end, size_t *at) {
  if (isfinite(q->to) && q->to > end) {
    *at = q->to_at;
    return corot_fail(COROT_EFORMAT, "t = %g s is after the run, which ends at %g s", q->to, end);
  }
  if (q->operation == QUANTITY_AT || q->from < end) return COROT_OK;
  *at = q->from_at;
  return corot_fail(COROT_EFORMAT,
                    "the window is empty: it begins at %g s, and the run ends at %g s", q->from,
                    end);
}

/* --- In words --- */

static int print_moment(double t, char *text, size_t size) {
  if (!isfinite(t)) return snprintf(text, size, "end");
  int n = snprintf(text, size, "%.15g", t);
  double back = 0;
  config_node node = {.kind = CONFIG_SCALAR, .text = text};
  if (!config_parse_number(&node, &back) || back != t) n = snprintf(text, size, "%.17g", t);
  return n;
}

void quantity_print(const quantity *q, char text[QUANTITY_TEXT]) {
  char from[32], to[32], column[QUANTITY_MOST + 8], window[72] = "";
  bool at = q->operation == QUANTITY_AT, whole_run = q->from == 0 && !isfinite(q->to);
  /* the parts */
  print_moment(q->from, from, sizeof from);
  print_moment(q->to, to, sizeof to);
  snprintf(column, sizeof column, "%s%.*s%s", q->magnitude ? "abs(" : "", (int)q->column_length,
           q->text + q->column_at, q->magnitude ? ")" : "");
  if (!at && !whole_run) snprintf(window, sizeof window, ", %s, %s", from, to);
  /* the whole */
  const char *head = q->when ? "when(" : q->absolute ? "abs(" : "";
  const char *tail = *head ? ")" : "";
  if (at)
    snprintf(text, QUANTITY_TEXT, "%s%s@%s%s", head, column, from, tail);
  else
    snprintf(text, QUANTITY_TEXT, "%s%s(%s%s)%s", head, quantity_words[q->operation], column,
             window, tail);
}

void quantity_name(const quantity *q, char name[QUANTITY_TEXT]) {
  char text[QUANTITY_TEXT];
  quantity_print(q, text);
  size_t n = 0;
  for (const char *c = text; *c && n + 4 < QUANTITY_TEXT; c++) {
    bool plain = is_letter(*c) || is_digit(*c) || *c == '_' || *c == '-';
    if (*c == '@')
      n += (size_t)snprintf(name + n, QUANTITY_TEXT - n,
                            n > 0 && name[n - 1] == '_' ? "at_" : "_at_");
    else if (plain)
      name[n++] = *c;
    else if (n > 0 && name[n - 1] != '_')
      name[n++] = '_';
  }
  while (n > 0 && name[n - 1] == '_') n--;
  name[n] = '\0';
}

corot_status quantity_point(const char *head, const char *text, size_t at) {
  char reason[512];
  snprintf(reason, sizeof reason, "%s", corot_error());
  return corot_fail(COROT_EFORMAT, "%s: %s\n  %s\n  %*s^", head, reason, text, (int)at, "");
}
