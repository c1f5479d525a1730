/* XML around binary arrays, whose places in the file are known beforehand. */
#include "write_vtu.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include "core/element/element.h"
#include "folder.h"
#include "inventory.h"
#include "zlib_array.h"

/* Most characters of what is in front of the data, and its length where that is not known before.
 */
enum { HEADER = 4096, PACKED_HEADER = HEADER - 8 };

typedef enum section { FIELD, POINT, CELL, POINTS, CELLS } section;

/* The arrays of a file, in the order of its header. */
enum {
  TIME,
  DISPLACEMENT,
  MODE,
  VELOCITY,
  FRAME,
  STRAIN,
  VON_MISES,
  DET,
  FRAME_AT,
  STRAIN_AT,
  VON_MISES_AT,
  DET_AT,
  MATERIAL,
  REST,
  NODES,
  OFFSETS,
  TYPES,
  NARRAY,
  CONSTANT = MATERIAL /* from here on they are the same in all frames */
};

/* Arrays that are not in all files: those of a motion, of modes, of a mesh of order 2. */
enum { OF_MOTION = 1, OF_MODES = 2, OF_ORDER_2 = 4 };

static const struct layout {
  const char *name, *type;
  section section;
  int values;  /* a node, a tet */
  size_t item; /* bytes of a component */
  const char *attributes;
  unsigned only; /* a sum of OF_s */
} layout[NARRAY] = {
    [TIME] = {"TimeValue", "Float64", FIELD, 1, 8, " NumberOfTuples=\"1\""},
    [DISPLACEMENT] = {"displacement", "Float64", POINT, 3, 8, ""},
    [VELOCITY] = {"velocity", "Float64", POINT, 3, 8, "", OF_MOTION},
    [MODE] = {"mode", "Float64", POINT, 3, 8, "", OF_MODES},
    [FRAME] = {"frame", "Float64", CELL, 9, 8, "", OF_MOTION},
    [STRAIN] = {"strain", "Float64", CELL, 6, 8,
                " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\""
                " ComponentName3=\"XY\" ComponentName4=\"YZ\" ComponentName5=\"XZ\"",
                OF_MOTION},
    [VON_MISES] = {"von_mises", "Float64", CELL, 1, 8, "", OF_MOTION},
    [DET] = {"det", "Float64", CELL, 1, 8, "", OF_MOTION},
    [FRAME_AT] = {"frame_points", "Float64", CELL, 36, 8, "", OF_MOTION | OF_ORDER_2},
    [STRAIN_AT] = {"strain_points", "Float64", CELL, 24, 8, "", OF_MOTION | OF_ORDER_2},
    [VON_MISES_AT] = {"von_mises_points", "Float64", CELL, 4, 8, "", OF_MOTION | OF_ORDER_2},
    [DET_AT] = {"det_points", "Float64", CELL, 4, 8, "", OF_MOTION | OF_ORDER_2},
    [MATERIAL] = {"material", "Int32", CELL, 1, 4, ""},
    [REST] = {"Points", "Float64", POINTS, 3, 8, ""},
    [NODES] = {"connectivity", "Int32", CELLS, 1, 4, ""}, /* values: those of the mesh */
    [OFFSETS] = {"offsets", "Int32", CELLS, 1, 4, ""},
    [TYPES] = {"types", "UInt8", CELLS, 1, 1, ""},
};

static const struct {
  const char *open, *close;
} tag[] = {
    [FIELD] = {"<FieldData>\n", "</FieldData>\n"},
    [POINT] = {"<PointData Vectors=\"displacement\">\n", "</PointData>\n"},
    [CELL] = {"<CellData Scalars=\"von_mises\" Tensors=\"frame\">\n", "</CellData>\n"},
    [POINTS] = {"<Points>\n", "</Points>\n"},
    [CELLS] = {"<Cells>\n", "</Cells>\n"},
};

/* Modes have no other cell data. */
static const char open_cells_of_modes[] = "<CellData Scalars=\"material\">\n";

static const char pvd_head[] =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
static const char pvd_tail[] = "</Collection>\n</VTKFile>\n";
static const char file_tail[] = "\n</AppendedData>\n</VTKFile>\n";

