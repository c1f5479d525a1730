# Whoever asks a run to end gets a result.json that says so, whatever the run is doing, and an exit
# code that names the signal.
. "$(dirname "$0")/lib.sh"
signals='INT:2 TERM:15 HUP:1 USR1:10 XCPU:24'

has() { [ -s "$1" ]; }
# Whether a process catches SIGALRM, the last of those it begins to heed.
heeds() {
  [ "$(readlink "/proc/$1/exe")" != "$(readlink /proc/$$/exe)" ] &&
    caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$1/status") &&
    [ $((0x${caught:-0} & 0x2000)) != 0 ]
}

# said DIR NUMBER: result.json there is whole, and is that of a run that this signal ended.
said() {
  cp "$1/result.json" stdout 2>/dev/null || complain "$what: no result.json"
  json "d['status'] == 'interrupted' and d['exit_code'] == 128 + $2"
  json "d['reason'] == 'interrupted by signal $2' and d['failure'] == {'kind': 'interrupted', 'retry': True}"
  json "d['t_reached'] >= 0 and d['scenario']['time']['end'] == d['t_end']"
}

# ended PROCESS DIR NUMBER
ended() {
  wait "$1"
  got=$?
  [ $got = $((128 + $3)) ] || complain "$what: exit code $got"
  said "$2" "$3"
}

for signal in $signals; do
  name=${signal%:*} number=${signal#*:}
  what="SIG$name while it integrates"
  "$corot" run model.yaml -o run-$name --set time.end=1e6 --set output.fields=none >stdout 2>stderr &
  until_true has run-$name/steps.csv; kill -$name $!; ended $! run-$name $number
  expect 0 report run-$name

  # One step of a solid at rest goes past a million output times.
  what="SIG$name in the midst of outputs"
  "$corot" run model.yaml -o fine-$name --set 'loads=[]' --set 'time={end: 1.0e6, output: 1.0e-5}' --set output.fields=none \
    >stdout 2>stderr &
  until_true has fine-$name/energy.csv; kill -$name $!; ended $! fine-$name $number

  # A pipe that nobody writes to is a mesh that is never read to its end.
  what="SIG$name while the mesh is read"
  rm -f pipe.msh; mkfifo pipe.msh
  for command in run $([ $name = TERM ] && echo static); do
    rm -rf mesh
    "$corot" $command model.yaml -o mesh/in/depth --set mesh.box=null --set mesh.file=pipe.msh >stdout 2>stderr &
    until_true heeds $!; kill -$name $!; ended $! mesh/in/depth $number
  done
done

# What has been written by then is not read again, nor waited for on the disk.
what="SIGTERM after many outputs"
"$corot" run model.yaml -o many --set 'loads=[]' --set 'time={end: 1.0e6, output: 1.0e-5}' --set output.fields=none \
  --set output.states=none >stdout 2>stderr &
until_true eval '[ "$(stat -c %s many/energy.csv)" -gt 100000000 ]'; kill -TERM $!; ended $! many 15
json "all('sha256' not in f and f['size'] > 0 for f in d['files']) and 'probes.csv' in [f['name'] for f in d['files']]"
rm -rf many

# What takes long and asks nobody: a large matrix, with all that comes before it.
large='mesh.box={size: [0.1, 0.1, 0.2], cells: [40, 40, 80]}'
for command in run static; do
  for after in 0.3 1 2; do
    what="$command of a large mesh after $after s"
    rm -rf large
    "$corot" $command model.yaml -o large --set "$large" --set start=equilibrium >stdout 2>stderr &
    until_true heeds $!; sleep $after; kill -TERM $!; ended $! large 15
  done
done

# A second request of the same kind does not wait for anything. Twice in a row is once.
what="SIGTERM twice"
rm -f pipe.msh; mkfifo pipe.msh; rm -rf mesh
"$corot" run model.yaml -o mesh --set mesh.box=null --set mesh.file=pipe.msh >stdout 2>stderr &
until_true heeds $!; kill -TERM $!; sleep 0.3; kill -TERM $! 2>/dev/null; ended $! mesh 15
"$corot" run model.yaml -o twice --set time.end=1e6 --set output.fields=none >stdout 2>stderr &
until_true has twice/steps.csv; kill -TERM $!; kill -TERM $! 2>/dev/null; ended $! twice 15
grep -q '"nst"' twice/result.json || complain "SIGTERM twice in a row: no statistics"

# nohup stays what it is.
what="nohup"
(trap '' HUP; exec "$corot" run model.yaml -o nohup --set time.end=1e6 --set output.fields=none) >stdout 2>stderr &
until_true has nohup/steps.csv; kill -HUP $!; sleep 0.2; kill -TERM $!; ended $! nohup 15
exit $failed
