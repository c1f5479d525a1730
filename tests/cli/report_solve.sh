# The page of `corot solve`: it says what solve.json says, and why.
. "$(dirname "$0")/lib.sh"

cat >same.py <<'PY'
import base64, html, json, re, struct, sys
folder = sys.argv[1]
d = json.load(open(folder + "/solve.json"))
text = open(folder + "/report.html", encoding="utf-8").read()
page = html.unescape(re.sub(r"<script.*?</script>", "", text, flags=re.S))
assert d["title"] in page and d["scenario"] in page and d["goal"] in page
assert ('<p class="outcome good"><b>met</b>' in page) == d["met"]
assert ('<p class="outcome bad"><b>not met</b>' in page) == (not d["met"])
assert d["obstacle"] is None or d["obstacle"] in page, d["obstacle"]
assert d["advice"] is None or d["advice"] in page, d["advice"]
sections = re.findall(r'<section id="([a-z]*)"', text)
if d["value"] is None:
    assert sections == ["answer", "attempts"], sections
else:
    assert sections == ["answer", "mesh", "parts", "attempts"], sections
    # the diagram has the values on the meshes, and the interval as a band
    figure = json.loads(re.search(r'<figure class="chart" id="meshes">.*?<script type="application/json">(.*?)</script>', text, re.S).group(1))
    numbers = lambda s: list(struct.unpack("<%dd" % (len(base64.b64decode(s)) // 8), base64.b64decode(s)))
    values = figure["series"][0]
    assert figure["xLog"] and numbers(values["x"]) == [l["dofs"] for l in d["levels"]]
    assert numbers(values["y"]) == [l["value"] for l in d["levels"]]
    assert values["note"] == [l["label"] for l in d["levels"]]
    assert all(abs(a - b) < 1e-9 * abs(b) for a, b in zip(figure["interval"], (d["low"], d["high"])))
    asked = numbers(figure["series"][1]["y"])
    assert abs(asked[3] - asked[0] - 2 * d["allowed"]) < 1e-9 * abs(d["value"]), asked
    names = [s["name"] for s in figure["series"]]
    assert ("extrapolated limit" in names) == (d["limit"] is not None), names
    # every part that there is has a row
    for name, key in (("space", "space"), ("algebra", "algebra"), ("frames", "frames"), ("strain measure", "model")):
        assert '<th scope="row">%s</th>' % name in page, name
    assert ('<th scope="row">time</th>' in page) == (not d["static"])
    # labels of runs, of which each was made
    labels = {a["label"] for a in d["attempts"]}
    for part, runs in d["measured"].items():
        assert set(runs) <= labels, (part, runs)
    assert len(d["measured"]["space"]) >= min(3, len(d["levels"]))
    assert len(d["measured"]["algebra"]) == len(d["measured"]["model"]) == 2
    allowed = d["within"] if d["within_abs"] else d["within"] * abs(d["value"])
    assert abs(d["allowed"] - allowed) < 1e-12
# all runs, each with its folder
runs = page[page.index('<section id="attempts"'):]
assert runs.count("<tr>") == len(d["attempts"]) + 1
for a in d["attempts"]:
    assert a["label"] in runs and a["id"] in runs, a
    assert a["reason"] is None or a["reason"] in runs, a
PY
same() { python3 same.py "$1" || complain "the page of $1 is not what its solve.json says"; }

# An equilibrium; the page is made anew by `corot report`, and says the same.
expect 0 solve model.yaml --goal corner.ux@end --within 0.05 --static -o still
out "corner.ux@end = "; err "still/report.html: to look at"
same still
grep -q 'corner.ux@end of the equilibrium within 5 %' still/report.html || complain "what was asked for"
cp still/report.html first.html
expect 0 report still; out still/report.html
cmp -s first.html still/report.html || complain "the page made anew is another"

# Motion, in the unit of the quantity; nothing is told with --quiet, and --json has stdout to itself.
expect 1 solve model.yaml --goal 'max(corner.ux)' --within 1e-9 --within-abs --cpu-limit 0.3 -o moving --quiet --json
no_err
json "d == json.load(open('moving/solve.json'))"
same moving
grep -q 'What stands in the way: ' moving/report.html || complain "not what stands in the way"

# No value: a run that fails, and a question that makes no sense, whose page is not advertised.
expect 1 solve model.yaml --goal 'max(corner.ux)' --within 0.01 --timeout 1e-4 -o late --quiet
out "not found"
same late
sed 's/corner: .*/foot: {point: [0, 0, 0]}/' model.yaml >foot.yaml
expect 3 solve foot.yaml --goal 'max(foot.ux)' --within 0.01 -o foot
no_out; err "foot.ux is zero"
grep -q 'report.html' stderr && complain "an answer that there is not is recommended"
same foot

# What is no solve.json.
expect 0 report --help; out "corot solve"
expect 0 solve --help; out "report.html"
printf '[]' >late/solve.json
expect 3 report late; err "late/solve.json: not a map"
exit $failed
