# One title that every format could trip over, in names of files and groups as well: it is shown
# wherever a title is shown, and nothing in it is obeyed.
. "$(dirname "$0")/lib.sh"

# Where they would be executed, these leave a file "pwned" in the folder.
cat >make.py <<'PY'
import json, os
title = ("=cmd|' /C touch pwned'!A0\n$(touch pwned) `touch pwned`; touch pwned #\r\n"
         "open('pwned', 'w') #\n'''; open('pwned', 'w') #\n\"\"\"\nopen('pwned', 'w')\n"
         "</script><script>document.title='pwned'</script><!-- ]]> --> <img src=x onerror=pwned()>"
         "\x1b]0;pwned\x07\x1b[31m\x7f\x9b31m\u2028touch pwned\u2029 {pwned} %s%n \\ \", '); drop table runs; --")
long = title + " long" * 2000
group = "=1+1,$(touch pwned)</script>--><img src=x onerror=pwned()>\\"
probe = "-1-tip"
model = json.load(open("plain.json"))
model["title"] = long
model["groups"] = {group: {"plane": {"axis": "z", "at": 0.0}}}
model["boundary"] = [{"group": group, "fix": ["x", "y", "z"]}]
model["probes"] = {probe: {"point": [0.1, 0.1, 0.2]}}
name = os.fsencode("a\n$(touch pwned)'; touch pwned; '\"\x1b[31m") + b"\xff\xfe"
os.mkdir(name)
json.dump(model, open("model.json", "w"))
json.dump(model, open(os.path.join(name, b"model.yaml"), "w"))
variants = [{"label": title, "set": {"integrator.rtol": 1e-3}}, {"label": "+two", "set": {"integrator.rtol": 1e-4}}]
study = {"study": long, "base": "model.json", "set": {"time.end": 0.02},
         "axes": [{"name": "-kind", "variants": variants}]}
json.dump(study, open("study.json", "w"))
json.dump(study, open(b"$(touch pwned)\ntouch pwned\n'.yaml", "w"))
PY
python3 - <<'PY'
import json
json.dump({"mesh": {"box": {"size": [0.1, 0.1, 0.2], "cells": [1, 1, 2]}},
           "material": {"lambda": 1.0e5, "mu": 1.0e4, "density": 1000.0, "damping": {"lambda": 10.0, "mu": 1.0}},
           "loads": [{"group": "zmax", "traction": [200.0, 0.0, 0.0]}],
           "time": {"end": 0.02, "output": 0.01}}, open("plain.json", "w"))
PY
python3 make.py || complain "the inputs cannot be made"

# harmless: nothing was executed, and neither stream controls the terminal.
harmless() {
  [ -z "$(find . -name pwned)" ] || complain "$what: executed"
  for stream in stdout stderr; do
    LC_ALL=C grep -q "$(printf '[\001-\010\013-\037\177]')" $stream && complain "$what: control characters on $stream"
  done
}

expect 0 check model.json; harmless; out "title          =cmd"
expect 0 run model.json -o run; harmless
expect 0 run "$(printf "a\n\$(touch pwned)'; touch pwned; '\"\033[31m\377\376")/model.yaml" -o run2; harmless
expect 0 study study.json -o study; harmless; err "study: 4 of 4 runs done"
expect 0 study "$(printf "\$(touch pwned)\ntouch pwned\n'.yaml")"; harmless
for verb in status table; do expect 0 study $verb study; harmless; done
expect 0 study csv study; harmless
expect 0 plot study; harmless
expect 0 report run; harmless
expect 5 report "$(printf 'no\033[31m\377folder')"; harmless
expect 2 run "$(printf -- '--no\033[31m')"; harmless
expect 3 run model.json --set "$(printf 'time.\033[31m=1')" -o none; harmless
sed 's/"study": "./"study": "x/' study.json >other.json
expect 3 study other.json -o study; harmless; err "belongs to the study"

# Each format, by a reader of its own. The text itself is what it was but for what cannot be shown.
cat >read.py <<'PY'
import csv, html.parser, json, sqlite3, sys, xml.etree.ElementTree as tree
def shown(text):
    return all(c in "\n\t" or (c >= " " and not "\x7f" <= c <= "\x9f") for c in text)
table = json.load(open("study/table.json"))
assert table["title"] == json.load(open("study.json"))["study"]
rows = list(csv.reader(open("study/table.csv", newline="")))
assert len(rows) == 3 and len({len(row) for row in rows}) == 1, rows
precision = list(csv.reader(open("study/precision-cpu-displacement.csv", newline="")))
probes = list(csv.reader(open("run/probes.csv", newline="")))
assert len(probes) == 4 and len(probes[0]) == 4, probes[0]
for row in rows + precision + probes:
    for cell in row:
        try: float(cell)
        except ValueError: assert cell[:1] not in list("=+-@\t\r") or not cell, cell
        assert shown(cell), repr(cell)
