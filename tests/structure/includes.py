#!/usr/bin/env python3
"""Reads the include lines of a tree and says which of them offend against the order of its rooms.

usage: includes.py TREE

The order stands in TREE/tests/structure/rooms. Offences, each told with file and line:

  * an include that points up: at a later storey, a later room, or a room beside;
  * a circle between modules (a module is NAME.c with NAME.h);
  * two files of one name among the sources;
  * a bare name ("NAME.h") of what is not in the same folder: sources of another folder are included
    by their path from src ("core/mesh/mesh.h"), so that a line says where it leads. Programs of
    tests may use bare names of tests/unit, which all of them share.

Ends with 1 if there are any.
"""
import os
import re
import sys

SHARED_TESTS = "tests/unit"


def read_order(text):
    """'a < b, c < d' -> {'a': 0, 'b': 1, 'c': 1, 'd': 2}"""
    return {
        name.strip(): height
        for height, names in enumerate(text.split("<"))
        for name in names.split(",")
    }


class Rooms:
    """What the file of rooms says."""

    def __init__(self, path):
        self.storeys, self.headers, self.rooms, self.visible = {}, {}, {}, {}
        with open(path) as lines:
            for line in lines:
                line = line.split("#")[0].strip()
                if "may include:" in line:
                    place, names = line.split("may include:")
                    self.visible.update((name, place.strip()) for name in names.split())
                elif line:
                    key, order = line.split(":")
                    order = read_order(order)
                    if key in ("storeys", "headers"):
                        setattr(self, key, order)
                    else:
                        self.rooms[key] = order

    def of(self, path):
        """(storey, room) of a source: 'src/core/mesh/read/reader.c' -> ('core', 'mesh')."""
        parts = path.split("/")[1:-1]
        return (parts + [None, None])[0], (parts + [None, None])[1]

    def unknown(self, path):
        """Why a source stands in no room; None: it does."""
        storey, room = self.of(path)
        if storey not in self.storeys:
            return f"no storey '{storey}'"
        if storey in self.rooms and room not in self.rooms[storey]:
            return f"no room '{room}' in {storey}"
        return None

    def forbids(self, user, used):
        """Why one (storey, room) may not use another; None: it may."""
        if user[0] != used[0]:
            up = self.storeys[user[0]] <= self.storeys[used[0]]
            return f"{user[0]} may not use {used[0]}" if up else None
        order = self.rooms.get(user[0])
        if not order or user[1] == used[1] or order[used[1]] < order[user[1]]:
            return None
        beside = order[used[1]] == order[user[1]]
        return f"room {user[1]} may not use {used[1]}, which is {'beside' if beside else 'above'} it"

    def forbids_header(self, path, name):
        """Why a file may not include <corot/NAME.h>; None: it may."""
        if name not in self.headers:
            return f"no public header '{name}' in the list of rooms"
        if path.startswith("include/"):
            user = os.path.basename(path)[:-2]
            down = self.headers[name] < self.headers.get(user, -1)
            return None if down else f"header {user} may not use {name}"
        if path.startswith("tests/"):
            return None
        storey, _, room = self.visible[name].partition("/")
        if room:
            return self.forbids(self.of(path), (storey, room))
        return None if self.of(path)[0] == storey else self.forbids(self.of(path), (storey, None))


def find_files(tree):
    """All .c and .h below include, src and tests, by their path in the tree."""
    found = []
    for top in ("include", "src", "tests"):
        for folder, folders, names in os.walk(os.path.join(tree, top)):
            folders.sort()
            found += [
                os.path.relpath(os.path.join(folder, name), tree)
                for name in sorted(names)
                if name.endswith((".c", ".h"))
            ]
    return found


def read_includes(tree, path):
    """[(line number, name, quoted)]; of <...> only those of corot."""
    pattern = re.compile(r'\s*#\s*include\s+(?:"([^"]+)"|<(corot/[^>]+)>)')
    found = []
    with open(os.path.join(tree, path), encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            match = pattern.match(line)
            if match:
                found.append((number, match.group(1) or match.group(2), bool(match.group(1))))
    return found


class Check:
    def __init__(self, tree):
        self.tree = tree
        self.rooms = Rooms(os.path.join(tree, "tests/structure/rooms"))
        self.files = find_files(tree)
        self.offences = []
        self.edges = {}  # module -> {module: "file:line: includes ..."}

    def offend(self, path, line, why):
        self.offences.append(f"{path}:{line}: {why}")

    def resolve(self, path, name):
        """The file that "NAME" in `path` means, and why it may not be written so; None: not found."""
        folder = os.path.dirname(path)
        beside = os.path.normpath(os.path.join(folder, name))
        if "/" not in name and beside in self.files:
            return beside, None
        if "/" in name and f"src/{name}" in self.files:
            return f"src/{name}", None
        if path.startswith("tests/") and "/" not in name and f"{SHARED_TESTS}/{name}" in self.files:
            return f"{SHARED_TESTS}/{name}", None
        elsewhere = [f for f in self.files if f.endswith("/" + name)]
        if elsewhere:
            return elsewhere[0], f"bare name of {elsewhere[0]}: write its path from src"
        return None, "no such file in the tree"

    def look_at(self, path, line, name, quoted):
        """One include line: offends, or becomes an edge between modules."""
        if quoted:
            used, why = self.resolve(path, name)
        else:
            used, why = "include/" + name, self.rooms.forbids_header(path, name[len("corot/") : -2])
        if not why and quoted and path.startswith("src/"):
            why = self.rooms.forbids(self.rooms.of(path), self.rooms.of(used))
        if why:
            self.offend(path, line, f'includes "{name}": {why}')
            return
        modules = os.path.splitext(path)[0], os.path.splitext(used)[0]
        if modules[0] != modules[1]:
            self.edges.setdefault(modules[0], {})[modules[1]] = f'{path}:{line}: includes "{name}"'

    def find_way(self, start):
        """The shortest way of edges from a module back to itself; None: there is none."""
        came, queue = {}, [start]
        for module in queue:
            for used in self.edges.get(module, {}):
                if used == start:
                    way = [(module, used)]
                    while module != start:
                        way.insert(0, (came[module], module))
                        module = came[module]
                    return way
                if used not in came:
                    came[used] = module
                    queue.append(used)
        return None

    def find_circles(self):
        told = set()
        for start in sorted(self.edges):
            way = None if start in told else self.find_way(start)
            if way:
                told.update(module for module, _ in way)
                names = [module for module, _ in way] + [start]
                self.offences.append("circle of modules: " + " -> ".join(names))
                self.offences += [f"  {self.edges[a][b]}" for a, b in way]

    def find_twins(self):
        first = {}
        for path in self.files:
            name = os.path.basename(path)
            if not path.startswith("src/"):
                continue
            if name in first:
                self.offend(path, 1, f"has the name of {first[name]}")
            first.setdefault(name, path)

    def run(self):
        for path in self.files:
            why = self.rooms.unknown(path) if path.startswith("src/") else None
            if why:
                self.offend(path, 1, f"stands in no room: {why}")
                continue
            for line, name, quoted in read_includes(self.tree, path):
                self.look_at(path, line, name, quoted)
        self.find_circles()
        self.find_twins()
        return self.offences


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    check = Check(sys.argv[1])
    offences = check.run()
    if not check.files:
        offences = ["no files found"]
    print("\n".join(offences) or f"{len(check.files)} files: no offence")
    sys.exit(bool(offences))


if __name__ == "__main__":
    main()
