/* What is shown of ten-node tets: fields at their points, files of them, curved surfaces. */
#include <corot/ode.h>
#include <stdint.h>
#include <stdio.h>

#include "alloc.h"
#include "app/folder/hash.h"
#include "app/folder/write_vtu.h"
#include "core/lanes/polar.h"
#include "order_2.h"
#include "report/read/surface.h"
#include "report/run/gradients.h"
#include "solid.h"
#include "temporary.h"

static const double near_corner = 0.5854101966249685, elsewhere = 0.1381966011250105;

/* The point of a straight tet next to corner k. */
static void point_of(const corot_mesh *mesh, int e, int k, double x[3]) {
  for (int i = 0; i < 3; i++) {
    x[i] = 0;
    for (int a = 0; a < 4; a++)
      x[i] += (a == k ? near_corner : elsewhere) * mesh->x[mesh->tet[e][a]][i];
  }
}

/* u = A x + (x . B x) c, which ten nodes interpolate exactly where edges are straight. */
static const double A[9] = {0.1, -0.2, 0.05, 0.3, -0.1, 0.1, 0, 0.15, 0.2};
static const double B[3] = {0.3, -0.2, 0.25}, c[3] = {0.4, 0.2, -0.3};

static void displacement(const double x[3], double u[3]) {
  double square = B[0] * x[0] * x[0] + B[1] * x[1] * x[1] + B[2] * x[2] * x[2];
  apply(A, x, u);
  for (int i = 0; i < 3; i++) u[i] += square * c[i];
}

static void gradient_at(const double x[3], double F[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) F[3 * i + j] = (i == j) + A[3 * i + j] + 2 * c[i] * B[j] * x[j];
}

static corot_mesh *raised(void) {
  corot_mesh *linear = crooked_box(2, 2, 1), *mesh = with_order(linear, 2);
  corot_mesh_destroy(linear);
  return mesh;
}

/* Arrays for all fields of a mesh. */
typedef struct room {
  corot_element_fields f;
  double *memory;
} room;

static room make_room(int ntet) {
  room r = {.memory = malloc((size_t)ntet * 85 * sizeof(double))};
  double *at = r.memory;
  r.f.frame = (void *)at, at += 9 * ntet;
  r.f.strain = (void *)at, at += 6 * ntet;
  r.f.von_mises = at, at += ntet;
  r.f.det = at, at += ntet;
  r.f.frame_at = (void *)at, at += 36 * ntet;
  r.f.strain_at = (void *)at, at += 24 * ntet;
  r.f.von_mises_at = (void *)at, at += 4 * ntet;
  r.f.det_at = (void *)at;
  return r;
}

/* The fields of a free body in the displacement above. */
static void find_fields(corot_mesh *mesh, const char *strain, const corot_element_fields *f) {
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &soft;
  body b = make_body(mesh, def);
  double(*nodal)[3] = malloc(b.mesh->nnode * sizeof *nodal), *u = malloc(b.n * sizeof *u);
  for (int n = 0; n < b.mesh->nnode; n++) displacement(b.mesh->x[n], nodal[n]);
  to_dofs(&b, (const double(*)[3])nodal, u);
  assert_ok(corot_elements(b.model, b.state, 0, u, f));
  free(nodal), free(u);
  drop_body(&b);
}

/* Gradients are quotients of differences of positions of order one at distances down to 0.1:
   some tens of roundings. */
#define ROUNDING 1e-13

