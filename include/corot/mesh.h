/* Tetrahedral meshes with named groups: made by hand, read from a file, or generated.

   A mesh is plain data and may be read directly; it is built and destroyed by the functions here.
   Every mesh they hand out is sound: indices in range; coordinates of at most 1e100; tets in
   right-handed order ((x1-x0) x (x2-x0) . (x3-x0) > 0) with a volume above 1e-12 times the cube of
   their longest edge; no tet twice; at most two tets at a face, on either side of it; every node in
   some tet; 3 nnode and 4 ntet fit an int. Nodes and tets are numbered from 0 in the order of the
   file. Lengths are in metres.

   A mesh is of order 1, four-node tets, or all of it of order 2, ten-node tets: these have a node on
   each edge, too, and are the image of a tet under their ten shape functions, so that edges may be
   curved. There each edge has one node, which all its tets share, which is on no other edge and no
   tet's corner, and which is off the middle by at most half the distance of the ends; the Jacobian
   determinant of the map is above 6e-12 times the cube of the longest edge at the ten nodes and at
   the four points with barycentric coordinates (5 + 3 sqrt 5) / 20 and (5 - sqrt 5) / 20; 10 ntet
   fits an int. Everything else that is said of tets, their faces and edges, is said of the corners.

   A complete program: tests/examples/mesh.c. */
#ifndef COROT_MESH_H
#define COROT_MESH_H

#include <corot/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A named part of a mesh. A boundary condition uses its nodes, a traction its triangles,
   a material its tets; a group may have any of the three. */
typedef struct corot_group {
  char *name;
  int nnode;
  int *node; /* [nnode] ascending, no repeats */
  int ntri;
  int (*tri)[3]; /* [ntri] node numbers; faces of the boundary wind outward */
  int ntet;
  int *tet; /* [ntet] ascending, no repeats */
} corot_group;

typedef struct corot_mesh {
  int nnode;
  double (*x)[3]; /* [nnode] rest positions [m] */
  int ntet;
  int (*tet)[4]; /* [ntet] node numbers of the corners */
  int (*mid)[6]; /* [ntet] order 2: the nodes on the edges 01 12 02 03 13 23; NULL: order 1 */
  int ngroup;
  corot_group *group; /* [ngroup] distinct names */
} corot_mesh;

/* Copies `x` [nnode] and `tet` [ntet] into a new mesh without groups. The mesh owns the copies until
   corot_mesh_destroy; a model copies what it needs of a mesh in its turn, and so does each function
   that adds a group: the caller's arrays may go at once.
   COROT_EINVAL names what is not sound, a line for each of the first ten nodes and tets: nothing is
   mended (corot_mesh_read_mended does so with files). COROT_ENOMEM. */
COROT_API corot_status corot_mesh_create(int nnode, const double (*x)[3], int ntet,
                                         const int (*tet)[4], corot_mesh **mesh);

/* The same of order 2: a tet has its corners, then the nodes on its edges 01 12 02 03 13 23, as in
   VTK and Abaqus; gmsh's last two are the other way round. COROT_EINVAL and COROT_ENOMEM as above. */
COROT_API corot_status corot_mesh_create_order_2(int nnode, const double (*x)[3], int ntet,
                                                 const int (*tet)[10], corot_mesh **mesh);

/* 1: four-node tets; 2: ten-node tets. */
COROT_API int corot_mesh_order(const corot_mesh *mesh);

/* A copy of that order, with the same tets in all groups.

   2 of 1: the middles of the edges follow the nodes, in ascending order of their two ends, as one
   octasection would number and place them; a group takes those that it would take there.
   1 of 2: the nodes on the edges are dropped, and the corners close up, so that curved edges become
   straight; a group that had no others is dropped. The one undoes the other.

   COROT_EINVAL: `order` is neither 1 nor 2, or the mesh is too large for order 2. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_change_order(const corot_mesh *mesh, int order, corot_mesh **out);

/* A copy with all groups. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_copy(const corot_mesh *mesh, corot_mesh **copy);

/* Takes NULL. */
COROT_API void corot_mesh_destroy(corot_mesh *mesh);

