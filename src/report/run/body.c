/* Surface, moments and fields, each cut down to what a page can carry. */
#include "body.h"

#include <corot/model.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "conditions.h"
#include "core/lanes/polar.h"
#include "report/page/encode.h"
#include "report/page/html.h"
#include "report/read/lookup.h"
#include "report/read/surface.h"

/* What is known of each frame, by node or by triangle of the surface. */
enum { UX, UY, UZ, SPEED, VON_MISES, TURN, DRIFT, VOLUME, NVALUE };

static const struct {
  const char *name, *unit;
  bool nodal;
  double centre; /* what the colours part at; NAN: they go from low to high */
} about[NVALUE] = {
    [UX] = {"ux", "m", true, NAN},
    [UY] = {"uy", "m", true, NAN},
    [UZ] = {"uz", "m", true, NAN},
    [SPEED] = {"speed", "m/s", true, NAN},
    [VON_MISES] = {"von Mises stress", "Pa", false, NAN},
    [TURN] = {"rotation", "degree", false, NAN},
    [DRIFT] = {"drift of the frame", "degree", false, NAN},
    [VOLUME] = {"volume over rest volume", "1", false, 1},
};

typedef struct body {
  const run_folder *run;
  const fields *f;
  surface s;
  fields_frame frame;   /* the one being read */
  double (*inverse)[9]; /* [ntri] of the matrix of rest edges of the triangle's tet */
  int nshown;
  double *t;             /* [nshown] */
  double *value[NVALUE]; /* [nshown][nodes or triangles] */
} body;

static void body_free(body *b) {
  surface_free(&b->s);
  fields_frame_free(&b->frame);
  free(b->inverse);
  free(b->t);
  for (int k = 0; k < NVALUE; k++) free(b->value[k]);
}

static size_t count(const body *b, int k) {
  return (size_t)(about[k].nodal ? b->s.nnode : b->s.ntri);
}

/* m = the edges of a tet as columns, row-major. */
static void edges(const double (*x)[3], const int tet[4], double m[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[3 * i + j] = x[tet[j + 1]][i] - x[tet[0]][i];
}

static void invert(const double m[9], double inverse[9]) {
  double c[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      c[3 * j + i] = m[3 * p + r] * m[3 * q + s] - m[3 * p + s] * m[3 * q + r];
    }
  double det = m[0] * c[0] + m[1] * c[3] + m[2] * c[6];
  for (int k = 0; k < 9; k++) inverse[k] = c[k] / det;
}

/* F = I + du/dX of a triangle's tet. */
static void gradient(const body *b, int i, double F[9]) {
  double du[9];
  edges((const double(*)[3])b->frame.displacement, b->f->tet[b->s.tet[i]], du);
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      F[3 * r + c] = r == c;
      for (int k = 0; k < 3; k++) F[3 * r + c] += du[3 * r + k] * b->inverse[i][3 * k + c];
    }
}

/* Between two rotations, in degrees: |A - B| = 2 sqrt(2) sin(angle / 2). */
static double angle(const double A[9], const double B[9]) {
  double sum = 0;
  for (int k = 0; k < 9; k++) sum += (A[k] - B[k]) * (A[k] - B[k]);
  return 360 / 3.14159265358979323846 * asin(fmin(1, sqrt(sum / 8)));
}

static void take_triangle(body *b, size_t at, int i) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double F[9], R[9];
  int e = b->s.tet[i];
  gradient(b, i, F);
  bool turned = corot_polar(F, R) == COROT_OK; /* an inverted tet has no rotation */
  b->value[VON_MISES][at] = b->frame.von_mises[e];
  b->value[VOLUME][at] = b->frame.det[e];
  b->value[TURN][at] = turned ? angle(R, identity) : NAN;
  b->value[DRIFT][at] = turned ? angle(R, b->frame.frame[e]) : NAN;
}

