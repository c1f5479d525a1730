# A fault that ends the program is told in one line; its exit status is that of the signal, and
# nothing on the disk says "ok".
# usage: crash.sh COROT SCRATCH_FOLDER DISTURB, the library of disturb.c
. "$(dirname "$0")/lib.sh"
disturb=$3
ulimit -c 0
told='what is written stays, and a folder is complete only where its result.json says "ok"'

# ended CODE DIR: what `wait` or a command has left in $got, and in stderr.
ended() {
  [ $got = "$1" ] || complain "$what: exit code $got"
  err "$told"
  [ "$(grep -c '^corot: ' stderr)" = 1 ] || complain "$what: not told once"
  grep -qs '"status": "ok"' "$2/result.json" && complain "$what: ok on the disk"
}

# A fault in a library, in whatever it is doing; a stack that is used up; an abort.
memory='; memory that has run out is a frequent cause; '
for kind in null:139 stack:139 abort:134; do
  for call in 1 5 20; do
    for command in run static; do
      what="$command, ${kind%:*} at call $call"
      rm -rf out
      (DISTURB_FAULT=${kind%:*}:$call LD_PRELOAD=$disturb "$corot" $command model.yaml -o out >stdout 2>stderr; exit $?) 2>/dev/null
      got=$?
      ended "${kind#*:}" out
      case $kind in
        abort*) err "ended by an internal error (SIGABRT)$memory" ;;
        *) err "ended by a fault inside the program (SIGSEGV in $(basename "$disturb"))$memory" ;;
      esac
      expect 0 $command model.yaml -o out --quiet
    done
  done
done

# A signal that somebody sends.
for signal in ABRT:134 BUS:135 FPE:136 ILL:132 SEGV:139; do
  what="SIG${signal%:*} from outside"
  rm -rf out
  "$corot" run model.yaml -o out --set time.end=1e6 --set output.fields=none >stdout 2>stderr &
  until_true test -s out/steps.csv; kill -"${signal%:*}" $!; wait $! 2>/dev/null
  got=$?
  ended "${signal#*:}" out; err "ended by another process (SIG${signal%:*}); "
done
what="a signal that is ignored"
rm -rf out
(trap '' SEGV; exec "$corot" run model.yaml -o out --quiet --set time.end=1e6 --set output.fields=none) >stdout 2>stderr &
until_true test -s out/steps.csv; kill -SEGV $!; sleep 0.2; kill -TERM $!; wait $!
got=$?
[ $got = 143 ] || complain "$what: exit code $got"
grep -q 'ended by' stderr && complain "$what: told"

# A study books the line, and tries the run again: more memory may be there then.
what="a crash in a study"
printf '%s\n' 'study: one run' 'base: model.yaml' 'set: {time.end: 1.0e6, output.fields: none}' \
  'axes: [{key: strain, values: [polar]}]' 'reference: none' >study.yaml
"$corot" study study.yaml -o study >stdout 2>stderr &
study=$!
for attempt in 1 2 3; do
  until_true eval '[ -s study/runs/*/steps.csv ]'
  rm study/runs/*/steps.csv
  for child in $(cat /proc/$study/task/*/children); do run=$child; done # the last one is the run
  kill -SEGV "$run"
done
wait $study
got=$?
[ $got = 5 ] || complain "$what: exit code $got"
err "killed by signal 11 (Segmentation fault): corot: ended by another process (SIGSEGV); "
cat study/runs/*/failure.json >stdout
json "d['failure'] == {'kind': 'crash', 'retry': True}"
json "'killed by signal 11 (Segmentation fault): corot: ended by another process (SIGSEGV); ' in d['reason']"
exit $failed
