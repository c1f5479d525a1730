/* Text from outside (titles, labels, names of files, messages of libraries) in a format that gives
   some characters a meaning of their own. Nothing writes such text into a format but by one of
   these, so none of it can end the place it stands in: it is never read as a command, a tag, a
   formula or a control sequence.

   NULL is written like "". Errors are left in the stream. */
#ifndef COROT_APP_TEXT_ESCAPE_H
#define COROT_APP_TEXT_ESCAPE_H

#include <stddef.h>
#include <stdio.h>

/* Length in bytes of the UTF-8 character at `text`; 0 where there is none that may be shown: a
   control character other than tab and line feed, or bytes that are not UTF-8. What this accepts,
   XML 1.0 does. */
int escape_character(const char *text);

/* One word of a POSIX shell, in single quotes, byte for byte. It may hold line breaks. */
void escape_shell(const char *text, FILE *out);

/* The rest of a line, as a comment of a shell, of Python or of gnuplot: line breaks and tabs become
   spaces, what cannot be shown, or turns the order of the text, '?'. */
void escape_line(const char *text, FILE *out);

/* The same into `line`, cut to at most size - 1 bytes, of which the last are then "...". Returns
   `line`. For a message that names it beside other things. */
const char *escape_line_cut(const char *text, size_t size, char *line);

/* A name of letters, digits, '.', '_' and '-', as schedulers want it: all else becomes '_'. */
void escape_name(const char *text, FILE *out);

/* A string of Python in ASCII. Bytes that are not UTF-8 become what os.fsdecode() makes of them, so
   that Python finds the file of this name. */
void escape_python(const char *text, FILE *out);

/* A string of gnuplot, or an expression for one. It cannot hold line breaks: they become spaces. */
void escape_gnuplot(const char *text, FILE *out);

/* A field of a CSV table. It is quoted where it would break the table, and begins with an
   apostrophe where a spreadsheet would take it for a formula: at = + - @, unless it is a number. */
void escape_csv(const char *text, FILE *out);

/* Where the text of such a field begins, once its quotes are undone: behind the apostrophe. */
char *escape_csv_undo(char *field);

/* Between tags and in attributes of XML and HTML. */
void escape_markup(const char *text, FILE *out);

/* A name of a table or column in SQL, in double quotes. Values are bound instead. */
void escape_sql_name(const char *text, FILE *out);

/* For a terminal: as it is but for what cannot be shown, or turns the order of the text, which
   becomes
   '?'. */
void escape_terminal(const char *text, FILE *out);

#endif
