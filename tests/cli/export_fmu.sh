# `corot export-fmu`: what it writes, says and refuses.
. "$(dirname "$0")/lib.sh"

expect 2 export-fmu; err "expected one scenario, found 0"; no_out
expect 2 export-fmu a b; err "expected one scenario, found 2"
expect 2 export-fmu model.yaml --interfaces both; err "did you mean --interface?"
expect 2 export-fmu model.yaml --interface scheduled; err "expected auto, co-simulation, model-exchange or both"
expect 2 export-fmu model.yaml -o ""; err "the name is empty"
expect 3 export-fmu missing.yaml; err "missing.yaml"; no_out
expect 3 export-fmu model.yaml --set strain=soft; err "strain"
[ ! -e model.fmu ] || complain "a scenario that is bad left an FMU"

# Where this build has no minizip, or not the archives for the object, it says what to install.
"$corot" export-fmu model.yaml -o try.fmu >stdout 2>stderr || {
  grep -q 'install libminizip-dev\|corot_fmu.so is not there' stderr || complain "no reason"
  exit $failed
}

# The name, the words, and facts as JSON.
expect 0 export-fmu model.yaml; no_out
err "model.yaml: Co-Simulation and Model Exchange; 0 inputs, 3 outputs, 6 parameters; model.fmu"
expect 0 export-fmu model.yaml -o one.fmu --quiet --json; no_err
json 'd["fmu"] == "one.fmu" and d["interfaces"] == ["CoSimulation", "ModelExchange"] and d["model_identifier"] == "model"'
json 'd["outputs"] == 3 and d["continuous_states"] == 2 * 3 * (12 - 4) and d["no_model_exchange"] is None'
cmp -s model.fmu one.fmu || complain "two exports of one scenario differ"

# It replaces one that is there, or leaves it as it was.
expect 0 export-fmu model.yaml -o one.fmu --quiet --set material.mu=2.0e4
cmp -s model.fmu one.fmu && complain "another material, and the same FMU"
cp one.fmu before.fmu
expect 3 export-fmu model.yaml -o one.fmu --quiet --set material.mu=-1
cmp -s before.fmu one.fmu || complain "a failure changed the FMU"
expect 5 export-fmu model.yaml -o nowhere/one.fmu; err "nowhere/one.fmu.files: cannot write"
mkdir folder.fmu
expect 5 export-fmu model.yaml -o folder.fmu; err "folder.fmu"
# What a process that was killed has left is in nobody's way.
mkdir one.fmu.files
echo cut >one.fmu.part
echo cut >one.fmu.files/scenario.json
expect 0 export-fmu model.yaml -o one.fmu --quiet
cmp -s model.fmu one.fmu || complain "what was left by another made a difference"
[ "$(ls | grep -c 'fmu\.')" = 0 ] || complain "drafts are left: $(ls)"

# What Model Exchange cannot have.
cat model.yaml - >held.yaml <<'YAML'
frames: {policy: step}
YAML
expect 0 export-fmu held.yaml; err "held.yaml: without Model Exchange: frames that are held"
err "held.yaml: Co-Simulation; 0 inputs"
expect 3 export-fmu held.yaml --interface both; err "Co-Simulation is: --interface co-simulation"
expect 3 export-fmu held.yaml --interface model-exchange; err "Model Exchange is not possible"
expect 0 export-fmu held.yaml --interface co-simulation --json
json 'd["interfaces"] == ["CoSimulation"] and d["no_model_exchange"] is None and d["continuous_states"] == 0'
expect 0 export-fmu model.yaml --interface model-exchange --json
json 'd["interfaces"] == ["ModelExchange"]'
sed 's/^probes:/&\n  lost: {of: dissipated}/' model.yaml >lossy.yaml
expect 0 export-fmu lossy.yaml; err "a probe is of work done since the start"

# What no FMU has.
expect 3 export-fmu model.yaml --set linear_solver=cholmod; err "cholmod is not in an FMU"
expect 3 export-fmu model.yaml --set linear_solver.ordering=metis; err "metis is not in an FMU"
cat model.yaml - >named.yaml <<'YAML'
inputs: {time: {load: 0, values: [[0, 1]]}}
YAML
expect 3 export-fmu named.yaml; err "two variables of the FMU would be called time: rename the input"