static void take_frame(body *b, int k) {
  for (int i = 0; i < b->s.nnode; i++) {
    size_t at = (size_t)k * (size_t)b->s.nnode + (size_t)i;
    const double *u = b->frame.displacement[b->s.node[i]], *v = b->frame.velocity[b->s.node[i]];
    for (int c = 0; c < 3; c++) b->value[UX + c][at] = u[c];
    b->value[SPEED][at] = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  for (int i = 0; i < b->s.ntri; i++)
    take_triangle(b, (size_t)k * (size_t)b->s.ntri + (size_t)i, i);
}

static int stride_of(const body *b) {
  size_t bytes = 0;
  for (int k = 0; k < NVALUE; k++) bytes += sizeof(uint16_t) * count(b, k);
  int most = (int)fmax(2, floor((double)BODY_BYTES / (double)bytes));
  return (b->f->nframe + most - 1) / most;
}

static corot_status take_frames(body *b, int stride) {
  int last = b->f->nframe - 1, n = last / stride + 1 + (last % stride > 0);
  bool complete = (b->t = malloc((size_t)n * sizeof *b->t));
  for (int k = 0; k < NVALUE && complete; k++)
    complete = (b->value[k] = malloc((size_t)n * count(b, k) * sizeof(double)));
  if (!complete) return corot_fail(COROT_ENOMEM, "the fields of %d frames: out of memory", n);
  for (; b->nshown < n; b->nshown++) {
    int i = b->nshown * stride < last ? b->nshown * stride : last;
    COROT_TRY(fields_read(b->f, i, &b->frame));
    b->t[b->nshown] = b->f->t[i];
    take_frame(b, b->nshown);
  }
  return COROT_OK;
}

static corot_status prepare(body *b) {
  const fields *f = b->f;
  COROT_TRY(surface_create(f->nnode, f->ntet, (const int(*)[4])f->tet, &b->s));
  COROT_TRY(fields_frame_create(f, &b->frame));
  b->inverse = malloc((size_t)b->s.ntri * sizeof *b->inverse);
  if (!b->inverse) return corot_fail(COROT_ENOMEM, "the surface's tets: out of memory");
  for (int i = 0; i < b->s.ntri; i++) {
    double m[9];
    edges((const double(*)[3])f->x, f->tet[b->s.tet[i]], m);
    invert(m, b->inverse[i]);
  }
  return COROT_OK;
}

/* Of the numbers there are; 0 to 0 where there are none. */
static void range(size_t n, const double *x, double *low, double *high) {
  *low = INFINITY, *high = -INFINITY;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(x[i])) continue;
    *low = fmin(*low, x[i]);
    *high = fmax(*high, x[i]);
  }
  if (!(*low <= *high)) *low = *high = 0;
}

/* {"low":, "step":, "q": base64}: x = low + step q, to half a step. What is no number is low. */
static corot_status write_steps(size_t n, const double *x, FILE *out) {
  double low, high;
  range(n, x, &low, &high);
  double step = (high - low) / 65535;
  uint16_t *q = malloc((n + 1) * sizeof *q);
  if (!q) return corot_fail(COROT_ENOMEM, "%zu numbers of the body: out of memory", n);
  for (size_t i = 0; i < n; i++)
    q[i] = step > 0 && isfinite(x[i]) ? (uint16_t)((x[i] - low) / step + 0.5) : 0;
  fputs("{\"low\":", out);
  encode_number(low, out);
  fputs(",\"step\":", out);
  encode_number(step, out);
  fputs(",\"q\":", out);
  encode_words(n, q, out);
  fputc('}', out);
  free(q);
  return COROT_OK;
}

static void write_geometry(const body *b, FILE *out) {
  const surface *s = &b->s;
  fprintf(out, "{\"nodes\":%d,\"triangles\":%d,\"rest\":[", s->nnode, s->ntri);
  for (int i = 0; i < s->nnode; i++) {
    const double *x = b->f->x[s->node[i]];
    fprintf(out, "%s%.8g,%.8g,%.8g", i ? "," : "", x[0], x[1], x[2]);
  }
  fputs("],\"corners\":[", out);
  for (int i = 0; i < s->ntri; i++)
    fprintf(out, "%s%d,%d,%d", i ? "," : "", s->corner[i][0], s->corner[i][1], s->corner[i][2]);
  fputs("],\"clock\":", out);
  encode_text(run_folder_is_static(b->run) ? "load factor" : "t", out);
}

