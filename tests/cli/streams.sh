# Whoever cannot be told is not told "ok": a full device, a reader that has left, a stream that is
# closed, for every command that prints. And no file gets what was meant for a stream.
. "$(dirname "$0")/lib.sh"
[ -c /dev/full ] || exit 77

write_study
expect 0 mesh box --size 1,1,1 --cells 2,2,2 -o box.msh
expect 0 run model.yaml -o done --quiet
expect 0 study study.yaml -o study --quiet

cat >commands <<'END'
--help
--version
run --help
static --help
check --help
study --help
study export --help
study status --help
budget --help
find-limit --help
plot --help
report --help
schema --help
mesh --help
mesh box --help
mesh info --help
mesh refine --help
schema
schema --json
schema integrator
check model.yaml
check model.yaml --json
check model.yaml --resolved
check --warnings
run model.yaml -o run --json
static model.yaml -o static --json
mesh info box.msh
mesh info box.msh --json
study status study
study table study
study csv study
study schema
study study.yaml -o study --dry-run
study export study.yaml --format commands
study export study.yaml --format slurm
study export study.yaml --format snakemake
budget model.yaml --levels 2 --skip space -o budget
budget model.yaml --levels 2 --skip space -o budget --json
find-limit model.yaml -o limit --key time.end --from 0.01 --to 0.02 --scan 2
find-limit model.yaml -o limit --key time.end --from 0.01 --to 0.02 --scan 2 --json
plot study
report study
report done
END

# refused HOW: the command has ended with code 5 and a sentence.
refused() {
  what="corot $arguments, standard output $1"
  [ "$got" = 5 ] || complain "$what: exit code $got"
  err "standard output"
}

: >stdout
while read -r arguments; do
  # shellcheck disable=SC2086
  set -- $arguments
  "$corot" "$@" >/dev/full 2>stderr </dev/null; got=$?
  refused full
  "$corot" "$@" >&- 2>stderr </dev/null; got=$?
  refused closed
  { "$corot" "$@" 2>stderr </dev/null; echo $? >code; } | true
  got=$(cat code)
  case $got in
    0) ;; # it was over before the reader left
    *) refused "without a reader" ;;
  esac
done <commands

# Messages, too.
for arguments in 'mesh box --size 1,1,1 --cells 2,2,2 -o full.msh' 'run model.yaml -o full' 'study study.yaml -o study' \
  'mesh refine box.msh -o fine.msh' 'study collect study'; do
  # shellcheck disable=SC2086
  "$corot" $arguments >stdout 2>stderr
  [ -s stderr ] || continue
  "$corot" $arguments >stdout 2>/dev/full
  got=$?
  [ $got = 5 ] || complain "corot $arguments, messages to a full device: exit code $got"
done

# Without any standard stream every file is what it is with them.
what="all streams closed"
"$corot" run model.yaml -o closed --json <&- >&- 2>&-
got=$?
[ $got = 5 ] || complain "$what: exit code $got"
"$corot" run model.yaml -o quiet --quiet <&- >&- 2>&-
got=$?
[ $got = 0 ] || complain "$what, --quiet: exit code $got"
for name in probes.csv energy.csv fields.pvd; do
  cmp done/$name closed/$name && cmp done/$name quiet/$name || complain "$what: $name is not the same"
done
"$corot" mesh box --size 1,1,1 --cells 2,2,2 -o closed.msh <&- >&- 2>&-
cmp box.msh closed.msh || complain "$what: a mesh is not the same"
"$corot" study study.yaml -o closed-study --quiet <&- >&- 2>&- || complain "$what: a study"
cp closed-study/table.json stdout; json "[c['status'] for c in d['cells']] == ['done', 'done']"
exit $failed
