# Studies whose quantities have known values: errors are total and need no references.
. "$(dirname "$0")/lib.sh"

sed -i '$a quantities: {last: corner.ux@end, T: "mean(kinetic)"}' model.yaml

# study LINE...: a study of two tolerances with these lines behind.
study() {
  printf '%s\n' "study: known values" "base: model.yaml" "set: {output.fields: none}" \
    "axes: [{key: integrator.rtol, values: [1.0e-3, 1.0e-5]}]" "$@" >study.yaml
}

# What is wrong is pointed at, before anything runs.
refuse() { # MESSAGE LINE...
  message=$1
  shift
  study "$@"
  expect 3 study study.yaml -o refused
  no_out
  err "$message"
  [ ! -e refused ] || complain "a folder of what was refused"
}
m='measure: ["max(corner.ux)"]'
refuse 'study.yaml:6:21: reference.known.max(corner.uy): max(corner.uy) is not measured; did you mean max(corner.ux)?' \
  "$m" 'reference: {known: {max(corner.uy): 1}}'
refuse 'study.yaml:6:21: reference.known.lst: lst is not measured; did you mean last?' "$m" 'reference: {known: {lst: 1}}'
refuse 'qqqqqqq is not measured: expected a quantity of measure' "$m" 'reference: {known: {qqqqqqq: 1}}'
refuse 'study.yaml:6:37: reference.known.max(corner.ux).value: expected a finite number' "$m" \
  'reference: {known: {max(corner.ux): .inf}}'
refuse 'value: expected a finite number in decimal, such as 1.5 or 1.0e-3, found .nan' "$m" 'reference: {known: {max(corner.ux): .nan}}'
refuse 'reference.known.max(corner.ux).within: must be >= 0, found -1' "$m" \
  'reference: {known: {max(corner.ux): {value: 1, within: -1}}}'
refuse 'reference.known.max(corner.ux).scale: must be > 0, found 0' "$m" \
  'reference: {known: {max(corner.ux): {value: 1, scale: 0}}}'
refuse 'value: no error is relative to 0: a known value of 0 wants a scale' "$m" \
  'reference: {known: {max(corner.ux): 0}}'
refuse 'wthin: unknown key; did you mean within?' "$m" \
  'reference: {known: {max(corner.ux): {value: 1, wthin: 0}}}'
refuse 'reference.known.max(corner.ux): value is missing' "$m" 'reference: {known: {max(corner.ux): {within: 1}}}'
refuse 'total is of known values: reference.known has none' 'measure: [total]'
refuse 'corner.ux@end has a known value already' 'measure: [corner.ux@end]' \
  'reference: {known: {corner.ux@end: 1, last: 1}}'

# A first run says what the values are; one of them is then "known" to be half of it, the second to be
# near, the third to be zero.
study 'measure: ["max(corner.ux)", last, T]' 'reference: none'
expect 0 study study.yaml -o plain --quiet
known=$(python3 - <<'PY'
import json
q = json.load(open("plain/table.json"))["cells"][0]["quantity"]
assert list(q) == ["max(corner.ux)", "corner.ux@end", "mean(kinetic)"], q
x, T = q["corner.ux@end"], q["mean(kinetic)"]
print(f'{{max(corner.ux): {2 * x:.17e}, last: {{value: {0.99 * x:.17e}, within: {0.05 * x:.17e}}}, '
      f'T: {{value: 0.0, within: {0.1 * T:.17e}, scale: {4 * T:.17e}}}}}')
PY
)
study 'measure: ["max(corner.ux)", last, T]' "reference: {known: $known}"
expect 0 study study.yaml -o known; err "2 of 2 runs done"
cat >errors.py <<'PY'
import csv, html, json, sys
t = json.load(open(sys.argv[1] + "/table.json"))
known = {k["measure"]: k for k in t["known"]}
assert len(known) == 3 and known["mean(kinetic)"]["value"] == 0, known
for c in t["cells"]:
    e = {n: (c["quantity"][n] - k["value"]) / k["scale"] for n, k in known.items()}
    assert e["max(corner.ux)"] < -0.49 and 0 < e["corner.ux@end"] < 0.02, e
    assert all(c["error"][n] == e[n] for n in e), c
    assert c["error"]["total"] == max(map(abs, e.values())), c
    assert c["unrated"] == ["corner.ux@end"], c
    most = {n: abs(e[n]) + known[n]["within"] / known[n]["scale"] for n in c["unrated"]}
    assert c["at_most"] == most, c
PY
python3 errors.py known || complain "errors against known values"
python3 - <<'PY' || complain "the tables"
import csv, html, json
t = json.load(open("known/table.json"))
assert t["measure"] == "max(corner.ux)" and t["references"] == [] and len(t["cells"]) == 2, t
rows = list(csv.DictReader(open("known/table.csv")))
for row, c in zip(rows, t["cells"]):
    for name in c["error"]:
        assert float(row["error." + name]) == c["error"][name], row
    assert float(row["at_most.corner.ux@end"]) == c["at_most"]["corner.ux@end"], row
    assert row["at_most.total"] == "", row
page = html.unescape(open("known/report.html", encoding="utf-8").read())
assert "Known: corner.ux@end is " in page and "at most 0." in page and "total error" in page
PY
expect 0 study table known
out "total error"; out "known values, against which errors are total"; out "-5."; out "< 6."
out "mean(kinetic) = 0, within"; out ", relative to"
grep -q displacement stdout && complain "a column of norms that nobody has measured"
expect 0 plot known -o figure; no_err
expect 0 plot known --error total -o total
expect 0 study collect known
python3 errors.py known || complain "errors against known values, collected"

# The total may be what runs are compared by, and is where only known values are said.
study 'measure: [total, "max(corner.ux)", T, last]' "reference: {known: $known}"
expect 0 study study.yaml -o total --quiet
study "reference: {known: {last: 1.0}}"
expect 0 study study.yaml -o default --quiet
python3 - <<'PY' || complain "the total as measure"
import json
t = json.load(open("total/table.json"))
assert t["measure"] == "total" and t["rankings"] == [], t
d = json.load(open("default/table.json"))
assert d["measure"] == "total" and d["references"] == [] and d["quantities"] == ["corner.ux@end"], d
PY

# What has no known value is held against references, as ever.
study 'measure: [displacement, last]' "reference: {known: {last: {value: 1.0, within: 0.1}}, rtol: 1.0e-6}"
expect 0 study study.yaml -o both --quiet
python3 - <<'PY' || complain "known values beside references"
import json
t = json.load(open("both/table.json"))
assert len(t["references"]) == 1, t["references"]
for c in t["cells"]:
    assert c["error"]["displacement"] > 0 and c["error"]["corner.ux@end"] == c["quantity"]["corner.ux@end"] - 1, c
PY
exit $failed
