. "$(dirname "$0")/lib.sh"

expect 0 --version; out "corot 1."; no_err
expect 0 --help; out "usage: corot COMMAND"; no_err
expect 2; err "usage: corot COMMAND"; no_out
expect 2 chek; err "unknown command chek; did you mean check?"; no_out
expect 2 wombat; err "unknown command wombat"; no_out
for command in run check export-fmu schema study "study export" "mesh box" "mesh info"; do
  # shellcheck disable=SC2086
  expect 0 $command --help; out "usage: corot $command"; out "example: corot $command"; no_err
done
expect 0 mesh --help; out "usage: corot mesh box"
expect 2 mesh; err "usage: corot mesh box"
expect 2 mesh bx; err "did you mean box?"

expect 2 run; err "expected one scenario, found 0"
expect 2 run a b; err "expected one scenario, found 2"
expect 2 run --outptu d model.yaml; err "unknown option --outptu; did you mean --output?"
expect 2 run -z model.yaml; err "unknown option -z"
expect 2 run model.yaml -o; err "-o needs a value"
expect 2 run model.yaml --set; err "--set needs a value"
expect 2 run model.yaml --quiet=3; err "--quiet takes no value"
expect 2 run model.yaml -o ""; err "the name is empty"
expect 2 check; err "expected one scenario"
expect 2 schema a b; err "at most one key"
expect 2 schema intergrator; err "did you mean integrator?"
no_out

# A full disk and a reader that has left are errors, not silence.
"$corot" schema >/dev/full 2>stderr
[ $? = 5 ] || complain "full disk"
err "standard output"
# shellcheck disable=SC2216
{ "$corot" schema --json; echo $? >code; } 2>stderr | true
sleep 0.2
case $(cat code) in 0 | 5) ;; *) complain "closed pipe: $(cat code)" ;; esac
"$corot" schema >&- 2>stderr
[ $? = 5 ] || complain "closed stdout"

# Exit codes are those of --help, whatever the command.
expect 0 --help
for word in '  0  ok' '1  finished, but' '2  the command line' '3  a scenario, study or mesh' '4  the integrator' '5  the system' '128 + N'; do out "$word"; done
for command in "run" "static" "modes" "check" "export-fmu" "budget" "study" "study export --format commands" \
  "find-limit --key time.end --from 1 --to 2" "mesh info" "mesh refine -o new.msh"; do
  expect 3 $command missing.yaml; no_out; err "missing.yaml"
  expect 2 $command --no-such-option missing.yaml; no_out
done
for command in "report" "plot" "study status" "study collect" "study table" "study csv"; do
  expect 5 $command missing; no_out; err "missing"
  expect 2 $command; no_out
done
for command in run static check budget; do expect 3 $command model.yaml --set mesh.box=null --set mesh.file=missing.msh; err "missing.msh"; done
expect 4 run model.yaml -o stuck --set integrator.max_steps=2
if [ -w /dev/full ]; then
  for command in "--help" "--version" "schema" "schema --json" "check model.yaml" "check model.yaml --json" "run model.yaml -o full --json" \
    "run --help"; do
    "$corot" $command >/dev/full 2>stderr
    [ $? = 5 ] || complain "corot $command to a full disk"
    err "standard output"
  done
  "$corot" run model.yaml -o full 2>/dev/full >stdout
  [ $? = 5 ] || complain "messages to a full disk"
fi
exit $failed
