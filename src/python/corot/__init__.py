"""corot: deformable solids as ordinary differential equations, from Python.

    import corot
    mesh = corot.Mesh.box([0.1, 0.1, 0.6], [2, 2, 12])
    model = corot.Model(mesh, corot.Material(1e5, 1e4, 1000), fix=corot.Fix("zmin"), gravity=(0, 0, -9.81))
    integrator = corot.Integrator(corot.State(model), rtol=1e-5)
    u, v = integrator.advance([0.1, 0.2, 0.3])      # [3, n] each

Units are SI throughout. The C headers are the reference (include/corot); names and settings are
theirs. src/python/README.md is the guide.
"""
from __future__ import annotations

from typing import Any

from ._convert import EXTRAPOLATION_CAP, Record
from ._errors import (ClosedError, Error, FormatError, IntegrationError, InvalidError, LibraryError,
                      OutOfMemoryError, ProgramError, RetryError, SingularError, SystemRefusedError)
from ._folder import Run, States, Study, Table, read, read_states, read_table
from ._integrate import FrameClock, Integrator, methods
from ._library import HEADER_VERSION as __version__
from ._library import has, lib, library_path, text
from ._mesh import Group, Mesh, Refinement
from ._model import Amplitude, Fix, Hierarchy, Load, Material, Model, Motion, strains
from ._program import find_program, run, study
from ._solve import (Equilibrium, MassSolver, Modes, Pencil, Statics, mark, modes, modes_available,
                     space_error, space_indicators, statics)
from ._state import Blocks, Inputs, Points, State

__all__ = [
    "Amplitude", "Blocks", "ClosedError", "EXTRAPOLATION_CAP", "Equilibrium", "Error", "Fix",
    "FormatError", "FrameClock", "Group", "Hierarchy", "Inputs", "IntegrationError", "Integrator",
    "InvalidError", "LibraryError", "Load", "MassSolver", "Material", "Mesh", "Model", "Modes", "Motion",
    "OutOfMemoryError", "Pencil", "Points", "ProgramError", "Record", "Refinement", "RetryError", "Run",
    "SingularError", "State", "States", "Statics", "Study", "SystemRefusedError", "Table", "build_info",
    "find_program", "library_path", "mark", "methods", "modes", "modes_available", "read",
    "read_states", "read_table", "run", "space_error", "space_indicators", "statics", "strains", "study",
]


def build_info() -> dict[str, Any]:
    """What the loaded library is and what it was built with: version, library (path), parts, sundials
    (version), solvers (of linear systems), arpack."""
    info: dict[str, Any] = {"version": text(lib.corot_version()), "library": library_path,
                            "parts": ["core"], "sundials": "", "solvers": [], "arpack": False}
    if has("corot_integrator_create"):
        info["parts"] += ["solve", "integrate"]
        info["sundials"] = text(lib.corot_sundials_version())
        info["arpack"] = modes_available()
        info["solvers"] = [name for name in ("klu", "cholmod", "pcg") if _has_solver(name)]
    return info


def _has_solver(name: str) -> bool:
    with Mesh.box([1, 1, 1], [1, 1, 1], split="kuhn") as mesh, \
            Model(mesh, Material(1, 1, 1)) as model, State(model) as state:
        try:
            Pencil(state, name).close()
        except InvalidError:
            return False
        return True
