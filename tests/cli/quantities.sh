# Quantities from a scenario to its result, its page, a study's table and a limit.
. "$(dirname "$0")/lib.sh"

# asks NAME: QUANTITY into asks.yaml, on line 15.
asks() {
  cp model.yaml asks.yaml
  printf 'output: {fields: none}\nquantities:\n  %s\n' "$1" >>asks.yaml
}

# What is asked is listed, answered, told and shown.
cp model.yaml all.yaml
cat >>all.yaml <<'YAML'
output: {fields: none}
quantities:
  peak: max(corner.ux)
  end: corner.ux@end
  mean: mean(corner.ux, 0.01, 0.05)
  late: when(max( corner.ux ))
YAML
expect 0 check all.yaml; out "quantity       peak: max(corner.ux)"
expect 0 check all.yaml --json; json 'd["quantities"]["end"] == "corner.ux@end"'
expect 0 check all.yaml --resolved; json 'd["quantities"]["late"] == "when(max( corner.ux ))"'
expect 0 run all.yaml -o run; err "  peak           0."; err " m at t = 0.05 s"; err "  late           0.05 s"
python3 - <<'PY' || complain "quantities are not those of history.csv"
import csv, json
q = json.load(open("run/result.json"))["quantities"]
rows = [{k: float(v) for k, v in r.items()} for r in csv.DictReader(open("run/history.csv"))]
end = rows[-1]["corner.ux"]
assert list(q) == ["peak", "end", "mean", "late"], q
assert q["end"] == {"of": "corner.ux@end", "value": end, "t": 0.05, "unit": "m"}, q
assert max(r["corner.ux"] for r in rows) <= q["peak"]["value"] <= 1.001 * end, q
assert q["late"] == {"of": "when(max(corner.ux))", "value": q["peak"]["t"], "unit": "s"}, q
assert 0 < q["mean"]["value"] < end and "t" not in q["mean"], q
PY
expect 0 report run
python3 - <<'PY' || complain "the page"
import html
page = html.unescape(open("run/report.html", encoding="utf-8").read())
table = page[page.index('id="quantities"'):page.index('id="extremes"')]
assert all(w in table for w in ("peak [m]", "max(corner.ux)", "mean(corner.ux, 0.01, 0.05)")), table
PY
expect 0 static all.yaml -o still --quiet --set statics.max_step=0.25
python3 - <<'PY' || complain "quantities of statics"
import csv, json
q = json.load(open("still/result.json"))["quantities"]
end = float(list(csv.DictReader(open("still/probes.csv")))[-1]["corner.ux"])
assert q["end"]["value"] == end and abs(q["peak"]["value"] - end) <= 1e-12, q
# a load that grows in proportion to t moves the corner so, nearly: the mean is that at t = 0.03 s
assert abs(q["mean"]["value"] - 0.6 * end) < 0.01 * end, q
PY

# The name of a probe alone leads to its columns.
asks 'peak: max(corner)'
expect 3 check asks.yaml; err "there is no column corner; did you mean corner.ux?"

# What is wrong is pointed at, before anything runs.
asks 'peak: max(cornr.ux)'
for command in check run static; do
  expect 3 $command asks.yaml; no_out
  err "asks.yaml:15:13: quantities.peak: there is no column cornr.ux; did you mean corner.ux?"
  err "    peak: max(cornr.ux)"
  grep -q '^              ^$' stderr || complain "$what: no caret"
done
[ ! -e out ] || complain "a folder of a run that was refused"
asks 'peak: max(corner.ux'; expect 3 run asks.yaml; err "asks.yaml:15:22: quantities.peak: a ) is missing"
asks 'T: "max(corner.ux, 0, 1)"'; expect 3 run asks.yaml; err "asks.yaml:15:25: quantities.T: t = 1 s is after the run"
asks 'T: corner.ux'; expect 3 run asks.yaml; err "15:15: quantities.T: a column alone is no number"
asks 'a.b: corner.ux@end'; expect 3 run asks.yaml; err "made of letters, digits, _ and -"
asks 'T: [1]'; expect 3 run asks.yaml; err "15:6: quantities.T: expected text"
asks '{T: mean(corner.ux, 0, 1)}'; expect 3 run asks.yaml; err "a text with commas wants quotes"
asks 'T: period(corner.ux)'; expect 3 static asks.yaml; err "15:6: quantities.T: an equilibrium has no period"
expect 3 run model.yaml --set 'quantities.T=max(kinetik)'; err "did you mean kinetic?"
expect 0 schema quantities; out "map of texts"; out "max(corner.ux)"

# A question without an answer: all else is there, and the exit code says so.
asks 'T: period(corner.ux, 0, 0.01)'
expect 1 run asks.yaml -o none; err "quantities.T has no value"
python3 -c '
import json; r = json.load(open("none/result.json"))
assert r["status"] == "ok" and r["exit_code"] == 1 and r["quantities"]["T"]["value"] is None, r'

