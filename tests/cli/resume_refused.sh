# A checkpoint that cannot be used is refused with a sentence, and nothing is changed; what a
# checkpoint is worth is not lost by another command; and what asks a run to end leaves one.
. "$(dirname "$0")/lib.sh"
cat >>model.yaml <<'YAML'
quantities: {peak: max(corner.ux)}
output: {states: binary, steps: all}
checkpoint: {every: 1 h, steps: 10}
YAML
sed -i 's/end: 0.05/end: 10.0/' model.yaml
as_it_was() { # FOLDER: all bytes of it, and of the names in it
  (cd "$1" && find . -type f ! -name .lock-run -exec sha256sum {} + | sort)
}
same() { as_it_was cut | cmp -s - was || complain "$what: the folder has changed"; }
has() { [ -s "$1" ]; }

# Asked to end: what is kept in memory is written, and the same command goes on.
expect 0 run model.yaml -o whole --quiet
expect 0 run model.yaml -o cut --set time.end=0.2 --resume
err 'model.yaml: nothing to go on from in cut; it begins'
[ ! -e cut/checkpoint.bin ] || complain "the checkpoint of a run that is over stays"
rm -rf cut
for signal in INT:2 TERM:15 XCPU:24; do
  what="SIG${signal%:*} of a run with checkpoints"
  size=$(stat -c %s cut/steps.csv 2>/dev/null || echo 0)
  "$corot" run model.yaml -o cut --resume >stdout 2>stderr &
  until_true eval '[ "$(stat -c %s cut/steps.csv 2>/dev/null || echo 0)" -gt $((size + 5000)) ] || ! kill -0 $!'
  kill -"${signal%:*}" $!; wait $!
  got=$?
  [ $got = $((128 + ${signal#*:})) ] || complain "$what: exit code $got"
  err 'corot run --resume goes on from t = '
  has cut/checkpoint.bin || complain "$what: no checkpoint"
  grep -q '"status": "interrupted"' cut/result.json || complain "$what: result.json does not say so"
done
as_it_was cut >was

# Other commands leave it alone: anew, by the equilibrium, for modes, by a scenario that is bad.
for command in run static modes; do
  expect 5 $command model.yaml -o cut --quiet; err 'cut: has the checkpoint of a run that was cut'; err '--resume'; same
done
expect 3 run model.yaml -o cut --quiet --set strain=cubic; same
expect 3 run model.yaml -o cut --quiet --set groups.base.plane.at=0.3141 --resume; same
expect 3 run missing.yaml -o cut --quiet --resume; same

# Of another scenario, mesh, file of inputs; how often it is written does not matter.
for set in integrator.rtol=1e-3 mesh.box.cells='[1, 1, 3]' checkpoint.steps=11 checkpoint=null; do
  expect 3 run model.yaml -o cut --quiet --resume --set "$set"
  err 'cut/checkpoint.bin: is of another scenario or mesh than model.yaml'; err '--force'; same
done

# A bit that is flipped, a file that is cut or too long, of another order, format or program.
cp -r cut kept
python3 - "$corot" <<'PYTHON' || complain "a damaged checkpoint"
import hashlib, os, random, subprocess, sys

random.seed(1)
path = "cut/checkpoint.bin"
good = open(path, "rb").read()

def snapshot():
    return {os.path.join(d, f): open(os.path.join(d, f), "rb").read()
            for d, _, all in os.walk("cut") for f in all if f != ".lock-run"}

def refused(data, *words):
    open(path, "wb").write(data)
    before = snapshot()
    done = subprocess.run([sys.argv[1], "run", "model.yaml", "-o", "cut", "--resume", "--quiet"], capture_output=True)
    said = done.stderr.decode()
    assert done.returncode in (3, 5) and path in said and said.count("\n") == 1, (done, words)
    assert all(w in said for w in words), (said, words)
    assert snapshot() == before, "the folder has changed"

def sealed(data):
    return data + hashlib.sha256(data).hexdigest().encode()

def flipped(at, bit):
    return good[:at] + bytes([good[at] ^ 1 << bit]) + good[at + 1:]

for at in list(range(0, 48)) + random.sample(range(48, len(good)), 60):
    refused(flipped(at, random.randrange(8)))
for size in (0, 5, 16, 40, 100, len(good) // 2, len(good) - 1):
    refused(good[:size])
refused(good + b"x", "damaged")
refused(sealed(good[:16] + good[16:24][::-1] + good[24:-64]), "another byte order")
refused(sealed(good[:24] + (7).to_bytes(8, sys.byteorder) + good[32:-64]), "format 7")
program = good.index(b'"corot":"') + len(b'"corot":"')
refused(sealed(good[:program] + b"9" + good[program + 1:-64]), "written by another program", "go on with that one")
open(path, "wb").write(good)
PYTHON
same

# The files that belong to it: gone, cut, changed.
for file in steps.csv history.csv probes.csv energy.csv states.bin fields.pvd fields/fields_000001.vtu; do
  rm cut/$file; as_it_was cut >was
  expect 3 run model.yaml -o cut --quiet --resume; err "cut/$file: is not "; same
  head -c 200 kept/$file >cut/$file; as_it_was cut >was
  expect 3 run model.yaml -o cut --quiet --resume; err "cut/$file: "; same
  case $file in
    *.csv | *.pvd)
      sed '3,6s/[1-8]/9/' kept/$file >cut/$file; as_it_was cut >was
      expect 3 run model.yaml -o cut --quiet --resume; err "cut/$file: is not what it was at the checkpoint"; same
      ;;
  esac
  cp kept/$file cut/$file
done

# While another process writes there.
"$corot" run model.yaml -o cut --quiet --resume --set checkpoint.every=0 >stdout 2>first.err &
first=$!
until_true eval '! cmp -s kept/checkpoint.bin cut/checkpoint.bin'
kill -STOP $first
expect 5 run model.yaml -o cut --quiet --resume; err "process $first on "; err "is writing there"
kill -CONT $first; kill -KILL $first; wait $first 2>/dev/null

# It goes on in a copy without its lock, and somebody else's files there stay; so does a page.
rm -rf copy && mkdir copy && cp -r cut/* copy && rm -f copy/result.json && echo mine >copy/notes.txt
echo mine >copy/fields/fields_old.vtu
expect 0 run model.yaml -o copy --resume; err 'model.yaml: goes on from t = '
[ "$(cat copy/notes.txt copy/fields/fields_old.vtu)" = "mine
mine" ] || complain "files of others have changed"
rm copy/notes.txt copy/fields/fields_old.vtu
(cd whole && find . -type f ! -name result.json) | while read -r file; do
  cmp -s "whole/$file" "copy/$file" || echo "$file"
done >stdout
[ ! -s stdout ] || complain "a run that went on is not the one that was not cut"
[ ! -e copy/checkpoint.bin ] || complain "the checkpoint of a run that is over stays"

# What is done is done.
as_it_was copy >was
expect 0 run model.yaml -o copy --resume --json; err 'model.yaml: is done already; copy'
json "d['status'] == 'ok' and d['resumed'] > 0"
as_it_was copy | cmp -s - was || complain "what is done has changed"
expect 1 run model.yaml -o stuck --quiet --set time.end=0.1 --set 'quantities={T: period(corner.ux)}'
expect 1 run model.yaml -o stuck --quiet --set time.end=0.1 --set 'quantities={T: period(corner.ux)}' --resume
# But not if it is another run's, or lacks a file.
expect 0 run model.yaml -o stuck --set time.end=0.1 --resume; err 'nothing to go on from in stuck'
rm stuck/probes.csv
expect 0 run model.yaml -o stuck --set time.end=0.1 --resume; err 'nothing to go on from in stuck'
has stuck/probes.csv || complain "a file that was lost is not made again"

# --force begins anew, also where the checkpoint is of no use; with --resume, it says why.
cp -r cut other
expect 0 run model.yaml -o other --force --set time.end=0.1
[ ! -e other/checkpoint.bin ] || complain "--force leaves a checkpoint"
cp cut/checkpoint.bin other
rm other/result.json
expect 0 run model.yaml -o other --force --resume --set time.end=0.1; err 'another scenario'; err 'the run begins anew'

# A file of that name that is somebody else's.
rm -rf other && mkdir other && echo mine >other/checkpoint.bin
for resume in '' --resume; do
  expect 5 run model.yaml -o other --quiet $resume; err other/checkpoint.bin; err --force
done
expect 0 run model.yaml -o other2 --quiet --set time.end=0.1
echo mine >other2/checkpoint.bin
expect 5 run model.yaml -o other2 --quiet; err other2/checkpoint.bin
[ "$(cat other/checkpoint.bin other2/checkpoint.bin)" = "mine
mine" ] || complain "somebody else's file has changed"

# A disk that is full ends no run; it is said once, and the run is what it would have been.
if [ -w /dev/full ]; then
  rm -rf full && mkdir full && ln -s /dev/full full/checkpoint.bin.tmp
  expect 0 run model.yaml -o full --force --set checkpoint.every=0
  err 'the checkpoint of t = '; err 'is not written: full/checkpoint.bin.tmp: cannot write: No space left'
  [ "$(grep -c 'is not written' stderr)" = 1 ] || complain "it is said more than once"
  cmp -s whole/history.csv full/history.csv || complain "a run without room for checkpoints is another one"
fi

# Steps that take longer than what was asked for.
expect 0 run model.yaml -o slow --set time.end=0.2 --set checkpoint='1e-9 s' --set checkpoint.steps=10
err 'model.yaml: 10 steps took '; err 'checkpoint.steps: 1 would keep to it'

# What makes none says so; check and schema know of it.
expect 0 static model.yaml -o still; err 'corot static makes no checkpoints'
expect 0 modes model.yaml -n 2 -o modes; err 'corot modes makes no checkpoints'
expect 0 check model.yaml; out 'checkpoint     after each 10 steps, written every 3600 s of the clock'
expect 0 check model.yaml --json; json "d['checkpoint'] == {'every': 3600, 'steps': 10}"
expect 0 check model.yaml --resolved --set checkpoint=10min; json "d['checkpoint'] == {'every': 600, 'steps': 500}"
for bad in '10 parsec' fast -1 '[1]' '1e999 h'; do
  expect 3 check model.yaml --set checkpoint.every="$bad"; err 'checkpoint.every'
done
expect 3 check model.yaml --set checkpoint.steps=0; err 'checkpoint.steps: must be > 0'
grep -q checkpoint slow/steps.csv || complain "steps.csv does not show where the integrator began anew"
exit $failed
