/* states.bin: what is written is read to the last bit, and what is damaged is refused. */
#include "alloc.h"
#include "app/folder/folder.h"
#include "app/folder/states.h"
#include "bar.h"
#include "temporary.h"

enum { MOMENTS = 3 };

static void write_states(const bar *b, const char *dir) {
  state_writer *w = NULL;
  assert_ok(states_create(dir, b->model, &w));
  for (int k = 0; k < MOMENTS; k++) {
    for (int i = 0; i < b->n; i++) b->u[i] = sin(i + k) / 3, b->v[i] = -cos(i * k) * 1e-300;
    assert_ok(states_add(w, 0.1 * k, b->u, b->v));
  }
  assert_ok(states_close(w));
}

static void as_written(void **state) {
  (void)state;
  char *dir = temporary_folder();
  bar b = bar_create(&example2);
  trajectory t;
  write_states(&b, dir);
  assert_ok(states_read(dir, &t));
  assert_int_equal(t.n, b.n);
  assert_int_equal(t.count, MOMENTS);
  const int(*dof)[3] = corot_model_dof(b.model);
  for (int i = 0; i < t.n; i++) assert_int_equal(dof[t.place[i] / 3][t.place[i] % 3], i);
  for (int k = 0; k < t.count; k++) {
    assert_close(states_t(&t, k), 0.1 * k, 0, 0);
    for (int i = 0; i < t.n; i++) {
      assert_close(states_u(&t, k)[i], sin(i + k) / 3, 0, 0);
      assert_close(states_v(&t, k)[i], -cos(i * k) * 1e-300, 0, 0);
    }
  }
  states_free(&t);
  bar_destroy(&b);
  remove_folder(dir);
}

static void put_bytes(const char *path, const char *data, size_t size) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
}

/* A program that is killed leaves a piece of a record. */
static void a_cut_record_is_dropped(void **state) {
  (void)state;
  char *dir = temporary_folder();
  bar b = bar_create(&example2);
  write_states(&b, dir);
  size_t size, record = (1 + 2 * (size_t)b.n) * sizeof(double);
  char *text = slurp(in(dir, "states.bin"), &size);
  for (size_t less = 1; less < 3 * record; less += 97) {
    trajectory t;
    put_bytes(in(dir, "states.bin"), text, size - less);
    assert_ok(states_read(dir, &t));
    assert_int_equal(t.count, MOMENTS - (less + record - 1) / record);
    states_free(&t);
  }
  size_t head = size - MOMENTS * record;
  for (size_t left = 0; left < head; left += 7) {
    trajectory t;
    put_bytes(in(dir, "states.bin"), text, left);
    assert_fails(states_read(dir, &t), COROT_EFORMAT, "states.bin: ");
  }
  free(text);
  bar_destroy(&b);
  remove_folder(dir);
}

static void damage_is_refused(void **state) {
  (void)state;
  char *dir = temporary_folder();
  bar b = bar_create(&example2);
  write_states(&b, dir);
  size_t size, record = (1 + 2 * (size_t)b.n) * sizeof(double);
  char *text = slurp(in(dir, "states.bin"), &size);
  size_t first = size - MOMENTS * record;
  const struct {
    size_t at;
    unsigned char byte;
    const char *words;
  } damage[] = {
      {0, 'x', "not a file of states"},      {8, 2, "version 2"},
      {12, 1, "another byte order"},         {23, 0x80, "degrees of freedom in"},
      {18, 1, "degrees of freedom in"},      {24 + 4, 0, "out of order"},
      {first + 16 + 7, 0x7f, "number 2 is"}, {first + 2 * record + 7, 0xbf, "follows"},
  };
  for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
    trajectory t;
    char kept = text[damage[i].at], next = text[damage[i].at - (damage[i].byte == 0x7f)];
    text[damage[i].at] = (char)damage[i].byte;
    if (damage[i].byte == 0x7f) text[damage[i].at - 1] = (char)0xf0; /* an infinity, or no number */
    put_bytes(in(dir, "states.bin"), text, size);
    assert_fails(states_read(dir, &t), COROT_EFORMAT, damage[i].words);
    if (damage[i].byte == 0x7f) text[damage[i].at - 1] = next;
    text[damage[i].at] = kept;
  }
  free(text);
  trajectory t;
  assert_fails(states_read(in(dir, "none"), &t), COROT_EIO, "none/states.bin: cannot open it");
  bar_destroy(&b);
  remove_folder(dir);
}

typedef struct both {
  const bar *b;
  const char *dir;
} both;

static corot_status write_once(void *context) {
  const both *c = context;
  state_writer *w = NULL;
  COROT_TRY(states_create(c->dir, c->b->model, &w));
  corot_status status = states_add(w, 0, c->b->u, c->b->v);
  states_close(w);
  return status;
}

static corot_status read_once(void *context) {
  const both *c = context;
  trajectory t;
  COROT_TRY(states_read(c->dir, &t));
  states_free(&t);
  return COROT_OK;
}

static void failed_allocations(void **state) {
  (void)state;
  char *dir = temporary_folder();
  bar b = bar_create(&example2);
  both c = {&b, dir};
  assert_survives_failed_allocations(write_once, &c);
  assert_survives_failed_allocations(read_once, &c);
  bar_destroy(&b);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(as_written),
      cmocka_unit_test(a_cut_record_is_dropped),
      cmocka_unit_test(damage_is_refused),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
