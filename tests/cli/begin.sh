# What somebody meets first: help, version, starters, messages on a terminal, all faults at once.
. "$(dirname "$0")/lib.sh"

# The help of a command is the same by each way to it.
expect 0 help; out "usage: corot COMMAND"; out "to begin:"; no_err
cp stdout whole
expect 0 --help; cmp -s stdout whole || complain "help and --help differ"
expect 0 help help; cmp -s stdout whole || complain "help help is not help"
for command in new "study export" "mesh box"; do
  # shellcheck disable=SC2086
  expect 0 $command --help; cp stdout told
  # shellcheck disable=SC2086
  expect 0 help $command; no_err
  cmp -s stdout told || complain "help $command is not what $command --help says"
done
expect 2 help chek; err "did you mean check?"; no_out
expect 2 help a b c; err "expected one command"

expect 0 --version; cp stdout told; out "commit "; out "SUNDIALS "; out "SuiteSparse "; out "KLU "
expect 0 -v; cmp -s stdout told || complain "-v is not --version"

# Starters run as they are, and nobody's file is written over.
for kind in bar bracket free; do
  expect 0 new $kind; no_err; cp stdout told
  head -n 1 told | grep -q '^# yaml-language-server: \$schema=corot.schema.json$' || complain "no modeline"
  expect 0 new $kind -o $kind.yaml; no_out; err "$kind.yaml: "
  cmp -s told $kind.yaml || complain "$kind.yaml is not what stdout has"
  expect 0 check $kind.yaml
  echo "# mine" >>$kind.yaml
  expect 5 new $kind -o $kind.yaml; err "there is a file already; --force replaces it"
  grep -q '^# mine' $kind.yaml || complain "a file was written over"
done
expect 0 new bar -o bar.yaml --force; ! grep -q '^# mine' bar.yaml || complain "--force replaces nothing"
expect 0 run bar.yaml; err "largest "; ! grep -q '^warning' stderr || complain "a starter that warns"
expect 0 run free.yaml; ! grep -q '^warning' stderr || complain "a starter that warns"
expect 0 static bracket.yaml; err "deflection "
expect 2 new brecket; err "did you mean bracket?"; no_out
expect 2 new; err "expected one of bar, bracket and free, found 0"
expect 2 new bar -o ""; err "the name is empty"
expect 5 new bar -o nowhere/bar.yaml; err "nowhere/bar.yaml: No such file"
if [ -w /dev/full ]; then expect 5 new bar --force -o /dev/full; err "No space left"; fi

# The JSON Schema accepts the starters, with their units, and refuses what corot check refuses.
"$corot" schema --json >corot.schema.json
for python in /usr/bin/python3 python3; do
  "$python" -c 'import jsonschema, yaml' 2>/dev/null && break
done
"$python" - <<'PYTHON' || complain "the JSON Schema and the starters"
import json, sys
try:
    import jsonschema, yaml
except ImportError:
    sys.exit(0)
schema = json.load(open("corot.schema.json"))
jsonschema.Draft202012Validator.check_schema(schema)
judge = jsonschema.Draft202012Validator(schema)
for kind in "bar", "bracket", "free":
    scenario = yaml.safe_load(open(kind + ".yaml"))
    judge.validate(scenario)
    scenario["material"]["density"] = "heavy"
    assert not judge.is_valid(scenario)
PYTHON

# All that is wrong, by place; what is there under a wrong name is not missing, too.
cat >bad.yaml <<'YAML'
mesh: {box: {size: [10 kg, 1, 1], cells: [1, 1, 1]}}
groups:
  a: {plane: {axis: q, at: 1}}
  b: {box: {min: [0, 0, 0]}}
material: {E: 1 mpa, nu: 0.4, density: 1, dampin: {mu: 200}}
boundary: [{grup: zmin, fix: [x, y, z]}]
tim: {end: 1}
integrator: {rtol: 3}
YAML
expect 3 check bad.yaml --set threads=many; no_out
{
  echo bad.yaml:1:21: mesh.box.size
  echo bad.yaml:3:21: groups.a.plane.axis
  echo bad.yaml:4:7: groups.b.box
  echo bad.yaml:5:15: material.E
  echo bad.yaml:5:43: material.dampin
  echo bad.yaml:6:13: "boundary[0].grup"
  echo bad.yaml:7:1: tim
  echo bad.yaml:8:20: integrator.rtol
  echo --set threads=many: threads
} >wanted
sed -n 's/^\([^ ].*: [a-zA-Z_.]*\(\[0\][a-z.]*\)\?\): .*/\1/p; /^  /d' stderr | sed 's/\[0\]$//' >got
sed 's/size\[0\]/size/' got | diff - wanted >diffs || { cat diffs; complain "faults and their order"; }
err "unknown unit mpa; did you mean MPa?"
! grep -q "time.*missing" stderr || complain "time is said to be missing"

# What does not go together, and names that the mesh does not have, in the same manner.
sed '/^groups/a\  c: {box: {min: [0, 0, 1], max: [0, 0, 0]}}' model.yaml |
  sed 's/lambda: 1.0e5, mu/E: 1, mu/; s/group: zmax, //' >bad.yaml
expect 3 check bad.yaml; err "min is larger than max"; err "give lambda and mu"; err "loads[0]: group is missing"
sed 's/group: base/group: bse/; s/group: zmax/group: zmox/; s/  corner:.*/&\n  p: {group: xmxa}/' model.yaml >bad.yaml
expect 3 check bad.yaml
err "no group bse; did you mean base?"; err "no group zmox; did you mean zmax?"; err "no group xmxa; did you mean xmax?"

# Ten, and how many more.
{
  cat model.yaml
  for i in 1 2 3 4 5 6 7 8 9 10 11 12 13; do echo "  p$i: {pint: [0, 0, 0]}"; done
} >bad.yaml
expect 3 check bad.yaml; no_out
[ "$(grep -c 'unknown key; did you mean point?' stderr)" = 10 ] || complain "not ten"
err "bad.yaml:13:8: probes.p1.pint"; err "bad.yaml:22:9: probes.p10.pint"
[ "$(tail -n 1 stderr)" = "and 3 more" ] || complain "not: and 3 more"

# Colours: on a terminal that has them, nowhere else, and not where nobody wants them.
escape=$(printf '\033')
expect 3 check bad.yaml; ! grep -q "$escape" stderr || complain "colours in a file"
if script -qec true /dev/null >/dev/null 2>&1 </dev/null; then
  on_terminal() { env "$@" script -qec "'$corot' check bad.yaml" /dev/null </dev/null 2>&1 | grep -c "$escape"; }
  [ "$(on_terminal -u NO_COLOR TERM=xterm)" -gt 10 ] || complain "no colours on a terminal"
  [ "$(on_terminal NO_COLOR= TERM=xterm)" -gt 10 ] || complain "an empty NO_COLOR is one"
  [ "$(on_terminal NO_COLOR=1 TERM=xterm)" = 0 ] || complain "NO_COLOR"
  [ "$(on_terminal -u NO_COLOR TERM=dumb)" = 0 ] || complain "TERM=dumb"
fi
exit $failed
