. "$(dirname "$0")/lib.sh"

expect 0 schema; no_err
out "integrator.rtol"; out "kg/m^3"; out "cauchy, green, polar, warp, hybrid"
out "frames.max_angle"; out "boundary[].rotate.axis"; out "generalized-alpha"; out "compare"
expect 0 schema integrator.atol; no_err
out "integrator.atol.velocity"
grep -q strain stdout && complain "schema KEY prints other keys"
expect 0 schema --json; no_err
json 'd["properties"]["time"]["required"] == ["end"]'
json 'd["properties"]["integrator"]["properties"]["rtol"]["default"] == 1e-4'
json 'd["additionalProperties"] is False'

# If there is a validator at hand, it has to agree with the tool.
expect 0 check model.yaml --resolved
cp stdout resolved.json
"$corot" schema --json >schema.json
python3 - <<'PYTHON' || complain "the resolved scenario does not fit the JSON Schema"
import json
try:
    import jsonschema
except ImportError:
    raise SystemExit(0)
jsonschema.validate(json.load(open("resolved.json")), json.load(open("schema.json")))
PYTHON
exit $failed
