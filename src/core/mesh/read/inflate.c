/* Inflation: blocks of literals and of references to what has come before, in Huffman codes. A code
   of n bits is decoded by counting, bit by bit, how many codes are shorter (RFC 1951, 3.2.2). */
#include "inflate.h"

#include <stdint.h>
#include <string.h>

enum { BITS_MAX = 15, LENGTHS = 286, DISTANCES = 30, FIXED_LENGTHS = 288 };

typedef struct stream {
  const unsigned char *from, *end;
  unsigned char *to;
  size_t n, room; /* bytes made, and to be made */
  uint32_t bits;  /* that are left of a byte, the next the lowest */
  int nbit;
  bool bad;
} stream;

/* count [length] codes of each length, and their symbols in the order of the codes. */
typedef struct code {
  uint16_t count[BITS_MAX + 1], symbol[FIXED_LENGTHS];
} code;

/* The next n <= 16 bits, the first the lowest. */
static unsigned take(stream *s, int n) {
  while (s->nbit < n) {
    if (s->from == s->end) {
      s->bad = true;
      return 0;
    }
    s->bits |= (uint32_t)*s->from++ << s->nbit;
    s->nbit += 8;
  }
  unsigned value = s->bits & ((1u << n) - 1);
  s->bits >>= n;
  s->nbit -= n;
  return value;
}

/* The code in which symbol i has length [i] bits, 0: none. */
static void make_code(code *c, const uint8_t *length, int n, bool *bad) {
  uint16_t place[BITS_MAX + 2] = {0};
  int left = 1;
  memset(c->count, 0, sizeof c->count);
  for (int i = 0; i < n; i++) c->count[length[i]]++;
  for (int k = 1; k <= BITS_MAX; k++) {
    left = 2 * left - c->count[k];
    if (left < 0) *bad = true; /* more codes than there is room for */
    place[k + 1] = (uint16_t)(place[k] + c->count[k]);
  }
  if (*bad) return;
  for (int i = 0; i < n; i++)
    if (length[i]) c->symbol[place[length[i]]++] = (uint16_t)i;
  c->count[0] = 0;
}

static int decode(stream *s, const code *c) {
  int value = 0, first = 0, place = 0;
  for (int k = 1; k <= BITS_MAX && !s->bad; k++) {
    value |= (int)take(s, 1);
    int count = c->count[k];
    if (value - first < count) return c->symbol[place + value - first];
    place += count;
    first = (first + count) << 1;
    value <<= 1;
  }
  s->bad = true;
  return 0;
}

static void put(stream *s, unsigned char byte) {
  if (s->n == s->room)
    s->bad = true;
  else
    s->to[s->n++] = byte;
}

/* Copies `length` bytes from `distance` before; what is copied may overlap. */
static void repeat(stream *s, size_t length, size_t distance) {
  if (distance > s->n || length > s->room - s->n) {
    s->bad = true;
    return;
  }
  for (size_t i = 0; i < length; i++, s->n++) s->to[s->n] = s->to[s->n - distance];
}

/* Literals and references up to the end of the block. */
static void read_symbols(stream *s, const code *lengths, const code *distances) {
  static const uint16_t length[29] = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                      15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                      67, 83, 99, 115, 131, 163, 195, 227, 258};
  static const uint8_t length_bits[29] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                          2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
  static const uint16_t distance[30] = {
      1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
      193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
  for (;;) {
    int symbol = decode(s, lengths);
    if (s->bad || symbol == 256) return;
    if (symbol < 256) {
      put(s, (unsigned char)symbol);
      continue;
    }
    int k = symbol - 257;
    if (k >= 29) {
      s->bad = true;
      return;
    }
    size_t n = length[k] + take(s, length_bits[k]);
    int d = decode(s, distances);
    if (s->bad || d >= DISTANCES) {
      s->bad = true;
      return;
    }
    repeat(s, n, distance[d] + take(s, d < 2 ? 0 : d / 2 - 1));
  }
}

