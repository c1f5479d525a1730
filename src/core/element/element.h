/* Kinds of elements: a row each. The loops over elements take their kind as a constant, as they
   take the strain measure, so that the counts below are known where they are compiled.

   An element's displacement is interpolated by shape functions of its nodes, and its energy is
   summed over points of integration:

     F_q = I + sum_a u_a g_qa',    E = sum_q w_q psi(F_q),    f_a = -sum_q w_q P_q g_qa

   with the gradients g_qa of the shape functions at rest, and the weights w_q, of each element.
   They follow from the reference element's by the Jacobian at the point, so that edges may be
   curved. */
#ifndef COROT_CORE_ELEMENT_ELEMENT_H
#define COROT_CORE_ELEMENT_ELEMENT_H

enum { KIND_NODES = 4, KIND_POINTS = 1, KIND_PAIRS = KIND_NODES * (KIND_NODES - 1) / 2 }; /* most */

typedef struct element_kind {
  int nnode;  /* corners first */
  int npoint; /* of integration */
  int npair;  /* of nodes: the edges of the element's part of a graph */
  /* At each point: the gradients of the shape functions of nodes 1, 2, ... in the reference element
     with the corners 0, e_x, e_y, e_z (that of node 0 is minus their sum), and the part of the
     volume that the point stands for. */
  double slope[KIND_POINTS][KIND_NODES - 1][3];
  double part[KIND_POINTS];
  /* The mass matrix of a unit of mass, the same in each component: whole numbers over one
     denominator; and lumped. */
  int mass[KIND_NODES][KIND_NODES], mass_over;
  int lumped[KIND_NODES], lumped_over;
  int vtk; /* what VTK numbers it by */
} element_kind;

enum { TET4, NKIND };

static const element_kind element_kinds[NKIND] = {
    [TET4] = {.nnode = 4,
              .npoint = 1,
              .npair = 6,
              .slope = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
              .part = {1},
              .mass = {{2, 1, 1, 1}, {1, 2, 1, 1}, {1, 1, 2, 1}, {1, 1, 1, 2}},
              .mass_over = 20,
              .lumped = {1, 1, 1, 1},
              .lumped_over = 4,
              .vtk = 10},
};

/* Pairs (a, b), a > b, of an element's nodes, in the order in which they enter a matrix. */
static const int pair_row[KIND_PAIRS] = {1, 2, 3, 2, 3, 3};
static const int pair_col[KIND_PAIRS] = {0, 0, 0, 1, 1, 2};

#endif
