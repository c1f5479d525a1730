. "$(dirname "$0")/lib.sh"

expect 2 plot; err "expected one folder"
expect 2 plot a b; err "found 2"
expect 0 plot --help; out "--cost COST"
expect 5 plot none; no_out; err "none/table.json: No such file"

mkdir study bad
python3 - <<'PY'
import json
cells = []
for k, series in enumerate(["cvode", "bdf, order 2", "tr <&> 'x' \"y\""]):
    for i in range(2, 7):
        cells.append({
            "id": f"{k}{i}", "series": series, "tolerance": 10.0**-i, "status": "done", "reason": "",
            "cost": {"cpu": 0.01 * 2**i, "cpu_min": 0.009 * 2**i, "cpu_max": 0.012 * 2**i,
                     "steps": 10 * 3**i, "rhs": 20 * 3**i, "factorisations": i},
            "error": {"displacement": (k + 1) * 10.0**-i, "velocity": (k + 2) * 10.0**-i},
            "unrated": ["displacement", "velocity"] if i == 6 else []})
cells[0].update(status="failed", reason="cvode gave up", cost={}, error={})
table = {"title": "Title <&> 'x'", "cost": "cpu", "measure": "displacement", "cells": cells,
         "references": [{"floor": {"displacement": 1e-7, "velocity": 2e-7}}]}
json.dump(table, open("study/table.json", "w"))
PY

expect 0 plot study
out study/precision-cpu-displacement.svg; err "no point: cvode, tolerance 0.01: failed: cvode gave up"
err "no point: bdf, order 2, tolerance 1e-06: below the floor"
expect 0 plot study --cost rhs --error velocity -o figure.svg
for suffix in svg csv gp py; do out figure.$suffix; done
python3 - <<'PY' || complain "the files of $what"
import ast, csv, xml.etree.ElementTree as tree
for name, cost in ("study/precision-cpu-displacement", "cpu"), ("figure", "rhs"):
    svg = tree.parse(name + ".svg").getroot()
    marks = [e for e in svg.iter("{http://www.w3.org/2000/svg}path") if e.get("class") == "mark"]
    assert len(marks) == 11 + 3, len(marks)  # rated cells, and the legend
    texts = "".join(svg.itertext())
    assert "Title <&> 'x'" in texts and "tr <&> 'x' \"y\"" in texts
    rows = list(csv.DictReader(open(name + ".csv", newline="")))
    assert [r["status"] for r in rows].count("rated") == 11 and len(rows) == 15
    assert float(rows[1][cost]) == {"cpu": 0.08, "rhs": 540}[cost]
    ast.parse(open(name + ".py").read())
PY
if command -v gnuplot >/dev/null; then
  gnuplot figure.gp && [ -s figure-gnuplot.svg ] || complain "gnuplot figure.gp"
fi

expect 2 plot study --cost cup; err "did you mean cpu?"
expect 2 plot study --error displacment; err "did you mean displacement?"
expect 2 plot study --output=; err "the name is empty"
expect 5 plot study -o none/figure.svg; err "none/figure.svg"
for text in '' '[1' '{"cells": 3}' '{"cells": [3]}' '{"cells": [{"status": "odd"}]}'; do
  printf '%s' "$text" >bad/table.json
  expect 3 plot bad; err "bad/table.json"; no_out
done
printf '{"cells": [{"status": "missing", "series": "a"}]}' >bad/table.json
expect 3 plot bad; err "no cell has an error yet"
exit $failed
