# What is the most that a file may have is said by the documentation and, where there is more, by
# the message, with its place. All of what is allowed works.
. "$(dirname "$0")/lib.sh"

python3 - <<'PY'
base = open("model.yaml").read()
head = base.split("probes:")[0]

def probes(n):
    return head + "probes:\n" + "".join(f"  p{i}: {{point: [0.1, 0.1, 0.1]}}\n" for i in range(n))

def pairs(n):
    text = "[" + ", ".join(f"[{i}, 1]" for i in range(n)) + "]"
    return base.replace("traction: [200.0, 0.0, 0.0]", "traction: [200.0, 0.0, 0.0], amplitude: " + text)

open("probes-10000.yaml", "w").write(probes(10000))
open("probes-10001.yaml", "w").write(probes(10001))
open("values-less.yaml", "w").write(pairs(333000))  # three values each
open("values-more.yaml", "w").write(pairs(334000))
for n in (32, 33):
    open(f"levels-{n}.yaml", "w").write("x: " + n * "[" + n * "]" + "\n")
open("size-less.yaml", "w").write(base + "#" * ((16 << 20) - len(base)))
open("size-more.yaml", "w").write(base + "#" * ((16 << 20) - len(base) + 1))
open("name-127.yaml", "w").write(base.replace("base", 127 * "g"))
open("name-128.yaml", "w").write(base.replace("base", 128 * "g"))
open("study-64.yaml", "w").write("study: s\nbase: model.yaml\naxes:\n  - points:\n    - {" + ", ".join(f"k{i}: 1" for i in range(64)) + "}\n")
open("study-65.yaml", "w").write("study: s\nbase: model.yaml\naxes:\n  - points:\n    - {" + ", ".join(f"k{i}: 1" for i in range(65)) + "}\n")
for n in (1000, 1001):
    open(f"log-{n}.yaml", "w").write(f"study: s\nbase: model.yaml\naxes:\n  - {{key: time.end, log: {{from: 1, to: 2, points: {n}}}}}\n")
axis = "  - {key: %s, log: {from: 1, to: 2, points: %d}}\n"
for n in (100, 101):
    open(f"cells-{n}.yaml", "w").write("study: s\nbase: model.yaml\nreference: none\naxes:\n" + axis % ("time.end", 1000) + axis % ("material.mu", n))
PY

expect 0 schema --help; out '16 MiB, 1000000 values'; out '10000 keys in one'; out '32 levels'; out '127 bytes'
expect 0 check probes-10000.yaml; out 'probe          p9999:'
expect 3 check probes-10001.yaml; err 'probes-10001.yaml:10012:3: more than 10000 keys in one map, the limit of a file'
expect 3 check model.yaml --set "probes={$(seq -s , -f '"p%g": 0' 10001)}" ; err 'more than 10000 keys in one map'
expect 0 check values-less.yaml
expect 3 check values-more.yaml; err 'values-more.yaml:9:'; err 'more than 1000000 values, the limit of a file'
expect 3 check levels-32.yaml; err 'x: unknown key'
expect 3 check levels-33.yaml; err 'levels-33.yaml:1:'; err 'nested deeper than 32 levels, the limit of a file'
expect 0 check size-less.yaml
expect 3 check size-more.yaml; err 'size-more.yaml: larger than 16 MiB, the limit'
expect 0 check name-127.yaml
expect 3 check name-128.yaml; err 'name-128.yaml:4:3:'; err 'at most 127 bytes, this one 128'
expect 0 schema --json
json "d['properties']['probes']['maxProperties'] == d['properties']['groups']['maxProperties'] == 10000"

expect 0 study --help; out '64 different keys'; out '1000 values of a log'; out '100000 combinations'
expect 0 study schema axes.log; out 'at most 1000'
expect 0 study log-1000.yaml --dry-run
expect 3 study log-1001.yaml --dry-run; err 'log-1001.yaml:4:'; err '1001 values; 1000 is the most'
expect 3 study cells-101.yaml --dry-run; err 'cells-101.yaml:1:1: 101000 combinations; 100000 is the most'
exit $failed