assert probes[0][1] == "'-1-tip.ux", probes[0][1]
assert "'-kind" in rows[0] and "'+two" in [row[1] for row in rows], rows
db = sqlite3.connect("study/index.sqlite")
assert db.execute('select count("-kind") from runs').fetchone() == (2,)
assert sorted(row[0][:4] for row in db.execute('select "-kind" from runs')) == ["+two", "=cmd"]
for svg in ("study/precision-cpu-displacement.svg", "run/fields.pvd"):
    tree.parse(svg)
class page(html.parser.HTMLParser):
    scripts = 0
    def handle_starttag(self, tag, attributes):
        assert tag != "img" and not any(name.startswith("on") for name, _ in attributes), tag
    def handle_comment(self, data): assert "]]>" not in data
for name in ("study/report.html", "run/report.html"):
    text = open(name).read()
    assert shown(text), name
    page().feed(text)
    assert "document.title='pwned'" not in text
compile(open("study/precision-cpu-displacement.py").read(), "script", "exec")
PY
python3 read.py || complain "one of the formats"
if command -v gnuplot >/dev/null; then
  (cd study && gnuplot precision-cpu-displacement.gp) >stdout 2>stderr || complain "gnuplot"
  what=gnuplot harmless
fi

# What schedulers get really runs, with the names as they are.
mkdir 'fo$(touch pwned) `touch pwned`'"'"'"lder'
for study in study.json "$(printf "\$(touch pwned)\ntouch pwned\n'.yaml")"; do
  expect 0 study export "$study" --format slurm -o 'fo$(touch pwned) `touch pwned`'"'"'"lder/slurm'
  harmless
  cp stdout job.sh
  grep '^#SBATCH --job-name=' job.sh | grep -qvx '#SBATCH --job-name=[A-Za-z0-9._-]*' && complain "the name of the job"
  [ "$(grep -c '^[^#]' job.sh)" = "$(grep -c '^exec\|^touch pwned$\|^'"'"'\\'"''"'' job.sh)" ] || complain "lines beside comments and the command"
  for task in 1 2 3 4; do SLURM_ARRAY_TASK_ID=$task sh job.sh >stdout 2>stderr || complain "task $task"; done
  what="the job of SLURM" harmless
  rm -r fo*lder/slurm
done
expect 0 study export study.json --format commands -o 'fo$(touch pwned) `touch pwned`'"'"'"lder/commands'; harmless
[ "$(wc -l <stdout)" = 4 ] || complain "not 4 commands"
xargs -d '\n' -n 1 sh -c <stdout >said 2>&1 || complain "the commands: $(cat said)"
what="the commands" harmless
expect 0 study collect fo*lder/commands; expect 0 study status fo*lder/commands; out "4 runs: 4 done"
mkdir "$(printf 'two\nlines')"
expect 3 study export study.json --format commands -o "$(printf 'two\nlines')"; err "a name with a line break"; no_out
expect 3 study export study.json --format snakemake -o '{brace}'; err "a brace or a line break"; no_out
expect 0 study export study.json --format snakemake -o 'fo$(touch pwned) `touch pwned`'"'"'"lder/snake'; harmless
cp stdout Snakefile
cat >snake.py <<'PY'
# The Python in it, as Snakemake executes it: all before the rules; then the commands of its rule.
import glob, os, shlex, subprocess
text = open("Snakefile", encoding="ascii").read()
head = text.split("\nrule all:")[0]
names = {}
exec(compile(head, "Snakefile", "exec"), names)
assert [n for n in names if n[0] != "_"] == ["PROGRAM", "BASE", "DIR", "RUNS"], names
assert os.path.isdir(names["DIR"]) and len(names["RUNS"]) == 4
for name, settings in names["RUNS"].items():
    quoted = [shlex.quote(names[n]) for n in ("PROGRAM", "BASE", "DIR")]
    subprocess.run("%s run %s --quiet --output %s/runs/" % tuple(quoted) + name + " " + settings, shell=True, check=True)
PY
python3 snake.py || complain "the Snakefile"
what="the Snakefile" harmless

# U+0000 would cut a title short.
printf 'title: "a\\0b"\n' >nul.yaml
expect 3 run nul.yaml; err "nul.yaml:1:8: text cannot hold the character U+0000"
printf '{"title":\n "a\\u0000b"}\n' >nul.json
expect 3 check nul.json; err "nul.json:2:2: text cannot hold the character U+0000"
expect 3 run model.json --set 'title="\u0000"' -o none; err "U+0000"
printf 'study: "a\\x00"\n' >nul.yaml
expect 3 study nul.yaml; err "nul.yaml:1:8: text cannot hold"
exit $failed
