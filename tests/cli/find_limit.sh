. "$(dirname "$0")/lib.sh"

# A limit that is known: so many steps of one length reach no further than their sum.
limit="find-limit model.yaml --quiet --set time.end=0.2 --set integrator.method=backward-euler"
expect 0 $limit -o steps --set integrator.max_steps=20 --key time.end --from 0.05 --to 0.8 \
  --set integrator.step=0.01 --scan 5 --energy 1e9 --json
no_err
json '0.2 / 1.021 < d["stable"] <= 0.2 * (1 + 1e-9) < d["unstable"] < 0.2 * 1.021'
json 'd["stable_again"] == 0 and len(d["trials"]) > 5'
json 'all("max_steps = 20" in t["reason"] for t in d["trials"] if not t["stable"])'
cmp -s stdout steps/limit.json || python3 -c 'import json
assert json.load(open("stdout")) == json.load(open("steps/limit.json"))' || complain "limit.json"

# The same in words; the runs are there already.
touch before
expect 0 $limit -o steps --set integrator.max_steps=20 --key time.end --from 0.05 --to 0.8 \
  --set integrator.step=0.01 --scan 5 --energy 1e9
out "time.end: stable up to 0."; out "unstable: "
[ -z "$(find steps/runs -name result.json -newer before)" ] || complain "a run was repeated"

# More energy than the first run has: a load that grows tenfold makes a hundredfold.
expect 0 $limit -o energy --set integrator.step=0.01 --key loads.0.force.0 --from 1 --to 10 --scan 3 \
  --set 'loads.0={group: zmax, force: [1, 0, 0]}' --json
# it grows with the square, nearly: twice at sqrt(2)
json '1.35 < d["stable"] < d["unstable"] < 1.45'

# No limit within the range, or none above its beginning.
expect 1 $limit -o none --key integrator.step --from 0.01 --to 0.02 --scan 2; out "stable up to 0.02"
expect 1 $limit -o all --set integrator.step=0.01 --set integrator.max_steps=2 --key time.end \
  --from 0.1 --to 0.2 --scan 2
out "not even 0.1 is stable"

expect 2 find-limit model.yaml --from 1 --to 2; err "--key is missing"
long=$(printf '%079d' 0) # the longest key, and one that is longer
expect 3 find-limit model.yaml --key "$long" --from 1 --to 2; err "$long"
expect 2 find-limit model.yaml --key "0$long" --from 1 --to 2; err "expected a key such as"
expect 2 find-limit model.yaml --key time.end --from 2 --to 1; err "expected 0 < from < to"
expect 2 find-limit model.yaml --key time.end --from x; err "x: expected a number"
expect 2 find-limit model.yaml --key time.end --from 1 --to 2 --energy 1; err "above 1"
expect 2 find-limit model.yaml --key time.end --from 1 --to 2 --scan 1.5; err "a scan of 0 values"
expect 3 find-limit model.yaml --key time.ende --from 1 --to 2; err "did you mean end?"
expect 2 find-limit model.yaml --key time.end --to 2; err "--from is missing"
expect 2 find-limit model.yaml --key time.end --from 1; err "--to is missing"
expect 3 find-limit model.yaml --key integrator.max_order --from 1 --to 2 --scan 3
err "--set integrator.max_order=1.41421356: integrator.max_order: "
grep -q exclude stderr && complain "there is nothing to exclude cells with"
expect 0 find-limit --help; out "example: corot find-limit"; no_err
exit $failed
