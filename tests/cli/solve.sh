# A number with an interval: what is printed, written and refused, and what goes on from a folder.
. "$(dirname "$0")/lib.sh"

expect 0 solve --help; out "usage: corot solve MODEL.yaml --goal QUANTITY --within ERROR"; no_err

# What makes no sense is said before anything runs.
expect 2 solve model.yaml --within 0.1; err "--goal is missing"
expect 2 solve model.yaml --goal 'max(corner.ux)'; err "--within is missing"
for within in 0 -1 one 1e400; do
  expect 2 solve model.yaml --goal 'max(corner.ux)' --within=$within; err "--within $within: expected a number > 0"
done
expect 2 solve model.yaml --goal 'max(corner.ux)' --within 1; err "expected a fraction below 1"
expect 2 solve model.yaml --goal 'max(corner.ux' --within 0.1; err "--goal: a ) is missing"
expect 2 solve model.yaml --goal 'max(corner.ux)' --within 0.1 --cpu-limit 0; err "--cpu-limit 0: expected seconds"
expect 3 solve model.yaml --goal 'max(corne.ux)' --within 0.1; err "did you mean corner.ux?"
expect 3 solve model.yaml --goal 'corner.ux@1' --within 0.1; err "after the run"
expect 3 solve model.yaml --goal 'period(corner.ux)' --within 0.1 --static; err "an equilibrium has no period"
[ ! -e out ] || complain "a folder, but nothing to solve"

# An equilibrium, with each part of the error, by JSON and in words.
pull='--set strain=green'
expect 0 solve model.yaml --static --goal corner.ux@end --within 0.03 $pull --json; err "order 2, "
json 'd["met"] and d["goal"] == "corner.ux@end" and d["unit"] == "m" and d["within"] == 0.03 and d["static"]'
json 'd["low"] < d["value"] < d["high"] and d["high"] - d["low"] <= 2 * 0.03 * d["value"] * (1 + 1e-12)'
json 'set(d["parts"]) == {"space", "time", "algebra", "frames", "model"} and d["parts"]["model"] == 0'
json 'abs(sum(d["half"].values()) - (d["high"] - d["low"]) / 2) < 1e-12'
json 'len(d["levels"]) >= 2 and all(a["status"] == "done" and a["cpu_s"] >= 0 for a in d["attempts"])'
json 'd["levels"][-1]["value"] == d["value"] and abs(d["cpu_s"] - sum(a["cpu_s"] for a in d["attempts"])) < 1e-9'
cmp -s stdout out/model-static-solve/solve.json || python3 - <<'PY' || complain "solve.json is something else"
import json
assert json.load(open("stdout")) == json.load(open("out/model-static-solve/solve.json"))
PY
cp stdout first

# The same again makes no run anew; less error goes on from there.
before=$(find out/model-static-solve/runs -name result.json | wc -l)
expect 0 solve model.yaml --static --goal corner.ux@end --within 0.03 $pull --json --quiet; no_err
cmp -s stdout first || complain "another answer"
[ "$before" = "$(find out/model-static-solve/runs -name result.json | wc -l)" ] || complain "runs made anew"
expect 0 solve model.yaml --static --goal corner.ux@end --within 0.012 $pull
out "corner.ux@end = "; out " m, between "; out "1.2 % asked"; out "  space  "
[ "$before" -lt "$(find out/model-static-solve/runs -name result.json | wc -l)" ] || complain "no more runs"

# Motion: method and tolerance are chosen, and an early extreme is followed no further than needed.
expect 0 solve model.yaml --goal 'max(corner.ux)' --within 0.2 --json --set time.end=2 -o motion
json 'd["met"] and d["parts"]["time"] > 0 and d["half"]["time"] >= d["parts"]["time"]'
json '{a["method"] for a in d["attempts"]} == {"cvode", "arkode"}'
json 'len({a["until"] for a in d["attempts"]}) > 1 and max(a["until"] for a in d["attempts"]) == 2'
json 'd["parts"]["model"] > 0 and "model" not in d["half"]'
expect 0 solve model.yaml --goal 'max(corner.ux)' --within 0.2 --json --set time.end=2 -o motion --exact-model
json 'd["half"]["model"] >= d["parts"]["model"]'

# Where it is not met: the best that is known, why, and exit code 1.
expect 1 solve model.yaml --static --goal corner.ux@end --within 1e-6 --cpu-limit 0.2 -o short
out "not met: the limit of 0.2 s of CPU"; out "--cpu-limit"
expect 1 solve model.yaml --goal corner.ux@end --within 1e-6 --cpu-limit 1e-6 -o short2
out "corner.ux@end: not found"; out "the limit of 1e-06 s of CPU"

# What is nothing cannot be known to a part of it.
expect 3 solve model.yaml --static --goal held.ux@end --within 0.1 -o zero --set 'probes.held={group: base, of: displacement}'
err "held.ux is zero at all times"; no_out
expect 3 solve model.yaml --static --goal corner.uy@end --within 0.1 -o zero2 \
  --set 'mesh.box={size: [1, 1, 1], cells: [1, 1, 1]}' --set 'groups.base={plane: {axis: x, at: 0}}' \
  --set 'loads=[{group: xmax, traction: [20, 0, 0]}]' --set 'boundary=[{group: base, fix: [x]}, {group: ymin, fix: [y]}, {group: zmin, fix: [z]}]' \
  --set 'material={lambda: 0, mu: 1e4, density: 1}' --set 'probes.corner={point: [1, 1, 1]}'
err "corner.uy@end is zero"; err "--within-abs"
expect 0 solve model.yaml --static --goal corner.uy@end --within 1e-9 --within-abs -o zero3 \
  --set 'mesh.box={size: [1, 1, 1], cells: [1, 1, 1]}' --set 'groups.base={plane: {axis: x, at: 0}}' \
  --set 'loads=[{group: xmax, traction: [20, 0, 0]}]' --set 'boundary=[{group: base, fix: [x]}, {group: ymin, fix: [y]}, {group: zmin, fix: [z]}]' \
  --set 'material={lambda: 0, mu: 1e4, density: 1}' --set 'probes.corner={point: [1, 1, 1]}'
out "+- "; out "1e-09 m asked"

# Loads without an equilibrium, and a body that nothing holds.
expect 4 solve model.yaml --static --goal corner.ux@end --within 0.1 -o none --set 'loads=[{group: zmax, pressure: 1e7}]'
out "the first attempt, order 1"; out "no equilibrium"; out "without --static the motion has an answer"
expect 3 solve model.yaml --static --goal corner.ux@end --within 0.1 -o loose --set boundary=[]
out "no support hinders it"

# Passes of local refinement stand in a file; one of somebody else by that name stays.
grep -q '^# corot solve: ' out/model-static-solve/marks/1.txt || complain "marks"
mkdir -p theirs/marks; echo mine >theirs/marks/1.txt
expect 5 solve model.yaml --static --goal corner.ux@end --within 0.03 --set strain=green -o theirs; err "theirs/marks/1.txt"
[ "$(cat theirs/marks/1.txt)" = mine ] || complain "a file of others was replaced"
expect 0 solve model.yaml --static --goal corner.ux@end --within 0.03 --set strain=green -o theirs --force

# A folder of another scenario stays as it is.
expect 3 solve model.yaml --static --goal corner.ux@end --within 0.1 -o short --set title=other; err 'belongs to the study'
exit $failed
