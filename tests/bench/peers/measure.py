"""One process at a time: its mesh, its run, its CPU time, its answer."""
import functools
import os
import resource
import shutil
import subprocess
import sys

import numpy as np

import lattice

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
ONE_THREAD = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")


class Failed(Exception):
    pass


@functools.lru_cache(maxsize=4)
def refined(corot, path, levels, order, folder):
    target = os.path.join(folder, f"refined-{levels}-{order}.msh")
    source = os.path.join(ROOT, path)
    if levels == 0:
        first = lattice.read(source)
        if order == 1:
            return first
    subprocess.run([corot, "mesh", "refine", source, "--levels", str(levels), "--order", str(order),
                    "-o", target], check=True, stderr=subprocess.DEVNULL)
    return lattice.read(target)


def make_mesh(problem, kind, order, cells, corot, folder):
    if "file" in problem:
        mesh = refined(corot, problem["file"], cells, order, folder)
        problem["point"] = tuple(mesh.x[problem["node"]])
        return mesh
    if kind in ("tri", "quad"):
        cells = cells[:2]
    mesh = lattice.lattice(cells, problem["shape"], order, kind, problem.get("grades", {}))
    if "line" in problem:
        unit = lattice.lattice(cells, lambda *x: x, order, kind)
        mesh.nodes["middle"] = np.flatnonzero(problem["line"](*unit.x.T))
    return mesh


def run(command, folder, seconds, core):
    """CPU time of the process and its children, user and system [s]."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
        os.sched_setaffinity(0, {core})

    with open(os.path.join(folder, "log"), "w") as log:
        child = subprocess.Popen(command, cwd=folder, stdout=log, stderr=subprocess.STDOUT,
                                 env=ONE_THREAD, preexec_fn=limit)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    cpu = usage.ru_utime + usage.ru_stime
    if child.returncode:
        with open(os.path.join(folder, "log")) as log:
            last = [line.strip() for line in log if line.strip()][-1:]
        why = "out of time" if cpu > seconds else f"exit code {child.returncode}"
        raise Failed(f"{why} after {cpu:.1f} s of CPU: {' '.join(last)[:200]}")
    return cpu


def measure(peer, problem, cells, setting, folder, corot, seconds=60, core=0):
    """CPU time and answer of one row; its unknowns are those of the mesh before any is held."""
    mesh = make_mesh(problem, *peer.element(setting), cells, corot, folder)
    where = os.path.join(folder, "row")
    shutil.rmtree(where, ignore_errors=True)
    os.makedirs(where)
    command = peer.prepare(where, problem, mesh, setting)
    cpu = run(command, where, seconds, core)
    with open(os.path.join(where, "log"), errors="replace") as log:
        if "running build_ext" in log.read():  # forms are compiled once, and then found compiled
            cpu = run(command, where, seconds, core)
    dim = 2 if mesh.kind in ("tri", "quad") else 3
    return cpu, peer.answer(where, problem), dim * len(mesh.x)
