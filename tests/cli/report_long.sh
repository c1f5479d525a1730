# However many steps a run has taken, its page is no longer than its charts can show: ten times as
# many lines in every table make it hardly longer. Thinning leaves at most 4000 points of a curve.
. "$(dirname "$0")/lib.sh"
expect 0 run model.yaml -o run --quiet

cat >lengthen.py <<'PY'
import json, sys

n = int(sys.argv[1])
with open("run/result.json") as file:
    result = json.load(file)
result.pop("files", None)  # what it lists is not what stands there then
with open("run/result.json", "w") as file:
    json.dump(result, file)
for table in ("history", "steps", "energy", "probes"):
    with open(f"run/{table}.csv") as file:
        head = file.readline()
    with open(f"run/{table}.csv", "w") as file:
        file.write(head)
        for i in range(n + 1):
            values = [f"{(i * 7919 * j % 1000003) / 1000003:.17g}" for j in range(1, head.count(",") + 1)]
            file.write(",".join([f"{i / n:.9g}", *values]) + "\n")
PY
for n in 10000 100000; do
  python3 lengthen.py $n
  expect 0 report run
  wc -c <run/report.html >size-$n
done
short=$(cat size-10000) long=$(cat size-100000)
what="a report of ten times as many steps"
# In a piece of ten points first, lowest, highest and last are often the same, in one of a hundred
# they hardly are: so it grows a little once, by 1.5 here. Unthinned it would be 10.
[ "$long" -lt $((short * 2)) ] || complain "$what: $short and $long bytes"
[ "$long" -lt 3000000 ] || complain "$what: $long bytes"
exit $failed
