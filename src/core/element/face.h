/* Kinds of faces, which surface loads are integrated over: with the shape functions N_i of a face's
   nodes, and x(xi, eta) = sum_i N_i x_i of its points,

     integral of N_i n dA = sum_q part_q N_i (x_xi x x_eta) / 2

   The three-node face has one point, at which all is constant. On the six-node face N_i and the
   cross product are quadratic: six points integrate polynomials of degree four exactly (Dunavant,
   Int. J. Numer. Meth. Engng. 21, 1985). Nodes are the corners, then the middles of the edges 01 12
   20. */
#ifndef COROT_CORE_ELEMENT_FACE_H
#define COROT_CORE_ELEMENT_FACE_H

enum { FACE_NODES = 6, FACE_POINTS = 6 }; /* most */

typedef struct face_kind {
  int nnode, npoint;
  double part[FACE_POINTS]; /* they sum to one */
  /* At each point: gradients of the shape functions of nodes 1, 2, ... by (xi, eta), the volume
     coordinates of corners 1 and 2 (that of node 0 is minus their sum), and the shape functions
     times `over`. */
  double slope[FACE_POINTS][FACE_NODES - 1][2];
  double share[FACE_POINTS][FACE_NODES], over;
} face_kind;

#define TRI6_SLOPE(L0, L1, L2)                                                              \
  {                                                                                         \
    {4 * (L1)-1, 0}, {0, 4 * (L2)-1}, {4 * ((L0) - (L1)), -4 * (L1)}, {4 * (L2), 4 * (L1)}, \
        {-4 * (L2), 4 * ((L0) - (L2))},                                                     \
  }
#define TRI6_SHARE(L0, L1, L2)                                                      \
  {                                                                                 \
    (L0) * (2 * (L0)-1), (L1) * (2 * (L1)-1), (L2) * (2 * (L2)-1), 4 * (L0) * (L1), \
        4 * (L1) * (L2), 4 * (L2) * (L0),                                           \
  }

/* Points of two orbits, their volume coordinates and parts. */
#define TRI6_A 0.44594849091596488632
#define TRI6_B 0.09157621350977074346
#define TRI6_PART_A 0.22338158967801146570
#define TRI6_PART_B 0.10995174365532186764

static const face_kind face_kinds[] = {
    {.nnode = 3,
     .npoint = 1,
     .part = {1},
     .slope = {{{1, 0}, {0, 1}}},
     .share = {{1, 1, 1}},
     .over = 3},
    {.nnode = 6,
     .npoint = 6,
     .part = {TRI6_PART_A, TRI6_PART_A, TRI6_PART_A, TRI6_PART_B, TRI6_PART_B, TRI6_PART_B},
     .slope =
         {TRI6_SLOPE(1 - 2 * TRI6_A, TRI6_A, TRI6_A), TRI6_SLOPE(TRI6_A, 1 - 2 * TRI6_A, TRI6_A),
          TRI6_SLOPE(TRI6_A, TRI6_A, 1 - 2 * TRI6_A), TRI6_SLOPE(1 - 2 * TRI6_B, TRI6_B, TRI6_B),
          TRI6_SLOPE(TRI6_B, 1 - 2 * TRI6_B, TRI6_B), TRI6_SLOPE(TRI6_B, TRI6_B, 1 - 2 * TRI6_B)},
     .share =
         {TRI6_SHARE(1 - 2 * TRI6_A, TRI6_A, TRI6_A), TRI6_SHARE(TRI6_A, 1 - 2 * TRI6_A, TRI6_A),
          TRI6_SHARE(TRI6_A, TRI6_A, 1 - 2 * TRI6_A), TRI6_SHARE(1 - 2 * TRI6_B, TRI6_B, TRI6_B),
          TRI6_SHARE(TRI6_B, 1 - 2 * TRI6_B, TRI6_B), TRI6_SHARE(TRI6_B, TRI6_B, 1 - 2 * TRI6_B)},
     .over = 1},
};

/* That of the faces of a mesh's elements. */
static inline const face_kind *face_kind_of(int order) { return &face_kinds[order - 1]; }

#endif
