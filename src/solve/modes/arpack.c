/* ARPACK's reverse communication: it asks for products, and keeps what it knows in variables of its
   own, so that one search at a time can go on in a process. */
#include <arpack/arpack.h>
#include <limits.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "eigenproblem.h"
#include "solve/linsol/blas_room.h"

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

/* The arguments of dsaupd, under ARPACK's names. */
typedef struct arpack {
  int nev, ncv, lworkl;
  a_int info, iparam[11], ipntr[11];
  double *resid, *v, *workd, *workl; /* [n], [ncv][n], [3 n], [lworkl] */
  a_int *select;                     /* [ncv] */
  double *d;                         /* [nev] */
} arpack;

static void clear(arpack *a) {
  free(a->resid), free(a->v), free(a->workd), free(a->workl), free(a->select), free(a->d);
}

/* Numbers in (-1, 1) without any symmetry, the same in every call. */
static void fill_start(int n, double *x) {
  uint64_t seed = 1;
  for (int i = 0; i < n; i++) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    x[i] = (double)(seed >> 11) / (double)(UINT64_C(1) << 52) - 1;
  }
}

/* So many are left beside what was found. */
static int dimension(const eigen *e) { return e->n - e->nfound; }

static corot_status allocate(const eigen *e, int count, arpack *a) {
  size_t n = (size_t)e->n;
  int most = dimension(e);
  a->nev = count;
  a->ncv = 2 * count + 1 > 20 ? 2 * count + 1 : 20;
  if (a->ncv > most) a->ncv = most;
  if (a->ncv > 40000 || n > (size_t)INT_MAX / 3) /* ARPACK counts in int */
    return corot_fail(COROT_EINVAL, "modes: %d of %zu unknowns are too many", count, n);
  a->lworkl = a->ncv * (a->ncv + 8);
  a->resid = malloc(n * sizeof *a->resid);
  a->v = malloc((size_t)a->ncv * n * sizeof *a->v);
  a->workd = calloc(3 * n, sizeof *a->workd);
  a->workl = calloc((size_t)a->lworkl, sizeof *a->workl);
  a->select = calloc((size_t)a->ncv, sizeof *a->select);
  a->d = calloc((size_t)a->nev, sizeof *a->d);
  if (!a->resid || !a->v || !a->workd || !a->workl || !a->select || !a->d)
    return corot_fail(COROT_ENOMEM, "no memory for %d Lanczos vectors of %zu unknowns", a->ncv, n);
  fill_start(e->n, a->resid);
  corot_eigen_project(e, a->resid);
  a->iparam[0] = 1; /* exact shifts */
  a->iparam[2] = e->def->max_restarts;
  a->iparam[6] = 3; /* shift and invert */
  a->info = 1;      /* resid is where to start */
  return COROT_OK;
}

/* What ARPACK asks for: ido 1 and -1: y = (K - s M)^-1 M x, with M x at hand or not; 2: y = M x. */
static corot_status answer(eigen *e, const arpack *a, a_int ido) {
  const double *x = a->workd + a->ipntr[0] - 1;
  double *y = a->workd + a->ipntr[1] - 1;
  if (ido == 1)
    memcpy(y, a->workd + a->ipntr[2] - 1, (size_t)e->n * sizeof *y);
  else
    corot_mass_multiply(e->model, x, y);
  if (ido == 2) return COROT_OK;
  COROT_TRY(corot_eigen_solve(e, y));
  corot_eigen_project(e, y);
  return COROT_OK;
}

static corot_status judge(const eigen *e, const arpack *a, const char *function) {
  if (a->info == 0) return COROT_OK;
  if (a->info == 1)
    return corot_fail(COROT_EINTEGRATE, "arpack: %d of %d modes after %d restarts; allow more",
                      (int)a->iparam[4], a->nev, e->def->max_restarts);
  return corot_fail(COROT_EINTEGRATE, "arpack: %s ended with info = %d (%d modes of %d unknowns)",
                    function, (int)a->info, a->nev, e->n);
}

static corot_status iterate(eigen *e, arpack *a) {
  a_int ido = 0;
  do {
    dsaupd_c(&ido, "G", e->n, "LA", a->nev, e->def->tolerance, a->resid, a->ncv, a->v, e->n,
             a->iparam, a->ipntr, a->workd, a->workl, a->lworkl, &a->info);
    if (ido == 1 || ido == -1 || ido == 2) COROT_TRY(answer(e, a, ido));
  } while (ido == 1 || ido == -1 || ido == 2);
  e->facts.nrestart += a->iparam[2];
  COROT_TRY(judge(e, a, "dsaupd"));
  dseupd_c(1, "A", a->select, a->d, a->v, e->n, e->shift, "G", e->n, "LA", a->nev,
           e->def->tolerance, a->resid, a->ncv, a->v, e->n, a->iparam, a->ipntr, a->workd, a->workl,
           a->lworkl, &a->info);
  return judge(e, a, "dseupd");
}

/* One step of inverse iteration takes the vector's high frequencies away, which K x would show. */
static corot_status add(eigen *e, const double *x) {
  double *y = e->work + e->n;
  corot_mass_multiply(e->model, x, y);
  COROT_TRY(corot_eigen_solve(e, y));
  if (corot_eigen_add(e, y)) return COROT_OK;
  return corot_fail(COROT_EINTEGRATE, "arpack: two of its vectors are the same");
}

corot_status corot_arpack_search(eigen *e, int count) {
  arpack a = {0};
  int left = dimension(e);
  if (left == 1) { /* too few for ARPACK, and known */
    double *only = e->x + (size_t)e->nfound * e->n;
    fill_start(e->n, only);
    corot_eigen_project(e, only);
    return add(e, only);
  }
  corot_status status = corot_blas_room();
  if (!status) status = allocate(e, count, &a);
  if (!status) {
    pthread_mutex_lock(&one_at_a_time);
    status = iterate(e, &a);
    pthread_mutex_unlock(&one_at_a_time);
  }
  for (int k = count - 1; k >= 0 && !status; k--) status = add(e, a.v + (size_t)k * e->n);
  clear(&a);
  return status;
}
