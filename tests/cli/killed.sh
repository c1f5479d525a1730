# A command that a signal ends, at whichever call that changes a file, leaves nothing half-written
# under the name of a result, ends with 128 + the signal's number, and can simply be repeated.
# usage: killed.sh COROT SCRATCH_FOLDER DISTURB, the library of disturb.c
. "$(dirname "$0")/lib.sh"
disturb=$3
ulimit -c 0

write_study
expect 0 mesh box --size 1,1,1 --cells 1,1,2 -o box.msh
expect 0 run model.yaml -o run --quiet
expect 0 study study.yaml -o study --quiet
expect 0 budget model.yaml --levels 2 --skip space -o budget --quiet
rm -f budget/budget.json budget/report.html study/table.* study/index.sqlite study/report.html
expect 0 study collect study
mkdir before
cp -r box.msh run study budget before

# Results that are neither as they were nor as a command that nothing disturbs leaves them.
partial() {
  (cd work && find . -type f ! -name '*.tmp*' ! -name '.lock*') | while read -r name; do
    cmp -s "work/$name" "before/$name" || cmp -s "work/$name" "after/$name" || echo "$name"
  done
}

# attack ARGUMENTS: kills the command at some seven of its calls, the first and the last included.
attack() {
  rm -rf work after
  cp -r before after
  (cd after && DISTURB_COUNT=../count LD_PRELOAD=$disturb "$corot" "$@" >../stdout 2>../stderr) || complain "corot $*: it fails undisturbed"
  n=$(cat count)
  step=$(((n + 6) / 7)) k=1
  while [ $k -le "$n" ]; do
    name=${signal%:*} number=${signal#*:}
    what="corot $*, SIG$name at change $k of $n"
    rm -rf work
    cp -r before work
    (cd work; DISTURB_KILL=$number:$k LD_PRELOAD=$disturb "$corot" "$@" >../stdout 2>../stderr; exit $?) 2>/dev/null
    got=$?
    # One that is asked for at the very end may come too late.
    [ $got = $((128 + number)) ] || [ $got = 0 ] || complain "$what: exit code $got"
    bad=$(partial)
    [ -z "$bad" ] || complain "$what: half-written: $bad"
    rm -f work/*.tmp*
    (cd work && "$corot" "$@" >../stdout 2>../stderr) || complain "$what: it cannot be repeated"
    bad=$(partial)
    [ -z "$bad" ] || complain "$what: repeated, not the same: $bad"
    next_signal
    [ $k -lt "$n" ] && [ $((k + step)) -gt "$n" ] && k=$((n - step))
    k=$((k + step))
  done
}

# One signal at each call, each in its turn.
signal=INT:2
next_signal() {
  case $signal in
    INT:2) signal=TERM:15 ;;
    TERM:15) signal=HUP:1 ;;
    HUP:1) signal=USR1:10 ;;
    USR1:10) signal=XCPU:24 ;;
    *) signal=INT:2 ;;
  esac
}

attack study collect study
attack report study
attack report run
attack plot study
attack mesh refine box.msh -o fine.msh
attack mesh box --size 1,1,1 --cells 2,1,1 -o new.msh
attack study ../study.yaml -o study --quiet
attack budget ../model.yaml --levels 2 --skip space -o budget --quiet
exit $failed