/* At each point, and not at the one next to another corner. */
static void fields_are_those_of_the_points(void **state) {
  (void)state;
  corot_mesh *mesh = raised();
  room r = make_room(mesh->ntet);
  for (int i = 0; i < NMEASURE; i++) {
    const corot_strain_kind *kind = corot_strain_traits(i);
    corot_mesh *copy;
    assert_ok(corot_mesh_copy(mesh, &copy));
    find_fields(copy, kind->name, &r.f);
    for (int e = 0; e < mesh->ntet; e++)
      for (int k = 0; k < 4; k++) {
        double x[3], F[9], R[9], RtF[9];
        point_of(mesh, e, k, x);
        gradient_at(x, F);
        const double *frame = r.f.frame_at[e][k], *strain = r.f.strain_at[e][k];
        assert_close(r.f.det_at[e][k], determinant(F), ROUNDING, ROUNDING);
        if (strcmp(kind->name, "polar") == 0) {
          assert_ok(corot_polar(F, R));
          assert_below(distance(frame, R), ROUNDING);
        }
        bool material = kind->exact; /* axes of the strain; else those of the frame */
        multiply_transposed(material ? F : frame, F, RtF);
        assert_close(strain[0], material ? (RtF[0] - 1) / 2 : RtF[0] - 1, ROUNDING, ROUNDING);
        assert_close(strain[3], (RtF[1] + RtF[3]) / (material ? 4 : 2), ROUNDING, ROUNDING);
        assert_above(r.f.von_mises_at[e][k], 0);
      }
  }
  free(r.memory);
  corot_mesh_destroy(mesh);
}

/* Where edges are straight the points stand for a quarter of the volume each. */
static void fields_of_tets_are_means(void **state) {
  (void)state;
  corot_mesh *mesh = raised();
  int ntet = mesh->ntet;
  room r = make_room(ntet);
  find_fields(mesh, "polar", &r.f);
  for (int e = 0; e < ntet; e++) {
    double mises = 0, det = 0, strain = 0, mean[9] = {0}, R[9];
    for (int k = 0; k < 4; k++) {
      mises += r.f.von_mises_at[e][k] / 4, det += r.f.det_at[e][k] / 4;
      strain += r.f.strain_at[e][k][5] / 4;
      for (int i = 0; i < 9; i++) mean[i] += r.f.frame_at[e][k][i] / 4;
    }
    assert_ok(corot_polar(mean, R));
    assert_close(r.f.von_mises[e], mises, ROUNDING * mises, ROUNDING);
    assert_close(r.f.det[e], det, ROUNDING, ROUNDING);
    assert_close(r.f.strain[e][5], strain, ROUNDING, ROUNDING);
    assert_below(distance(r.f.frame[e], R), ROUNDING);
  }
  free(r.memory);
}

static void points_of_linear_tets_are_alike(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(2, 2, 1);
  int ntet = mesh->ntet;
  room r = make_room(ntet);
  find_fields(mesh, "polar", &r.f);
  for (int e = 0; e < ntet; e++)
    for (int k = 0; k < 4; k++) {
      assert_memory_equal(r.f.frame_at[e][k], r.f.frame[e], sizeof r.f.frame[e]);
      assert_memory_equal(r.f.strain_at[e][k], r.f.strain[e], sizeof r.f.strain[e]);
      assert_true(r.f.von_mises_at[e][k] == r.f.von_mises[e] && r.f.det_at[e][k] == r.f.det[e]);
    }
  free(r.memory);
}

/* --- Files --- */

/* Values that tell where they are from. */
static void write_fields(const char *dir, const corot_mesh *mesh) {
  vtu *w;
  int *material = calloc((size_t)mesh->ntet, sizeof *material);
  assert_ok(vtu_create(dir, mesh, material, VTU_RAW, &w));
  vtu_fields v = vtu_arrays(w);
  for (int i = 0; i < mesh->nnode; i++) displacement(mesh->x[i], v.displacement[i]);
  for (int e = 0; e < mesh->ntet; e++) {
    v.von_mises[e] = e, v.det[e] = 1;
    for (int k = 0; k < 4 && mesh->mid; k++) {
      for (int i = 0; i < 9; i++) v.frame_at[e][k][i] = 100 * e + 10 * k + i;
      for (int i = 0; i < 6; i++) v.strain_at[e][k][i] = -100 * e - 10 * k - i;
      v.von_mises_at[e][k] = 100 * e + k, v.det_at[e][k] = 1000 * e + k;
    }
  }
  assert_ok(vtu_write(w, 0.5));
  assert_ok(vtu_finish(w));
  vtu_destroy(w);
  free(material);
}

