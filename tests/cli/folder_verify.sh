# What reads the files of a run looks whether they are what the run has left.
. "$(dirname "$0")/lib.sh"

# change FILE: other contents of the same size.
change() { python3 -c "import sys; p = sys.argv[1]; b = bytearray(open(p, 'rb').read()); b[len(b) // 2] ^= 1; open(p, 'wb').write(b)" "$1"; }

cat >study.yaml <<'YAML'
study: which one
base: model.yaml
axes: [{key: strain, values: [polar, green]}]
reference: none
YAML
expect 0 study study.yaml -o store --quiet
rm -rf whole && cp -r store whole
set -- store/runs/*/
id=$(basename "$1")
for file in states.bin probes.csv energy.csv history.csv; do
  rm -rf store && cp -r whole store
  change "$1$file"
  expect 1 study collect store; err "$id is missing: $1"; err "$file: has other contents than when result.json was written"
  expect 0 study study.yaml -o store; err "2 of 2 runs done (1 now)"
  cmp -s "$1$file" "whole/runs/$id/$file" || complain "$file is not made again"
  expect 0 study study.yaml -o store; err "2 of 2 runs done (0 now)"
  expect 0 study collect store
done

# Nothing is done of which the files are gone.
rm -f store/runs/*/states.bin
expect 0 study status store; out "0 done, 0 failed, 2 missing"; out "states.bin: result.json lists it, and it is not there"
expect 1 study collect store; err "states.bin: result.json lists it, and it is not there"
python3 -c 'import json; d = json.load(open("store/table.json")); assert all(c["status"] == "missing" and c["cost"] is None for c in d["cells"]), d' ||
  complain "the table knows of runs whose files are gone"
expect 0 study study.yaml -o store; err "2 of 2 runs done (2 now)"
for id in $(ls whole/runs); do cmp -s whole/runs/$id/states.bin store/runs/$id/states.bin || complain "states are not made again"; done

# Nor is a list believed that was edited.
for edit in 's/"size": [0-9]*/"size": 1/' 's/"sha256": "./"sha256": "x/' 's/"sha256"/"sha"/' 's/"name": "probes.csv"/"nom": "probes.csv"/' 's/"name": "probes.csv"/"name": "probes"/'; do
  for run in store/runs/*/; do sed -i "$edit" "$run/result.json"; done
  expect 0 study study.yaml -o store; err "2 of 2 runs done (2 now)"
done

# A budget makes its runs again.
expect 0 budget model.yaml -o parts --quiet --skip space --json; cp stdout before.json
change "$(ls parts/runs/*/states.bin | head -n 1)"
touch mark; sleep 1
expect 0 budget model.yaml -o parts --quiet --skip space --json
[ "$(find parts/runs -name result.json -newer mark | wc -l)" = 1 ] || complain "$what: not the one run that was damaged"
python3 - <<'PY' || complain "another budget"
import json
a, b = [json.load(open(f)) for f in ("before.json", "stdout")]
assert [p["error"] for p in a["parts"]] == [p["error"] for p in b["parts"]]
PY

# A page shows nothing that has changed; of what is gone it says so.
expect 0 run model.yaml -o run --quiet --set 'compare=[polar]'
expect 0 static model.yaml -o still --quiet
expect 0 report run
for file in run/probes.csv run/energy.csv run/steps.csv run/history.csv run/compare.csv run/groups.json run/fields.pvd \
  run/fields/fields_000000.vtu run/fields/fields_000005.vtu still/reactions.csv; do
  cp $file kept
  change $file
  expect 3 report ${file%%/*} -o page.html; err "$file: has other contents than when result.json was written"; no_out
  echo more >>$file
  expect 3 report ${file%%/*} -o page.html; err "$file: has "; err " bytes where result.json says "
  cp kept $file
done
[ ! -e page.html ] || complain "a page in spite of that"
echo t,base.x >run/reactions.csv
expect 3 report run -o page.html; err "run/reactions.csv: is not among the files that result.json lists"
rm run/reactions.csv run/history.csv run/fields.pvd
expect 0 report run -o page.html
for file in history.csv fields.pvd; do
  grep -qF "$file is listed in result.json, and is not there any more" page.html || complain "the page says nothing of $file"
done
exit $failed
