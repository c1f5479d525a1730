. "$(dirname "$0")/lib.sh"

expect 2 report; err "expected one folder"
expect 2 report a b; err "found 2"
expect 2 report a --output=; err "the name is empty"
expect 2 report a --outptu b; err "did you mean --output?"
expect 0 report --help; out "-o, --output FILE"
expect 5 report none; no_out; err "none: holds no result.json of a run"

expect 0 run model.yaml -o run --quiet
expect 0 report run; out run/report.html; no_err
expect 0 report run -o other.html; out other.html
cmp -s run/report.html other.html || complain "two reports of one run differ"
python3 - <<'PY' || complain "the page"
import html.parser, json, re
class Page(html.parser.HTMLParser):
    found = []
    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))
page = Page()
text = open("run/report.html", encoding="utf-8").read()
page.feed(text)
for tag, attributes in page.found:  # nothing is fetched
    assert tag not in ("img", "iframe", "object", "embed"), tag
    assert "src" not in attributes and attributes.get("href", "data:,") == "data:,", attributes
assert not set(re.findall(r"https?://[^\s'\"<]*", text)) - {"http://www.w3.org/2000/svg"}
assert [a["id"] for t, a in page.found if t == "section"] == \
    ["summary", "body", "probes", "steps", "energy", "scenario"]
warnings = json.load(open("run/result.json"))["warnings"]
assert ("No warnings." in text) == (not warnings)
PY

# What the run warns of stands on its page; where there is nothing, the page says so.
cp -r run quiet
python3 - <<'PY' || complain "the warnings"
import html, json
page = html.unescape(open("run/report.html", encoding="utf-8").read())
result = json.load(open("run/result.json"))
assert result["warnings"] and all(w["text"] in page for w in result["warnings"]), result["warnings"]
result["warnings"] = []
json.dump(result, open("quiet/result.json", "w"))
PY
expect 0 report quiet
grep -q 'No warnings\.' quiet/report.html || complain "that there are no warnings"
grep -q '"text":"traction on zmax: (200, 0, 0) Pa"' run/report.html || complain "the load"
grep -q '"text":"base: x, y, z held"' run/report.html || complain "the support"

# The space error is a fact of the body, or why there is none.
expect 0 static model.yaml -o coarse --quiet --set output.space_error=true
expect 0 report coarse
grep -q 'space error, estimated</th><td>[0-9.]* % of the displacement at' coarse/report.html || complain "no space error"
expect 0 static model.yaml -o fine --quiet --set mesh.order=2
expect 0 report fine
grep -q 'space error, estimated</th><td>none: there is no estimate for' fine/report.html || complain "not why there is no space error"

expect 0 run model.yaml -o stiff --set material.lambda=1e7
said=$(sed -n 's/.*\(nu = 0\.499[0-9]*\): .*/\1/p' stderr | head -n 1)
[ -n "$said" ] || complain "no warning of locking"
expect 0 report stiff
grep -q "<li>.*$said" stiff/report.html || complain "a warning of the run is not on its page"

expect 0 run model.yaml -o bare --quiet --set output.fields=none
expect 0 report bare
grep -q 'id="body"' bare/report.html && complain "a body without fields"
expect 0 static model.yaml -o still --quiet
expect 0 report still
grep -q 'Equilibrium of' still/report.html || complain "statics are not called so"
sections=$(grep -o '<section id="[a-z]*"' still/report.html | cut -d'"' -f2 | tr '\n' ' ')
[ "$sections" = 'summary body probes reactions steps energy scenario ' ] || complain "still: $sections"
grep -q 'id="balance"\|t \[s\]\|off balance' still/report.html && complain "an equilibrium has no clock and no error in energy"
expect 4 run model.yaml -o gone --quiet --set 'integrator={method: newmark, step: 0.004, newton: {iterations: 1}}'
expect 0 report gone
grep -q 'class="outcome bad"' gone/report.html || complain "a failure is not called so"

mkdir budget
cat >budget/budget.json <<'JSON'
{"title": "T", "measure": "displacement", "first": "space first", "total": 0.5, "check": null,
 "parts": [{"part": "space", "pair": "mesh.refine=1", "error": 0.4, "end": 0.3, "alone": 0.35, "cost": 8.0, "advice": "refine"}]}
JSON
expect 0 report budget
for text in 'space first' 'mesh.refine=1' 4.00e-01 5.00e-01 refine 'width:100.0%'; do
  grep -qF "$text" budget/report.html || complain "the budget lacks $text"
done
grep -qF 'check of time' budget/report.html && complain "something of what is not known"
cp budget/budget.json bare
expect 0 report bare
grep -qF 'space first' bare/report.html && complain "a budget of nobody knows what is on the run's page"
grep -qF 'is not of this run' bare/report.html || complain "the page says nothing of a budget that is not its own"

# A run's page shows its budget, whatever is written of the run, and not one of another run.
expect 0 budget model.yaml -o parts --quiet --skip space
expect 0 budget model.yaml -o parts-still --quiet --skip space --static
expect 0 run model.yaml -o other --quiet --set material.lambda=1.1e5
expect 0 run model.yaml -o finer --quiet --set 'mesh.box.cells=[1, 1, 3]'
for pair in bare:parts:1 run:parts:1 other:parts:0 finer:parts:0 still:parts:0 still:parts-still:1 bare:parts-still:0; do
  IFS=: read -r folder budget own <<HERE
$pair
HERE
  cp "$budget/budget.json" "$folder"
  expect 0 report "$folder"
  [ "$(grep -c 'id="budget"' "$folder/report.html")" = "$own" ] || complain "$pair: whether the page shows the budget"
  [ "$(grep -c 'is not of this run' "$folder/report.html")" = $((1 - own)) ] || complain "$pair: what the page says of it"
done

expect 5 report run -o none/report.html; err "none/report.html"
printf '{' >bare/result.json
expect 3 report bare; err "bare/result.json:1:"
printf '<VTKFile' >run/fields/fields_000002.vtu
expect 3 report run; err "fields_000002.vtu"
exit $failed
