/* The style and the scripts of a report's page, files of this folder that the build puts into the
   program. */
#ifndef COROT_REPORT_PAGE_ASSETS_H
#define COROT_REPORT_PAGE_ASSETS_H

#include <stddef.h>

extern const char asset_page_css[];
extern const size_t asset_page_css_size;

/* In the order in which they stand in the page. */
typedef struct asset {
  const char *text;
  size_t size;
} asset;
extern const asset asset_script[];
extern const int asset_nscript;

#endif
