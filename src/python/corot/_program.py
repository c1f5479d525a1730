"""Runs the program corot as a process, and reads what it leaves."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._errors import LibraryError, ProgramError
from ._folder import Run, Study
from ._library import installed_folder


def find_program() -> str:
    """The path of the program: what the environment variable COROT says, else where CMake has installed
    it with this package, else the first on PATH. LibraryError: there is none."""
    said = os.environ.get("COROT")
    if said:
        if os.access(said, os.X_OK) and os.path.isfile(said):
            return said
        raise LibraryError(f"COROT={said} is no program")
    folder = installed_folder("PROGRAM")
    if folder and os.access(os.path.join(folder, "corot"), os.X_OK):
        return os.path.join(folder, "corot")
    found = shutil.which("corot")
    if found is None:
        raise LibraryError("the program corot is not on PATH: install it, or set COROT to its path")
    return found


def _word(value: Any, inside: bool = False) -> str:
    """A value as --set takes it, which is YAML with a point in numbers that have an exponent. A text is
    taken as it stands, so that it may be YAML; inside a list or a map it is a text."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, str):
        return json.dumps(value) if inside else value
    if isinstance(value, float):
        text = repr(value)
        return text if "." in text or "n" in text else text.replace("e", ".0e")
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_word(each, True) for each in value)}]"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{_word(str(k), True)}: {_word(v, True)}' for k, v in value.items())}}}"
    return json.dumps(value)


def _call(arguments: list[str], fine: tuple[int, ...]) -> str:
    done = subprocess.run([find_program(), *arguments], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          errors="replace", check=False)
    if done.returncode not in fine:
        told = done.stderr.strip()
        last = told.splitlines()[-1] if told else "it said nothing"
        raise ProgramError(f"corot {arguments[0]}: exit code {done.returncode}: {told or last}",
                           done.returncode, done.stderr)
    return done.stderr


def _settings(given: Mapping[str, Any] | None) -> list[str]:
    return [f"--set={key}={_word(value)}" for key, value in (given or {}).items()]


def run(model: Any, out: Any, *, set: Mapping[str, Any] | None = None, command: str = "run",
        options: tuple[str, ...] = ()) -> Run:
    """`corot run MODEL -o OUT --set KEY=VALUE ...` as a process, and what it has left in OUT.

    set: keys of the scenario and their values, {"integrator.rtol": 1e-6, "mesh.order": 2}; a text is
    YAML, as on the command line. command: "static" or "modes" in place of "run"; options: more of the
    command line, as ("--force",). Exit code 1 (a quantity has no value) is no failure. ProgramError:
    another one, with what the program said; LibraryError: there is no program."""
    _call([command, os.fspath(model), "-o", os.fspath(out), "-q", *_settings(set), *options], (0, 1))
    return Run(Path(os.fspath(out)))


def study(file: Any, out: Any, *, jobs: int | None = None, options: tuple[str, ...] = ()) -> Study:
    """`corot study FILE -o OUT`, which goes on where it was if OUT is there, and what it has left:
    `study(...).rows["quantity.peak"]` is an array, a number for each run.

    Exit code 1 (some runs failed) is no failure: column `status` says which. The rest as of `run`."""
    more = ["-j", str(jobs)] if jobs is not None else []
    _call(["study", os.fspath(file), "-o", os.fspath(out), "-q", *more, *options], (0, 1))
    return Study(Path(os.fspath(out)))
