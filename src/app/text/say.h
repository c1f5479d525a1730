/* Messages and facts for people, with what names and titles may hold made harmless. */
#ifndef COROT_APP_TEXT_SAY_H
#define COROT_APP_TEXT_SAY_H

#include <corot/base.h>
#include <stdarg.h>
#include <stdio.h>

/* As printf, to stderr or to stdout; what a terminal would obey becomes '?' (escape.h). Line breaks
   stay: text that must not bring its own goes through escape_line_cut() first. */
void say(const char *format, ...) __attribute__((format(printf, 1, 2)));
void show(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Prints corot_error() in lines of its own. On a terminal what it is about, which stands before the
   first ": ", has a colour (colour.h), as has the caret below a line that it shows. */
void say_error(void);

/* Prints "HEAD: " to stderr, HEAD in the colour of errors. */
void say_head(const char *head);

/* As vprintf, to `out`. */
void say_to(FILE *out, const char *format, va_list arguments) __attribute__((format(printf, 2, 0)));

/* What `write` prints, to stdout in the same manner. */
corot_status show_all(corot_status (*write)(const void *what, FILE *out), const void *what);

#endif
