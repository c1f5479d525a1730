"""What this corot is, its commands, or a demonstration.

    python3 -m corot                    version, library, what it was built with
    python3 -m corot --demo             a bar falls sideways: its tip, as CSV on stdout
    python3 -m corot COMMAND ...        the program: python3 -m corot run bar.yaml
"""
from __future__ import annotations

import os
import sys

import numpy as np

import corot


def show() -> None:
    info = corot.build_info()
    try:
        program = corot.find_program()
    except corot.LibraryError as error:
        program = f"none ({error})"
    print(f"corot {info['version']}")
    print(f"library:        {info['library']}, with {', '.join(info['parts'])}")
    print(f"program:        {program}")
    print(f"SUNDIALS:       {info['sundials'] or 'none'}")
    print(f"linear solvers: {', '.join(info['solvers']) or 'none'}")
    print(f"modes (ARPACK): {'yes' if info['arpack'] else 'no'}")


def demonstrate() -> None:
    """A soft cantilever of 0.6 m under its weight, from rest."""
    mesh = corot.Mesh.box([0.6, 0.1, 0.1], [12, 2, 2])
    rubber = corot.Material.engineering(young=1e5, poisson=0.3, density=1000, damping_mu=20)
    model = corot.Model(mesh, rubber, fix=corot.Fix("xmin"), gravity=(0, 0, -9.81))
    times = np.linspace(0, 1, 51)
    u, _ = corot.Integrator(corot.State(model)).advance(times)
    tip = model.dof[mesh.nearest([0.6, 0.05, 0.05])]
    print("t,tip.ux,tip.uy,tip.uz")
    for t, row in zip(times, u[:, tip]):
        print(",".join(f"{number:.9g}" for number in (t, *row)))


def main(arguments: list[str]) -> int:
    if not arguments:
        show()
    elif arguments == ["--demo"]:
        demonstrate()
    elif arguments[0] in ("-h", "--help"):
        print((__doc__ or "").strip())
    else:
        program = corot.find_program()
        os.execv(program, [program, *arguments])
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except corot.Error as failure:
        sys.exit(f"corot: {failure}")
