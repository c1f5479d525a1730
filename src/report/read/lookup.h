/* Values in a JSON document by their path, "mesh.nodes". */
#ifndef COROT_REPORT_READ_LOOKUP_H
#define COROT_REPORT_READ_LOOKUP_H

#include <corot/base.h>
#include <jansson.h>

/* Each takes NULL for the document. What is not there gives NULL, NAN, "". */
const json_t *lookup(const json_t *document, const char *path);
double lookup_number(const json_t *document, const char *path);
const char *lookup_text(const json_t *document, const char *path);

/* Reads DIR/NAME; its root must be a map. COROT_EIO: it cannot be read; COROT_EFORMAT. */
corot_status lookup_read(const char *dir, const char *name, json_t **document);

#endif
