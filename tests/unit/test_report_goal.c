/* The page of a quantity that was found within an error, whatever its solve.json holds. */
#include "alloc.h"
#include "report/command/report.h"
#include "report/study/goal_answer.h"
#include "temporary.h"

/* Three meshes, with text that would be markup if it were let. */
static const char solved[] =
    "{\"title\": \"</script><x-t>\", \"scenario\": \"<x-s>.yaml\", \"static\": true, "
    "\"goal\": \"max(<x-g>.ux)\", \"unit\": \"<x-u>\", \"value\": 2.0, \"low\": 1.98, "
    "\"high\": 2.02, \"within\": 0.02, \"within_abs\": false, \"met\": true, \"asymptotic\": true, "
    "\"why_not\": null, \"order\": 1.75, \"limit\": 2.01, \"allowed\": 0.04, "
    "\"parts\": {\"space\": 0.01, \"time\": 0.0, \"algebra\": 1e-9, \"frames\": 0.0, "
    "\"model\": 0.003}, "
    "\"half\": {\"space\": 0.02, \"time\": 0.0, \"algebra\": 2e-9, \"frames\": 0.0, "
    "\"tail\": 0.0}, "
    "\"measured\": {\"space\": [\"a\", \"b\", \"<x-c>\"], \"time\": [], \"algebra\": [\"t\", "
    "\"a\"], \"model\": [], \"tail\": []}, \"model_counts\": false, "
    "\"obstacle\": \"<x-o>\", \"advice\": \"<x-a>\", \"levels\": ["
    "{\"label\": \"a\", \"tets\": 6, \"dofs\": 81, \"value\": 1.9, \"cpu_s\": 0.1}, "
    "{\"label\": \"b\", \"tets\": 48, \"dofs\": 375, \"value\": 1.975, \"cpu_s\": 1}, "
    "{\"label\": \"<x-c>\", \"tets\": 384, \"dofs\": 2187, \"value\": 2.0, \"cpu_s\": 9}], "
    "\"attempts\": [{\"label\": \"a\", \"tets\": 6, \"dofs\": 81, \"value\": 1.9, \"cpu_s\": 0.1, "
    "\"status\": \"done\", \"reason\": null, \"id\": \"<x-i>\"}, {\"label\": \"t\", "
    "\"value\": null, \"status\": \"failed\", \"reason\": \"<x-r>\"}, 3], "
    "\"cpu_s\": 10.1, \"overhead\": 1.12}";

static char *page_of(const char *dir) {
  assert_ok(report_write(dir, in(dir, "report.html")));
  return slurp(in(dir, "report.html"), NULL);
}

static int count(const char *page, const char *text) {
  int n = 0;
  for (const char *s = page; (s = strstr(s, text)); s++) n++;
  return n;
}

static void assert_count(const char *page, const char *text, int n) {
  if (count(page, text) != n) fail_msg("the page has %d times: %s", count(page, text), text);
}

static void the_page_shows_why(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "solve.json"), solved);
  char *page = page_of(dir);
  static const char *const ids[] = {"answer", "mesh", "parts", "attempts"};
  for (int i = 0; i < 4; i++) {
    char section[64];
    snprintf(section, sizeof section, "<section id=\"%s\">", ids[i]);
    assert_count(page, section, 1);
  }
  assert_count(page, "<p class=\"outcome good\"><b>met</b>", 1);
  assert_count(page, " = 2 &lt;x-u&gt;, between 1.98 and 2.02 (± 1 %; 2 % asked)", 1);
  assert_count(page, "\"interval\":[1.98,2.02]", 1);
  assert_count(page, "\"name\":\"extrapolated limit\"", 1);
  /* a half of what is allowed, in the row of space and in that of all; of an equilibrium no time,
     of no window no tail */
  assert_count(page, "<div style=\"width:50.0%\"></div>50 %</td>", 2);
  assert_count(page, "&lt; 0.1 %", 1);
  assert_count(page, "<th scope=\"row\">time</th>", 0);
  assert_count(page, "<th scope=\"row\">tail</th>", 0);
  assert_count(page, "does not count", 1);
  /* what the runs are for */
  assert_count(page, "<td>mesh 1, space, algebra</td>", 1);
  assert_count(page, "failed: &lt;x-r&gt;", 1);
  free(page);
  remove_folder(dir);
}