/* When the frames are: times, or the load factors of equilibria. */
static corot_status write_moments(const body *b, FILE *out) {
  double *moment = malloc(((size_t)b->nshown + 1) * sizeof *moment), unit = run_folder_unit(b->run);
  if (!moment) return corot_fail(COROT_ENOMEM, "%d frames: out of memory", b->nshown);
  for (int k = 0; k < b->nshown; k++) moment[k] = b->t[k] / unit;
  fputs(",\"t\":", out);
  encode_doubles((size_t)b->nshown, moment, out);
  free(moment);
  return COROT_OK;
}

/* Whether there is something to colour by: rounding is not. */
static bool varies(const body *b, int k, bool has_frames) {
  double low, high;
  range(count(b, k) * (size_t)b->nshown, b->value[k], &low, &high);
  if (k == DRIFT && (!has_frames || high < 1e-6)) return false;
  return high - low > 1e-9 * fmax(fabs(low), fabs(high));
}

static corot_status write_data(const body *b, FILE *out) {
  const corot_strain_kind *strain = corot_strain_find(lookup_text(b->run->result, "strain"));
  bool has_frames = !strain || !strain->exact;
  write_geometry(b, out);
  COROT_TRY(write_moments(b, out));
  COROT_TRY(conditions_write(b->run, b->f, &b->s, b->nshown, b->t, out));
  /* the displacement moves the body */
  for (int k = UX; k <= UZ; k++) {
    fprintf(out, ",\"%s\":", about[k].name);
    COROT_TRY(write_steps(count(b, k) * (size_t)b->nshown, b->value[k], out));
  }
  /* fields that vary colour it */
  fputs(",\"fields\":[", out);
  const char *separator = "";
  for (int k = SPEED; k < NVALUE; k++) {
    if (!varies(b, k, has_frames)) continue;
    fprintf(out, "%s{\"name\":\"%s\",\"unit\":\"%s\",\"nodal\":%s,\"centre\":", separator,
            about[k].name, about[k].unit, about[k].nodal ? "true" : "false");
    encode_number(about[k].centre, out);
    fputs(",\"data\":", out);
    COROT_TRY(write_steps(count(b, k) * (size_t)b->nshown, b->value[k], out));
    fputc('}', out);
    separator = ",";
  }
  fputs("]}", out);
  return COROT_OK;
}

static corot_status write_section(const body *b, int stride, FILE *out) {
  double error = 0;
  for (int k = UX; k <= UZ; k++) {
    double low, high;
    range(count(b, k) * (size_t)b->nshown, b->value[k], &low, &high);
    error = fmax(error, (high - low) / 65535 / 2);
  }
  page_section("body", "Body", out);
  fputs("<figure class=\"body\" id=\"view\"><script type=\"application/json\">", out);
  COROT_TRY(write_data(b, out));
  fputs("</script></figure>\n", out);
  page_element(
      out, "p class=\"note\"",
      "Drag to turn it, shift and drag to move it, click and turn the wheel to scale it; a "
      "click on a chart over time shows that moment here.");
  page_element(out, "p class=\"note\"",
               "The surface has %d triangles; %d of %d frames are here%s. Displacements are kept "
               "to %.1e m, fields to a 130000th of their range; those of a tet are constant in it.",
               b->s.ntri, b->nshown, b->f->nframe, stride > 1 ? ", for the size of this page" : "",
               error);
  page_section_end(out);
  return COROT_OK;
}

corot_status body_write(const fields *f, const run_folder *run, FILE *out) {
  body b = {.run = run, .f = f};
  corot_status status = prepare(&b);
  int stride = status == COROT_OK ? stride_of(&b) : 1;
  if (status == COROT_OK) status = take_frames(&b, stride);
  if (status == COROT_OK) status = write_section(&b, stride, out);
  body_free(&b);
  return status;
}
