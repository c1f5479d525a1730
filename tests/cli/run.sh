. "$(dirname "$0")/lib.sh"

expect 0 run model.yaml; no_out
[ -s out/model/probes.csv ] && [ -s out/model/result.json ] || complain "no output in out/model"

expect 0 run model.yaml -o a/b --quiet; no_out; no_err
[ -s a/b/energy.csv ] || complain "no a/b/energy.csv"

# The groups that supports and loads name, where there are fields to draw them on.
python3 - <<'PY' || complain "a/b/groups.json"
import json
groups = json.load(open("a/b/groups.json"))
assert sorted(groups) == ["base", "zmax"], sorted(groups)
assert groups["base"]["nodes"] == [0, 1, 2, 3] and groups["zmax"]["nodes"] == [8, 9, 10, 11]
assert len(groups["zmax"]["faces"]) == 2 and set(sum(groups["zmax"]["faces"], [])) == {8, 9, 10, 11}
PY
expect 0 run model.yaml --output a/b --quiet --set time.end=0.02 --set output.fields=none
[ ! -e a/b/groups.json ] || complain "groups of an earlier run"

expect 0 run model.yaml --output a/b --json --set time.end=0.02
json 'd is not None'

expect 0 run model.yaml -o c --json --set 'integrator={method: newmark, step: 0.004}' \
  --set 'frames={policy: hold, interval: 0.02}' --set 'compare=[warp]'
json 'd["t_reached"] == 0.05 and d["statistics"]["nst"] == 13 and d["frames"]["updates_by"]["interval"] == 2'
[ "$(head -1 c/compare.csv)" = t,warp.total,warp.pressure,warp.shear,polar.total,polar.pressure,polar.shear ] ||
  complain "c/compare.csv"
expect 4 run model.yaml -o c --set 'integrator={method: newmark, step: 0.004, newton: {iterations: 1}}'
err "newmark: "; err "Newton has not converged in 1 iterations"

# A consistent mass on a base that is shaken, or starts and stops at once: the books are balanced.
for base in 'move: {direction: [0.01, 0, 0], amplitude: {sine: {frequency: 20}}}' \
  'move: {direction: [0.01, 0, 0], amplitude: {smooth: [[0.01, 0], [0.03, 1]]}}' \
  'translate: {velocity: [0.2, 0, 0], from: 0.01, to: 0.03}'; do
  expect 0 run model.yaml -o c --json --set mass=consistent --set "boundary=[{group: base, $base}]"
  json 'abs(d["energy"]["balance"]) < 5e-3 * d["energy"]["external_work"]'
done

expect 3 run none.yaml; no_out; err "none.yaml"
expect 3 run model.yaml --set boundary.0.group=bse -o d; err "did you mean base?"; no_out
expect 3 run model.yaml --set mesh.box=null --set mesh.file=none.msh -o c; err "none.msh"
echo >file
expect 5 run model.yaml -o file/x; err "file: exists and is not a folder"; no_out

# Which output times have fields.
expect 0 run model.yaml -o f --set output.every=2
cp f/result.json stdout; json 'd["fields"]["every"] == 2 and not d["fields"]["thinned"]'
expect 0 run model.yaml -o f --set output.fields=none --force
cp f/result.json stdout; json 'd["fields"] is None'

# Interrupted: what there is gets written, and the exit code says by what.
for signal in INT:130 TERM:143; do
  "$corot" run model.yaml -o i --set time.end=1e6 --set output.fields=none >stdout 2>stderr &
  what="interrupted run"
  tries=0
  until [ -s i/steps.csv ] || [ $tries = 100 ]; do sleep 0.1; tries=$((tries + 1)); done
  kill -"${signal%:*}" $!
  wait $!
  got=$?
  [ $got = "${signal#*:}" ] || complain "signal ${signal%:*}: exit code $got"
  [ -s i/result.json ] || complain "signal ${signal%:*}: no result.json"
  no_out
  rm -r i
done
exit $failed
