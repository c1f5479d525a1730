# A run that fails does not leave an earlier "ok", and no process writes where another one does.
. "$(dirname "$0")/lib.sh"

# says EXPRESSION: python says whether it is true of out/result.json, d.
says() { cp out/result.json stdout 2>/dev/null || complain "$what: no result.json"; json "$1"; }

printf '{' >cut.msh
cp model.yaml bad.yaml && echo 'strian: polar' >>bad.yaml
for command in run static; do
  # A scenario that cannot be read, that makes no sense, with no mesh, that is not there.
  for case in bad.yaml 'model.yaml --set strain=cubic' 'model.yaml --set mesh.box=null --set mesh.file=cut.msh' \
    'model.yaml --set groups.base.plane.at=0.3141' missing.yaml; do
    rm -rf out
    case $case in
      model*) set -- ${case#model.yaml}; file=model.yaml ;;
      *) set --; file=$case ;;
    esac
    expect 3 $command "$file" -o out --quiet "$@"
    [ ! -e out ] || complain "$what: a folder where there was none"

    # Beside a run's result nothing stays that says ok, and nothing of its files; others stay.
    expect 0 $command model.yaml -o out --quiet
    echo mine >out/notes.txt
    expect 3 $command "$file" -o out --quiet "$@"
    reason=$(head -n 1 stderr)
    says "d['status'] == 'failed' and d['exit_code'] == 3 and d['failure'] == {'kind': 'scenario', 'retry': False}"
    grep -qF -e "${reason%%\"*}" out/result.json || complain "$what: result.json does not say: $reason"
    [ "$(ls -A out | tr '\n' ' ')" = 'fields notes.txt result.json ' ] || complain "$what: $(ls -A out)"
    expect 0 report out
    grep -q 'class="outcome bad"' out/report.html || complain "$what: its page does not call it a failure"
    expect 0 $command model.yaml -o out --quiet
  done

  # What is somebody else's stays.
  rm -rf out && mkdir out && echo mine >out/probes.csv
  expect 3 $command bad.yaml -o out --quiet
  [ "$(ls -A out)" = probes.csv ] && [ "$(cat out/probes.csv)" = mine ] || complain "$what: $(ls -A out)"
done

# In its own folder, too, of which no one has spoken.
expect 0 run model.yaml --quiet
expect 3 run model.yaml --quiet --set time.end=-1
grep -q '"status": "failed"' out/model/result.json || complain "an ok in the default folder"

# A process that a signal ends while another one writes there leaves that one alone.
for command in run static; do
  rm -rf out pipe.msh; mkfifo pipe.msh
  "$corot" $command model.yaml -o out --quiet --set mesh.box=null --set mesh.file=pipe.msh >stdout 2>second.err &
  second=$!
  "$corot" run model.yaml -o out --quiet --set time.end=1e6 --set output.fields=none >stdout 2>first.err &
  first=$!
  tries=0
  until [ -s out/steps.csv ] || [ $tries = 600 ]; do sleep 0.05; tries=$((tries + 1)); done
  kill -TERM $second
  wait $second
  got=$?
  [ $got = 143 ] || complain "$command: exit code $got of the second"
  [ ! -e out/result.json ] || complain "$command: the second has written where the first writes"
  [ -s out/.lock-run ] || complain "$command: the second has taken the lock of the first"
  kill -TERM $first
  wait $first
  says "d['status'] == 'interrupted' and d['statistics']['nst'] > 0"

  # Alone it writes, and leaves no lock.
  "$corot" $command model.yaml -o out --quiet --set mesh.box=null --set mesh.file=pipe.msh >stdout 2>second.err &
  second=$!
  sleep 0.5; kill -TERM $second
  wait $second
  says "d['status'] == 'interrupted' and 'statistics' not in d"
  [ ! -e out/.lock-run ] || complain "$command: a lock stays"
done
exit $failed
