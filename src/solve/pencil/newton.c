/* Newton's system of 2n unknowns by way of the pencil. That of y' = f,

     du - g dv = r_u,    g M^-1 K du + (I + g M^-1 D) dv = r_v,

   becomes (M + g D + g^2 K) dv = M r_v - g K r_u, then du = r_u + g dv, with the g of the set-up.

   That of F(t, y, y') = (u' - v, M v' - r), with the leading coefficient c = dy'/dy of the method
   and g = 1/c,

     c du - dv = F_u,    K du + (c M + D) dv = F_v,

   becomes (M + g D + g^2 K) dv = g (F_v - g K F_u), then du = g (F_u + dv): the matrix is that of
   y' = f at gamma = g. M is only multiplied by, so a consistent one costs no solve. */
#include "pencil.h"
#include "wall_clock.h"

/* Whether S is the matrix of a step. */
static corot_status check_step(const corot_pencil *p) {
  COROT_TRY(corot_pencil_check(p, "corot_pencil_newton"));
  if (p->a == 1 && p->c == p->b * p->b) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "pencil: S = %g M + %g D + %g K is not M + g D + g^2 K, the matrix of a step",
                    p->a, p->b, p->c);
}

corot_status corot_pencil_newton(corot_pencil *p, const double *r, double *x) {
  COROT_TRY(check_step(p));
  int n = p->n;
  double start = clock_wall(), g = p->gamma;
  const double *ru = r, *rv = r + n;
  double *du = x, *dv = x + n, *Kru = p->work, *rhs = Kru + n;

  corot_block_multiply(p->model, (const double(*)[9])p->K, ru, Kru);
  corot_mass_multiply(p->model, rv, rhs);
  for (int i = 0; i < n; i++) rhs[i] -= g * Kru[i];
  p->counts.solve_s += clock_wall() - start;
  COROT_TRY(corot_pencil_solve(p, rhs, rhs));
  for (int i = 0; i < n; i++) {
    du[i] = ru[i] + g * rhs[i];
    dv[i] = rhs[i];
  }
  return COROT_OK;
}

corot_status corot_pencil_newton_dae(corot_pencil *p, const double *F, double *x) {
  COROT_TRY(check_step(p));
  int n = p->n;
  double start = clock_wall(), g = p->gamma;
  const double *Fu = F, *Fv = F + n;
  double *du = x, *dv = x + n, *KFu = p->work, *rhs = KFu + n;

  corot_block_multiply(p->model, (const double(*)[9])p->K, Fu, KFu);
  for (int i = 0; i < n; i++) rhs[i] = g * (Fv[i] - g * KFu[i]);
  p->counts.solve_s += clock_wall() - start;
  COROT_TRY(corot_pencil_solve(p, rhs, rhs));
  for (int i = 0; i < n; i++) {
    du[i] = g * (Fu[i] + rhs[i]);
    dv[i] = rhs[i];
  }
  return COROT_OK;
}
