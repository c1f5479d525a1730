# A folder has one writer at a time, and what is in the way of a run is never the loss of its user.
. "$(dirname "$0")/lib.sh"

# The equilibrium of a scenario leaves its motion alone.
expect 0 run model.yaml --quiet
cp out/model/result.json before.json
expect 0 static model.yaml --quiet
cmp -s before.json out/model/result.json || complain "static has replaced the results of run"

# While one writes, another is refused by name, and touches nothing.
rm -rf out
"$corot" run model.yaml -o out --quiet --set time.end=1000 >first.out 2>first.err &
first=$!
for wait in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do [ -s out/steps.csv ] || sleep 1; done
for command in run static; do
  expect 5 $command model.yaml -o out --quiet; err "process $first on "; err "is writing there"
  [ ! -e out/result.json ] || complain "$command: who was refused has written"
done

# The lock of a process that was killed is taken over, and it is said.
kill -KILL $first
wait $first 2>/dev/null
expect 0 run model.yaml -o out; err "process $first on "; err "has left no result"
[ ! -e out/.lock-run ] || complain "the lock stays"
expect 0 run model.yaml -o out
grep -q "has left no result" stderr && complain "an old lock is told of again"

# What is not a file of ours stays.
rm -rf out && mkdir -p out/result.json/kept
expect 5 run model.yaml -o out --quiet; err "result.json"
[ -d out/result.json/kept ] || complain "a folder is gone"
rm -rf out && echo text >out
expect 5 run model.yaml -o out --quiet; err "is not a folder"
[ "$(cat out)" = text ] || complain "a file is gone"
if [ -c /dev/full ]; then
  expect 5 run model.yaml -o /dev/full --quiet; err "/dev/full"
  [ -c /dev/full ] || complain "a device is gone"
fi
exit $failed
