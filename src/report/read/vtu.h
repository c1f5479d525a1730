/* One file of fields, opened to read arrays from. See fields.h. */
#ifndef COROT_REPORT_READ_VTU_H
#define COROT_REPORT_READ_VTU_H

#include <corot/base.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct vtu_file {
  const char *path;
  int fd;
  long long size, data; /* bytes; where the arrays begin */
  int nnode, ntet;
  bool compressed;   /* app/folder/zlib_array.h */
  char header[8192]; /* the XML before the data, and a terminator */
} vtu_file;

/* `path` must outlive the file. COROT_EIO, or COROT_EFORMAT with what is not as expected. */
corot_status vtu_open(const char *path, vtu_file *file);
void vtu_close(vtu_file *file);

/* Reads the array of this name and VTK type ("Float64", "Int32"), which must have `bytes` bytes. */
corot_status vtu_array(const vtu_file *file, const char *name, const char *type, size_t bytes,
                       void *values);

/* Whether its tets have four nodes, 1, or ten, 2. */
corot_status vtu_order(const vtu_file *file, int *order);

#endif
