"""Readers of the folders that the program corot writes."""
from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ._errors import FormatError, SystemRefusedError

#: Units of columns that have the same name in all tables, by what stands behind the last dot.
UNITS = {
    "t": "s", "h": "s",
    **dict.fromkeys(("kinetic", "elastic", "dissipated", "external_work", "balance", "frame_energy"), "J"),
    **dict.fromkeys(("ux", "uy", "uz"), "m"), **dict.fromkeys(("vx", "vy", "vz"), "m/s"),
    **dict.fromkeys(("ax", "ay", "az"), "m/s^2"), **dict.fromkeys(("fx", "fy", "fz"), "N"),
    **dict.fromkeys(("mx", "my", "mz"), "N m"), **dict.fromkeys(("px", "py", "pz"), "kg m/s"),
    **dict.fromkeys(("lx", "ly", "lz"), "kg m^2/s"), "angle_max": "rad", "angle_mean": "rad",
    "frequency": "Hz", "angular_frequency": "1/s", "growth": "1/s", "eigenvalue": "1/s^2",
    **dict.fromkeys(("mass_x", "mass_y", "mass_z"), "kg"),
}


def _open(path: Path) -> Any:
    try:
        return open(path, encoding="utf-8", newline="")
    except OSError as error:
        raise SystemRefusedError(f"{path}: cannot open it: {error.strerror}") from None


def _column(cells: list[str]) -> np.ndarray:
    """Numbers, nan where there is none; or texts, if one is no number."""
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells, dtype=object)


class Table(Mapping[str, np.ndarray]):
    """A table in columns: `table["corner.ux"]` is an array of doubles with nan for empty cells, or of
    texts. `units` has the unit of each column that has one; `len(table)` counts columns, `nrow` rows."""

    def __init__(self, columns: dict[str, np.ndarray], units: dict[str, str], path: str) -> None:
        self._columns, self.units, self.path = columns, units, path

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"{self.path} has no column {name!r}; it has {', '.join(self)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<Table {self.path}: {self.nrow} rows of {', '.join(self)}>"

    @property
    def nrow(self) -> int:
        return len(next(iter(self._columns.values()), ()))

    @property
    def array(self) -> np.ndarray:
        """The same as one structured array [nrow], a field a column."""
        kinds = [(name, column.dtype) for name, column in self.items()]
        array = np.zeros(self.nrow, kinds)
        for name, column in self.items():
            array[name] = column
        return array


def read_table(path: Any, units: Mapping[str, str] | None = None) -> Table:
    """A CSV file of corot's. SystemRefusedError: it cannot be read; FormatError: it has no head, or a
    row of another length than that."""
    path = Path(path)
    with _open(path) as file:
        try:
            rows = list(csv.reader(file))
        except (csv.Error, UnicodeDecodeError) as error:
            raise FormatError(f"{path}: {error}") from None
    if not rows or not rows[0]:
        raise FormatError(f"{path}: it has no head")
    head, rows = rows[0], rows[1:]
    if len(set(head)) < len(head):
        raise FormatError(f"{path}:1: two columns have one name")
    for i, row in enumerate(rows):
        if len(row) != len(head):
            raise FormatError(f"{path}:{i + 2}: {len(row)} cells, and the head has {len(head)}")
    columns = {name: _column([row[i] for row in rows]) for i, name in enumerate(head)}
    known = {name: unit for name in head if (unit := UNITS.get(name.rsplit(".", 1)[-1]))}
    known.update((k, v) for k, v in (units or {}).items() if k in columns)
    return Table(columns, known, str(path))


@dataclass(frozen=True)
class States:
    """states.bin: u and v of all degrees of freedom at the output times, to the last bit.

    t: [k] [s]; u, v: [k, n] [m], [m/s]; place: [n] 3 * node + component of each degree of freedom.
    """

    t: np.ndarray
    u: np.ndarray
    v: np.ndarray
    place: np.ndarray

    def nodal(self, nnode: int) -> np.ndarray:
        """u of all nodes [k, nnode, 3], zero where supports hold them."""
        out = np.zeros((len(self.t), 3 * nnode))
        out[:, self.place] = self.u
        return out.reshape(len(self.t), nnode, 3)


def read_states(path: Any) -> States:
    """Reads states.bin; the layout stands in src/app/folder/states.h. A piece of a record at the end, as
    a program that is killed may leave, is dropped. SystemRefusedError, FormatError as of read_table."""
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise SystemRefusedError(f"{path}: cannot read it: {error.strerror}") from None
    if len(data) < 24 or data[:8] != b"corot-st":
        raise FormatError(f"{path}: not a file of states")
    version, order = np.frombuffer(data, np.uint32, 2, 8).tolist()
    n = int(np.frombuffer(data, np.int64, 1, 16)[0])
    if order != 0x01020304:
        raise FormatError(f"{path}: written by a machine of another byte order")
    if version != 1:
        raise FormatError(f"{path}: version {version}; this package reads 1")
    start = 24 + 4 * (n + n % 2)
    if n < 0 or start > len(data):
        raise FormatError(f"{path}: {n} degrees of freedom in {len(data)} bytes")
    width = 1 + 2 * n
    count = (len(data) - start) // (8 * width)
    records = np.frombuffer(data, np.float64, count * width, start).reshape(count, width)
    return States(records[:, 0], records[:, 1 : n + 1], records[:, n + 1 :],
                  np.frombuffer(data, np.int32, n, 24))


