/* Quantities: one number out of a column of a run's tables, as text.

     corner.ux@end                the column's value at the end,
     corner.ux@1.5                or at a time [s]
     max(corner.ux)               its largest value, min(..) its smallest, and when that was reached
     mean(corner.ux)              its mean over time
     integral(corner.ux)          its integral over time [unit of the column times s]
     amplitude(corner.ux)         half the way from its smallest value to its largest
     period(corner.ux)            of its oscillation [s] (turning.h)
     when(max(corner.ux))         the time of an extreme [s], of max or of min

   All but those with @ take a window: max(corner.ux, 0.5, end) looks from t = 0.5 s to the end.
   abs(..) may stand around a column, max(abs(corner.ux)), or around a number, abs(min(corner.ux)).

     quantity  = value | "abs" "(" value ")" | "when" "(" extreme ")"
     value     = signal "@" moment | operation
     extreme   = ("max" | "min") "(" signal [window] ")"
     operation = extreme | ("mean" | "integral" | "amplitude" | "period") "(" signal [window] ")"
     window    = "," moment "," moment
     signal    = column | "abs" "(" column ")"
     moment    = number | "end"

   A column is a word of letters, digits, '.', '_' and '-'; there may be blanks between the words.
 */
#ifndef COROT_APP_QUANTITY_QUANTITY_H
#define COROT_APP_QUANTITY_QUANTITY_H

#include <corot/base.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum quantity_operation {
  QUANTITY_AT, /* from = to */
  QUANTITY_MAX,
  QUANTITY_MIN,
  QUANTITY_MEAN,
  QUANTITY_INTEGRAL,
  QUANTITY_AMPLITUDE,
  QUANTITY_PERIOD,
  QUANTITY_OPERATIONS
} quantity_operation;

/* As they are written; "@" for the first. */
extern const char *const quantity_words[QUANTITY_OPERATIONS];

enum {
  QUANTITY_MOST = 200, /* characters of a text: longer ones are refused */
  QUANTITY_TEXT = 320  /* room for what any of them is printed as */
};

typedef struct quantity {
  quantity_operation operation;
  bool when;                           /* the time of an extreme, not its value */
  bool magnitude;                      /* of the column's absolute value */
  bool absolute;                       /* the absolute value of what comes out */
  double from, to;                     /* [s]; infinite: the end of the run */
  const char *text;                    /* what was parsed, which it must not outlive */
  size_t column_at, column_length;     /* where its column stands there, */
  size_t operation_at, from_at, to_at; /* its operation, and its times: [0] of none */
  int column;                          /* its number, once it is resolved; -1 */
} quantity;

/* COROT_EFORMAT: corot_error() is what is wrong, and *at the place of the text where. */
corot_status quantity_parse(const char *text, quantity *out, size_t *at);

/* Finds the number of its column among the names [n] of columns. COROT_EFORMAT: there is none, as
   above, with the name that may have been meant. */
corot_status quantity_resolve(quantity *q, int n, const char *const *name, size_t *at);

/* Looks whether its times are within a run, from 0 to `end`. COROT_EFORMAT as above. */
corot_status quantity_check_window(const quantity *q, double end, size_t *at);

/* The same quantity in one way of writing: "max(corner.ux, 0.5, end)". */
void quantity_print(const quantity *q, char text[QUANTITY_TEXT]);

/* A name for it, of letters, digits, '_' and '-': "max_corner_ux_0_5_end". */
void quantity_name(const quantity *q, char name[QUANTITY_TEXT]);

/* Fails with COROT_EFORMAT and "HEAD: REASON", the text, and a caret under place `at`, where the
   reason is corot_error(). */
corot_status quantity_point(const char *head, const char *text, size_t at);

#endif
