/* The tags of an XML file, one after the other: no more of XML than mesh files have. What is
   between two tags is for who reads them. */
#ifndef COROT_CORE_MESH_READ_XML_TAGS_H
#define COROT_CORE_MESH_READ_XML_TAGS_H

#include "reader.h"

typedef struct corot_xml_tag {
  char name[40];  /* cut if it is longer */
  bool opens;     /* <NAME ...> or <NAME .../> */
  bool closes;    /* </NAME> or <NAME .../> */
  size_t at, end; /* of '<', and behind '>' */
  size_t inside;  /* where attributes begin */
} corot_xml_tag;

/* Goes behind the next tag, past comments, declarations and CDATA; false: there is none.
   COROT_EFORMAT: it has no end. */
corot_status corot_xml_next(corot_reader *r, corot_xml_tag *tag, bool *found);

/* The value of an attribute, cut at `size`; false, and "", if there is none. */
bool corot_xml_attribute(const corot_reader *r, const corot_xml_tag *tag, const char *name,
                         size_t size, char *value);

/* One that is a whole number >= 0; `missing` if it is not there. COROT_EFORMAT: it is no such
 * number. */
corot_status corot_xml_number(const corot_reader *r, const corot_xml_tag *tag, const char *name,
                              int64_t missing, int64_t *value);

#endif
