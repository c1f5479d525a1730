"""corot: four-node and ten-node tets, adaptive steps, from a scenario and a mesh in files."""
import json
import os

import lattice

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
COROT = os.environ.get("COROT", os.path.join(ROOT, "build/release/src/main/corot"))
AXES = "xyz"


def found():
    return os.access(COROT, os.X_OK)


def rows(problem):
    """What is measured: meshes and settings, the cheapest first of each family."""
    moving = "end" in problem
    for order, meshes in (2, problem.get("cells", problem.get("refine"))), (1, problem["coarse"]):
        for mesh in meshes:
            if not moving:
                for dilatation in problem.get("dilatation", ["local"]):
                    if (order, dilatation) != (1, "element"):
                        yield dilatation, mesh, dict(order=order, dilatation=dilatation)
                continue
            for rtol in problem["tolerances"]:
                for method in problem.get("methods", ["arkode", "cvode"]):
                    yield method, mesh, dict(order=order, method=method,
                                                                 rtol=rtol)


def element(setting):
    return "tet", setting["order"]


def scenario(problem, mesh, setting):
    """As JSON, which is YAML."""
    lam, mu = problem["lame"]
    groups = {"all": {"nodes": list(range(len(mesh.x)))}} if problem.get("plane") else {}
    if "middle" in mesh.nodes:
        groups["middle"] = {"nodes": [int(n) for n in mesh.nodes["middle"]]}
    boundary = [{"group": g, "fix": list(axes)} for g, axes in problem["hold"]]
    if "move" in problem:
        side, vector = problem["move"]
        boundary.append({"group": side, "translate": {"velocity": list(vector)}})
    rise = {"amplitude": [[0, 0], [problem["rise"], 1]]} if "rise" in problem else {}
    loads = [dict(group=g, traction=list(v), **rise) for g, v in problem.get("tractions", [])]
    if "gravity" in problem:
        loads.append({"gravity": list(problem["gravity"])})
    take = problem["take"]
    probe = {"point": [float(c) for c in problem["point"]]} if "point" in problem else {}
    if take == "reaction":
        probe = {"group": problem["side"], "of": "reaction"}
    if take == "stress":
        probe["of"] = "stress"
    column = "P." + {"u": "u", "reaction": "f", "stress": ""}.get(take, "u") + problem["component"]
    if take in ("max", "min"):
        column = f"{take}({column})"
    else:
        column += "@end"
    out = {
        "mesh": {"file": "body.msh"}, "groups": groups,
        "material": {"lambda": lam, "mu": mu, "density": problem["density"]},
        "strain": "cauchy" if problem.get("linear") else "green",
        "boundary": boundary, "loads": loads, "time": {"end": problem.get("end", 1.0)},
        "probes": {"P": probe}, "quantities": {"it": column},
        "output": {"fields": "none"}}
    if "end" in problem:
        out["time"]["output"] = problem["output"]
        out["integrator"] = {"method": setting["method"], "rtol": setting["rtol"]}
    if "spin" in problem:
        rate, center = problem["spin"]
        out["start"] = {"spin": {"axis": [0, 0, 1], "center": list(center), "rate": rate}}
    if setting.get("dilatation", "local") != "local":
        out["dilatation"] = setting["dilatation"]
    return dict(out, **setting.get("keys", {}))


def prepare(folder, problem, mesh, setting):
    """Writes what the process reads; its command."""
    lattice.write(mesh, os.path.join(folder, "body.msh"))
    with open(os.path.join(folder, "model.json"), "w") as file:
        json.dump(scenario(problem, mesh, setting), file)
    verb = "run" if "end" in problem else "static"
    return [COROT, verb, "model.json", "-o", "out", "--lean", "--quiet"]


def answer(folder, problem):
    with open(os.path.join(folder, "out/result.json")) as file:
        return json.load(file)["quantities"]["it"]["value"]


def name(setting):
    parts = [f"{'ten' if setting['order'] == 2 else 'four'}-node tets"]
    if setting.get("dilatation", "local") != "local":
        parts.append("dilatation by " + setting["dilatation"])
    if "method" in setting:
        parts.append(f"{setting['method']} {setting['rtol']:g}")
    return ", ".join(parts)
