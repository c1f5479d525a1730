/* Text from outside in each format: what a format would obey is made harmless, and nothing else is
   changed. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "app/text/escape.h"

typedef void escape(const char *text, FILE *out);

static const struct {
  escape *write;
  const char *text, *expected;
} example[] = {
    {escape_shell, "", "''"},
    {escape_shell, "a'b\n$(c)\xff", "'a'\\''b\n$(c)\xff'"},
    {escape_line, "a\r\nb\tc", "a  b c"},
    {escape_line,
     "a\xe2\x80\xae"
     "b\xe2\x81\xa6"
     "c\xe2\x80\x8f",
     "a???b???c\xe2\x80\x8f"},
    {escape_line,
     "a\xe2\x80\xa8"
     "b\xe2\x80\xa9\x1b[0m\xc2\x85\xff\xc3\xa9",
     "a b ?[0m???\xc3\xa9"},
    {escape_name, "a b\n$(c)-d.e_1", "a_b___c_-d.e_1"},
    {escape_python, "a\"\\\n\x7f'", "\"a\\\"\\\\\\x0a\\x7f'\""},
    {escape_python, "\xc3\xa9\xe2\x80\xa8\xf0\x9f\x98\x80",
     "\"\\U000000e9\\U00002028\\U0001f600\""},
    {escape_python, "\xff\xc2\x9b\xed\xa0\x80", "\"\\udcff\\U0000009b\\udced\\udca0\\udc80\""},
    {escape_gnuplot, "it's\n`x`", "'it''s `x`'"},
    {escape_csv, "plain text", "plain text"},
    {escape_csv, "a,b", "\"a,b\""},
    {escape_csv, "say \"a\"\nb", "\"say \"\"a\"\"\nb\""},
    {escape_csv, "=1+1", "'=1+1"},
    {escape_csv, "-x", "'-x"},
    {escape_csv, "+x,", "\"'+x,\""},
    {escape_csv, "@x", "'@x"},
    {escape_csv, "\t=x", "'\t=x"},
    {escape_csv, "'=x", "''=x"},
    {escape_csv, "'x", "'x"},
    {escape_csv, "-1.5e-3", "-1.5e-3"},
    {escape_csv, "-", "'-"},
    {escape_csv, "1-1", "1-1"},
    {escape_markup, "<a href=\"'&\">\x01\xff]]>", "&lt;a href=&quot;&#39;&amp;&quot;&gt;??]]&gt;"},
    {escape_sql_name, "a\"b", "\"a\"\"b\""},
    {escape_terminal,
     "a\xe2\x80\xae"
     "b",
     "a???b"},
    {escape_terminal, "a\n\tb\x1b[31m\xc2\x9b\r\xc3\xa9", "a\n\tb?[31m???\xc3\xa9"},
};

static char *written(escape *write, const char *text) {
  char *got = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&got, &size);
  assert_non_null(out);
  write(text, out);
  assert_int_equal(fclose(out), 0);
  return got;
}

static void each_format_keeps_its_text_to_itself(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof example / sizeof *example; i++) {
    char *got = written(example[i].write, example[i].text);
    assert_string_equal(got, example[i].expected);
    free(got);
    free(written(example[i].write, NULL)); /* is "" */
  }
}

/* What is read back from a table is what was written, but for what cannot be shown. */
static void an_apostrophe_is_taken_back(void **state) {
  (void)state;
  static const char *const text[] = {"=x", "'=x", "''=x", "'x", "x", "", "-1", "'-1", "+-1x", "-"};
  for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
    char *field = written(escape_csv, text[i]);
    assert_string_equal(escape_csv_undo(field), text[i]);
    free(field);
  }
}

/* Whole characters, within the size, and dots where something is missing. */
static void a_line_is_cut_between_characters(void **state) {
  (void)state;
  char line[64];
  for (size_t size = 1; size < sizeof line; size++) {
    memset(line, 'x', sizeof line);
    escape_line_cut("\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9\n\xff", size, line);
    assert_true(strlen(line) < size);
    for (const char *s = line; *s; s += escape_character(s)) assert_true(escape_character(s) > 0);
    if (size >= 4 && size < 13) assert_string_equal(line + strlen(line) - 3, "...");
  }
  assert_string_equal(line, "\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9 ?");
  assert_string_equal(escape_line_cut(NULL, sizeof line, line), "");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_format_keeps_its_text_to_itself),
      cmocka_unit_test(an_apostrophe_is_taken_back),
      cmocka_unit_test(a_line_is_cut_between_characters),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
