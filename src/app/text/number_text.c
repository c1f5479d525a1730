/* The seventeen digits of x are the whole number nearest to x 10^p, p = 16 - floor(log10 |x|). The
   power is the product of two of 64 bits, 10^r exact and 10^(27 q) rounded, which leaves a relative
   error of at most 2^-62; with the product's own, 10^17 times that is less than 1/32. So where the
   fraction is further than that from one half the number is known, and elsewhere, one time in
   sixteen, printf is asked. */
#include "number_text.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* value 2^exponent, the value's highest bit set. */
typedef struct scaled {
  uint64_t value;
  int exponent;
} scaled;

enum { SPAN = 27, LOWEST = -12, HIGHEST = 12 }; /* 10^27 = 5^27 2^27, and 5^27 < 2^63 */

/* 10^(27 q), rounded. */
static const scaled far_powers[HIGHEST - LOWEST + 1] = {
    {0xcf42894a5dce35eau, -1140}, {0xa76c582338ed2622u, -1050}, {0x873e4f75e2224e68u, -960},
    {0xda7f5bf590966849u, -871},  {0xb080392cc4349dedu, -781},  {0x8e938662882af53eu, -691},
    {0xe65829b3046b0afau, -602},  {0xba121a4650e4ddecu, -512},  {0x964e858c91ba2655u, -422},
    {0xf2d56790ab41c2a3u, -333},  {0xc428d05aa4751e4du, -243},  {0x9e74d1b791e07e48u, -153},
    {0x8000000000000000u, -63},   {0xcecb8f27f4200f3au, 26},    {0xa70c3c40a64e6c52u, 116},
    {0x86f0ac99b4e8dafdu, 206},   {0xda01ee641a708deau, 295},   {0xb01ae745b101e9e4u, 385},
    {0x8e41ade9fbebc27du, 475},   {0xe5d3ef282a242e82u, 564},   {0xb9a74a0637ce2ee1u, 654},
    {0x95f83d0a1fb69cd9u, 744},   {0xf24a01a73cf2dcd0u, 833},   {0xc3b8358109e84f07u, 923},
    {0x9e19db92b4e31ba9u, 1013},
};

/* 10^r = 5^r 2^r, exact. */
static const scaled near_powers[SPAN] = {
    {0x8000000000000000u, -63}, {0xa000000000000000u, -60}, {0xc800000000000000u, -57},
    {0xfa00000000000000u, -54}, {0x9c40000000000000u, -50}, {0xc350000000000000u, -47},
    {0xf424000000000000u, -44}, {0x9896800000000000u, -40}, {0xbebc200000000000u, -37},
    {0xee6b280000000000u, -34}, {0x9502f90000000000u, -30}, {0xba43b74000000000u, -27},
    {0xe8d4a51000000000u, -24}, {0x9184e72a00000000u, -20}, {0xb5e620f480000000u, -17},
    {0xe35fa931a0000000u, -14}, {0x8e1bc9bf04000000u, -10}, {0xb1a2bc2ec5000000u, -7},
    {0xde0b6b3a76400000u, -4},  {0x8ac7230489e80000u, 0},   {0xad78ebc5ac620000u, 3},
    {0xd8d726b7177a8000u, 6},   {0x878678326eac9000u, 10},  {0xa968163f0a57b400u, 13},
    {0xd3c21bcecceda100u, 16},  {0x84595161401484a0u, 20},  {0xa56fa5b99019a5c8u, 23},
};

/* The product's upper and lower 64 bits. */
static uint64_t multiply(uint64_t a, uint64_t b, uint64_t *low) {
  uint64_t a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
  uint64_t p00 = a0 * b0, p01 = a0 * b1, p10 = a1 * b0, p11 = a1 * b1;
  uint64_t middle = p10 + (p00 >> 32) + (p01 & 0xffffffffu);
  *low = (middle << 32) | (p00 & 0xffffffffu);
  return p11 + (p01 >> 32) + (middle >> 32);
}

