/* Bytes of a state: what is written is read, and nothing else. */
#include "core/base/pack.h"

#include "alloc.h"
#include "check.h"

static const char words[] = "of a length that the reader does not know";

typedef struct thing {
  double a, many[3];
  long b;
  int c;
  bool d;
} thing;

static void exchange(pack *p, thing *x) {
  corot_pack_same(p, 7, "the kind");
  corot_pack_double(p, &x->a);
  corot_pack_doubles(p, x->many, 3);
  corot_pack_long(p, &x->b);
  corot_pack_int(p, &x->c);
  const void *block = words;
  size_t bytes = sizeof words;
  corot_pack_block(p, &block, &bytes);
  if (p->reading && !p->status) {
    assert_int_equal(bytes, sizeof words);
    assert_memory_equal(block, words, bytes);
  }
  corot_pack_bool(p, &x->d);
}

static const thing some = {-0.0, {NAN, INFINITY, 5e-324}, -(1L << 40), -3, true};

static void what_is_written_is_read(void **state) {
  (void)state;
  thing x = some, y = {0};
  pack p = {0};
  exchange(&p, &x);
  assert_ok(corot_pack_status(&p));
  pack q = corot_pack_reader(p.data, p.bytes);
  exchange(&q, &y);
  assert_ok(corot_pack_status(&q));
  assert_int_equal(corot_pack_left(&q), 0);
  assert_memory_equal(&x.a, &y.a, sizeof x.a);
  assert_memory_equal(x.many, y.many, sizeof x.many);
  assert_true(x.b == y.b && x.c == y.c && x.d == y.d);
  corot_pack_clear(&p);
  corot_pack_clear(&q);
}

/* From the place on where there is nothing to read, nothing changes. */
static void what_is_cut_short_is_told(void **state) {
  (void)state;
  thing x = some;
  pack p = {0};
  exchange(&p, &x);
  for (size_t k = 0; k < p.bytes; k++) {
    thing y = {0};
    pack q = corot_pack_reader(p.data, k);
    exchange(&q, &y);
    assert_fails(corot_pack_status(&q), COROT_EINVAL, "cut short");
    assert_false(y.d);
  }
  corot_pack_clear(&p);
}

static void another_number_than_the_known_one_is_told(void **state) {
  (void)state;
  thing x = some;
  pack p = {0};
  corot_pack_same(&p, 8, "the kind");
  exchange(&p, &x);
  pack q = corot_pack_reader(p.data, p.bytes);
  exchange(&q, &x);
  assert_fails(corot_pack_status(&q), COROT_EINVAL, "the kind is 8, not 7");
  corot_pack_clear(&p);
}

static corot_status write_much(void *context) {
  (void)context;
  pack p = {0};
  for (int k = 0; k < 1000; k++) {
    thing x = some;
    exchange(&p, &x);
  }
  corot_status status = corot_pack_status(&p);
  corot_pack_clear(&p);
  return status;
}

static void want_of_memory_is_told(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(write_much, NULL) < 20);
}

/* Values of the FNV-1a of 64 bits that its authors publish. */
static void the_checksum_is_the_known_one(void **state) {
  (void)state;
  assert_true(corot_checksum(COROT_CHECKSUM, "", 0) == UINT64_C(0xcbf29ce484222325));
  assert_true(corot_checksum(COROT_CHECKSUM, "a", 1) == UINT64_C(0xaf63dc4c8601ec8c));
  assert_true(corot_checksum(COROT_CHECKSUM, "foobar", 6) == UINT64_C(0x85944171f73967e8));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_written_is_read),
      cmocka_unit_test(what_is_cut_short_is_told),
      cmocka_unit_test(another_number_than_the_known_one_is_told),
      cmocka_unit_test(want_of_memory_is_told),
      cmocka_unit_test(the_checksum_is_the_known_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