/* The file of a frame that is compressed, made anew for each. */
typedef struct packed_frame {
  zlib_packer *packer;
  char *file;           /* what is in front of the arrays has PACKED_HEADER bytes */
  char *kept[NARRAY];   /* from CONSTANT on: compressed once */
  size_t nkept[NARRAY]; /* bytes of these */
} packed_frame;

struct vtu {
  unsigned is;            /* OF_MOTION or OF_MODES, with OF_ORDER_2 */
  const corot_mesh *mesh; /* the caller's */
  packed_frame *packed;   /* NULL: the image is the file */
  growth sizes;           /* of the frames that are compressed, no two of which are as long */
  char *image;            /* [size] the file of the next frame: header, arrays, closing tags */
  size_t size;
  char *array[NARRAY]; /* in the image */
  char *path;          /* DIR/fields/fields_NNNNNN.vtu, the number being rewritten */
  size_t path_size, number_at;
  char *folder;    /* DIR/fields */
  char *temporary; /* DIR/fields/frame.tmp */
  char *pvd_path;
  int pvd;
  growth list; /* of the pvd, up to its closing tags */
  int nframe, nsynchronised;
};

corot_status vtu_finish(vtu *w) {
  int fd = w->pvd;
  w->pvd = -1;
  return file_close(fd, w->pvd_path);
}

static void packed_destroy(packed_frame *p) {
  if (!p) return;
  zlib_packer_destroy(p->packer);
  for (int i = 0; i < NARRAY; i++) free(p->kept[i]);
  free(p->file);
  free(p);
}

void vtu_destroy(vtu *w) {
  if (!w) return;
  vtu_finish(w);
  packed_destroy(w->packed);
  free(w->image);
  free(w->path);
  free(w->folder);
  free(w->temporary);
  free(w->pvd_path);
  free(w);
}

static size_t padded(size_t size) { return (size + 7) / 8 * 8; }

static const element_kind *kind_of(const corot_mesh *mesh) {
  return &element_kinds[corot_mesh_order(mesh) == 2 ? TET10 : TET4];
}

static bool is_there(int i, const vtu *w) { return (layout[i].only & ~w->is) == 0; }

static size_t array_bytes(int i, const corot_mesh *mesh) {
  const struct layout *a = &layout[i];
  int values = i == NODES ? kind_of(mesh)->nnode : a->values;
  size_t tuples = a->section == FIELD                           ? 1
                  : a->section == POINT || a->section == POINTS ? (size_t)mesh->nnode
                                                                : (size_t)mesh->ntet;
  return tuples * (size_t)values * a->item;
}

/* Bytes of an array in the file: its size, then the data. */
static size_t room_of(int i, const vtu *w, const corot_mesh *mesh) {
  return is_there(i, w) ? 8 + padded(array_bytes(i, mesh)) : 0;
}

static unsigned of_mesh(const corot_mesh *mesh, unsigned what) {
  return corot_mesh_order(mesh) == 2 ? what | OF_ORDER_2 : what;
}

size_t vtu_bytes(const corot_mesh *mesh) {
  const vtu w = {.is = of_mesh(mesh, OF_MOTION)};
  size_t bytes = 0;
  for (int i = 0; i < NARRAY; i++) bytes += room_of(i, &w, mesh);
  return bytes;
}

/* Appends to text [HEADER], which is known to be long enough. */
static void append(char *text, const char *format, ...) {
  size_t length = strlen(text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + length, HEADER - length, format, arguments);
  va_end(arguments);
}

/* The XML before the data; padded with blanks so that the data begins at a multiple of `step`.
   offset [NARRAY] of the arrays from there. */