static void read_stored(stream *s) {
  s->bits = 0;
  s->nbit = 0;
  unsigned n = take(s, 16), check = take(s, 16);
  if (s->bad || n != (~check & 0xffff) || (size_t)(s->end - s->from) < n || n > s->room - s->n) {
    s->bad = true;
    return;
  }
  memcpy(s->to + s->n, s->from, n);
  s->from += n;
  s->n += n;
}

static void read_fixed(stream *s) {
  uint8_t length[FIXED_LENGTHS];
  code lengths, distances;
  for (int i = 0; i < FIXED_LENGTHS; i++)
    length[i] = (uint8_t)(i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8);
  make_code(&lengths, length, FIXED_LENGTHS, &s->bad);
  for (int i = 0; i < DISTANCES; i++) length[i] = 5;
  make_code(&distances, length, DISTANCES, &s->bad);
  read_symbols(s, &lengths, &distances);
}

/* Lengths of codes, themselves in a code, in which 16 to 18 are repetitions. */
static void read_lengths(stream *s, const code *c, uint8_t *length, int n) {
  for (int i = 0; i < n && !s->bad;) {
    int symbol = decode(s, c), times;
    uint8_t value = 0;
    if (symbol < 16) {
      length[i++] = (uint8_t)symbol;
      continue;
    }
    if (symbol == 16 && i == 0) s->bad = true;
    if (symbol == 16 && i > 0) value = length[i - 1];
    times = symbol == 16   ? 3 + (int)take(s, 2)
            : symbol == 17 ? 3 + (int)take(s, 3)
                           : 11 + (int)take(s, 7);
    if (times > n - i) s->bad = true;
    for (; times > 0 && !s->bad; times--) length[i++] = value;
  }
}

static void read_dynamic(stream *s) {
  static const uint8_t order[19] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                    11, 4,  12, 3, 13, 2, 14, 1, 15};
  uint8_t length[LENGTHS + DISTANCES + 2] = {0};
  code c, distances;
  int nlength = 257 + (int)take(s, 5), ndistance = 1 + (int)take(s, 5), n = 4 + (int)take(s, 4);
  if (s->bad || nlength > LENGTHS || ndistance > DISTANCES) {
    s->bad = true;
    return;
  }
  for (int i = 0; i < n; i++) length[order[i]] = (uint8_t)take(s, 3);
  make_code(&c, length, 19, &s->bad);
  memset(length, 0, sizeof length);
  if (!s->bad) read_lengths(s, &c, length, nlength + ndistance);
  if (s->bad) return;
  make_code(&c, length, nlength, &s->bad);
  make_code(&distances, length + nlength, ndistance, &s->bad);
  if (!s->bad) read_symbols(s, &c, &distances);
}

static uint32_t adler(const unsigned char *p, size_t n) {
  uint32_t a = 1, b = 0;
  for (size_t i = 0; i < n; i++) {
    a = (a + p[i]) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

bool corot_inflate(const unsigned char *from, size_t nfrom, unsigned char *to, size_t nto) {
  if (nfrom < 6) return false;
  stream s = {.from = from + 2, .end = from + nfrom - 4, .to = to, .room = nto};
  const unsigned char *sum = s.end;
  if ((from[0] & 15) != 8 || (256 * from[0] + from[1]) % 31 != 0 || from[1] & 32) return false;
  for (bool last = false; !last && !s.bad;) {
    last = take(&s, 1);
    switch (take(&s, 2)) {
      case 0:
        read_stored(&s);
        break;
      case 1:
        read_fixed(&s);
        break;
      case 2:
        read_dynamic(&s);
        break;
      default:
        s.bad = true;
    }
  }
  uint32_t wanted =
      (uint32_t)sum[0] << 24 | (uint32_t)sum[1] << 16 | (uint32_t)sum[2] << 8 | sum[3];
  return !s.bad && s.n == nto && adler(to, nto) == wanted;
}
