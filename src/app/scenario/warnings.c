/* The list of warnings, and the table of their codes. */
#include "warnings.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/colour.h"
#include "app/text/escape.h"
#include "app/text/json_text.h"

const warning_kind warning_kinds[WARNING_CODES] = {
    [WARNING_MENDED] = {"mesh-mended",
                        "nodes or tets of the mesh file are left out or turned round"},
    [WARNING_CUT] = {"mesh-cut",
                     "hexahedra, prisms or pyramids of the mesh file are cut into tets"},
    [WARNING_LOST] = {"mesh-lost",
                      "corot mesh convert: groups that the format cannot hold as they are"},
    [WARNING_LOCKING] = {"locking", "nearly incompressible, and each tet has its own dilatation"},
    [WARNING_PARTS] = {"parts", "the body is in several parts that share no node"},
    [WARNING_UNHELD] = {"unheld", "a part has no support while another has"},
    [WARNING_PROBE] = {"probe",
                       "the point of a probe is outside the body, or its nearest node far off"},
    [WARNING_INTEGRATOR] = {"integrator", "cvode or ida, where a body is free or undamped"},
    [WARNING_THREADS] = {"threads", "there are more threads than processors"},
    [WARNING_RTOL] = {"rtol", "a tolerance is below what double precision can tell"},
    [WARNING_ATOL] = {"atol", "the absolute tolerance is no small part of the motion"},
    [WARNING_LEDGER] = {"ledger", "work and energies do not add up, or the method adds energy"},
    [WARNING_DISSIPATION] = {"numerical-dissipation", "the method takes energy away"},
    [WARNING_STRAIN] = {"strain-range", "strains or turns beyond what the measure is meant for"},
    [WARNING_INVERTED] = {"inverted", "tets are turned inside out, which cauchy does not see"},
    [WARNING_SPACE] = {"space", "the mesh leaves out a part of the displacement: it is too coarse"},
    [WARNING_BENDING] = {"bending", "the stress jumps between tets: the mesh is too coarse"},
    [WARNING_STEP] = {"step", "a constant step is long for the motion"},
    [WARNING_UNDAMPED] = {"undamped", "modes are those without the damping that the scenario has"},
    [WARNING_UNSTABLE] = {"unstable", "a mode grows: the equilibrium is unstable"},
    [WARNING_SYMMETRIC] = {"symmetric", "modes leave out what of a pressure has no potential"},
    [WARNING_OUTPUT] = {"output", "output times are too far apart for the motion"},
    [WARNING_QUANTITY] = {"quantity", "a quantity that was asked for has no value"},
};

corot_status warnings_add(warnings *w, warning_code code, const char *format, ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  warning *item = realloc(w->item, ((size_t)w->n + 1) * sizeof *item);
  if (item) w->item = item;
  char *copy = malloc(strlen(text) + 1);
  if (!item || !copy) {
    free(copy);
    return corot_fail(COROT_ENOMEM, "a warning: out of memory");
  }
  w->item[w->n++] = (warning){code, strcpy(copy, text)};
  return COROT_OK;
}

void warnings_free(warnings *w) {
  for (int i = 0; i < w->n; i++) free(w->item[i].text);
  free(w->item);
  *w = (warnings){0};
}

json_t *warnings_json(const warnings *w) {
  json_t *list = json_array();
  for (int i = 0; list && i < w->n; i++) {
    json_t *entry = json_pack("{s:s, s:o}", "code", warning_kinds[w->item[i].code].word, "text",
                              json_text_string(w->item[i].text));
    if (json_array_append_new(list, entry) == 0) continue;
    json_decref(list);
    list = NULL;
  }
  return list;
}

void warnings_print(const warnings *w, int from, const char *head, FILE *out) {
  for (int i = from; i < w->n; i++) {
    fprintf(out, "%s%s%s", colour_of(COLOUR_WARNING, out), head, colour_of(COLOUR_END, out));
    escape_line(w->item[i].text, out);
    fprintf(out, " [%s]\n", warning_kinds[w->item[i].code].word);
  }
}