/* Reads a mesh file. The format is found from the content and, for TetGen, from the suffix:
     gmsh 1 ($NOD/$ELM), 2.2 and 4.1 ($MeshFormat), ASCII and binary of either byte order, 4.0 ASCII;
     TetGen NAME.node + NAME.ele (either path may be given), first index 0 or 1, and NAME.face if it
     is there;
     MEDIT (.mesh, ASCII; .meshb, binary, of versions 1 to 4);
     Abaqus and CalculiX (.inp), with the files that it includes;
     VTK, legacy files (.vtk) of unstructured grids, ASCII and binary, and XML files (.vtu), ASCII,
     base64 or appended, compressed by zlib or not;
     FEBio (.feb), of formats 2.0 to 4.0;
     Netgen (.vol);
     MFEM (.mesh, "MFEM mesh v1.0" to v1.3) with straight edges; VegaFEM (.veg).

   gmsh: 4-node tets become a mesh of order 1, 10-node tets one of order 2; an element that formats
   1 and 2.2 repeat for each of its physical groups becomes one. Physical groups of points, lines of
   2 or 3 nodes, triangles of 3 or 6 and tets, all of one order, become groups with all nodes, those of one name a single one, in the order of $PhysicalNames. Nameless ones follow and
   are called by their number, as "7"; where nameless groups of several dimensions have the same
   number, as "point-7", "line-7", "surface-7", "volume-7". A name without elements makes no group.
   A group's triangles must be faces of tets; those inside the mesh keep the file's winding
   (reversed by a negative physical number in format 4.1). Other lines and surfaces are ignored
   outside physical groups and refused inside; other solids, and tets of both orders in one file, are
   refused (but see corot_mesh_read_mended, here and below). A partitioned mesh of format 4.1 is put together: what is between partitions makes no
   group. Refused, too,
   are tets that list the nodes on their edges in another order than gmsh, which shows in where these
   are. Sections that are not needed are skipped.

   TetGen: region attributes (the last, if there are several), markers of faces and markers of nodes
   become groups "region-N", "face-N" and "marker-N"; 0 stands for none. TetGen 1.5 winds tets as we do; a file whose tets are
   all left-handed is turned round, since the format does not say. Nor does it say in which order
   ten-node tets (TetGen's -o2) list the nodes on their edges, and versions differ: the order is
   found from where the nodes are, and has to be the same in all tets. Nodes on edges have no markers
   and are in the groups of both ends, as after octasection; a face has all its nodes.

   MEDIT: Vertices, Triangles, TrianglesP2, Tetrahedra and TetrahedraP2; references of triangles and
   tets other than 0 become groups, called as gmsh's nameless ones. Triangles of 3 nodes on ten-node
   tets take those on their edges from the tets. The order of nodes on edges is heeded where the file
   says it (TetrahedraP2Ordering). Control points of Bezier's and other solids are refused, other
   keywords skipped.

   Abaqus, CalculiX: *NODE, *ELEMENT of types C3D4 and C3D10 (and C3D4H, C3D10M, ...), *NSET, *ELSET
   (GENERATE, sets in sets that stand before them), *SURFACE of element faces S1 to S4 or of nodes, and
   *INCLUDE; sets and surfaces become groups, those of one name (in which case does not matter) a
   single one. Triangles (S3, CPS3, M3D3, S6, ...) are faces of tets, which a set may have. Other
   solids, a second *PART or *INSTANCE, and what generates nodes or elements are refused; other
   elements, also in sets, and other keywords are skipped.

   VTK: cells of types 10 and 24, tets of 4 and 10 nodes; positive numbers in an array of cells that
   is called CellEntityIds (gmsh), gmsh:physical or medit:ref (meshio) become groups, called as gmsh's
   nameless ones, of the triangles (types 5 and 22), too; whole numbers other than 0 in an array of cells
   or points that is called group:NAME, the group NAME, where %41 is A. Other solids, and XML files of
   several pieces, are refused, other cells skipped.

   FEBio: of <Mesh> or <Geometry>, Nodes, Elements of types tet4 and tet10, NodeSet, ElementSet and
   Surface of triangles; those of one name become one group, and so do Elements and Nodes with a name;
   Elements that have only a material are the group "material-N". Parts and their instances, meshes
   in another file and other solids are refused, shells, trusses and what else there is skipped.

   Netgen: volumeelements and surfaceelements; materials and boundary conditions become groups, by
   their names, or called as gmsh's nameless ones. Its tets are left-handed, and turned round.

   MFEM: elements and boundary; attributes become groups, called as gmsh's nameless ones. Meshes with
   curved nodes are refused.

   VegaFEM: *VERTICES, *ELEMENTS, and each *SET as a group; other keywords are skipped, but *INCLUDE.

   Text may begin with a byte order mark of UTF-8, end its lines with LF, CR LF or CR, and have
   Fortran's exponents, 1D-3; numbers of nodes are not negative.

   Fails with COROT_EIO (cannot be read), COROT_EFORMAT with "FILE:LINE: ..." (text) or
   "FILE: byte N: ..." (binary). What cannot be read at all ends with the first such place; of what
   can be, but is not sound, up to ten faults are told, a line each, by the file's numbers of nodes and
   elements, and how many more there are. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_read(const char *path, corot_mesh **mesh);

/* How a mesh file is read that is not sound as it is. All zero: with what corot_mesh_read_mended does
   in any case. */
