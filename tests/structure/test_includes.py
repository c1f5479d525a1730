#!/usr/bin/env python3
"""Shows that includes.py tells each of its offences: small made-up trees with one fault each."""
import os
import sys
import tempfile

sys.dont_write_bytecode = True
from includes import Check

ROOMS = """
storeys: low < high        # a comment
low:     floor < left, right < roof
headers: ground < sky
low        may include: ground
high/attic may include: sky
high:    hall < attic
"""

# A tree without a fault: text by path.
SOUND = {
    "tests/structure/rooms": ROOMS,
    "include/corot/ground.h": "",
    "include/corot/sky.h": "#include <corot/ground.h>\n",
    "src/low/floor/base.h": "#include <corot/ground.h>\n#include <stdio.h>\n",
    "src/low/floor/base.c": '#include "base.h"\n',
    "src/low/left/deep/part.h": '#include "low/floor/base.h"\n',
    "src/low/left/left.c": '#include "low/left/deep/part.h"\n',
    "src/low/right/right.h": "",
    "src/low/roof/roof.c": '#include "low/right/right.h"\n  # include "low/left/deep/part.h"\n',
    "src/high/hall/hall.c": '#include "low/roof/own.h"\n',
    "src/low/roof/own.h": "",
    "src/high/attic/attic.c": "#include <corot/sky.h>\n",
    "tests/unit/helper.h": "",
    "tests/models/test_model.c": '#include "helper.h"\n#include "low/floor/base.h"\n',
}

# (what is wrong, files beside or in place of the sound ones, how the offences begin)
FAULTS = [
    ("a later storey", {"src/low/floor/base.c": '\n#include "high/hall/other.h"\n',
                        "src/high/hall/other.h": ""},
     ["src/low/floor/base.c:2: includes \"high/hall/other.h\": low may not use high"]),
    ("a later room", {"src/low/floor/base.c": '#include "low/roof/own.h"\n'},
     ["src/low/floor/base.c:1: includes \"low/roof/own.h\": room floor may not use roof"]),
    ("a room beside", {"src/low/left/left.c": '#include "low/right/right.h"\n'},
     ["src/low/left/left.c:1: includes \"low/right/right.h\": room left may not use right"]),
    ("a room above, from a folder within a room",
     {"src/low/left/deep/part.h": '#include "low/roof/own.h"\n'},
     ["src/low/left/deep/part.h:1: includes \"low/roof/own.h\": room left may not use roof"]),
    ("a circle of two headers", {"src/low/floor/one.h": '#include "two.h"\n',
                                 "src/low/floor/two.h": '#include "one.h"\n'},
     ["circle of modules: src/low/floor/one -> src/low/floor/two -> src/low/floor/one",
      "  src/low/floor/one.h:1: includes \"two.h\"", "  src/low/floor/two.h:1: includes \"one.h\""]),
    ("a circle by way of sources", {"src/low/floor/one.h": "", "src/low/floor/two.h": "",
                                    "src/low/floor/three.h": '#include "one.h"\n',
                                    "src/low/floor/one.c": '#include "two.h"\n',
                                    "src/low/floor/two.c": '#include "three.h"\n'},
     ["circle of modules: src/low/floor/one -> src/low/floor/two -> src/low/floor/three ->",
      "  src/low/floor/one.c:1:", "  src/low/floor/two.c:1:", "  src/low/floor/three.h:1:"]),
    ("a circle of tests", {"tests/unit/one.h": '#include "two.h"\n',
                           "tests/unit/two.h": '#include "one.h"\n'},
     ["circle of modules: tests/unit/one -> ", "  tests/unit/one.h:1:", "  tests/unit/two.h:1:"]),
    ("two files of one name", {"src/high/hall/base.h": ""},
     ["src/low/floor/base.h:1: has the name of src/high/hall/base.h"]),
    ("a bare name of another room", {"src/low/roof/roof.c": '#include "base.h"\n'},
     ["src/low/roof/roof.c:1: includes \"base.h\": bare name of src/low/floor/base.h"]),
    ("a bare name of the sources, in a test", {"tests/models/test_model.c": '#include "base.h"\n'},
     ["tests/models/test_model.c:1: includes \"base.h\": bare name of src/low/floor/base.h"]),
    ("a bare name of another folder of tests", {"tests/unit/test_unit.c": '#include "own_model.h"\n',
                                                "tests/models/own_model.h": ""},
     ["tests/unit/test_unit.c:1: includes \"own_model.h\": bare name of tests/models/own_model.h"]),
    ("nothing of that name", {"src/low/roof/roof.c": '#include "low/floor/gone.h"\n'},
     ["src/low/roof/roof.c:1: includes \"low/floor/gone.h\": no such file"]),
    ("no such room", {"src/low/cellar/coal.c": ""},
     ["src/low/cellar/coal.c:1: stands in no room: no room 'cellar' in low"]),
    ("no such storey", {"src/cellar/coal.c": ""},
     ["src/cellar/coal.c:1: stands in no room: no storey 'cellar'"]),
    ("a public header of a later one", {"include/corot/ground.h": "#include <corot/sky.h>\n",
                                        "include/corot/sky.h": ""},
     ["include/corot/ground.h:1: includes \"corot/sky.h\": header ground may not use sky"]),
    ("a public header of a later storey", {"src/low/floor/base.c": "#include <corot/sky.h>\n"},
     ["src/low/floor/base.c:1: includes \"corot/sky.h\": low may not use high"]),
    ("a public header of a later room", {"src/high/hall/hall.c": "#include <corot/sky.h>\n"},
     ["src/high/hall/hall.c:1: includes \"corot/sky.h\": room hall may not use attic"]),
    ("a public header that is not in the list", {"include/corot/new.h": "",
                                                 "src/low/floor/base.c": "#include <corot/new.h>\n"},
     ["src/low/floor/base.c:1: includes \"corot/new.h\": no public header 'new'"]),
]


def find_offences(files):
    with tempfile.TemporaryDirectory() as tree:
        for path, text in files.items():
            path = os.path.join(tree, path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w") as out:
                out.write(text)
        return Check(tree).run()


def expect(label, offences, beginnings):
    told = len(offences) == len(beginnings) and all(map(str.startswith, offences, beginnings))
    if not told:
        print(f"FAILED: {label}: expected {beginnings}, told {offences}")
    return told


def main():
    good = expect("no fault", find_offences(SOUND), [])
    for label, files, beginnings in FAULTS:
        good &= expect(label, find_offences({**SOUND, **files}), beginnings)
    sys.exit(not good)


if __name__ == "__main__":
    main()
