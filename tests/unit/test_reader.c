/* Values at the ends of their ranges and of the file, and what messages show of what was found. */
#include "core/mesh/read/reader.h"

#include <stdio.h>

#include "check.h"

static corot_reader over(const char *text) {
  return (corot_reader){.path = "a", .data = text, .size = strlen(text)};
}

static corot_reader binary(const char *bytes, size_t size) {
  return (corot_reader){.path = "a", .data = bytes, .size = size, .bytes = true, .binary = true};
}

/* The largest and the smallest numbers are read, the next ones are refused. */
static void integers_to_the_ends_of_their_range(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int64_t value;
    bool fits_int, fits_long;
  } table[] = {
      {"2147483647", 2147483647, true, true},           {"2147483648", 2147483648, false, true},
      {"-2147483648", -2147483647 - 1, true, true},     {"-2147483649", -2147483649, false, true},
      {"9223372036854775807", INT64_MAX, false, true},  {"9223372036854775808", 0, false, false},
      {"-9223372036854775808", INT64_MIN, false, true}, {"-9223372036854775809", 0, false, false},
      {"92233720368547758070", 0, false, false},        {"+0", 0, true, true},
  };
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    corot_reader r = over(table[k].text);
    int64_t wide = 1;
    int narrow = 1;
    if (table[k].fits_long) {
      assert_ok(corot_reader_long(&r, "n", &wide));
      assert_true(wide == table[k].value && r.at == r.size);
    } else {
      assert_fails(corot_reader_long(&r, "n", &wide), COROT_EFORMAT, "a:1: n is too large");
      assert_true(wide == 1 && r.at == 0);
    }
    r = over(table[k].text);
    if (table[k].fits_int) {
      assert_ok(corot_reader_int(&r, "n", &narrow));
      assert_int_equal(narrow, (int)table[k].value);
    } else {
      assert_fails(corot_reader_int(&r, "n", &narrow), COROT_EFORMAT, "a:1: n is too large");
    }
  }
}

static void what_is_no_number(void **state) {
  (void)state;
  static const char *const bad[] = {"-", "+", "1.5", "1/", "1:", "0x1", "--1", "a"};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    corot_reader r = over(bad[k]);
    int value = 7;
    char words[64];
    snprintf(words, sizeof words, "a:1: expected n, found '%s'", bad[k]);
    assert_fails(corot_reader_int(&r, "n", &value), COROT_EFORMAT, words);
    assert_int_equal(value, 7);
  }
}

/* A word of 24 letters is shown whole, a longer one is cut there. */
static void messages_show_what_was_found(void **state) {
  (void)state;
  static const struct {
    const char *text, *shown;
  } table[] = {
      {"abcdefghijklmnopqrstuvwx", "found 'abcdefghijklmnopqrstuvwx'"},
      {"abcdefghijklmnopqrstuvwxy", "found 'abcdefghijklmnopqrstuvwx...'"},
      {"abcdefghijklmnopqrstuvwx\ny", "found 'abcdefghijklmnopqrstuvwx'"},
      {"abcdefghijklmnopqrstuvwx y", "found 'abcdefghijklmnopqrstuvwx'"},
      {"", "found the end of the file"},
      {" \n1", "found the end of the line"},
      {"a\x1f\x20", "found 'a?'"},
      {"a\x7f\x7e ", "found 'a?~'"},
  };
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    corot_reader r = over(table[k].text);
    double value;
    assert_fails(corot_reader_real(&r, "x", &value), COROT_EFORMAT, table[k].shown);
    size_t length = strlen(corot_error()), tail = strlen(table[k].shown);
    assert_string_equal(corot_error() + length - tail, table[k].shown);
  }
}

/* A word is one only up to a blank, the end of the line or the end of the file. */
static void words_are_whole(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool is;
  } table[] = {{"$End", true},  {"$End\n", true}, {"$End\t", true}, {"$End\r\n", true},
               {"$End ", true}, {"$Ends", false}, {"$En", false},   {"End", false}};
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    corot_reader r = over(table[k].text);
    assert_int_equal(corot_reader_word(&r, "$End"), table[k].is);
    assert_int_equal(r.at, table[k].is ? 4 : 0);
  }
}

/* As many items as the rest of the file can hold, and not one more. */
static void counts_that_fill_the_file(void **state) {
  (void)state;
  for (int n = 0; n < 5; n++) {
    char text[24];
    snprintf(text, sizeof text, "%d 123456", n); /* seven bytes follow: three items of two */
    corot_reader r = over(text);
    int count = -1;
    if (n <= 3) {
      assert_ok(corot_reader_count(&r, "items", 2, &count));
      assert_int_equal(count, n);
    } else {
      assert_fails(corot_reader_count(&r, "items", 2, &count), COROT_EFORMAT,
                   "a:1: items is 4, more than the rest of the file can hold");
    }
  }
  corot_reader r = over("-1");
  int count;
  assert_fails(corot_reader_count(&r, "items", 2, &count), COROT_EFORMAT, "a:1: items is -1");
}

/* The last value of a file may end with it, in either order of bytes. */
static void binary_values_at_the_end(void **state) {
  (void)state;
  const int32_t value = 0x01020304, swapped = 0x04030201;
  char bytes[8] = {0};
  memcpy(bytes + 4, &value, 4);
  corot_reader r = binary(bytes, 8);
  int got = 0;
  assert_ok(corot_reader_int(&r, "n", &got));
  assert_int_equal(got, 0);
  assert_ok(corot_reader_int(&r, "n", &got));
  assert_int_equal(got, value);
  assert_fails(corot_reader_int(&r, "n", &got), COROT_EFORMAT,
               "a: byte 8: expected n, found the end of the file");
  r = binary(bytes, 8);
  r.at = 4, r.swap = true;
  assert_ok(corot_reader_int(&r, "n", &got));
  assert_int_equal(got, swapped);
  r = binary(bytes, 7);
  r.at = 4;
  assert_fails(corot_reader_int(&r, "n", &got), COROT_EFORMAT, "a: byte 4: expected n");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integers_to_the_ends_of_their_range),
      cmocka_unit_test(what_is_no_number),
      cmocka_unit_test(messages_show_what_was_found),
      cmocka_unit_test(words_are_whole),
      cmocka_unit_test(counts_that_fill_the_file),
      cmocka_unit_test(binary_values_at_the_end),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