static void files_are_read_back(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh = raised();
  bend(mesh, (const double[3]){0.1, 0.2, -0.1});
  write_fields(dir, mesh);
  fields f;
  fields_frame frame;
  assert_ok(fields_open(dir, &f));
  assert_int_equal(f.nnode, mesh->nnode);
  assert_int_equal(f.ntet, mesh->ntet);
  assert_memory_equal(f.x, mesh->x, mesh->nnode * sizeof *f.x);
  assert_memory_equal(f.tet, mesh->tet, mesh->ntet * sizeof *f.tet);
  assert_memory_equal(f.mid, mesh->mid, mesh->ntet * sizeof *f.mid);
  assert_ok(fields_frame_create(&f, &frame));
  assert_ok(fields_read(&f, 0, &frame));
  assert_true(frame.frame_at[3][2][8] == 328 && frame.von_mises[3] == 3);
  assert_true(frame.von_mises_at[3][2] == 302 && frame.det_at[3][1] == 3001);
  fields_frame_free(&frame);
  fields_close(&f);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

static void files_of_linear_tets_are_as_they_were(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh = crooked_box(1, 1, 1);
  write_fields(dir, mesh);
  size_t size;
  char *file = slurp(in(dir, "fields/fields_000000.vtu"), &size);
  assert_null(strstr(file, "_points"));
  fields f;
  fields_frame frame;
  assert_ok(fields_open(dir, &f));
  assert_null(f.mid);
  assert_ok(fields_frame_create(&f, &frame));
  assert_ok(fields_read(&f, 0, &frame));
  assert_null(frame.frame_at);
  fields_frame_free(&frame);
  fields_close(&f);
  free(file);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

/* The size of the list of nodes, which stands before it, and a node in it. */
static void damaged_files_are_refused(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh = raised();
  write_fields(dir, mesh);
  size_t size;
  const char *path = in(dir, "fields/fields_000000.vtu");
  char *file = slurp(path, &size), *entry = strstr(file, "Name=\"connectivity\"");
  assert_non_null(entry);
  char *array = strchr(strstr(file, "<AppendedData"), '_') + 1 +
                strtoul(strstr(entry, "offset=\"") + strlen("offset=\""), NULL, 10);
  const uint64_t wrong[] = {36 * (uint64_t)mesh->ntet, 16 * (uint64_t)mesh->ntet - 4, UINT64_MAX};
  fields f;
  for (int i = 0; i < 4; i++) {
    char saved[16];
    memcpy(saved, array, sizeof saved);
    if (i < 3)
      memcpy(array, &wrong[i], 8);
    else
      memcpy(array + 8 + 4 * 9, &(int32_t){mesh->nnode}, 4); /* the last node on an edge */
    FILE *out = fopen(in(dir, "fields/fields_000000.vtu"), "wb");
    assert_int_equal(fwrite(file, 1, size, out), size);
    fclose(out);
    assert_fails(fields_open(dir, &f), COROT_EFORMAT, i < 3 ? "connectivity" : "tet 0 has node");
    if (i < 3) memcpy(array, saved, sizeof saved);
  }
  free(file);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

/* Where the nodes on edges are is part of what a run depends on. */
static void hashes_tell_orders_apart(void **state) {
  (void)state;
  char digest[2][HASH_SIZE];
  corot_mesh *mesh = raised();
  hash_mesh(mesh, digest[0]);
  int keep = mesh->mid[0][0];
  mesh->mid[0][0] = mesh->mid[0][1], mesh->mid[0][1] = keep;
  hash_mesh(mesh, digest[1]);
  assert_string_not_equal(digest[0], digest[1]);
  corot_mesh_destroy(mesh);
}

/* --- The surface --- */

/* Of a straight mesh each is in the middle of its edge, and all nodes of the sides are there. */
static void surfaces_have_the_nodes_on_their_edges(void **state) {
  (void)state;
  corot_mesh *mesh = raised();
  surface s;
  assert_ok(surface_create_of_order(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet,
                                    (const int(*)[6])mesh->mid, &s));
  for (int i = 0; i < s.ntri; i++)
    for (int k = 0; k < 3; k++) {
      const double *a = mesh->x[s.node[s.corner[i][k]]];
      const double *b = mesh->x[s.node[s.corner[i][(k + 1) % 3]]];
      const double *m = mesh->x[s.node[s.middle[i][k]]];
      for (int j = 0; j < 3; j++) assert_close(m[j], (a[j] + b[j]) / 2, 1e-15, 1e-15);
    }
  assert_int_equal(s.nnode, 2 * s.ntri + 2); /* as octasected: Euler's formula of a closed one */
  surface_free(&s);
  corot_mesh_destroy(mesh);
}

static void gradients_are_exact_at_the_points(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh = raised();
  write_fields(dir, mesh);
  fields f;
  fields_frame frame;
  gradients g;
  const int tet[] = {5, 2, 7};
  assert_ok(fields_open(dir, &f));
  assert_ok(fields_frame_create(&f, &frame));
  assert_ok(fields_read(&f, 0, &frame));
  assert_ok(gradients_create(&f, 3, tet, &g));
  assert_int_equal(g.npoint, 4);
  for (int i = 0; i < 3; i++)
    for (int q = 0; q < 4; q++) {
      double x[3], F[9], expected[9];
      point_of(mesh, tet[i], q, x);
      gradient_at(x, expected);
      gradients_at(&g, (const double(*)[3])frame.displacement, i, q, F);
      assert_below(distance(F, expected), ROUNDING);
    }
  gradients_free(&g);
  fields_frame_free(&frame);
  fields_close(&f);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

/* And the means that the file has are what a curved body's F amounts to: on a curved body a linear
   displacement has one gradient. */
static void gradients_know_curved_edges(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh = raised();
  bend(mesh, (const double[3]){0.1, 0.2, -0.1});
  write_fields(dir, mesh);
  fields f;
  gradients g;
  const int tet[] = {1, 6};
  assert_ok(fields_open(dir, &f));
  double(*u)[3] = malloc(mesh->nnode * sizeof *u), expected[9];
  for (int n = 0; n < mesh->nnode; n++) apply(A, mesh->x[n], u[n]);
  for (int k = 0; k < 9; k++) expected[k] = A[k] + (k % 4 == 0);
  assert_ok(gradients_create(&f, 2, tet, &g));
  for (int q = 0; q < 8; q++) {
    double F[9];
    gradients_at(&g, (const double(*)[3])u, q / 4, q % 4, F);
    assert_below(distance(F, expected), ROUNDING);
  }
  gradients_free(&g);
  fields_close(&f);
  free(u);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

static void a_linear_field_is_continued_to_the_corners(void **state) {
  (void)state;
  const double expected[4] = {3, -1, 0.5, 7};
  double at[4] = {0}, corner[4];
  for (int q = 0; q < 4; q++)
    for (int k = 0; k < 4; k++) at[q] += (k == q ? near_corner : elsewhere) * expected[k];
  gradients_to_corners(at, corner);
  for (int k = 0; k < 4; k++) assert_close(corner[k], expected[k], 1e-14, 1e-14);
}

/* --- No memory --- */

static corot_status open_all(void *dir) {
  static const int tet[] = {0, 1};
  fields f;
  fields_frame frame = {0};
  surface s = {0};
  gradients g = {0};
  COROT_TRY(fields_open(dir, &f));
  corot_status status = fields_frame_create(&f, &frame);
  if (status == COROT_OK)
    status = surface_create_of_order(f.nnode, f.ntet, (const int(*)[4])f.tet,
                                     (const int(*)[6])f.mid, &s);
  if (status == COROT_OK) status = gradients_create(&f, 2, tet, &g);
  gradients_free(&g);
  surface_free(&s);
  fields_frame_free(&frame);
  fields_close(&f);
  return status;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh = raised();
  write_fields(dir, mesh);
  assert_above((double)assert_survives_failed_allocations(open_all, dir), 15);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fields_are_those_of_the_points),
      cmocka_unit_test(fields_of_tets_are_means),
      cmocka_unit_test(points_of_linear_tets_are_alike),
      cmocka_unit_test(files_are_read_back),
      cmocka_unit_test(files_of_linear_tets_are_as_they_were),
      cmocka_unit_test(damaged_files_are_refused),
      cmocka_unit_test(hashes_tell_orders_apart),
      cmocka_unit_test(surfaces_have_the_nodes_on_their_edges),
      cmocka_unit_test(gradients_are_exact_at_the_points),
      cmocka_unit_test(gradients_know_curved_edges),
      cmocka_unit_test(a_linear_field_is_continued_to_the_corners),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
