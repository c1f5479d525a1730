/* Surface, moments and fields, each cut down to what a page can carry. */
#include "body.h"

#include <corot/model.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "conditions.h"
#include "core/lanes/polar.h"
#include "gradients.h"
#include "report/page/encode.h"
#include "report/page/html.h"
#include "report/read/lookup.h"
#include "report/read/surface.h"

/* What is known of each frame, by node or by triangle of the surface; of order 2, by corner of the
   triangle. */
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
  int nwhole;          /* triangles before it was thinned */
  fields_frame frame;  /* the one being read */
  gradients gradients; /* of the triangles' tets */
  int nshown;
  double *t;             /* [nshown] */
  double *value[NVALUE]; /* [nshown][nodes, triangles or corners] */
} body;

static void body_free(body *b) {
  surface_free(&b->s);
  fields_frame_free(&b->frame);
  gradients_free(&b->gradients);
  free(b->t);
  for (int k = 0; k < NVALUE; k++) free(b->value[k]);
}

/* Values of a triangle that are its tet's: one, or those at its corners. */
static int per_triangle(const body *b) { return b->s.middle ? 3 : 1; }

static size_t count(const body *b, int k) {
  return about[k].nodal ? (size_t)b->s.nnode : (size_t)per_triangle(b) * (size_t)b->s.ntri;
}

/* Between two rotations, in degrees: |A - B| = 2 sqrt(2) sin(angle / 2). */
static double angle(const double A[9], const double B[9]) {
  double sum = 0;
  for (int k = 0; k < 9; k++) sum += (A[k] - B[k]) * (A[k] - B[k]);
  return 360 / 3.14159265358979323846 * asin(fmin(1, sqrt(sum / 8)));
}

/* What the i-th triangle's tet has at point q, from VON_MISES on. */
static void look_at(const body *b, int i, int q, double value[NVALUE]) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const fields_frame *now = &b->frame;
  bool curved = b->s.middle;
  double F[9], R[9];
  int e = b->s.tet[i];
  gradients_at(&b->gradients, (const double(*)[3])now->displacement, i, q, F);
  bool turned = corot_polar(F, R) == COROT_OK; /* an inverted tet has no rotation */
  value[VON_MISES] = curved ? now->von_mises_at[e][q] : now->von_mises[e];
  value[VOLUME] = curved ? now->det_at[e][q] : now->det[e];
  value[TURN] = turned ? angle(R, identity) : NAN;
  value[DRIFT] = turned ? angle(R, curved ? now->frame_at[e][q] : now->frame[e]) : NAN;
}

/* Which corner of its tet is corner k of a triangle. */
static int corner_of_tet(const body *b, int i, int k) {
  const int *tet = b->f->tet[b->s.tet[i]];
  int node = b->s.node[b->s.corner[i][k]], found = 0;
  while (found < 3 && tet[found] != node) found++;
  return found;
}

/* A function of a ten-node tet is the linear one through its four points, but for what cannot be
   negative. */
static void take_corners(body *b, size_t at, int i) {
  double value[4][NVALUE];
  for (int q = 0; q < 4; q++) look_at(b, i, q, value[q]);
  for (int k = VON_MISES; k < NVALUE; k++) {
    double point[4], corner[4];
    for (int q = 0; q < 4; q++) point[q] = value[q][k];
    gradients_to_corners(point, corner);
    for (int c = 0; c < 3; c++) {
      double x = corner[corner_of_tet(b, i, c)];
      b->value[k][3 * at + (size_t)c] = x < 0 && k != VOLUME ? 0 : x;
    }
  }
}

static void take_triangle(body *b, size_t at, int i) {
  double value[NVALUE];
  look_at(b, i, 0, value);
  for (int k = VON_MISES; k < NVALUE; k++) b->value[k][at] = value[k];
}

static void take_frame(body *b, int k) {
  for (int i = 0; i < b->s.nnode; i++) {
    size_t at = (size_t)k * (size_t)b->s.nnode + (size_t)i;
    const double *u = b->frame.displacement[b->s.node[i]], *v = b->frame.velocity[b->s.node[i]];
    for (int c = 0; c < 3; c++) b->value[UX + c][at] = u[c];
    b->value[SPEED][at] = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  for (int i = 0; i < b->s.ntri; i++) {
    size_t at = (size_t)k * (size_t)b->s.ntri + (size_t)i;
    if (b->s.middle)
      take_corners(b, at, i);
    else
      take_triangle(b, at, i);
  }
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
  COROT_TRY(surface_create_of_order(f->nnode, f->ntet, (const int(*)[4])f->tet,
                                    (const int(*)[6])f->mid, &b->s));
  b->nwhole = b->s.ntri;
  COROT_TRY(surface_thin(&b->s, (const double(*)[3])f->x, f->nnode, BODY_TRIANGLES));
  COROT_TRY(fields_frame_create(f, &b->frame));
  return gradients_create(f, b->s.ntri, b->s.tet, &b->gradients);
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

static void write_nodes(int n, const int (*node)[3], FILE *out) {
  for (int i = 0; i < n; i++)
    fprintf(out, "%s%d,%d,%d", i ? "," : "", node[i][0], node[i][1], node[i][2]);
}

static void write_geometry(const body *b, FILE *out) {
  const surface *s = &b->s;
  fprintf(out, "{\"nodes\":%d,\"triangles\":%d,\"rest\":[", s->nnode, s->ntri);
  for (int i = 0; i < s->nnode; i++) {
    const double *x = b->f->x[s->node[i]];
    fprintf(out, "%s%.8g,%.8g,%.8g", i ? "," : "", x[0], x[1], x[2]);
  }
  fputs("],\"corners\":[", out);
  write_nodes(s->ntri, (const int(*)[3])s->corner, out);
  if (s->middle) {
    fputs("],\"middles\":[", out);
    write_nodes(s->ntri, (const int(*)[3])s->middle, out);
  }
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
  char thinned[160] = "";
  for (int k = UX; k <= UZ; k++) {
    double low, high;
    range(count(b, k) * (size_t)b->nshown, b->value[k], &low, &high);
    error = fmax(error, (high - low) / 65535 / 2);
  }
  if (b->s.ntri < b->nwhole)
    snprintf(thinned, sizeof thinned,
             ", of which %d are drawn, for the size of this page: they leave out what is smaller "
             "than they are",
             b->s.ntri);
  page_section("body", "Body", out);
  fputs("<figure class=\"body\" id=\"view\"><script type=\"application/json\">", out);
  COROT_TRY(write_data(b, out));
  fputs("</script></figure>\n", out);
  page_element(
      out, "p class=\"note\"",
      "Drag to turn it, shift and drag to move it, click and turn the wheel to scale it; a "
      "click on a chart over time shows that moment here.");
  page_element(
      out, "p class=\"note\"",
      "The surface has %d triangles%s; %d of %d frames are here%s. Displacements are kept "
      "to %.1e m, fields to a 130000th of their range; those of a tet are %s.",
      b->nwhole, thinned, b->nshown, b->f->nframe, stride > 1 ? ", for the size of this page" : "",
      error,
      b->s.middle ? "linear in it, through its four points of integration" : "constant in it");
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
