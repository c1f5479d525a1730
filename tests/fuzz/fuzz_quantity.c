/* Any text as a quantity: one that prints as itself, or a message and a place in the text. What is
   accepted is measured, of a few rows: a number, or a reason why there is none. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/quantity/meter.h"
#include "scratch.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

static void check_printed(const quantity *q) {
  char printed[QUANTITY_TEXT], again[QUANTITY_TEXT], name[QUANTITY_TEXT];
  quantity other;
  size_t at;
  quantity_print(q, printed);
  if (strlen(printed) > QUANTITY_MOST) return; /* numbers may be longer than they were written */
  require(quantity_parse(printed, &other, &at) == COROT_OK, "what is printed reads back");
  quantity_print(&other, again);
  require(strcmp(printed, again) == 0, "as itself");
  require(other.from == q->from && other.to == q->to, "with its times");
  quantity_name(q, name);
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  require(strspn(name, letters) == strlen(name), "a name");
}

static void check_measured(const quantity *of) {
  static const char *const name[] = {"x", "corner.ux"};
  static const double row[][3] = {{0, 1, 2}, {0.5, -1, 3}, {1, 2, 4}, {1, 5, 5}, {2, -4, -1}};
  quantity q = *of;
  meter *m;
  size_t at;
  if (quantity_check_window(&q, 2, &at) != COROT_OK) {
    require(at < strlen(q.text), "a time that stands there");
    return;
  }
  if (quantity_resolve(&q, 2, name, &at) != COROT_OK) {
    require(at < strlen(q.text), "a column that stands there");
    return;
  }
  require(meter_create(1, &q, 2, &m) == COROT_OK, "no memory");
  for (int k = 0; k < 5; k++) meter_row(m, row[k][0], &row[k][1], NULL);
  meter_close(m);
  quantity_value v = meter_value(m, 0);
  require(v.known ? isfinite(v.value) : *v.why != '\0', "a number or a reason");
  meter_destroy(m);
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) {
  char *text = malloc(size + 1);
  require(text, "no memory");
  if (size) memcpy(text, data, size);
  text[size] = '\0';
  quantity q;
  size_t at = size + 1;
  corot_status status = quantity_parse(text, &q, &at);
  require(at <= strlen(text), "a place in the text");
  if (status == COROT_OK) {
    check_printed(&q);
    check_measured(&q);
  } else {
    require(status == COROT_EFORMAT && *corot_error(), "no clean failure");
    require(quantity_point("text", text, at) == COROT_EFORMAT, "a caret");
  }
  free(text);
  return 0;
}