typedef struct corot_mending {
  int cut;      /* not 0: hexahedra, prisms and pyramids of first order are cut into tets */
  double merge; /* nodes no further apart become one, the first of them [m]; 0: none do */
  double scale; /* what the file's coordinates are multiplied by, to be metres: 1e-3 for
                   millimetres; 0: as 1 */
} corot_mending;

/* Kinds of what has been done. */
typedef enum corot_mended {
  COROT_MENDED_UNUSED,   /* nodes in no tet, left out */
  COROT_MENDED_TURNED,   /* left-handed tets, turned round */
  COROT_MENDED_REPEATED, /* tets that are there before, left out */
  COROT_MENDED_MERGED,   /* nodes that became others */
  COROT_MENDED_CUT,      /* tets that other solids have become */
  COROT_MENDED_LOST,     /* groups that a file format cannot hold (corot_mesh_write_as) */
} corot_mended;

/* One thing that has been done, however often. */
typedef struct corot_remark {
  corot_mended what;
  int count;  /* of nodes, tets or groups; 0: it is told of a group beside these */
  char *text; /* in words, with the first of the numbers in the file */
} corot_remark;

typedef struct corot_mesh_report {
  int nremark;
  corot_remark *remark; /* [nremark] */
} corot_mesh_report;

/* As corot_mesh_read, but what is only written down wrongly is mended, and told in *report, which is
   the caller's to destroy and has no remarks where nothing was to be mended:

     nodes in no tet, as the centres of arcs that gmsh writes, are left out, and the others numbered
     without them; groups lose them, and a group that has no others is left out, too;
     left-handed tets are turned round: corners 0 and 1 change places, and the nodes on edges with them;
     of tets with the same corners the first stays, in the groups of all of them; at order 2 only
     if the nodes on their edges are the same as well;
     if `mending` asks for it, other solids are cut into tets, so that neighbours match (each
     quad by the diagonal from its corner of the lowest number: Dompierre, Labbe, Vallet and Camarero
     1999), quads in groups into triangles, corners that a solid has twice being one; and nodes are
     merged. The tets of a solid are in its place and in its groups.

   `mending` may be NULL. What cannot be mended is refused: flat tets, coordinates that are no numbers,
   nodes that do not exist, three tets at a face or two on one side of it, solids that are not
   to be cut, are folded, or have tets at a quad that do not match its diagonal. COROT_EFORMAT, COROT_EIO, COROT_ENOMEM as of corot_mesh_read; COROT_EINVAL:
   `merge` or `scale` is negative, or no number. */
COROT_API corot_status corot_mesh_read_mended(const char *path, const corot_mending *mending,
                                              corot_mesh **mesh, corot_mesh_report **report);

/* Takes NULL. */
COROT_API void corot_mesh_report_destroy(corot_mesh_report *report);

/* How the cells of a box are cut into tets. A bent box of KUHN's cells, whose diagonals all point the
   same way, drifts sideways by up to a third of its deflection. */
typedef enum corot_box_split {
  /* Kuhn's: the six tets of a cell are the paths from its low to its high corner along the axes. */
  COROT_BOX_KUHN,
  /* Kuhn's cell, mirrored in each axis along which its index is odd. Where a count is even, the mesh
     is its own mirror image in that axis; where it is odd it is not, and drift is left, of about a
     tenth of KUHN's for 3 x 3 cells. */
  COROT_BOX_ALTERNATING,
  /* The same, with the middle one of an odd number of cells cut in halves first, so that the mesh is
     its own mirror image in all three axes: nothing drifts. */
  COROT_BOX_SYMMETRIC,
} corot_box_split;

