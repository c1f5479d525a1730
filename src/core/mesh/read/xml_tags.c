/* Tags of XML: found by their brackets, attributes by their quotes. */
#include "xml_tags.h"

#include <stdlib.h>
#include <string.h>

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

static bool is_name(char c) { return c && !is_blank(c) && !strchr("<>/=\"'", c); }

/* The place behind `end`; the file's size if it is not there. */
static size_t behind(const corot_reader *r, size_t at, const char *end) {
  const char *p = at < r->size ? strstr(r->data + at, end) : NULL;
  return p ? (size_t)(p - r->data) + strlen(end) : r->size;
}

/* The place behind the '>' of a tag, quotes being passed over. */
static size_t end_of(const corot_reader *r, size_t at) {
  char quote = 0;
  for (; at < r->size; at++) {
    char c = r->data[at];
    if (!quote && c == '>') return at + 1;
    if (!quote && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote)
      quote = 0;
  }
  return 0;
}

corot_status corot_xml_next(corot_reader *r, corot_xml_tag *tag, bool *found) {
  *found = false;
  for (;;) {
    const char *p = r->at < r->size ? memchr(r->data + r->at, '<', r->size - r->at) : NULL;
    if (!p) {
      r->at = r->size;
      return COROT_OK;
    }
    r->at = (size_t)(p - r->data);
    if (strncmp(p, "<!--", 4) == 0)
      r->at = behind(r, r->at, "-->");
    else if (strncmp(p, "<![CDATA[", 9) == 0)
      r->at = behind(r, r->at, "]]>");
    else if (p[1] == '?' || p[1] == '!')
      r->at = behind(r, r->at, ">");
    else
      break;
  }
  size_t at = r->at, n = 0, name = at + 1 + (r->data[at + 1] == '/'), end = end_of(r, at);
  if (end == 0) return corot_reader_fail(r, at, "a tag has no end");
  *tag = (corot_xml_tag){.at = at, .end = end, .closes = r->data[at + 1] == '/'};
  tag->opens = !tag->closes;
  for (; name < end && is_name(r->data[name]); name++)
    if (n + 1 < sizeof tag->name) tag->name[n++] = r->data[name];
  tag->inside = name;
  tag->closes = tag->closes || r->data[end - 2] == '/';
  r->at = end;
  *found = true;
  return COROT_OK;
}

/* The character that an entity is; *p goes behind it. */
static char unescape(const char **p) {
  static const struct {
    const char *name;
    char c;
  } entities[] = {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
  for (size_t i = 0; i < sizeof entities / sizeof *entities; i++) {
    size_t n = strlen(entities[i].name);
    if (strncmp(*p, entities[i].name, n) != 0) continue;
    *p += n;
    return entities[i].c;
  }
  return *(*p)++;
}

bool corot_xml_attribute(const corot_reader *r, const corot_xml_tag *tag, const char *name,
                         size_t size, char *value) {
  const char *p = r->data + tag->inside, *end = r->data + tag->end - 1;
  size_t length = strlen(name), n = 0;
  value[0] = 0;
  while (p < end) {
    while (p < end && !is_name(*p)) p++;
    const char *start = p;
    while (p < end && is_name(*p)) p++;
    bool wanted = (size_t)(p - start) == length && strncmp(start, name, length) == 0;
    while (p < end && is_blank(*p)) p++;
    if (p >= end || *p != '=') continue;
    p++;
    while (p < end && is_blank(*p)) p++;
    if (p >= end || (*p != '"' && *p != '\'')) continue;
    char quote = *p++;
    while (p < end && *p != quote) {
      char c = unescape(&p);
      if (wanted && n + 1 < size) value[n++] = c;
    }
    if (wanted) value[n] = 0;
    if (wanted) return true;
    p++;
  }
  return false;
}

corot_status corot_xml_number(const corot_reader *r, const corot_xml_tag *tag, const char *name,
                              int64_t missing, int64_t *value) {
  char text[32];
  *value = missing;
  if (!corot_xml_attribute(r, tag, name, sizeof text, text)) return COROT_OK;
  size_t n = strspn(text, "0123456789");
  if (n == 0 || text[n] || n > 18)
    return corot_reader_fail(r, tag->at, "%s: %s is '%.20s', not a whole number", tag->name, name,
                             text);
  *value = strtoll(text, NULL, 10);
  return COROT_OK;
}
