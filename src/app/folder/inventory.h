/* The names that a run may write in its folder. Nothing else in a folder is ever touched. */
#ifndef COROT_APP_FOLDER_INVENTORY_H
#define COROT_APP_FOLDER_INVENTORY_H

#include <stdbool.h>

/* What a run that was cut goes on from: checkpoint_file.h. */
#define CHECKPOINT_NAME "checkpoint.bin"

typedef struct inventory_file {
  const char *name;
  const char *writer; /* the command that makes it, for messages */
  bool cleaned;       /* a new run removes what an earlier one left; temporary files are not */
  bool listed;        /* result.json vouches for it */
} inventory_file;

/* In the order of the list in result.json. The frames of fields come beside them. */
enum { INVENTORY_SIZE = 17 };
extern const inventory_file inventory[INVENTORY_SIZE];

/* The folder of the frames, and the name of one in it: fields_DIGITS.vtu. */
#define INVENTORY_FIELDS "fields"
bool inventory_is_frame(const char *name);
long inventory_frame(const char *name); /* the number of one */

#endif