# A study: values, errors, orders; a run without the quantity is done all the same.
cat >orders.yaml <<'YAML'
study: orders of a number
base: model.yaml
set: {output.fields: none, integrator.method: newmark}
axes: [{key: integrator.step, values: [4.0e-3, 2.0e-3, 1.0e-3, 5.0e-4]}]
measure: ["mean(corner.ux)", displacement, corner.ux@end, "period(corner.ux, 0, 0.01)"]
YAML
expect 0 study orders.yaml -o orders --quiet
python3 - <<'PY' || complain "the table"
import json
t = json.load(open("orders/table.json"))
assert t["measure"] == "mean(corner.ux)" and len(t["quantities"]) == 3, t["quantities"]
for c in t["cells"]:
    assert c["status"] == "done" and c["quantity"]["corner.ux@end"] > 0, c
    assert c["quantity"]["period(corner.ux, 0, 0.01)"] is None, c
    assert c["error"]["period(corner.ux, 0, 0.01)"] is None, c
f = t["fits"] + t["quantity_fits"]  # newmark's order is two
assert [round(x["exponent"]) for x in f[:2]] == [2, 2], f
PY
expect 0 study table orders; out "mean(corner.ux)"; out "corner.ux@end, all: exponent"
sed 's/^measure.*/measure: [max(cornr.ux)]/' orders.yaml >wrong.yaml
expect 3 study wrong.yaml -o wrong; err "wrong.yaml:5:15:"; err "did you mean corner.ux?"

# A budget: what a part changes of the number is what it changes of the probe.
expect 0 budget model.yaml -o budget --quiet --skip space --set output.fields=none \
  --quantity corner.ux@end --quantity 'max(elastic)' --json
json 'list(d["quantities"]) == ["corner_ux_at_end", "max_elastic"]'
json 'all(abs(p["probes"]["corner"]["signed"][0] - q["change"]) <= 1e-12 * 1e-2
          for p, q in zip(d["parts"], d["quantities"]["corner_ux_at_end"]["parts"]))'
json 'all(abs(q["value"] + sum(p["change"] for p in q["parts"]) - q["reference"]) < 1e-12
          and [p["part"] for p in q["parts"]] == [p["part"] for p in d["parts"]]
          for q in d["quantities"].values())'
expect 0 budget model.yaml -o budget --quiet --skip space --set output.fields=none \
  --quantity corner.ux@end --quantity 'max(elastic)'
out "max_elastic, max(elastic): "; out "strain measure "
grep -q 'max_elastic, max(elastic): 0\.' budget/report.html || complain "the budget's page"
# It is that of the same run without these.
expect 0 run model.yaml -o plain --quiet; cp budget/budget.json plain
expect 0 report plain; grep -q 'id="budget"' plain/report.html || complain "the budget of a run is not on its page"
expect 2 budget model.yaml --quantity 'max(elastic'; err "--quantity: a ) is missing"

# A limit: the displacement is nearly in proportion to the load.
limit="find-limit model.yaml --quiet --key loads.0.traction.0 --from 20 --to 200 --scan 3"
expect 0 $limit -o limit --quantity corner.ux@end --below 1e-3 --json
json 'abs(d["stable"] / (20e-3 / d["trials"][0]["quantity"]) - 1) < 0.05'
json 'd["quantity"] == {"of": "corner.ux@end", "below": 1e-3, "above": None}'
expect 1 $limit -o limit --quantity corner.ux@end --above 1; out "not even 20 is stable"
expect 2 $limit --quantity 'max(corner.ux' --below 1; err "--quantity: a ) is missing"; err "               ^"
expect 2 $limit --quantity corner.ux@end; err "wants --below or --above"
expect 2 $limit --below 1; err "are of a --quantity"
expect 3 $limit --quantity cornr.ux@end --below 1; err "did you mean corner.ux?"

# What is wrong with a quantity is told by what was typed, not by the setting that asks for it.
for command in "$limit --below 1" "budget model.yaml --quiet"; do
  expect 3 $command --quantity 'max(cornr.ux)'
  err "--quantity max(cornr.ux): there is no column cornr.ux; did you mean corner.ux?"; err "      ^"
  expect 3 $command --quantity 'max(corner.ux, 0, 99)'
  err "--quantity max(corner.ux, 0, 99): t = 99 s is after the run"
done
expect 3 run model.yaml --set 'quantities.T=max(kinetik)'
err "--set quantities.T=max(kinetik): there is no column kinetik"; err "      ^"
sed 's/^measure.*/measure: dsplacement/' orders.yaml >wrong.yaml
expect 3 study wrong.yaml; err "wrong.yaml:5:10: measure: dsplacement is no measure; did you mean displacement?"
sed 's/^measure.*/measure: [dsplacement]/' orders.yaml >wrong.yaml
expect 3 study wrong.yaml; err "measure[0]: dsplacement is no measure"
exit $failed