/* A box of nx*ny*nz cells, each cut into six tets. */
typedef struct corot_box {
  double size[3];   /* [m] > 0 */
  int cells[3];     /* > 0 */
  double origin[3]; /* [m] the corner with the smallest coordinates */
  corot_box_split split;
} corot_box;

/* Split SYMMETRIC, which is recommended, origin 0; size and cells, which are to be set, 0. A box
   that is zero elsewhere is split as KUHN, node for node as before there was a choice. */
COROT_API corot_box corot_box_defaults(void);

/* Neighbouring cells match. Node (i,j,k) has the number i + (nx+1)(j + (ny+1)k), where a count that
   SYMMETRIC has made even is one larger than in `cells`. Octasection along the consistent diagonal
   cuts the halves of each cell as the cell was cut (Bey 1995). The six sides are groups
   xmin xmax ymin ymax zmin zmax. COROT_EINVAL: a size or a count is not positive, the origin is not
   finite, there is no such split, there would be too many tets, or cells so thin that rounding makes
   them flat. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_box(const corot_box *box, corot_mesh **mesh);

/* Writes gmsh 2.2 ASCII, with all groups as physical groups of points, triangles and tets, of 6 and
   10 nodes at order 2: reading
   it gives the same mesh to the last bit, but that a group has all nodes of its faces and tets, which
   a difference of others (corot_mesh_group_combine) need not have. Written beside `path` first, so that a failed write
   (COROT_EIO, COROT_ENOMEM) leaves what was there. */
COROT_API corot_status corot_mesh_write(const corot_mesh *mesh, const char *path);

/* The same in another format: "gmsh" (4.1), "gmsh-2.2", "vtu", "vtk" (legacy), "tetgen", "medit" or
   "abaqus"; NULL: by the suffix of `path`, .msh being gmsh 4.1, .vtu, .vtk, .node or .ele, .mesh and .inp.
   Text, all numbers with every bit. TetGen's three files have the name without its suffix, and
   .node, .ele, .face.

   Read again, nodes and tets are the same, in the same order, and so are groups, but for: TetGen and
   MEDIT have one number for each tet and triangle, so that names become numbers ("face-2",
   "surface-2"; a name that is such a number keeps it), and of groups that share some the first has
   these; MEDIT has no groups of nodes. Abaqus does not tell the case of names, and has no commas in
   them. In VTK's files a group is an array of 0 and 1 called group:NAME, of cells and of points.
   *report, unless it is NULL, has what was lost so, and is the caller's to destroy.

   COROT_EINVAL: there is no such format, or the suffix is of none; two groups would be one. COROT_EIO,
   COROT_ENOMEM. */
COROT_API corot_status corot_mesh_write_as(const corot_mesh *mesh, const char *path,
                                           const char *format, corot_mesh_report **report);

/* The name of the format that it would be written in; NULL, with a message, where it fails. */
COROT_API const char *corot_mesh_format(const char *format, const char *path);

/* NULL where there is none of that name. */
COROT_API const corot_group *corot_mesh_find_group(const corot_mesh *mesh, const char *name);

/* Add a group by its nodes. The boundary faces and the tets whose corners are all in the group
   belong to it. At order 2 the nodes on edges that octasection would add (below) belong to it, too,
   beside those that are listed: those of which both ends do, but for edges through the inside that
   join parts of a surface. COROT_EINVAL: the name is taken, empty, longer than 127 bytes or has quotes or
   control characters; a node is out of range; no node is selected. COROT_ENOMEM. The mesh is as it
   was then; this holds for the next two, too. */
COROT_API corot_status corot_mesh_group_nodes(corot_mesh *mesh, const char *name, int nnode,
                                              const int *node);

/* The nodes with |x[axis] - at| <= tol, at order 2 the corners, and nodes on edges as above; tol = 0 stands for 1e-6 of the mesh's diagonal.
   COROT_EINVAL, COROT_ENOMEM as above; COROT_EINVAL, too, if axis is not 0, 1 or 2, if `at` is not a
   number, or if tol is negative or none. */
COROT_API corot_status corot_mesh_group_plane(corot_mesh *mesh, const char *name, int axis,
                                              double at, double tol);

/* The nodes with min - tol <= x <= max + tol in each coordinate; tol and failures as above, and
   COROT_EINVAL if min is not at most max. */
