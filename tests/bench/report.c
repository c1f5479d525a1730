#include "report.h"

#include <math.h>
#include <stdio.h>

#include "core/lanes/widths.h"
#include "machine.h"

void report_object(json_t *object) {
  if (!object) return;
  json_dumpf(object, stdout, JSON_COMPACT | JSON_REAL_PRECISION(6));
  putchar('\n');
  json_decref(object);
}

void report_machine(bool json) {
  const char *cpu = machine_cpu(), *isa = corot_lanes_instruction_set();
  double peak = machine_peak() * 1e-9;
  if (json) {
    report_object(json_pack("{s:s, s:s, s:s, s:f}", "bench", "machine", "cpu", cpu,
                            "instruction_set", isa, "peak_gflops", peak));
    return;
  }
  printf("%s, kernels compiled for %s, %.1f Gflop/s in fused multiply-adds, one core\n", cpu, isa,
         peak);
  printf(
      "Times are process CPU time: median, minimum and distance of the quartiles of repeated\n"
      "calls. The clock of the processor is taken as it comes: it may rise and fall with load,\n"
      "temperature and the width of the vectors. The floor is measured beside each figure: the\n"
      "larger of bytes moved over the bandwidth of a triad, or of a sum if that is faster, on as\n"
      "much data, so out of the same cache, and operations over the peak (tests/bench/cost.h says\n"
      "what counts).\n");
}

void report_heading(bool json, int ntet, int n) {
  if (json) return;
  printf("\n%d tets, %d degrees of freedom; per tet\n", ntet, n);
  printf("%-14s %-8s %9s %9s %9s %9s %7s  %-8s %9s %9s\n", "bench", "of", "ns", "min", "spread",
         "floor", "ratio", "bound by", "bytes", "flops");
}

/* Bytes a second out of the cache that this cost's data fit in. */
static double bandwidth_for(const cost *least) {
  return machine_bandwidth((size_t)(least->data > 0 ? least->data : least->bytes));
}

double report_floor(const cost *least) {
  return fmax(least->bytes / bandwidth_for(least), least->flops / machine_peak());
}

/* Of the rows so far, the first whose time lies below its floor; "": none does. */
static char too_fast[160];

/* A floor is measured in a moment, in which the processor may have been busy with something else: a
   low one is measured again. */
static void check_floor(const row *r, double floor) {
  enum { TRIES = 20 };
  for (int k = 0; k < TRIES && r->time.median < floor; k++) floor = report_floor(&r->least);
  if (!(r->time.median < floor) || too_fast[0]) return;
  const char *of = r->solver ? r->solver : r->strain;
  double unit = 1e9 / r->ntet;
  snprintf(too_fast, sizeof too_fast, "%s%s%s takes %.3g ns a tet, less than its floor of %.3g ns",
           r->bench, of ? " " : "", of ? of : "", r->time.median * unit, floor * unit);
}

corot_status report_check(void) {
  if (!too_fast[0]) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: what this machine can do is measured wrongly", too_fast);
}

void report_row(bool json, const row *r) {
  double bandwidth = bandwidth_for(&r->least);
  double memory = r->least.bytes / bandwidth, arithmetic = r->least.flops / machine_peak();
  double floor = fmax(memory, arithmetic), unit = 1e9 / r->ntet;
  const char *of = r->solver ? r->solver : r->strain,
             *bound = memory > arithmetic ? "memory" : "flops";
  check_floor(r, floor);
  if (!json) {
    printf("%-14s %-8s %9.2f %9.2f %9.2f %9.2f %7.1f  %-8s %9.0f %9.0f\n", r->bench, of ? of : "",
           r->time.median * unit, r->time.min * unit, r->time.spread * unit, floor * unit,
           r->time.median / floor, bound, r->least.bytes / r->ntet, r->least.flops / r->ntet);
    fflush(stdout);
    return;
  }
  json_t *o = json_pack("{s:s}", "bench", r->bench);
  if (o && r->strain) json_object_set_new(o, "strain", json_string(r->strain));
  if (o && r->solver) json_object_set_new(o, "solver", json_string(r->solver));
  json_t *rest = json_pack(
      "{s:i, s:i, s:f, s:f, s:f, s:f, s:s, s:f, s:f, s:f, s:f}", "tets", r->ntet, "unknowns", r->n,
      "ns_per_tet", r->time.median * unit, "min_ns_per_tet", r->time.min * unit,
      "spread_ns_per_tet", r->time.spread * unit, "floor_ns_per_tet", floor * unit, "bound_by",
      bound, "bytes_per_tet", r->least.bytes / r->ntet, "flops_per_tet", r->least.flops / r->ntet,
      "bandwidth_gb_s", bandwidth * 1e-9, "ns_per_unknown", r->time.median * 1e9 / r->n);
  if (o && rest) json_object_update(o, rest);
  json_decref(rest);
  report_object(o);
}