def _read_map(path: Path) -> dict[str, Any]:
    """A JSON file that has a map."""
    with _open(path) as file:
        try:
            result = json.load(file)
        except ValueError as error:
            raise FormatError(f"{path}: {error}") from None
    if not isinstance(result, dict):
        raise FormatError(f"{path}: it has no map of results")
    return result


class Run:
    """The folder of a run, an equilibrium or modes. Tables are read when they are asked for: probes,
    energy, history, steps, reactions, compare, modes; then states, fields and result."""

    def __init__(self, folder: Any) -> None:
        self.folder = Path(folder)
        self.result  # noqa: B018: is it one?

    def __repr__(self) -> str:
        return f"<Run {self.folder}: {self.result.get('status')}>"

    @cached_property
    def result(self) -> dict[str, Any]:
        """result.json. SystemRefusedError, FormatError: there is none, or it is damaged."""
        return _read_map(self.folder / "result.json")

    @property
    def ok(self) -> bool:
        return self.result.get("status") == "ok"

    @property
    def warnings(self) -> list[str]:
        return [str(warning["text"]) for warning in self.result.get("warnings", [])]

    @property
    def quantities(self) -> dict[str, float]:
        """The values of the scenario's quantities by name; nan where one has none."""
        found = self.result.get("quantities", {})
        return {name: np.nan if (value := q.get("value")) is None else float(value)
                for name, q in found.items()}

    @cached_property
    def _units(self) -> dict[str, str]:
        """Units of the columns of probes, as result.json has them."""
        units = {}
        for name, probe in self.result.get("probes", {}).items():
            for column, unit in (probe.get("unit") or {}).items():
                units[f"{name}.{column}"] = unit
        return units

    def table(self, name: str) -> Table:
        """NAME.csv of the folder. SystemRefusedError: there is none."""
        return read_table(self.folder / f"{name}.csv", self._units)

    @cached_property
    def probes(self) -> Table:
        return self.table("probes")

    @cached_property
    def energy(self) -> Table:
        return self.table("energy")

    @cached_property
    def history(self) -> Table:
        return self.table("history")

    @cached_property
    def steps(self) -> Table:
        return self.table("steps")

    @cached_property
    def reactions(self) -> Table:
        return self.table("reactions")

    @cached_property
    def compare(self) -> Table:
        return self.table("compare")

    @cached_property
    def modes(self) -> Table:
        return self.table("modes")

    @cached_property
    def states(self) -> States:
        """Needs `output.states: binary` in the scenario."""
        return read_states(self.folder / "states.bin")

    @cached_property
    def fields(self) -> list[tuple[float, Path]]:
        """(t [s], path of the VTU file) of each moment, by fields.pvd; [] without fields."""
        path = self.folder / "fields.pvd"
        if not path.exists():
            return []
        with _open(path) as file:
            found = re.findall(r'timestep="([^"]+)"[^>]*file="([^"]+)"', file.read())
        return [(float(t), self.folder / name) for t, name in found]


class Study:
    """The folder of a study: `rows` has a row for each run, as `corot study csv` has."""

    def __init__(self, folder: Any) -> None:
        self.folder = Path(folder)
        self.rows  # noqa: B018: is it one?

    def __repr__(self) -> str:
        return f"<Study {self.folder}: {self.rows.nrow} runs>"

    @cached_property
    def result(self) -> dict[str, Any]:
        """table.json."""
        return _read_map(self.folder / "table.json")

    @cached_property
    def rows(self) -> Table:
        """table.csv: axes, costs, quantities and errors in columns."""
        return read_table(self.folder / "table.csv")

    @cached_property
    def runs(self) -> dict[str, Run]:
        """The folder of each run whose files are there, by its id."""
        folders = {str(name): self.folder / "runs" / str(name) for name in self.rows["id"]}
        return {name: Run(folder) for name, folder in folders.items()
                if (folder / "result.json").exists()}


def read(folder: Any) -> Run | Study:
    """The results in a folder: of a run, an equilibrium or modes a `Run`, of a study a `Study`.

    SystemRefusedError: the folder, or its result, is not there; FormatError: it is damaged."""
    folder = Path(os.fspath(folder))
    if (folder / "study.json").exists() and not (folder / "result.json").exists():
        return Study(folder)
    return Run(folder)