COROT_API corot_status corot_mesh_group_box(corot_mesh *mesh, const char *name, const double min[3],
                                            const double max[3], double tol);

/* The nodes in a shape, or at most `tol` outside of it; tol and failures as above. A sphere. COROT_EINVAL,
   too, if the radius is not > 0, or a coordinate is not finite. Where no node is there, the message has
   the nearest and how far outside it is; of box and plane the same. */
COROT_API corot_status corot_mesh_group_sphere(corot_mesh *mesh, const char *name,
                                               const double center[3], double radius, double tol);

/* A round cylinder, whose flat ends have their centers in `from` and `to`; as above, and COROT_EINVAL
   if these are one point. */
COROT_API corot_status corot_mesh_group_cylinder(corot_mesh *mesh, const char *name,
                                                 const double from[3], const double to[3],
                                                 double radius, double tol);

/* The half of space that begins at a plane through `point` and that `normal`, of any length but 0,
   points into; COROT_EINVAL as above, and if the normal has no direction. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_group_half_space(corot_mesh *mesh, const char *name,
                                                   const double point[3], const double normal[3],
                                                   double tol);

/* Adds a group of the boundary faces whose outward normals, of the flat triangle of the corners, make
   an angle of at most `angle` [rad] (and 1e-6) with `direction`, of any length but 0; with their
   nodes, and no tets. COROT_EINVAL: there is none, and the message has the smallest angle; the
   direction is zero or not finite; the angle is negative, above 4 or none; of the name as above.
   COROT_ENOMEM. */
COROT_API corot_status corot_mesh_group_normal(corot_mesh *mesh, const char *name,
                                               const double direction[3], double angle);

/* Adds a group of the nodes that are at most `distance` [m] (and 1e-6 of the mesh's diagonal) away from
   the nodes, faces and tets of the group `other`, which are among them; of order 2 the corners, from
   flat faces, and nodes on edges as above. COROT_EINVAL: there is no such group, or the distance is
   negative or not finite; at order 2, all nodes of the other are on edges, and no corner is near. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_group_near(corot_mesh *mesh, const char *name, const char *other,
                                             double distance);

typedef enum corot_set_operation {
  COROT_UNION,        /* what is in one of the groups */
  COROT_INTERSECTION, /* what is in all */
  COROT_DIFFERENCE,   /* what is in the first and in none of the others */
} corot_set_operation;

/* Adds a group made of the groups `other` [n], n >= 2: of their nodes, of their faces, whichever way
   these wind, and of their tets, each by themselves. So a union has no face that only some corners
   of each have, and a difference keeps faces whose corners are in the others, too, as nodes do not:
   where the sides of a box meet, "zmax without xmin" has all triangles of zmax and not the nodes of
   the edge. COROT_EINVAL: no node is left; there is no such group or operation, or n < 2; of the name
   as above. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_group_combine(corot_mesh *mesh, const char *name,
                                                corot_set_operation operation, int n,
                                                const char *const *other);

/* Add a group of listed tets, with all their nodes and no triangles: what a material fills.
   COROT_EINVAL: no tet is listed, or one that does not exist; of the name as above. COROT_ENOMEM.
   In this and the next a repeated entry counts once. */
COROT_API corot_status corot_mesh_group_tets(corot_mesh *mesh, const char *name, int ntet,
                                             const int *tet);

/* Add a group of listed triangles, with all their nodes, at order 2 those on the edges too, and no
   tets: what a traction or a pressure acts on. `tri` [ntri] are corners; each triangle is the face
   of a tet. On the boundary it is turned to wind outward, inside the mesh it stays as it is.
   COROT_EINVAL: none is listed, or one (which is named) is no face of a tet; of the name as above.
   COROT_ENOMEM. */
COROT_API corot_status corot_mesh_group_triangles(corot_mesh *mesh, const char *name, int ntri,
                                                  const int (*tri)[3]);

/* The faces that belong to one tet only, winding outward. *tri [*ntri] is the caller's to free.
   COROT_ENOMEM. */
COROT_API corot_status corot_mesh_boundary(const corot_mesh *mesh, int *ntri, int (**tri)[3]);

/* Of a mesh of order 2 all nodes of triangles that are faces of its tets: the corners, then the nodes
   on the edges 01 12 20. *node [ntri] is the caller's to free. COROT_EINVAL: the mesh is of order 1.
   COROT_ENOMEM. */
