# corot-bench peers on the coarsest meshes of two problems: the form of what it writes, and that
# programs which solve one problem on one mesh find one answer. No test judges its times.
# Runs as: sh check.sh COROT_BENCH
set -u
bench=$1
command -v /usr/bin/python3 >/dev/null && /usr/bin/python3 -c 'import numpy' 2>/dev/null || {
  echo "python3-numpy is not installed: skipped"
  exit 77
}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
peers=corot
command -v ccx >/dev/null && peers=corot,calculix
failed=0

# measure FOLDER ARGUMENTS...
measure() {
  folder=$dir/$1
  shift
  "$bench" peers "$@" --first --limit 60 -o "$folder" >"$dir/log" 2>&1 && return
  cat "$dir/log"
  echo "FAILED: corot-bench peers $*: exit code not zero"
  exit 1
}
measure out --only csm1 --peers $peers
measure motion --only rod --peers corot
/usr/bin/python3 - "$dir" "$peers" <<'PYTHON' || failed=1
import csv, sys
folder, peers = sys.argv[1], sys.argv[2].split(",")

def table(name):
    with open(f"{folder}/{name}/peers.csv", newline="") as file:
        return list(csv.DictReader(file))

rows = table("out")
assert {r["peer"] for r in rows} == set(peers), rows
for r in rows + table("motion"):
    assert not r["failure"] and float(r["cpu_s"]) >= 0 and int(r["unknowns"]) > 0, r
    off = abs(float(r["answer"]) / float(r["truth"]) - 1)
    assert abs(off - float(r["error"])) < 1e-12, r
    assert off < 0.25 or "four-node" in r["row"], r  # which lock on meshes as coarse
# Ten-node tets of four points of integration under Green's strain, here and there.
ten = [float(r["answer"]) for r in rows if r["row"].split(",")[0] in ("ten-node tets", "C3D10")]
assert len(ten) == len(peers) and abs(ten[0] / ten[-1] - 1) < 1e-5, ten
with open(folder + "/out/ranks.md") as file:
    text = file.read()
assert "| Turek and Hron, CSM1 |" in text and "First at 0.1 %, of 1: corot" in text, text
with open(folder + "/out/peers.html") as file:
    page = file.read()
assert page.count("<svg") == 1 and page.count("<circle") == len(rows), page
PYTHON
# The answers of the table are rated again without a run, to the same ranks.
"$bench" peers --from "$dir/out/peers.csv" --only csm1 -o "$dir/again" >/dev/null 2>&1 &&
  cmp -s "$dir/out/ranks.md" "$dir/again/ranks.md" || { echo "FAILED: --from"; failed=1; }

# usage ARGUMENTS...: refused with a message and exit code 2.
usage() {
  message=$("$bench" peers "$@" 2>&1 >/dev/null)
  [ $? = 2 ] && [ -n "$message" ] || { echo "FAILED: corot-bench peers $*: not refused"; failed=1; }
}
usage --only nothing
usage --peers nothing
usage --limit 0
usage extra
"$bench" peers --help | grep -q 'twelve problems' || { echo "FAILED: --help"; failed=1; }
exit $failed
