"""What the tests of the package for Python share: bodies, folders, where things are."""
import os
import shutil
import tempfile
import unittest
from pathlib import Path

import numpy as np

import corot

ROOT = Path(__file__).resolve().parents[2]
BAR = ROOT / "models" / "bar"
RUBBER = corot.Material(1e5, 1e4, 1000, damping_lambda=10, damping_mu=1)


def make_bar(**more):
    """The model of models/bar/bar.yaml."""
    mesh = corot.Mesh.read(BAR / "bar.msh")
    mesh.group_plane("base", "z", 0.0)
    mesh.group_plane("top", "z", 0.6)
    load = corot.Load.traction("top", [200, 0, 0], [(0, 0), (10, 1)])
    settings = {"viscosity": "corotated", "fix": corot.Fix("base"), "load": load, **more}
    return corot.Model(mesh, RUBBER, **settings)


def make_column(cells=(1, 1, 3), order=1, **more):
    """A small column on its base, without loads unless `more` says some."""
    mesh = corot.Mesh.box([0.1, 0.1, 0.3], cells, split="kuhn")
    if order == 2:
        mesh = mesh.change_order(2)
    return corot.Model(mesh, RUBBER, **{"fix": corot.Fix("zmin"), **more})


def deform(model, size=0.02, seed=1):
    """u and v of a moderate deformation, the same every time."""
    random = np.random.default_rng(seed)
    x = model.mesh.x
    wave = size * np.sin(7 * x[:, [1, 2, 0]] + 3 * x[:, [2, 0, 1]]) + 0.01 * size * random.normal(size=x.shape)
    state = corot.State(model)
    return state.free(wave), state.free(2 * wave[:, ::-1])


class Folder(unittest.TestCase):
    """Tests with a folder of their own, `self.folder`."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="corot-python-"))
        self.addCleanup(shutil.rmtree, self.folder)


def program_is_there():
    return os.access(os.environ.get("COROT", ""), os.X_OK)