static void make_header(const vtu *w, const size_t *offset, size_t step, char text[HEADER]) {
  const uint16_t one = 1;
  bool little = *(const char *)&one == 1;
  text[0] = '\0';
  append(text,
         "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\""
         " byte_order=\"%s\" header_type=\"UInt64\"%s>\n<UnstructuredGrid>\n",
         little ? "LittleEndian" : "BigEndian", w->packed ? VTU_COMPRESSOR : "");
  for (int i = 0; i < NARRAY; i++) {
    const struct layout *a = &layout[i];
    if (i == 0 || layout[i - 1].section != a->section)
      append(text, "%s",
             w->is & OF_MODES && a->section == CELL ? open_cells_of_modes : tag[a->section].open);
    if (is_there(i, w))
      append(text,
             "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"%s format=\"appended\""
             " offset=\"%zu\"/>\n",
             a->type, a->name, a->values, a->attributes, offset[i]);
    if (i + 1 < NARRAY && layout[i + 1].section == a->section) continue;
    append(text, "%s", tag[a->section].close);
    if (a->section == FIELD)
      append(text, "<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n", w->mesh->nnode,
             w->mesh->ntet);
  }
  append(text, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n");
  int blanks = (int)((strlen(text) + step) / step * step - strlen(text) - 1);
  append(text, "%*s_", blanks, "");
}

static void put_mesh(vtu *w, const corot_mesh *mesh, const int *material) {
  int n = kind_of(mesh)->nnode;
  int32_t *nodes = (void *)w->array[NODES], *offsets = (void *)w->array[OFFSETS];
  int32_t *number = (void *)w->array[MATERIAL];
  memcpy(w->array[REST], mesh->x, array_bytes(REST, mesh));
  for (int e = 0; e < mesh->ntet; e++) {
    for (int k = 0; k < n; k++) nodes[n * e + k] = k < 4 ? mesh->tet[e][k] : mesh->mid[e][k - 4];
    offsets[e] = n * (e + 1);
    number[e] = material[e];
  }
  memset(w->array[TYPES], kind_of(mesh)->vtk, (size_t)mesh->ntet);
}

/* Lays out the image: everything that stays the same from frame to frame is put in place. */
static corot_status make_image(vtu *w, const int *material) {
  const corot_mesh *mesh = w->mesh;
  char header[HEADER];
  size_t offset[NARRAY], end = 0;
  /* header, a size and the data of each array, tail */
  for (int i = 0; i < NARRAY; i++) offset[i] = end, end += room_of(i, w, mesh);
  make_header(w, offset, 8, header);
  size_t at = strlen(header);
  w->size = at + end + sizeof file_tail - 1;
  w->image = calloc(1, w->size);
  if (!w->image)
    return corot_fail(COROT_ENOMEM, "%zu bytes for the fields: out of memory", w->size);

  /* what frames the arrays, and where they are */
  memcpy(w->image, header, at);
  for (int i = 0; i < NARRAY; i++) {
    if (!is_there(i, w)) continue;
    uint64_t bytes = array_bytes(i, mesh);
    memcpy(w->image + at, &bytes, 8);
    w->array[i] = w->image + at + 8;
    at += room_of(i, w, mesh);
  }
  memcpy(w->image + at, file_tail, sizeof file_tail - 1);

  put_mesh(w, mesh, material);
  return COROT_OK;
}

/* --- Compressed --- */

/* The arrays that stay as they are, and room for a whole file. */
static corot_status make_packed(vtu *w) {
  packed_frame *p = w->packed;
  size_t bound = PACKED_HEADER + sizeof file_tail;
  COROT_TRY(zlib_packer_create(&p->packer));
  for (int i = 0; i < NARRAY; i++)
    if (is_there(i, w)) bound += zlib_bound(array_bytes(i, w->mesh));
  p->file = malloc(bound);
  if (!p->file) return corot_fail(COROT_ENOMEM, "%zu bytes for the fields: out of memory", bound);
  for (int i = CONSTANT; i < NARRAY; i++) {
    p->nkept[i] = zlib_pack(p->packer, w->array[i], array_bytes(i, w->mesh), p->file);
    p->kept[i] = malloc(p->nkept[i] + 1);
    if (!p->kept[i] || p->nkept[i] == 0)
      return corot_fail(COROT_ENOMEM, "%s for the fields: out of memory", layout[i].name);
    memcpy(p->kept[i], p->file, p->nkept[i]);
  }
  return COROT_OK;
}

/* The file of the image as it is; *size bytes. */
static corot_status pack_image(vtu *w, size_t *size) {
  packed_frame *p = w->packed;
  char header[HEADER];
  size_t offset[NARRAY] = {0}, at = PACKED_HEADER;
  for (int i = 0; i < NARRAY; i++) {
    if (!is_there(i, w)) continue;
    offset[i] = at - PACKED_HEADER;
    size_t n = i < CONSTANT
                   ? zlib_pack(p->packer, w->array[i], array_bytes(i, w->mesh), p->file + at)
                   : p->nkept[i];
    if (n == 0) return corot_fail(COROT_EIO, "%s: zlib fails on %s", w->path, layout[i].name);
    if (i >= CONSTANT) memcpy(p->file + at, p->kept[i], n);
    at += n;
  }
  make_header(w, offset, PACKED_HEADER, header);
  memcpy(p->file, header, PACKED_HEADER);
  memcpy(p->file + at, file_tail, sizeof file_tail - 1);
  *size = at + sizeof file_tail - 1;
  return COROT_OK;
}

/* --- The files --- */

/* Writes `text` over the closing tags of the list, and the closing tags after it: at once, so that
   the list is well-formed at any time. */
static corot_status extend_list(vtu *w, const char *text) {
  char block[256];
  int length = snprintf(block, sizeof block, "%s%s", text, pvd_tail);
  if (lseek(w->pvd, w->list.size, SEEK_SET) < 0)
    return corot_fail(COROT_EIO, "%s: not a file one can write to anywhere", w->pvd_path);
  COROT_TRY(file_write(w->pvd, w->pvd_path, block, (size_t)length));
  growth_add(&w->list, text, strlen(text));
  return COROT_OK;
}

static corot_status name_files(vtu *w, const char *dir) {
  static const char frame_name[] = "fields/fields_";
  w->number_at = strlen(dir) + sizeof frame_name;
  w->path_size = w->number_at + 32;
  w->path = malloc(w->path_size);
  w->folder = folder_path(dir, INVENTORY_FIELDS);
  w->temporary = folder_path(dir, "fields/frame.tmp");
  w->pvd_path = folder_path(dir, "fields.pvd");
  if (!w->path || !w->folder || !w->temporary || !w->pvd_path)
    return corot_fail(COROT_ENOMEM, "%s/fields: out of memory", dir);
  snprintf(w->path, w->path_size, "%s/%s", dir, frame_name);
  return COROT_OK;
}

static corot_status make_files(vtu *w) {
  COROT_TRY(folder_make(w->folder));
  COROT_TRY(file_create(w->pvd_path, &w->pvd));
  return extend_list(w, pvd_head);
}

static void set_number(vtu *w, int number) {
  snprintf(w->path + w->number_at, w->path_size - w->number_at, "%06d.vtu", number);
}

/* Every frame is as long as the next one, unless they are compressed: then *sizes takes it in. */
static corot_status check_frame(vtu *w, int number, growth *sizes) {
  struct stat info;
  set_number(w, number);
  bool there = lstat(w->path, &info) == 0 && S_ISREG(info.st_mode);
  uint64_t size = there ? (uint64_t)info.st_size : 0;
  growth_add(sizes, &size, sizeof size);
  if (there && (w->packed || size == w->size)) return COROT_OK;
  return corot_fail(COROT_EFORMAT, "%s: is not what it was at the checkpoint", w->path);
}

/* Those of a checkpoint, as they are. */
static corot_status find_files(vtu *w, pack *p) {
  growth sizes = growth_begin();
  COROT_TRY(vtu_pack(w, p));
  w->nsynchronised = w->nframe;
  for (int i = 0; i < w->nframe; i++) COROT_TRY(check_frame(w, i, &sizes));
  if (w->packed && sizes.sum != w->sizes.sum)
    return corot_fail(COROT_EFORMAT, "%s: the frames are not what they were at the checkpoint",
                      w->folder);
  return growth_reopen(w->pvd_path, &w->list, &w->pvd);
}

/* On the files of a checkpoint, or from the beginning (NULL). */
static corot_status create(const char *dir, const corot_mesh *mesh, const int *material,
                           unsigned what, vtu_data data, pack *p, vtu **out) {
  if (mesh->ntet > INT32_MAX / kind_of(mesh)->nnode)
    return corot_fail(COROT_EINVAL, "%d tets are too many for the fields' 32-bit indices",
                      mesh->ntet);
  vtu *w = calloc(1, sizeof *w);
  if (!w) return corot_fail(COROT_ENOMEM, "%s/fields: out of memory", dir);
  w->pvd = -1;
  w->is = of_mesh(mesh, what);
  w->mesh = mesh;
  w->list = w->sizes = growth_begin();
  corot_status status = COROT_OK;
  if (data == VTU_ZLIB && !(w->packed = calloc(1, sizeof *w->packed)))
    status = corot_fail(COROT_ENOMEM, "%s/fields: out of memory", dir);
  if (status == COROT_OK) status = make_image(w, material);
  if (status == COROT_OK && w->packed) status = make_packed(w);
  if (status == COROT_OK) status = name_files(w, dir);
  if (status == COROT_OK) status = p ? find_files(w, p) : make_files(w);
  if (status != COROT_OK) {
    vtu_destroy(w);
    return status;
  }
  *out = w;
  return COROT_OK;
}

corot_status vtu_create(const char *dir, const corot_mesh *mesh, const int *material, vtu_data data,
                        vtu **out) {
  return create(dir, mesh, material, OF_MOTION, data, NULL, out);
}

corot_status vtu_resume(const char *dir, const corot_mesh *mesh, const int *material, vtu_data data,
                        pack *p, vtu **out) {
  return create(dir, mesh, material, OF_MOTION, data, p, out);
}

corot_status vtu_create_modes(const char *dir, const corot_mesh *mesh, const int *material,
                              vtu_data data, vtu **out) {
  return create(dir, mesh, material, OF_MODES, data, NULL, out);
}

vtu_fields vtu_arrays(vtu *w) {
  return (vtu_fields){
      .displacement = (void *)w->array[DISPLACEMENT],
      .velocity = (void *)w->array[VELOCITY],
      .mode = (void *)w->array[MODE],
      .frame = (void *)w->array[FRAME],
      .strain = (void *)w->array[STRAIN],
      .von_mises = (void *)w->array[VON_MISES],
      .det = (void *)w->array[DET],
      .frame_at = (void *)w->array[FRAME_AT],
      .strain_at = (void *)w->array[STRAIN_AT],
      .von_mises_at = (void *)w->array[VON_MISES_AT],
      .det_at = (void *)w->array[DET_AT],
  };
}

corot_status vtu_write(vtu *w, double t) {
  memcpy(w->array[TIME], &t, sizeof t);
  set_number(w, w->nframe);
  uint64_t size = w->size;
  if (w->packed) {
    size_t packed;
    COROT_TRY(pack_image(w, &packed));
    size = packed;
  }
  COROT_TRY(file_replace(w->path, w->temporary, w->packed ? w->packed->file : w->image, size));

  char entry[160];
  snprintf(entry, sizeof entry, "<DataSet timestep=\"%.17g\" file=\"fields/fields_%06d.vtu\"/>\n",
           t, w->nframe);
  COROT_TRY(extend_list(w, entry));
  growth_add(&w->sizes, &size, sizeof size);
  w->nframe++;
  return COROT_OK;
}

/* --- Checkpoints --- */

corot_status vtu_pack(vtu *w, pack *p) {
  growth_exchange(p, &w->list);
  corot_pack_int(p, &w->nframe);
  if (w->packed) growth_exchange(p, &w->sizes);
  return corot_pack_status(p);
}

corot_status vtu_synchronise(vtu *w) {
  bool more = w->nsynchronised < w->nframe;
  for (; w->nsynchronised < w->nframe; w->nsynchronised++) {
    set_number(w, w->nsynchronised);
    COROT_TRY(file_synchronise_named(w->path));
  }
  if (more) COROT_TRY(file_synchronise_named(w->folder));
  return file_synchronise(w->pvd, w->pvd_path);
}

/* The closing tags first: the list is well-formed at any time. */
corot_status vtu_cut(vtu *w) {
  COROT_TRY(extend_list(w, ""));
  growth whole = w->list;
  whole.size += (long)sizeof pvd_tail - 1;
  COROT_TRY(growth_cut(w->pvd, w->pvd_path, &whole));
  return folder_remove_frames(w->folder, w->nframe);
}