COROT_API corot_status corot_mesh_face_nodes(const corot_mesh *mesh, int ntri, const int (*tri)[3],
                                             int (**node)[6]);

/* The node nearest to a point; the lower number wins a tie. */
COROT_API int corot_mesh_nearest(const corot_mesh *mesh, const double point[3]);

/* A place in the body at rest: a tet, and what its shape functions are there. A nodal field f has the
   value sum_k weight[k] f[node[k]]. */
typedef struct corot_location {
  int tet;           /* of several that share the place, one */
  double at[4];      /* its volume coordinates; of a curved tet those in its reference element */
  int nnode;         /* 1 at a node, else those of the tet */
  int node[10];      /* [nnode] */
  double weight[10]; /* [nnode] they sum to one */
  double x[3];       /* [m] */
  double distance;   /* from the point that was looked for [m]; 0: that is in the body */
} corot_location;

/* Where a point is; a node, if one is within 1e-9 of the mesh's diagonal. Of a point outside the
   body, the nearest of its surface (at a node or on an edge to 1e-8 of a face's size). In a curved
   tet by Newton's method. COROT_EINVAL: the point is not finite. COROT_ENOMEM. */
COROT_API corot_status corot_mesh_locate(const corot_mesh *mesh, const double point[3],
                                         corot_location *location);

/* That of a node, 0 <= node < nnode, in the first tet that has it. */
COROT_API corot_location corot_mesh_locate_node(const corot_mesh *mesh, int node);

/* Size and shape of a mesh. */
typedef struct corot_mesh_quality {
  double min[3], max[3];          /* bounding box [m] */
  double volume;                  /* sum [m^3]; of the curved tets at order 2 */
  double volume_min, volume_max;  /* of a tet [m^3] */
  double edge_min, edge_max;      /* [m], here and below of the corners */
  double dihedral_min, dihedral_max; /* [degree] */
  double shape_min, shape_mean;   /* 3 inradius / circumradius: 1 regular, 0 flat */
  int shape_worst;                /* the tet with shape_min */
} corot_mesh_quality;

COROT_API corot_mesh_quality corot_mesh_measure(const corot_mesh *mesh);

/* Octasection: every tet is cut into eight, of equal volume unless it is curved. The middles of its edges cut off four
   corners; what remains is an octahedron, cut into four along one of its three diagonals. */
typedef enum corot_diagonal {
  /* Bey's (1995): inherited, so that a tet has descendants of at most three shapes, however often
     and in however many calls it is refined. It is from the middle of edge 02 to that of edge 13;
     or, where the tet's node numbers are an odd permutation of ascending ones, from edge 01 to 23.
     Children have their nodes in such an order. */
  COROT_DIAGONAL_CONSISTENT,
  /* The shortest; the consistent one where no other is shorter. Better shapes on the average, but
     more of them with every level. */
  COROT_DIAGONAL_SHORTEST,
} corot_diagonal;

/* How a refined mesh descends from the unrefined one, level 0. */
typedef struct corot_refinement {
  int nlevel;
  int *nnode; /* [nlevel + 1] the nodes of level l are those below nnode[l], of all finer levels */
  int *ntet;  /* [nlevel + 1] ntet[0] times 8^l; of a level that corot_refinement_raise made, those
                 of the level below */
  int (*parent)[2]; /* [nnode[nlevel] - nnode[0]] ends of the edge of which node nnode[0] + i is the
                       middle: nodes of a coarser level, ascending; of order 2 the ends of the edge
                       on which it is, corners of its own level, which are the nodes of the coarser */
  int *node; /* [nnode[nlevel]] the mesh's number of each node, where all that is said here of nodes
                is said of places in this list (corot_refinement_lower); NULL: the numbers are these */
} corot_refinement;

