# Shards of one study at work in one folder are parts of the same number: others would leave runs out
# and make others twice.
. "$(dirname "$0")/lib.sh"

cat >study.yaml <<'YAML'
study: which one
base: model.yaml
axes: [{key: integrator.rtol, values: [1e-2, 1e-3, 1e-4, 1e-5]}]
reference: none
YAML
sed 's/model.yaml/long.yaml/' study.yaml >long_study.yaml
sed 's/end: 0.05/end: 1.0e6/' model.yaml >long.yaml

# While one is at work.
"$corot" study long_study.yaml -o store -q --shard 1/3 >stdout 2>first.err &
first=$!
tries=0
until ls store/runs/*/steps.csv >/dev/null 2>&1 || [ $tries = 600 ]; do sleep 0.05; tries=$((tries + 1)); done
before=$(ls store/runs)
for shard in 2/4 1/2 1/4; do
  expect 3 study long_study.yaml -o store --timeout 5 --shard $shard; err "store: shard 1/3 is at work here, and this is $shard"
done
expect 3 study long_study.yaml -o store --timeout 5; err "another study is at work here"
expect 3 study long_study.yaml -o store --timeout 5 --shard 1/3; err "another study is at work here"
[ "$(ls store/runs)" = "$before" ] || complain "who was refused has begun runs"
kill -TERM $first; wait $first

# When all of that number are over, another may be taken.
expect 0 study study.yaml -o other --shard 1/2 --quiet
expect 0 study study.yaml -o other --shard 1/3 --quiet
expect 0 study study.yaml -o other --shard 2/3 --quiet
expect 0 study study.yaml -o other --shard 3/3 --quiet
expect 0 study study.yaml -o other; err "4 of 4 runs done (0 now)"

# Begun at the same time, those of one number go on, and those of the other are refused.
running=
for i in 1 2 3; do
  for n in 3 4; do
    { "$corot" study long_study.yaml -o both -q --timeout 60 --shard $i/$n 2>err$n$i & echo $! >pid$n$i; wait $!; echo $? >code$n$i; } &
    running="$running $!"
  done
done
tries=0
until [ "$(cat code?? 2>/dev/null | wc -l)" = 3 ] || [ $tries = 600 ]; do sleep 0.05; tries=$((tries + 1)); done
sleep 0.5
for i in 31 32 33 41 42 43; do [ -e code$i ] || kill -TERM "$(cat pid$i)"; done
# shellcheck disable=SC2086
wait $running
case "$(cat code3? | tr '\n' ' ')/ $(cat code4? | tr '\n' ' ')" in
  '143 143 143 / 3 3 3 ' | '3 3 3 / 143 143 143 ') ;;
  *) cat err?? >stderr; complain "shards of three and of four at once: $(cat code3? code4? | tr '\n' ' ')" ;;
esac
exit $failed
