/* Fields for ParaView and VTK: one .vtu file a frame, and a .pvd file that lists them by time.

   Cells are tets of four nodes (VTK type 10) or, of a mesh of order 2, of ten (type 24, whose order
   of nodes is the mesh's). Points stand at rest; the deformed shape is theirs plus the point vector
   `displacement` (ParaView: Warp By Vector, scale 1), so that fields over the rest shape stay
   available.

     point data  displacement [m], velocity [m/s]
     cell data   frame      R, row-major, 9 components
                 strain     6 components in VTK's order XX YY ZZ XY YZ XZ, off-diagonal not doubled;
                            in the frame or in material axes as the strain measure has it
                 von_mises  of the Cauchy stress [Pa]
                 det        volume over rest volume
                 material   number of the tet's entry in the scenario's list of materials, from 0
                 of order 2, where the first four are means over a tet, also frame_points,
                            strain_points, von_mises_points, det_points: the same at the tet's four
                            points of integration, one after another, point k the one next to corner
                            k (see corot_element_fields)
     field data  TimeValue [s]

   Of modes there is one frame each, whose TimeValue is the mode's number from 1:

     point data  displacement  to what the modes are about and on by the mode, made MODE_SHOWN [m]
                 mode          as it is, with x' M x = 1 kg m^2 [m]
     cell data   material

   Numbers are Float64 as they stand in memory ("appended raw", UInt64 sizes), each array at a
   multiple of 8 bytes; or compressed. A frame appears as a whole, by renaming, and is listed after
   that: whenever the program is killed, the folder can be opened. */
#ifndef COROT_APP_FOLDER_WRITE_VTU_H
#define COROT_APP_FOLDER_WRITE_VTU_H

#include <corot/mesh.h>
#include <stddef.h>

#include "growth.h"

typedef struct vtu vtu;

/* Where the next frame's values are put; the arrays belong to the writer and stay where they are.
 */
typedef struct vtu_fields {
  double (*displacement)[3], (*velocity)[3]; /* [nnode] */
  double (*mode)[3];                         /* [nnode] of modes, which lack velocity */
  double (*frame)[9], (*strain)[6];          /* [ntet] and all of these */
  double *von_mises, *det;                   /* [ntet] */
  /* [ntet] at the points of a mesh of order 2; NULL: it is of order 1 */
  double (*frame_at)[4][9], (*strain_at)[4][6];
  double (*von_mises_at)[4], (*det_at)[4];
} vtu_fields;

/* How the arrays are in a file: as they are in memory, or each compressed (zlib_array.h), bit for
   bit the same when it is read. Then the attribute of VTKFile that says so. */
typedef enum vtu_data { VTU_RAW, VTU_ZLIB } vtu_data;
#define VTU_COMPRESSOR " compressor=\"vtkZLibDataCompressor\""

/* Makes DIR/fields and an empty DIR/fields.pvd. material: [ntet]. All memory is taken here. The
   mesh must outlive the writer. */
corot_status vtu_create(const char *dir, const corot_mesh *mesh, const int *material, vtu_data data,
                        vtu **out);

corot_status vtu_create_modes(const char *dir, const corot_mesh *mesh, const int *material,
                              vtu_data data, vtu **out);

/* The largest displacement of a mode as it is shown, over the length of the model. */
#define MODE_SHOWN 0.1

/* Bytes of a frame of a motion, but for a few kB of text; of one that is compressed, more than it
   has. */
size_t vtu_bytes(const corot_mesh *mesh);

vtu_fields vtu_arrays(vtu *w);

/* Writes the arrays as they are now to DIR/fields/fields_NNNNNN.vtu, counting from 0. */
corot_status vtu_write(vtu *w, double t);

/* How far it has come. Then the writer as it was, which changes nothing of the files until
   vtu_cut() takes away the frames since; the frames before are looked at for their sizes. And what
   is written is on the disk. Failures as of growth_reopen. */
corot_status vtu_pack(vtu *w, pack *p);
corot_status vtu_resume(const char *dir, const corot_mesh *mesh, const int *material, vtu_data data,
                        pack *p, vtu **out);
corot_status vtu_cut(vtu *w);
corot_status vtu_synchronise(vtu *w);

/* Ends the list of frames and reports an error that shows up on closing; the arrays stay. */
corot_status vtu_finish(vtu *w);

/* Takes NULL. */
void vtu_destroy(vtu *w);

#endif