/* Refines `nlevel` >= 0 times; 0 copies. Neighbouring tets still share whole faces.

   Nodes keep their numbers, and their positions to the last bit; the middles of the edges follow,
   level by level, in ascending order of their two ends. Children 8 e to 8 e + 7 come from tet e,
   the first four from its corners: node k of child 8 e + k is node k of e. At order 1 new nodes lie
   on straight edges: a curved surface stays as faceted as it was.

   A mesh of order 2 stays one, of the same shape: all its nodes become corners, and the new ones, on
   the edges of the children, lie where its shape functions have them. So a mesh that is refined and
   then raised, and one that is raised and then refined, are the same to the last bit.

   Groups keep their order. The children of a tet or triangle are in the groups of their parent,
   and wind as it does. A new node is in the groups of which both its parents are nodes, with two
   exceptions. Where both parents belong to triangles or tets of the group, their edge must be one
   of these. Elsewhere in a group with no node inside the mesh, their edge must be on the boundary.
   So a part of the surface does not spread across the inside, even if it is given by nodes alone;
   but a section of a body so thin that it has no node inside is not filled up either: add such a
   group to the refined mesh.

   `refinement` may be NULL. COROT_EINVAL: nlevel is negative, there is no such diagonal, there would
   be too many tets, or ones so flat, or so strongly curved, that they are none. COROT_ENOMEM. It needs
   up to 50 bytes a tet of the result while it works, 250 at order 2. */
COROT_API corot_status corot_mesh_refine(const corot_mesh *mesh, int nlevel,
                                         corot_diagonal diagonal, corot_mesh **fine,
                                         corot_refinement **refinement);

/* Local refinement: every tet of `mark` [nmark] is cut into at least eight, none of more than an eighth
   of its volume, and its neighbours as far as their faces have to match. A number may occur twice;
   nothing marked makes a copy.

   Tets are cut in halves, from the middle of their longest edge to the other two corners (Rivara 1984);
   of edges that are equally long to 1e-9 the one with the lower of the higher ends counts as longest,
   then the one with the lower of the lower ends. A marked tet is cut three times over. Nothing of how a
   mesh came about is needed, so that it can be refined again at any time, also once it has been written
   and read. Cubes in six (COROT_BOX_KUHN) keep to three shapes of tets, however often they are
   cut; of others no more is proven than that the cutting ends. In 12 refinements of meshes by gmsh
   towards a corner or an edge no shape measure fell below a third of the mesh's worst, and in five of a
   third of all tets, by chance, below a fifth; of boxes with cells ten times as long as wide to a
   twelfth at once, and no further.

   Nodes keep their numbers, and their positions to the last bit; new ones follow, round by round, in
   ascending order of the ends of their edges. The parts of a tet stand in its place, so that tets that
   are not cut keep their order; `*parent` [(*fine)->ntet], which may be NULL, is the tet of `mesh` that
   each comes from, ascending, and the caller's to free. At order 1 new nodes are the middles of straight
   edges; a mesh of order 2 stays one, of the same shape: a node on an edge that is cut becomes a
   corner, and those on the new edges lie where the shape functions have them. Groups as above, by the
   edges that are cut; whether a group has nodes inside the mesh is asked before it is refined.

   COROT_EINVAL: there is no such tet, there would be too many, or ones so flat, or so strongly curved,
   that they are none. COROT_ENOMEM. It needs up to 350 bytes a tet of the result while it works, 500 at
   order 2. */
COROT_API corot_status corot_mesh_refine_marked(const corot_mesh *mesh, int nmark, const int *mark,
                                                corot_mesh **fine, int **parent);

/* Adds a level: that the finest mesh has become `raised`, by corot_mesh_change_order to order 2. The
   nodes on its edges are the nodes of the new level, with the ends of the edges as parents; as there
   are no more tets, ntet[nlevel] = ntet[nlevel - 1]. The mean of the parents is how linear functions
   on the tets enter the ten-node ones: a multigrid method or a hierarchical basis needs no more.
   COROT_EINVAL: `raised` is not that. COROT_ENOMEM. The refinement is as it was then. */
COROT_API corot_status corot_refinement_raise(corot_refinement *refinement,
                                              const corot_mesh *raised);

/* Adds a level below: that of the corners of level 0, `mesh`, which is of order 2. They are the nodes
   of the new level 0, in ascending order, and the nodes on its edges those of the next, with the ends
   of the edges as parents. However the mesh numbers both, the refinement's nodes stand in the order of
   the levels: `node` has the mesh's numbers. A refinement that has that list already cannot be lowered,
   nor be a hierarchy's (corot/model.h). COROT_EINVAL: `mesh` is not that. COROT_ENOMEM. The refinement is as
   it was then. */
COROT_API corot_status corot_refinement_lower(corot_refinement *refinement, const corot_mesh *mesh);

/* Takes NULL. */
COROT_API void corot_refinement_destroy(corot_refinement *refinement);

#ifdef __cplusplus
}
#endif
#endif
