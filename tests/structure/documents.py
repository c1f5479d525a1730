#!/usr/bin/env python3
"""Reads what a tree says of itself, and tells with file and line where that is not so:

  * each public header names a complete program that uses it, and each function that returns a status
    says which failures there are;
  * files and folders that a document names in `backticks` are there: by their path from the root,
    from src, from tests or from the document's folder, or, of a bare name, anywhere in these;
  * tests/README.md names every test.

usage: documents.py TREE [DOCUMENT...]
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
    for match in re.finditer(r"^(?:COROT_API )?corot_status\s+(corot_\w+)\(", text, re.M):
        own = [said for end, said in comments
               if end < match.start() and "\n\n" not in text[end : match.start()]]
        if not FAILURES.search(" ".join(own)):
            found.append((text.count("\n", 0, match.start()) + 1, match.group(1)))
    return found


def look_at_headers(tree):
    folder, offences = os.path.join(tree, "include/corot"), []
    for header in sorted(os.listdir(folder)):
        with open(os.path.join(folder, header)) as lines:
            text = lines.read()
        example = f"tests/examples/{header[:-2]}.c"
        named = [example] + re.findall(r"models/embedding/host_\w+\.c", text)
        if not any(name in text and os.path.exists(os.path.join(tree, name)) for name in named):
            offences.append(f"include/corot/{header}:1: names no program {example}, nor a host")
        offences += [
            f"include/corot/{header}:{line}: {name} does not say how it fails"
            for line, name in find_silent(text)
            if name != "corot_fail"
        ]
    return offences


def list_names(tree):
    """The names of all files of the sources, tests, models and public headers."""
    names = set()
    for top in ("src", "tests", "models", "include", ".ci"):
        for _, _, files in os.walk(os.path.join(tree, top)):
            names.update(files)
    return names


def find_missing(tree, document, text, names):
    """[(line number, path)] that the text names, and that are not there."""
    found = []
    roots = [os.path.join(tree, top) for top in ("", "src", "tests", os.path.dirname(document))]
    for match in re.finditer(r"`([\w./-]+)`", text):
        path = match.group(1)
        is_file = re.search(r"\.(c|h|py|sh|js|md|cmake|txt)$", path)
        if "NAME" in path or not ("/" in path or is_file) or path.startswith(("out/", "build/")):
            continue
        known = path in names if "/" not in path else False
        if not known and not any(os.path.exists(os.path.join(root, path)) for root in roots):
            if not path.startswith("corot/"):  # a public header, by its name in an include line
                found.append((text.count("\n", 0, match.start()) + 1, path))
    return found


def find_untold(tree, text):
    """The tests that the text does not name."""
    tests = []
    for folder, pattern in (("unit", r"test_.*\.c"), ("models", r"test_.*\.c"), ("cli", r".*\.sh")):
        tests += [
            name
            for name in sorted(os.listdir(os.path.join(tree, "tests", folder)))
            if re.fullmatch(pattern, name) and not name.endswith("lib.sh")
        ]
    return [name for name in tests if name not in text]


def look_at_document(tree, document, names):
    with open(os.path.join(tree, document)) as lines:
        text = lines.read()
    offences = [
        f"{document}:{line}: there is no {path}"
        for line, path in find_missing(tree, document, text, names)
    ]
    if document == "tests/README.md":
        offences += [f"{document}:1: does not name {name}" for name in find_untold(tree, text)]
    return offences


def check_myself(tree, names):
    """What must be found, is."""
    silent = "/* Adds. */\nCOROT_API corot_status corot_add(int n);\n"
    assert find_silent(silent) == [(2, "corot_add")]
    assert not find_silent(silent.replace("Adds.", "Adds. COROT_ENOMEM."))
    said = "`core/base`, `solve/nowhere`,\n`gone.c` and `check.h`; `test_base.c`"
    assert find_missing(tree, "README.md", said, names) == [(1, "solve/nowhere"), (2, "gone.c")]
    untold = find_untold(tree, said)
    assert "test_mesh.c" in untold and "test_base.c" not in untold


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    tree, documents = sys.argv[1], sys.argv[2:]
    names = list_names(tree)
    check_myself(tree, names)
    offences = look_at_headers(tree)
    for document in documents:
        offences += look_at_document(tree, document, names)
    print("\n".join(offences) or f"public headers and {len(documents)} documents: no offence")
    sys.exit(bool(offences))


if __name__ == "__main__":
    main()