# Files of all kinds, of which two have one name; what is only for runs does not go along.
mkdir a b c
"$corot" mesh box --size 0.1,0.1,0.2 --cells 1,1,2 -o a/part.msh 2>/dev/null
printf '0 0\n0.05 1\n' >a/curve.txt
printf '0 1\n0.05 2\n' >b/curve.txt
printf '0 1 2\n' >b/marks.txt
sed 's|^mesh:.*|mesh: {file: a/part.msh, marks: b/marks.txt}|; s|0.0, 0.0\]}|0.0, 0.0], amplitude: {file: a/curve.txt}}|' \
  model.yaml >c/spread.yaml
sed -i 's|a/|../a/|; s|b/|../b/|' c/spread.yaml
cat >>c/spread.yaml <<'YAML'
inputs: {push: {load: 0, values: {file: ../b/curve.txt}}}
quantities: {file: max(corner.ux), peak: max(corner.ux)}
YAML
expect 0 export-fmu c/spread.yaml -o spread.fmu --json
json 'd["resources"] == 5 - 0 and d["inputs"] == 1'
python3 - <<'PY' || complain "the resources of spread.fmu"
import json, zipfile
z = zipfile.ZipFile("spread.fmu")
names = {n for n in z.namelist() if n.startswith("resources/")}
assert names == {"resources/" + n for n in ("scenario.json", "part.msh", "marks.txt", "curve.txt", "2_curve.txt")}, names
s = json.loads(z.read("resources/scenario.json"))
assert "quantities" not in s and "output" not in s, s.keys()
assert s["mesh"]["file"] == "part.msh" and s["mesh"]["marks"] == "marks.txt"
read = lambda name: z.read("resources/" + name).decode()
assert read(s["loads"][0]["amplitude"]["file"]) == "0 0\n0.05 1\n"
assert read(s["inputs"]["push"]["values"]["file"]) == "0 1\n0.05 2\n"
assert z.testzip() is None
PY

# Meshes of several files: TetGen's, whose faces are optional, and Abaqus' with one that it includes.
mkdir many
cat >many/tet.node <<'NODES'
4 3 0 0
1 0 0 0
2 0.1 0 0
3 0 0.1 0
4 0 0 0.1
NODES
printf '1 4 0\n1 1 2 3 4\n' >many/tet.ele
printf '1 1\n1 1 3 2 7\n' >many/tet.face
printf '*NODE\n1, 0, 0, 0\n2, 0.1, 0, 0\n3, 0, 0.1, 0\n4, 0, 0, 0.1\n' >many/nodes.txt
printf '*INCLUDE, INPUT=nodes.txt\n*ELEMENT, TYPE=C3D4, ELSET=all\n1, 1, 2, 3, 4\n*NSET, NSET=face-7\n1, 2, 3\n' >many/tet.inp
for kind in ele inp; do
  cat >many/$kind.yaml <<YAML
mesh: {file: tet.$kind}
groups: {}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0}
boundary: [{group: face-7, fix: [x, y, z]}]
loads: [{gravity: [0, 0, -9.81]}]
time: {end: 0.01}
YAML
  expect 0 export-fmu many/$kind.yaml -o $kind.fmu --json
done
python3 - <<'PY' || complain "the resources of meshes of several files"
import zipfile
names = lambda fmu: {n[10:] for n in zipfile.ZipFile(fmu).namelist() if n.startswith("resources/")}
assert names("ele.fmu") == {"scenario.json", "tet.ele", "tet.node", "tet.face"}, names("ele.fmu")
assert names("inp.fmu") == {"scenario.json", "tet.inp"}, names("inp.fmu")
text = zipfile.ZipFile("inp.fmu").read("resources/tet.inp").decode()
assert "INCLUDE" not in text and "*NODE" in text, text
PY

# A name that is none of C, and a title that is not of XML.
cp model.yaml "7 bars-of <steel>.yaml"
expect 0 export-fmu "7 bars-of <steel>.yaml" --json --set 'title="a & b <c> \"d\""'
json 'd["model_identifier"] == "model_7_bars_of__steel_"'
python3 - <<'PY' || complain "the description"
import xml.etree.ElementTree as xml, zipfile
root = xml.fromstring(zipfile.ZipFile("7 bars-of <steel>.fmu").read("modelDescription.xml"))
assert root.get("modelName") == "7 bars-of <steel>" and root.get("description") == 'a & b <c> "d"', root.attrib
PY

# A full disk.
if [ -w /dev/full ]; then
  "$corot" export-fmu model.yaml --quiet --json >/dev/full 2>stderr
  [ $? = 5 ] || complain "facts to a full disk"
fi
exit $failed
