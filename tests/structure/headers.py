#!/usr/bin/env python3
"""Reads the public headers of a tree: each names a complete program that uses it, and each function
that returns a status says which failures there are.

usage: headers.py TREE
"""
import os
import re
import sys

FAILURES = re.compile(r"COROT_(E|RETRY)|[Ff]ailures\s+as|cannot\s+fail")


def find_silent(text):
    """[(line number, function)] of what returns a status and says nothing of failures. A comment
    speaks for all functions below it up to the next empty line."""
    found = []
    comments = [(match.end(), match.group()) for match in re.finditer(r"/\*.*?\*/", text, re.S)]
    for match in re.finditer(r"^corot_status (corot_\w+)\(", text, re.M):
        own = [said for end, said in comments
               if end < match.start() and "\n\n" not in text[end : match.start()]]
        if not FAILURES.search(" ".join(own)):
            found.append((text.count("\n", 0, match.start()) + 1, match.group(1)))
    return found


def main():
    tree, offences, count = sys.argv[1], [], 0
    folder = os.path.join(tree, "include/corot")
    for header in sorted(os.listdir(folder)):
        count += 1
        with open(os.path.join(folder, header)) as lines:
            text = lines.read()
        example = f"tests/examples/{header[:-2]}.c"
        if example not in text or not os.path.exists(os.path.join(tree, example)):
            offences.append(f"include/corot/{header}:1: names no program {example}")
        offences += [
            f"include/corot/{header}:{line}: {name} does not say how it fails"
            for line, name in find_silent(text)
            if name != "corot_fail"
        ]
    silent = "/* Adds. */\ncorot_status corot_add(int n);\n"
    assert find_silent(silent) == [(2, "corot_add")]
    assert not find_silent(silent.replace("Adds.", "Adds. COROT_ENOMEM."))
    print("\n".join(offences) or f"{count} headers: no offence")
    sys.exit(bool(offences) or count == 0)


if __name__ == "__main__":
    main()