static void text_of_the_file_is_never_markup(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "solve.json"), solved);
  char *page = page_of(dir);
  assert_count(page, "<x-", 0);
  assert_count(page, "<figure ", 1);
  assert_count(page, "<script", 2); /* the chart's data, and what draws it */
  assert_count(page, "</script>", 2);
  free(page);
  remove_folder(dir);
}

/* Nothing is said of what is not known. */
static void what_is_not_known_is_left_out(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "solve.json"), "{}");
  char *page = page_of(dir);
  assert_count(page, "<section", 1);
  assert_count(page, "not found", 1);
  free(page);
  /* one mesh, of which no one knows how wrong it is */
  put_file(
      in(dir, "solve.json"),
      "{\"goal\": \"g\", \"value\": 3.0, \"low\": null, \"high\": null, \"within\": 0.1, "
      "\"within_abs\": true, \"met\": false, \"why_not\": \"because\", \"allowed\": 0.1, "
      "\"half\": {\"space\": null, \"time\": 0.3}, \"levels\": [{\"dofs\": 9, \"value\": 3}]}");
  page = page_of(dir);
  assert_count(page, "g = 3, and its error is not known (0.1 asked)", 1);
  assert_count(page, "\"interval\":", 0);
  assert_count(page, "extrapolated limit\"", 0);
  assert_count(page, "no: because", 1);
  assert_count(page, "</div>300 %</td>", 1); /* three times what is allowed, the longest bar */
  assert_count(page, "width:100.0%", 1);
  assert_count(page, "nan", count(page, "nance")); /* none of them printed */
  free(page);
  remove_folder(dir);
}

static void the_answer_has_the_digits_that_make_sense(void **state) {
  (void)state;
  static const struct {
    const char *json, *answer;
  } is[] = {
      {"{\"goal\": \"g\", \"unit\": \"m\", \"value\": 0.123456789, \"low\": 0.122456789, "
       "\"high\": 0.124456789, \"within\": 0.01}",
       "g = 0.12346 m, between 0.12246 and 0.12446 (+- 0.81 %; 1 % asked)"},
      {"{\"goal\": \"g\", \"unit\": \"m\", \"value\": 1.0, \"low\": -1.0, \"high\": 3.0, "
       "\"within\": 0.5, \"within_abs\": true}",
       "g = 1 m, between -1 and 3 (+- 2 m; 0.5 m asked)"},
      {"{\"goal\": \"g\", \"value\": 0.0, \"low\": -0.25, \"high\": 0.25, \"within\": 1, "
       "\"within_abs\": true}",
       "g = 0, between -0.25 and 0.25 (+- 0.25; 1 asked)"},
      {"{\"goal\": \"g\", \"value\": 2.0, \"low\": 2.0, \"high\": 2.0, \"within\": 0.01}",
       "g = 2, between 2 and 2 (+- 0 %; 1 % asked)"},
      {"{\"goal\": \"g\", \"value\": null}", "g: not found"},
  };
  for (size_t i = 0; i < sizeof is / sizeof *is; i++) {
    char answer[GOAL_ANSWER_SIZE];
    json_t *json = json_loads(is[i].json, 0, NULL);
    assert_non_null(json);
    goal_answer(json, "+-", answer);
    assert_string_equal(answer, is[i].answer);
    json_decref(json);
  }
}

/* Whatever one byte of the file is, there is a page or a message. */
static void a_damaged_file_does_no_harm(void **state) {
  (void)state;
  char *dir = temporary_folder(), *bad = malloc(sizeof solved);
  assert_non_null(bad);
  srand(11);
  for (int trial = 0; trial < 300; trial++) {
    memcpy(bad, solved, sizeof solved);
    size_t at = (size_t)rand() % (sizeof solved - 1);
    bad[at] = (char)(trial % 7 ? 1 + rand() % 255 : 0);
    put_file(in(dir, "solve.json"), bad);
    corot_status status = report_write(dir, in(dir, "report.html"));
    assert_true(status == COROT_OK || status == COROT_EFORMAT);
  }
  free(bad);
  remove_folder(dir);
}

static corot_status write_report(void *dir) { return report_write(dir, in(dir, "report.html")); }

static void failed_allocations_are_survived(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "solve.json"), solved);
  assert_above((double)assert_survives_failed_allocations(write_report, dir), 10);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_page_shows_why),
      cmocka_unit_test(text_of_the_file_is_never_markup),
      cmocka_unit_test(what_is_not_known_is_left_out),
      cmocka_unit_test(the_answer_has_the_digits_that_make_sense),
      cmocka_unit_test(a_damaged_file_does_no_harm),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
