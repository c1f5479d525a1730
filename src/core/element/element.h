/* Kinds of elements: a row each. The loops over elements take their kind as a constant, as they
   take the strain measure, so that the counts below are known where they are compiled.

   An element's displacement is interpolated by shape functions of its nodes, and its energy is
   summed over points of integration:

     F_q = I + sum_a u_a g_qa',    E = sum_q w_q psi(F_q),    f_a = -sum_q w_q P_q g_qa

   with the gradients g_qa of the shape functions at rest, and the weights w_q, of each element.
   They follow from the reference element's by the Jacobian at the point, so that edges may be
   curved.

   The nodes of a kind are numbered as the mesh has them: corners first, then the middles of the
   edges 01 12 02 03 13 23 (Zienkiewicz & Taylor, The Finite Element Method, I; L are the volume
   coordinates):

     linear:   N_i = L_i                        one point, the centroid
     ten-node: N_i = L_i (2 L_i - 1), N_ij = 4 L_i L_j
               four points with L = a once and b three times, which integrate quadratic functions
               exactly: 24 strains, as many as there are modes that deform

   On curved edges the products det(J) g_a are of degree three. What the rule then leaves out goes
   with the product of two offsets of an edge's node from its middle, in forces, and of three, in
   the volume: with h the offsets, an affine motion is in equilibrium (the patch test) to h^2, and
   the weights sum to the volume to h^3. Both hold exactly where edges are straight, in particular;
   the first where the offsets of an element are parallel, the second where they lie in a plane. */
#ifndef COROT_CORE_ELEMENT_ELEMENT_H
#define COROT_CORE_ELEMENT_ELEMENT_H

/* The most that a kind has. */
enum { KIND_NODES = 10, KIND_POINTS = 4, KIND_PAIRS = KIND_NODES * (KIND_NODES - 1) / 2 };

typedef struct element_kind {
  int number; /* its own, of the table */
  int order;  /* of the shape functions */
  int nnode;
  int npoint; /* of integration */
  int npair;  /* of nodes: the edges of the element's part of a graph, (a, b) with a > b, */
  int pair[KIND_PAIRS][2]; /* in the order in which they enter a matrix: by columns */
  /* At each point: the gradients of the shape functions of nodes 1, 2, ... in the reference element
     with the corners 0, e_x, e_y, e_z (that of node 0 is minus their sum), and the part of the
     volume that the point stands for, where edges are straight. */
  double slope[KIND_POINTS][KIND_NODES - 1][3];
  double part[KIND_POINTS];
  /* The mass matrix of a unit of mass where edges are straight, the same in each component: whole
     numbers over one denominator; and lumped: by row sums, or, where these are not positive, in
     proportion to the diagonal (Hinton, Rock & Zienkiewicz 1976). */
  int mass[KIND_NODES][KIND_NODES], mass_over;
  int lumped[KIND_NODES], lumped_over;
  int vtk; /* what VTK numbers it by */
} element_kind;

enum { TET4, TET10, NKIND };

/* Row q of the points of integration of the ten-node tet, with its volume coordinates. */
#define TET10_A 0.58541019662496845446 /* (5 + 3 sqrt(5)) / 20 */
#define TET10_B 0.13819660112501051518 /* (5 - sqrt(5)) / 20 */
#define TET10_SLOPE(L0, L1, L2, L3)                             \
  {                                                             \
    {4 * (L1)-1, 0, 0}, {0, 4 * (L2)-1, 0}, {0, 0, 4 * (L3)-1}, \
        {4 * ((L0) - (L1)), -4 * (L1), -4 * (L1)}, /* 01 */     \
        {4 * (L2), 4 * (L1), 0},                   /* 12 */     \
        {-4 * (L2), 4 * ((L0) - (L2)), -4 * (L2)}, /* 02 */     \
        {-4 * (L3), -4 * (L3), 4 * ((L0) - (L3))}, /* 03 */     \
        {4 * (L3), 0, 4 * (L1)},                   /* 13 */     \
        {0, 4 * (L3), 4 * (L2)},                   /* 23 */     \
  }

static const element_kind element_kinds[NKIND] = {
    [TET4] = {.number = TET4,
              .order = 1,
              .nnode = 4,
              .npoint = 1,
              .npair = 6,
              .pair = {{1, 0}, {2, 0}, {3, 0}, {2, 1}, {3, 1}, {3, 2}},
              .slope = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
              .part = {1},
              .mass = {{2, 1, 1, 1}, {1, 2, 1, 1}, {1, 1, 2, 1}, {1, 1, 1, 2}},
              .mass_over = 20,
              .lumped = {1, 1, 1, 1},
              .lumped_over = 4,
              .vtk = 10},
    [TET10] = {.number = TET10,
               .order = 2,
               .nnode = 10,
               .npoint = 4,
               .npair = 45,
               .pair = {{1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}, {6, 0}, {7, 0}, {8, 0}, {9, 0},
                        {2, 1}, {3, 1}, {4, 1}, {5, 1}, {6, 1}, {7, 1}, {8, 1}, {9, 1}, {3, 2},
                        {4, 2}, {5, 2}, {6, 2}, {7, 2}, {8, 2}, {9, 2}, {4, 3}, {5, 3}, {6, 3},
                        {7, 3}, {8, 3}, {9, 3}, {5, 4}, {6, 4}, {7, 4}, {8, 4}, {9, 4}, {6, 5},
                        {7, 5}, {8, 5}, {9, 5}, {7, 6}, {8, 6}, {9, 6}, {8, 7}, {9, 7}, {9, 8}},
               .slope = {TET10_SLOPE(TET10_A, TET10_B, TET10_B, TET10_B),
                         TET10_SLOPE(TET10_B, TET10_A, TET10_B, TET10_B),
                         TET10_SLOPE(TET10_B, TET10_B, TET10_A, TET10_B),
                         TET10_SLOPE(TET10_B, TET10_B, TET10_B, TET10_A)},
               .part = {0.25, 0.25, 0.25, 0.25},
               .mass = {{6, 1, 1, 1, -4, -6, -4, -4, -6, -6},
                        {1, 6, 1, 1, -4, -4, -6, -6, -4, -6},
                        {1, 1, 6, 1, -6, -4, -4, -6, -6, -4},
                        {1, 1, 1, 6, -6, -6, -6, -4, -4, -4},
                        {-4, -4, -6, -6, 32, 16, 16, 16, 16, 8},
                        {-6, -4, -4, -6, 16, 32, 16, 8, 16, 16},
                        {-4, -6, -4, -6, 16, 16, 32, 16, 8, 16},
                        {-4, -6, -6, -4, 16, 8, 16, 32, 16, 16},
                        {-6, -4, -6, -4, 16, 16, 8, 16, 32, 16},
                        {-6, -6, -4, -4, 8, 16, 16, 16, 16, 32}},
               .mass_over = 420,
               .lumped = {3, 3, 3, 3, 16, 16, 16, 16, 16, 16},
               .lumped_over = 108,
               .vtk = 24},
};

#endif
