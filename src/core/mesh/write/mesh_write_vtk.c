/* VTK's files of unstructured grids, legacy and XML, in ASCII. Groups are arrays of 0 and 1, of
   cells and of points, called group:NAME; triangles are cells, one for each group. */
#include <string.h>

#include "mesh_write.h"

/* A name as one word that XML takes, too: bytes that are none are %XX. */
static void write_name(FILE *f, const char *name) {
  for (const unsigned char *p = (const unsigned char *)name; *p; p++)
    if (*p <= 0x20 || strchr("%\"&<>'", *p))
      fprintf(f, "%%%02X", *p);
    else
      fputc(*p, f);
}

static int count_triangles(const corot_mesh *mesh) {
  int n = 0;
  for (int g = 0; g < mesh->ngroup; g++) n += mesh->group[g].ntri;
  return n;
}

/* Numbers, some to a line. */
static void write_number(FILE *f, int *written, int number) {
  fprintf(f, "%d%c", number, ++*written % 20 ? ' ' : '\n');
}

static void end_numbers(FILE *f, int written) {
  if (written % 20) fputc('\n', f);
}

static void write_points(const corot_writing *w) {
  for (int i = 0; i < w->mesh->nnode; i++) {
    const double *x = w->mesh->x[i];
    fprintf(w->file, "%.17g %.17g %.17g\n", x[0], x[1], x[2]);
  }
}

/* The nodes of all cells, tets first; `counted`: their number before them. */
static void write_cell(FILE *f, bool counted, int n, const int *v) {
  if (counted) fprintf(f, "%d ", n);
  for (int k = 0; k < n; k++) fprintf(f, "%d%c", v[k], k + 1 < n ? ' ' : '\n');
}

static void write_cells(const corot_writing *w, bool counted) {
  int v[10];
  for (int e = 0; e < w->mesh->ntet; e++)
    write_cell(w->file, counted, corot_writing_tet(w, e, v), v);
  for (int g = 0; g < w->mesh->ngroup; g++)
    for (int i = 0; i < w->mesh->group[g].ntri; i++) {
      int n = corot_writing_triangle(w, w->mesh->group[g].tri[i], v);
      write_cell(w->file, counted, n, v);
    }
}

static void write_types(const corot_writing *w) {
  int written = 0, ntri = count_triangles(w->mesh);
  for (int e = 0; e < w->mesh->ntet; e++) write_number(w->file, &written, w->mesh->mid ? 24 : 10);
  for (int i = 0; i < ntri; i++) write_number(w->file, &written, w->mesh->mid ? 22 : 5);
  end_numbers(w->file, written);
}

/* Which cells are of group g. */
static void write_members(const corot_writing *w, int g) {
  const corot_mesh *mesh = w->mesh;
  const corot_group *group = &mesh->group[g];
  int written = 0;
  for (int e = 0, i = 0; e < mesh->ntet; e++) {
    bool in = i < group->ntet && group->tet[i] == e;
    i += in;
    write_number(w->file, &written, in);
  }
  for (int h = 0; h < mesh->ngroup; h++)
    for (int i = 0; i < mesh->group[h].ntri; i++) write_number(w->file, &written, h == g);
  end_numbers(w->file, written);
}

static void write_nodes(const corot_writing *w, int g) {
  const corot_group *group = &w->mesh->group[g];
  int written = 0;
  for (int i = 0, k = 0; i < w->mesh->nnode; i++) {
    bool in = k < group->nnode && group->node[k] == i;
    k += in;
    write_number(w->file, &written, in);
  }
  end_numbers(w->file, written);
}

/* --- Legacy --- */

static void write_fields(const corot_writing *w, int n,
                         void (*write)(const corot_writing *w, int g)) {
  fprintf(w->file, "FIELD FieldData %d\n", w->mesh->ngroup);
  for (int g = 0; g < w->mesh->ngroup; g++) {
    fputs("group:", w->file);
    write_name(w->file, w->mesh->group[g].name);
    fprintf(w->file, " 1 %d unsigned_char\n", n);
    write(w, g);
  }
}

corot_status corot_write_vtk(corot_writing *w) {
  const corot_mesh *mesh = w->mesh;
  int ntri = count_triangles(mesh), order = mesh->mid ? 2 : 1;
  long long ncell = (long long)mesh->ntet + ntri;
  fprintf(w->file,
          "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n",
          mesh->nnode);
  write_points(w);
  fprintf(w->file, "CELLS %lld %lld\n", ncell,
          mesh->ntet * (order == 2 ? 11LL : 5LL) + ntri * (order == 2 ? 7LL : 4LL));
  write_cells(w, true);
  fprintf(w->file, "CELL_TYPES %lld\n", ncell);
  write_types(w);
  if (mesh->ngroup == 0) return COROT_OK;
  fprintf(w->file, "CELL_DATA %lld\n", ncell);
  write_fields(w, (int)ncell, write_members);
  fprintf(w->file, "POINT_DATA %d\n", mesh->nnode);
  write_fields(w, mesh->nnode, write_nodes);
  return COROT_OK;
}

/* --- XML --- */

static void begin_array(FILE *f, const char *type, const char *name, int ncomponent) {
  fprintf(f, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"ascii\">\n",
          type, name, ncomponent);
}

static void end_array(FILE *f) { fputs("</DataArray>\n", f); }

static void write_offsets(const corot_writing *w) {
  int written = 0, ntri = count_triangles(w->mesh), end = 0;
  for (int e = 0; e < w->mesh->ntet; e++)
    write_number(w->file, &written, end += w->mesh->mid ? 10 : 4);
  for (int i = 0; i < ntri; i++) write_number(w->file, &written, end += w->mesh->mid ? 6 : 3);
  end_numbers(w->file, written);
}

static void write_arrays(const corot_writing *w, void (*write)(const corot_writing *w, int g)) {
  for (int g = 0; g < w->mesh->ngroup; g++) {
    fputs("<DataArray type=\"UInt8\" Name=\"group:", w->file);
    write_name(w->file, w->mesh->group[g].name);
    fputs("\" format=\"ascii\">\n", w->file);
    write(w, g);
    end_array(w->file);
  }
}

corot_status corot_write_vtu(corot_writing *w) {
  const corot_mesh *mesh = w->mesh;
  FILE *f = w->file;
  fprintf(f,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n"
          "<UnstructuredGrid>\n<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%lld\">\n<Points>\n",
          mesh->nnode, (long long)mesh->ntet + count_triangles(mesh));
  begin_array(f, "Float64", "Points", 3);
  write_points(w);
  end_array(f);
  fputs("</Points>\n<Cells>\n", f);
  begin_array(f, "Int32", "connectivity", 1);
  write_cells(w, false);
  end_array(f);
  begin_array(f, "Int32", "offsets", 1);
  write_offsets(w);
  end_array(f);
  begin_array(f, "UInt8", "types", 1);
  write_types(w);
  end_array(f);
  fputs("</Cells>\n<PointData>\n", f);
  write_arrays(w, write_nodes);
  fputs("</PointData>\n<CellData>\n", f);
  write_arrays(w, write_members);
  fputs("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n", f);
  return COROT_OK;
}
