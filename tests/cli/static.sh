. "$(dirname "$0")/lib.sh"

expect 0 static --help; out "usage: corot static MODEL.yaml"; no_err
expect 2 static; err "expected one scenario, found 0"

expect 0 static model.yaml; no_out; err "load factor 1: residual "; err "in 1 load step, "
[ "$(wc -l <out/model-static/probes.csv)" = 3 ] || complain "rows of probes.csv"
tail -n 1 out/model-static/probes.csv | grep -q '^0\.050*[0-9]*,0\.0' || complain "the last row is not the end"
[ -s out/model-static/fields.pvd ] && [ -s out/model-static/energy.csv ] || complain "no output in out/model-static"

expect 0 static model.yaml -o a --quiet --json --set statics.max_step=0.25; no_err
json 'd["status"] == "ok" and d["t_reached"] == 0.05 and d["integrator"] is None'
json '[s["factor"] for s in d["statics"]["steps"]] == [0.25, 0.5, 0.75, 1.0]'
json 'd["statistics"]["nstep"] == 4 and d["statistics"]["nni"] == sum(s["iterations"] for s in d["statics"]["steps"])'
json 'all(s["stability"] == "stable" and len(s["residual"]) == s["iterations"] + 1 for s in d["statics"]["steps"])'
json 'all(k in d["statistics"] for k in ("nfe", "nje", "nbcfails", "nbacktrack", "nfactor", "nsolve", "nrejected"))'
json 'abs(d["energy"]["balance"]) < 0.02 * d["energy"]["elastic"] and d["energy"]["kinetic"] == 0'
json 'd["probes"]["corner"]["v"] == [0, 0, 0] and d["probes"]["corner"]["u"][0] > 0.005'
[ "$(wc -l <a/probes.csv)" = 6 ] && [ "$(wc -l <a/steps.csv)" = 5 ] || complain "rows of a load step each"

expect 0 static model.yaml -o b --quiet --json --set statics.frames=held --set linear_solver=klu
json 'd["statistics"]["nframes"] > 5 and d["statics"]["linear_solver"].startswith("klu")'

# Supports hold what is put on, weight and traction on held nodes included: 2 kg, 200 Pa on 0.01 and
# 0.02 m^2; to the tolerance of the residual, 1e-10 of some 10 N on each of the nodes.
expect 0 static model.yaml -o f --quiet --json \
  --set 'loads=[{gravity: [0, 0, -10]}, {group: zmax, traction: [200, 0, 0]}, {group: xmin, traction: [0, 200, 0]}]'
json 'all(abs(f - g) < 1e-7 for f, g in zip(d["statics"]["reactions"]["base"], [-2, -4, 20]))'
head -n 1 f/reactions.csv | grep -qx 't,base.fx,base.fy,base.fz' || complain "header of reactions.csv"
[ "$(wc -l <f/reactions.csv)" = "$(wc -l <f/probes.csv)" ] || complain "rows of reactions.csv"
expect 0 run model.yaml -o f --quiet
[ ! -e f/reactions.csv ] || complain "reactions of an earlier equilibrium"
# A support that an amplitude has turned and brought back a half: the body goes with it, unstrained.
expect 0 static model.yaml -o m --quiet --json --set loads=[] --set 'boundary.0={group: base,
  move: {rotate: {axis: [0, 0, 1], angle: 2}, amplitude: [[0, 0], [0.02, 1], [0.05, 0.5]]}}'
json 'abs(d["probes"]["corner"]["u"][0] - (0.1 * (0.5403023058681398 - 0.8414709848078965) - 0.1)) < 1e-12'
json 'd["energy"]["elastic"] < 1e-20'

# What is refused.
expect 3 static model.yaml -o c --set boundary=[]; no_out
err "model.yaml: statics: the body can move along x, y and z and turn about x, y and z freely"
[ ! -e c ] || complain "a folder for nothing"
expect 3 static model.yaml -o c --set statics.first_step=1.5; err "statics.first_step: must be > 0, at most 1"
expect 3 static model.yaml -o c --set 'statics={min_step: 0.2, max_step: 0.1}'; err "larger than max_step"
expect 3 static model.yaml -o c --set statics.frames=hold; err "did you mean held?"
expect 3 static model.yaml -o c --set statics.tolerence=1; err "did you mean tolerance?"

# A column pressed until it buckles: what was reached is kept.
expect 4 static model.yaml -o d --json --set 'mesh.box={size: [0.1, 0.1, 1.0], cells: [2, 2, 10]}' \
  --set 'loads=[{group: zmax, traction: [0, 0, -4000]}]' --set 'probes.corner={point: [0, 0, 1]}'
err "the equilibrium becomes unstable at load factor 0."; err "(buckling)"
json 'd["status"] == "failed" and d["exit_code"] == 4 and "unstable" in d["reason"]'
json 'd["statics"]["critical"][0] == d["statics"]["factor"] < d["statics"]["critical"][1] < 1 and d["statics"]["critical"][1] - d["statics"]["factor"] <= 2e-4'
json 'd["t_reached"] == d["statics"]["factor"] * d["t_end"]'
json 'd["statistics"]["nstep"] == len(d["statics"]["steps"]) >= 3'
[ "$(wc -l <d/probes.csv)" -ge 5 ] && [ -s d/fields.pvd ] || complain "d: what was reached is lost"

# A run that starts in equilibrium stays there, under loads that are there from the start only.
expect 0 run model.yaml -o e --quiet --json --set start=equilibrium
json 'd["energy"]["kinetic"] < 1e-15 * d["energy"]["elastic"]'
expect 0 static model.yaml -o f --quiet --json
u='[float(x) for x in open(n + "/probes.csv").read().split()[-1].split(",")[1:]]'
python3 -c "
e, f = [$u for n in 'ef']
assert max(abs(a - b) for a, b in zip(e, f)) < 1e-9, (e, f)" || complain "run and static disagree"
expect 0 run model.yaml -o e --quiet --json --set start=equilibrium \
  --set 'loads.0.amplitude=[[0, 0], [0.05, 1]]'
json 'd["energy"]["kinetic"] > 0'
expect 3 run model.yaml -o e --set start=equilibrium --set boundary=[]; err "start: equilibrium: statics: the body can"
expect 4 run model.yaml -o g --set start=equilibrium \
  --set 'statics={max_iterations: 1, min_step: 0.5}'
err "start: equilibrium: no equilibrium found beyond load factor 0: The maximum number of iterations"
exit $failed
