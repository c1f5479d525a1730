# Why a run of a study failed, and whether trying again can help: what is tried again, how often, and
# what ends a run that would not end.
. "$(dirname "$0")/lib.sh"
study() { printf '%s\n' "study: which one" "base: model.yaml" "set: {time.end: 0.02}" 'reference: none' "$@" >study.yaml; }

# why DIR KIND RETRY: failure.json of the only run there that has one.
why() {
  cat "$1"/runs/*/failure.json >stdout
  json "d['failure'] == {'kind': '$2', 'retry': $3}"
}

# A run that goes on and on has so many seconds. It would do the same again.
study 'axes: [{key: time.end, values: [0.01, 1.0e6]}]'
expect 1 study study.yaml -o long --timeout 1.5
err "1 of 2 runs done (1 now), 1 failed"; err "not over after the 1.5 s that each run has"; why long timeout False
grep -q '"interrupted"' long/runs/*/result.json || complain "it does not say how far it came"
expect 1 study study.yaml -o long; err "1 of 2 runs done (0 now), 1 failed"
expect 1 study study.yaml -o long --retry-failed --timeout 0.5; err "the 0.5 s that each run has"
expect 0 study status long; out "failed: not over after"
for wrong in 0 -1 1s nan; do expect 2 study study.yaml --timeout $wrong; err "--timeout $wrong: expected seconds > 0"; done
expect 1 budget model.yaml -o budget --set time.end=1e6 --set output.fields=none --timeout 0.2 --quiet
expect 2 find-limit model.yaml --timeout 0; err "--timeout 0: expected seconds > 0"

# One that waits for a pipe that is full cannot even be asked.
study 'axes: [{key: integrator.rtol, values: [1e-3, 1e-4]}, {key: output.fields, values: [none]}, {key: time.output, values: [5e-6]}]'
expect 0 study study.yaml -o deaf --quiet
run=$(ls -d deaf/runs/* | head -1)
rm "$run/result.json" "$run/probes.csv"; mkfifo "$run/probes.csv"
exec 9<>"$run/probes.csv" # which reads nothing
expect 1 study study.yaml -o deaf --timeout 1; err "1 of 2 runs done (0 now), 1 failed"; why deaf timeout False
exec 9>&-
rm "$run/probes.csv"
expect 0 study study.yaml -o deaf --retry-failed --timeout 60; err "2 of 2 runs done (1 now), 0 failed"

# What may pass is tried again: with the last attempt it is left for another time.
if [ -w /dev/full ]; then
  rm "$run/result.json"; ln -sf /dev/full "$run/steps.csv"
  expect 5 study study.yaml -o deaf; err "1 stopped for reasons from outside"; why deaf io True
  [ "$(grep -c 'No space left' stderr)" = 1 ] || complain "not told once"
  expect 0 study status deaf; out "to be tried again: "; out "1 done, 0 failed, 1 missing"
  rm "$run/steps.csv"
  expect 0 study study.yaml -o deaf; err "2 of 2 runs done (1 now), 0 failed"
fi

# The integrator's own failure is no such thing.
study 'axes: [{key: integrator.max_steps, values: [2, 100000]}]'
expect 1 study study.yaml -o steps; err "1 failed"
grep -q '"kind": "integrator"' steps/runs/*/result.json || complain "no kind"

# Interrupted by any of the signals, a study goes on from there.
study 'axes: [{key: time.end, values: [1e6, 2e6, 0.01]}]'
for signal in HUP:129 USR1:138 XCPU:152; do
  what="SIG${signal%:*}"
  rm -rf i
  "$corot" study study.yaml -o i -j 3 >stdout 2>stderr &
  until_true eval '[ "$(ls i/runs/*/steps.csv 2>/dev/null | wc -l)" = 3 ] && [ -s i/runs/*/result.json ]'
  kill -"${signal%:*}" $!
  wait $!
  got=$?
  [ $got = "${signal#*:}" ] || complain "$what: exit code $got"
  err "the same command goes on from here"
  expect 0 study status i; out "1 done, 0 failed, 2 missing"; out "interrupted by signal"
done
exit $failed