static scaled product(scaled a, scaled b) {
  uint64_t low, high = multiply(a.value, b.value, &low);
  int exponent = a.exponent + b.exponent + 64;
  if (high >> 63) return (scaled){high, exponent};
  return (scaled){high << 1 | low >> 63, exponent - 1};
}

/* x 10^p, cut; `fraction` is what was cut off, in 2^-64. */
static uint64_t whole_part(scaled x, int p, uint64_t *fraction) {
  int q = p >= 0 ? p / SPAN : -((SPAN - 1 - p) / SPAN);
  scaled power = product(near_powers[p - q * SPAN], far_powers[q - LOWEST]);
  uint64_t low, high = multiply(x.value, power.value, &low);
  int shift = -(x.exponent + power.exponent + 64); /* 5 to 11 */
  *fraction = high << (64 - shift) | low >> shift;
  return high >> shift;
}

static const uint64_t LEAST = 10000000000000000u, BEYOND = 100000000000000000u; /* 17 digits */

/* The digits of a positive normal number, and its power of ten; false: not known. */
static bool find_digits(scaled x, uint64_t *digits, int *power) {
  const uint64_t half = (uint64_t)1 << 63, near = half / 16;
  int k = (int)(((int64_t)(x.exponent + 63) * 1292913986) >> 32); /* log10(2) 2^32, floor */
  uint64_t fraction, d = whole_part(x, 16 - k, &fraction);
  if (d >= BEYOND) d = whole_part(x, 16 - ++k, &fraction);
  if (d < LEAST) d = whole_part(x, 16 - --k, &fraction);
  if (fraction - (half - near) < 2 * near) return false;
  d += fraction >> 63;
  if (d == BEYOND) d = LEAST, k++;
  *digits = d, *power = k;
  return true;
}

/* Without trailing zeros; returns how many are left, at least one. */
static int write_digits(uint64_t d, char digit[17]) {
  for (int i = 16; i >= 0; i--, d /= 10) digit[i] = (char)('0' + d % 10);
  int n = 17;
  while (n > 1 && digit[n - 1] == '0') n--;
  return n;
}

static char *put(char *to, const char *from, int n) {
  memcpy(to, from, (size_t)n);
  return to + n;
}

/* 1.25e-07 */
static char *put_exponential(char *c, const char *digit, int n, int k) {
  *c++ = digit[0];
  if (n > 1) *c++ = '.', c = put(c, digit + 1, n - 1);
  *c++ = 'e';
  *c++ = k < 0 ? '-' : '+';
  if (k < 0) k = -k;
  if (k >= 100) *c++ = (char)('0' + k / 100);
  *c++ = (char)('0' + k / 10 % 10);
  *c++ = (char)('0' + k % 10);
  return c;
}

/* 0.00125, 12.5, 1250 */
static char *put_fixed(char *c, const char *digit, int n, int k) {
  if (k < 0) {
    c = put(c, "0.000", 1 - k);
    return put(c, digit, n);
  }
  int before = n < k + 1 ? n : k + 1;
  c = put(c, digit, before);
  for (int i = before; i < k + 1; i++) *c++ = '0';
  if (n > before) *c++ = '.', c = put(c, digit + before, n - before);
  return c;
}

size_t number_text(double x, char text[NUMBER_TEXT]) {
  uint64_t bits, digits;
  memcpy(&bits, &x, sizeof bits);
  int exponent = (int)(bits >> 52 & 0x7ff), k;
  char *c = text, digit[17];
  if (bits >> 63) *c++ = '-';
  if (bits << 1 == 0) {
    *c++ = '0';
  } else {
    scaled s = {(uint64_t)1 << 63 | bits << 11, exponent - 1023 - 63};
    bool normal = exponent > 0 && exponent < 0x7ff;
    if (!normal || !find_digits(s, &digits, &k))
      return (size_t)snprintf(text, NUMBER_TEXT, "%.17g", x);
    int n = write_digits(digits, digit);
    c = k < -4 || k >= 17 ? put_exponential(c, digit, n, k) : put_fixed(c, digit, n, k);
  }
  *c = '\0';
  return (size_t)(c - text);
}
