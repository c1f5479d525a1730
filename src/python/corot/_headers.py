"""The declarations of corot's own public headers, as cffi reads them.

The headers of include/corot are the only place where a function or a structure is declared. This module
turns them into one text without preprocessor lines, comments, inline functions and attributes. It is
no C preprocessor: it knows what our headers use, and refuses what it does not understand. A condition
is taken with nothing defined, so that an include guard is open, and what is for C++ or for one
compiler is left out.

    python3 -m corot._headers INCLUDE/corot OUTPUT      writes the text, as the build does
"""
from __future__ import annotations

import os
import re
import sys

#: In the order in which each needs only those before it. Headers of other names follow: they need
#: no more than these.
ORDER = ("base", "mesh", "model", "hierarchy", "ode", "inputs", "solve", "host", "integrate")

#: What headers of SUNDIALS declare and ours use. To Python these are pointers that nothing can be
#: done with, and double precision is what corot/solve.h asks of SUNDIALS.
SUNDIALS = """\
typedef struct _generic_N_Vector *N_Vector;
typedef struct _generic_SUNMatrix *SUNMatrix;
typedef struct _generic_SUNLinearSolver *SUNLinearSolver;
typedef struct SUNContext_ *SUNContext;
typedef double sunrealtype;
typedef int sunbooleantype;
"""

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
_DEFINE = re.compile(r"define\s+(COROT_\w+)\s+(\S.*)")
_DECLARED = re.compile(r"\bCOROT_API\s[^;(]*?(?:\(\*)?\b(corot_\w+)\(")


def drop_comments(text: str) -> str:
    """The text with a space in place of each comment; lines keep their numbers."""
    return _COMMENT.sub(lambda match: "\n" * match.group().count("\n") or " ", text)


def read_directives(text: str) -> tuple[str, dict[str, float]]:
    """What is left of a header without comments once its preprocessor lines are carried out, and the
    numbers that it defines by name.

    ValueError: a directive that no header of ours has used so far, or conditions that do not nest.
    """
    lines, numbers, taken = [], {}, [True]
    for line in text.replace("\\\n", " ").split("\n"):
        if not line.lstrip().startswith("#"):
            lines.append(line if all(taken) else "")
            continue
        directive = line.strip()[1:].strip()
        word = re.match(r"\w*", directive).group()
        if word in ("if", "ifdef"):
            taken.append(False)
        elif word == "ifndef":
            taken.append(True)
        elif word == "else" and len(taken) > 1:
            taken[-1] = not taken[-1]
        elif word == "endif" and len(taken) > 1:
            taken.pop()
        elif word not in ("include", "define", "undef", "error"):
            raise ValueError(f"the header reader does not know the line '{line.strip()}'")
        define = _DEFINE.fullmatch(directive)
        if define and all(taken):
            try:
                numbers[define.group(1)] = float(define.group(2))
            except ValueError:
                pass  # a word or a macro: of no use to cffi
        lines.append("")
    if len(taken) != 1:
        raise ValueError("an #if of a header has no #endif")
    return "\n".join(lines), numbers


def drop_inline(text: str) -> str:
    """Leaves out `static inline` functions with their bodies."""
    while (start := text.find("static inline")) >= 0:
        depth, end = 0, text.index("{", start)
        while True:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
            if depth == 0:
                break
        text = text[:start] + text[end:]
    return text


def read_header(text: str) -> tuple[str, dict[str, float]]:
    """The declarations of one header, and the numbers it defines."""
    text, numbers = read_directives(drop_comments(text))
    text = drop_inline(text).replace("COROT_API", " ")
    for name, number in numbers.items():  # sizes of arrays
        if number.is_integer():
            text = re.sub(rf"\b{name}\b", str(int(number)), text)
    if "__attribute__" in text:
        raise ValueError("an attribute outside of #if: the header reader does not know it")
    return re.sub(r"\s*\n\s*", "\n", text).strip(), numbers


def list_declared(text: str) -> list[str]:
    """The names of the functions that a header marks as COROT_API, in its order."""
    text = read_directives(drop_comments(text))[0]
    return _DECLARED.findall(drop_inline(text))


def list_headers(folder: str) -> list[str]:
    """The paths of the headers in a folder, in the order in which they may be read.

    FileNotFoundError: base.h is not there.
    """
    names = sorted(name[:-2] for name in os.listdir(folder) if name.endswith(".h"))
    if "base" not in names:
        raise FileNotFoundError(f"{folder}: there is no base.h")
    ordered = [name for name in ORDER if name in names]
    ordered += [name for name in names if name not in ORDER]
    return [os.path.join(folder, name + ".h") for name in ordered]


def read_headers(folder: str) -> str:
    """The declarations of all headers in a folder, ready for `cffi.FFI().cdef`. Numbers that they
    define stand at the head, as `// NAME = VALUE`, for `read_numbers`."""
    parts, numbers = [SUNDIALS], {}
    for path in list_headers(folder):
        with open(path, encoding="utf-8") as file:
            declarations, more = read_header(file.read())
        numbers.update(more)
        parts.append(declarations)
    head = "".join(f"// {name} = {value!r}\n" for name, value in numbers.items())
    return head + "\n".join(part for part in parts if part) + "\n"


def read_numbers(text: str) -> dict[str, float]:
    """The numbers at the head of what `read_headers` returns."""
    return {name: float(value) for name, value in re.findall(r"^// (\w+) = (\S+)$", text, re.M)}


def main(arguments: list[str]) -> int:
    if len(arguments) != 2:
        print(__doc__.strip().splitlines()[-1].strip(), file=sys.stderr)
        return 2
    text = read_headers(arguments[0])
    with open(arguments[1], "w", encoding="utf-8") as file:
        file.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
