"""Libraries in which one writes forms, with a script each: quadratic tets and bricks, in the plane
where the problem is plane; Newton's iteration, the mid-point rule (forms.py)."""
import json
import os
import subprocess

import numpy as np

import lattice

HERE = os.path.dirname(os.path.abspath(__file__))
PYTHON = "/usr/bin/python3"
VOIGT = ["xx", "yy", "zz", "xy", "yz", "zx"]


class Peer:
    def __init__(self, module, script):
        self.module, self.script = module, script

    def found(self):
        return subprocess.run([PYTHON, "-c", f"import numpy, {self.module}"],
                              stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL).returncode == 0

    def rows(self, problem):
        solid = "file" not in problem
        kinds = ["tri", "quad"] if problem.get("plane") else ["tet", "hex"][:1 + solid]
        for kind in kinds:
            for mesh in problem["cells" if solid else "refine"]:
                for step in problem.get("steps", [None]):
                    yield kind, mesh, dict(kind=kind, step=step)

    def element(self, setting):
        return setting["kind"], 2

    def name(self, setting):
        words = {"tri": "P2 triangles", "quad": "Q2 quadrangles", "tet": "P2 tets",
                 "hex": "Q2 bricks"}[setting["kind"]]
        return words + (f", step {setting['step']:g} s" if setting["step"] else "")

    def prepare(self, folder, problem, mesh, setting):
        dim = 2 if mesh.kind in ("tri", "quad") else 3
        lattice.write(mesh, os.path.join(folder, "body.msh"))
        held = {(int(n), "xyz".index(a)): 0.0 for g, axes in problem["hold"] for a in axes
                for n in mesh.nodes[g] if "xyz".index(a) < dim}
        if "move" in problem:
            side, vector = problem["move"]
            held.update({(int(n), c): v for n in mesh.nodes[side] for c, v in enumerate(vector)})
        probe = mesh.nodes[problem["side"]] if "side" in problem else [
            mesh.nearest(problem["point"])]
        force = sum((lattice.traction(mesh, g, v) for g, v in problem.get("tractions", [])),
                    np.zeros_like(mesh.x))
        where = list(held) or np.zeros((0, 2), int)
        np.savez(os.path.join(folder, "input.npz"), x=mesh.x, cells=mesh.cells, force=force,
                 held_node=np.array(where)[:, 0], held_axis=np.array(where)[:, 1],
                 held_value=np.array(list(held.values())), probe=np.array(probe))
        words = {"linear": False, "gravity": None, "end": None, "rise": 0, "spin": None,
                 "increment": 1.0}
        given = {k: problem.get(k, v) for k, v in words.items()}
        component = problem["component"]
        given.update(dim=dim, kind=mesh.kind, lame=problem["lame"], density=problem["density"],
                     take=problem["take"], step=setting["step"],
                     component=(VOIGT if len(component) == 2 else list("xyz")).index(component))
        with open(os.path.join(folder, "input.json"), "w") as file:
            json.dump(given, file)
        return [PYTHON, os.path.join(HERE, self.script)]

    def answer(self, folder, problem):
        with open(os.path.join(folder, "answer.json")) as file:
            return json.load(file)
