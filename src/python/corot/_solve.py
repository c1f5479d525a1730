"""Linear algebra of an implicit step (corot/solve.h), equilibria (corot/statics.h), modes
(corot/modes.h) and the space error (corot/space.h)."""
from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _convert as cv
from ._errors import InvalidError
from ._handle import Handle
from ._library import Pending, check, ffi, lib, need, text
from ._model import Model
from ._state import Inputs, State, _tangent

# --- Linear algebra -------------------------------------------------------------------------------


def _linear(given: Any, keep: list[Any]) -> Any:
    """A corot_linear_def of the name of a solver, a mapping of fields, or None."""
    definition = ffi.new("corot_linear_def *")
    lib.corot_linear_set_defaults(definition, ffi.sizeof("corot_linear_def"))
    fields = {} if given is None else given if isinstance(given, Mapping) else {"solver": given}
    cv.fill(definition, fields, keep, "a linear solver")
    return definition


class Pencil(Handle):
    """S = a M + b D + c K of an implicit step, with its factor: for loops of your own. `linear` is the
    name of a solver ("auto", "klu", "cholmod", "pcg"), or a mapping of the fields of
    corot_linear_def. The order is: assemble, combine, factor, solve."""

    def __init__(self, state: State, linear: Any = None) -> None:
        need("corot_pencil_create", "a pencil")
        keep: list[Any] = []
        definition, out = _linear(linear, keep), ffi.new("corot_pencil **")
        with state._evaluate() as pointer:
            check(lib.corot_pencil_create(state._m, pointer, definition, out))
            self._open(out[0], lib.corot_pencil_destroy, state, guard=state._guard)
        self.state = state

    def _call(self, function: Any, *arguments: Any) -> None:
        with self.state._evaluate():
            self.state._check(function(self._pointer, *arguments))

    @property
    def solver(self) -> str:
        """The linear solver chosen, with what it was chosen with."""
        with self._guard:
            return text(lib.corot_pencil_solver(self._pointer))

    def use(self, tangent: str) -> None:
        """Which derivative of the frames K uses: held (at first), exact, clamped."""
        which = _tangent(tangent)
        with self._guard:
            lib.corot_pencil_use(self._pointer, which)

    def assemble(self, t: float, u: ArrayLike, v: ArrayLike | None = None) -> None:
        """K and D at (t, u, v)."""
        u = self.state._field(u)
        v = np.zeros(self.state._n) if v is None else self.state._field(v, "v")
        self._call(lib.corot_pencil_assemble, cv.real(t, "t"), cv.doubles(u), cv.doubles(v))

    def combine(self, a: float, b: float, c: float) -> None:
        """S = a M + b D + c K."""
        abc = cv.real(a, "a"), cv.real(b, "b"), cv.real(c, "c")
        with self._guard:
            lib.corot_pencil_combine(self._pointer, *abc)

    def factor(self) -> None:
        """Factors S. SingularError: no pivot; RetryError: in statics, not positive definite;
        InvalidError: there is no S."""
        self._call(lib.corot_pencil_factor)

    def _solve(self, function: Any, b: ArrayLike, n: int, name: str) -> np.ndarray:
        b = cv.reals(b, (n,), name)
        x = np.zeros(n)
        self._call(function, cv.doubles(b), cv.doubles(x))
        return x

    def solve(self, b: ArrayLike) -> np.ndarray:
        """S^-1 b [n]. InvalidError: S has no factor; RetryError: pcg did not converge."""
        return self._solve(lib.corot_pencil_solve, b, self.state._n, "b")

    def newton(self, r: ArrayLike) -> np.ndarray:
        """(I - g J)^-1 r [2n] of y' = f(t, y), at the g of the last combination (1, g, g^2)."""
        return self._solve(lib.corot_pencil_newton, r, 2 * self.state._n, "r")

    def newton_dae(self, F: ArrayLike) -> np.ndarray:
        """(dF/dy + dF/dy' / g)^-1 F [2n] of F = (u' - v, M v' - r)."""
        return self._solve(lib.corot_pencil_newton_dae, F, 2 * self.state._n, "F")

    def invalidate(self) -> None:
        """Marks K and D as out of date."""
        with self._guard:
            lib.corot_pencil_invalidate(self._pointer)

    @property
    def statistics(self) -> cv.Record:
        """Counts and times (corot_pencil_counts)."""
        with self._guard:
            return cv.record(lib.corot_pencil_statistics(self._pointer))


class MassSolver(Handle):
    """M^-1: a division where M is lumped, a factor computed once where it is consistent."""

    def __init__(self, model: Model) -> None:
        need("corot_mass_solver_create", "a mass solver")
        out = ffi.new("corot_mass_solver **")
        with model._guard:
            check(lib.corot_mass_solver_create(model._pointer, out))
            self._open(out[0], lib.corot_mass_solver_destroy, model)
        self._n = model.ndof

    def solve(self, b: ArrayLike) -> np.ndarray:
        """M^-1 b [n]."""
        b, x = cv.reals(b, (self._n,), "b"), np.zeros(self._n)
        with self._guard:
            check(lib.corot_mass_solve(self._pointer, cv.doubles(b), cv.doubles(x)))
        return x


def _stop_callback(function: Callable[[], bool], pending: Pending) -> Any:
    def run(_data: Any) -> bool:
        try:
            return bool(function())
        except BaseException as error:  # noqa: BLE001: raised after the call
            pending.keep(error)
            return True
    return ffi.callback("bool(void *)", run, error=True)


# --- Equilibria -----------------------------------------------------------------------------------


class Statics(Handle):
    """Load stepping from load factor 0 to 1 of the loads of time t [s], from u0 [n] (None: at rest).

    Settings are keywords named as in corot_statics_def: linear, frames, tolerance, max_iterations,
    first_step, min_step, max_step, follow_unstable. stop: a function that is asked in every iteration;
    True ends the step with IntegrationError. inputs: what comes in beside the model.

    SingularError: nothing holds the body against some rigid motion, which the message names.
    """

    def __init__(self, model: Model, t: float = 0.0, u0: ArrayLike | None = None, *,
                 inputs: Inputs | None = None, stop: Callable[[], bool] | None = None,
                 **settings: Any) -> None:
        need("corot_statics_create", "equilibria")
        definition, keep = ffi.new("corot_statics_def *"), []
        lib.corot_statics_set_defaults(definition, ffi.sizeof("corot_statics_def"))
        cv.fill(definition, settings, keep, "Statics", ("stop", "stop_data", "inputs"))
        self._pending, self._inputs = Pending(), inputs
        if stop is not None:
            self._stop = _stop_callback(stop, self._pending)
            definition.stop = self._stop
        pointer, _cell = model._borrow()
        self._n = int(lib.corot_model_ndof(pointer))
        u0 = cv.maybe_reals(u0, (self._n,), "u0")
        t, out = cv.real(t, "t"), ffi.new("corot_statics **")
        with self._seeing_inputs():
            if inputs is not None:
                if inputs.model is not model:
                    raise InvalidError("the inputs are those of another model")
                definition.inputs = inputs._pointer
            self._check(lib.corot_statics_create(definition, pointer, t, cv.doubles(u0), out))
        parents = (model,) if inputs is None else (model, inputs)
        self._open(out[0], lib.corot_statics_destroy, *parents)
        self.model = model

    @contextmanager
    def _seeing_inputs(self) -> Iterator[None]:
        if self._inputs is None:
            yield
        else:
            with self._inputs._guard:
                yield

    def _check(self, status: int) -> None:
        self._pending.raise_kept()
        if self._inputs is not None:
            self._inputs._pending.raise_kept()
        check(status)

    def step(self) -> cv.Record:
        """One load step: factor reached, length, iterations, rejected, force [N], residual [k] [N],
        rounding, stability. IntegrationError: there is no way on; what was reached remains readable.
        InvalidError: the full load was reached before."""
        out = ffi.new("corot_load_step *")
        with self._guard, self._seeing_inputs():
            self._check(lib.corot_statics_step(self._pointer, out))
            residual = np.frombuffer(ffi.buffer(out.residual, 8 * out.nresidual), np.float64).copy()
        return cv.Record("load_step", {**cv.record(out), "residual": residual})

    def solve(self) -> None:
        """Load steps to the end. Failures as of `step`."""
        with self._guard, self._seeing_inputs():
            self._check(lib.corot_statics_solve(self._pointer))

    @property
    def factor(self) -> float:
        """The load factor reached."""
        with self._guard:
            return float(lib.corot_statics_at(self._pointer, ffi.NULL))

    @property
    def u(self) -> np.ndarray:
        """The equilibrium reached [n] [m]; a new array each time."""
        u = np.zeros(self._n)
        with self._guard:
            lib.corot_statics_at(self._pointer, cv.doubles(u))
        return u

    @property
    def critical(self) -> tuple[float, float]:
        """The load factors between which stability was lost; nan: nowhere so far."""
        stable, unstable = ffi.new("double *"), ffi.new("double *")
        with self._guard:
            lib.corot_statics_critical(self._pointer, stable, unstable)
        return float(stable[0]), float(unstable[0])

    @property
    def statistics(self) -> cv.Record:
        """Counts and times (corot_statics_counts)."""
        with self._guard:
            return cv.record(lib.corot_statics_statistics(self._pointer))

    @property
    def solver(self) -> str:
        """The linear solver in use."""
        with self._guard:
            return text(lib.corot_statics_solver(self._pointer))

    @property
    def nbytes(self) -> int:
        """Memory of the evaluations' scratch."""
        with self._guard:
            return int(lib.corot_statics_bytes(self._pointer))


class Equilibrium(NamedTuple):
    """What `statics` found: u [n] [m], the load steps that led there, and counts."""

    u: np.ndarray
    steps: list[cv.Record]
    statistics: cv.Record


def statics(model: Model, t: float = 0.0, u0: ArrayLike | None = None, **settings: Any) -> Equilibrium:
    """The equilibrium under the loads of time t [s]: `Statics` to the end. Arguments and failures as
    there."""
    with Statics(model, t, u0, **settings) as solver:
        steps = [solver.step()]
        while steps[-1].factor < 1:
            steps.append(solver.step())
        return Equilibrium(solver.u, steps, solver.statistics)


# --- Modes ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Modes:
    """Modes by ascending w^2. frequency [k] [Hz], eigenvalue [k] w^2 [1/s^2], growth [k] [1/s] of
    unstable ones, residual [k], effective_mass [k, 3] [kg], shape [k, n] with x' M x = 1 kg m^2; facts:
    about all of them (corot_modes_facts)."""

    frequency: np.ndarray
    eigenvalue: np.ndarray
    growth: np.ndarray
    residual: np.ndarray
    effective_mass: np.ndarray
    shape: np.ndarray
    facts: cv.Record


def modes_available() -> bool:
    """Whether this build has ARPACK."""
    return hasattr(lib, "corot_modes_available") and bool(lib.corot_modes_available())


def modes(model: Model, count: int = 10, t: float = 0.0, u: ArrayLike | None = None, *,
          stop: Callable[[], bool] | None = None, **settings: Any) -> Modes:
    """The modes of least frequency about u [n] under the loads of time t, or about rest (u = None).

    Settings as in corot_modes_def: linear, tolerance, max_restarts. stop: a function that is asked at
    every solution; True ends it with IntegrationError. InvalidError: this build has no ARPACK, there are
    not so many modes, or K of this model is not all there; SingularError, RetryError as of Statics."""
    need("corot_modes_find", "modes")
    definition, keep, pending = ffi.new("corot_modes_def *"), [], Pending()
    lib.corot_modes_set_defaults(definition, ffi.sizeof("corot_modes_def"))
    cv.fill(definition, settings, keep, "modes", ("stop", "stop_data", "count"))
    definition.count = cv.whole(count, "count")
    if stop is not None:
        keep.append(_stop_callback(stop, pending))
        definition.stop = keep[-1]
    pointer, _cell = model._borrow()
    n = int(lib.corot_model_ndof(pointer))
    u = cv.maybe_reals(u, (n,), "u")
    t, out = cv.real(t, "t"), ffi.new("corot_modes **")
    check(lib.corot_modes_check(definition, pointer, t, u is None))
    pending.check(lib.corot_modes_find(definition, pointer, t, cv.doubles(u), out))
    try:
        return _copy_modes(out[0], n)
    finally:
        lib.corot_modes_destroy(out[0])


def _copy_modes(pointer: Any, n: int) -> Modes:
    found = [lib.corot_modes_at(pointer, i) for i in range(lib.corot_modes_count(pointer))]
    shape = np.array([np.frombuffer(ffi.buffer(m.shape, 8 * n), np.float64) for m in found])
    numbers = (np.array([getattr(m, name) for m in found])
               for name in ("frequency", "eigenvalue", "growth", "residual"))
    mass = np.array([list(m.effective_mass) for m in found])
    return Modes(*numbers, mass, shape.reshape(len(found), n), cv.record(lib.corot_modes_known(pointer)))


# --- The space error ------------------------------------------------------------------------------


def _moment(model: Any, t: float, u: ArrayLike, v: ArrayLike | None, load_t: float | None,
            factor: float, keep: list[Any]) -> Any:
    n = int(lib.corot_model_ndof(model))
    u = cv.reals(u, (n,), "u")
    v = np.zeros(n) if v is None else cv.reals(v, (n,), "v")
    keep += [u, v]
    still = load_t is not None
    return ffi.new("corot_space_moment *", {
        "t": cv.real(t, "t"), "u": cv.doubles(u), "v": cv.doubles(v), "still": still,
        "load_t": cv.real(load_t, "load_t") if still else 0.0, "factor": cv.real(factor, "factor")})


def space_error(model: Model, t: float, u: ArrayLike, v: ArrayLike | None = None, *,
                load_t: float | None = None, factor: float = 1.0, linear: Any = None
                ) -> tuple[cv.Record, np.ndarray]:
    """How much of the deformation four-node tets leave out: an estimate (error and displacement [m],
    relative, ...), and what is to be added to u at the model's nodes [nnode, 3] [m].

    load_t: u is an equilibrium, under `factor` times the loads of that time; None: in motion, with
    velocities v. InvalidError: ten-node tets, or a hierarchy; RetryError, SingularError: a tet is
    inverted, or there is no solution."""
    need("corot_space_error", "the space error")
    keep: list[Any] = []
    solver = ffi.NULL if linear is None else _linear(linear, keep)
    pointer, _cell = model._borrow()
    at = _moment(pointer, t, u, v, load_t, factor, keep)
    correction = np.zeros((int(lib.corot_model_mesh(pointer).nnode), 3))
    out = ffi.new("corot_space_estimate *")
    check(lib.corot_space_error(model._definition, pointer, at, solver, cv.triples(correction), out))
    return cv.record(out), correction


def space_indicators(model: Model, t: float, u: ArrayLike, v: ArrayLike | None = None, *,
                     goal: ArrayLike | None = None, load_t: float | None = None, factor: float = 1.0,
                     linear: Any = None) -> tuple[np.ndarray, cv.Record]:
    """Where the error comes from: an indicator for each tet [ntet] [J], or with the derivative `goal` [n]
    of a goal in its unit; and the total (corot_space_total). The rest as of space_error."""
    need("corot_space_indicators", "the space error")
    keep: list[Any] = []
    solver = ffi.NULL if linear is None else _linear(linear, keep)
    pointer, _cell = model._borrow()
    at = _moment(pointer, t, u, v, load_t, factor, keep)
    g = cv.maybe_reals(goal, (int(lib.corot_model_ndof(pointer)),), "goal")
    indicator = np.zeros(int(lib.corot_model_mesh(pointer).ntet))
    out = ffi.new("corot_space_total *")
    check(lib.corot_space_indicators(pointer, at, cv.doubles(g), solver, cv.doubles(indicator), out))
    return indicator, cv.record(out)


def mark(indicator: ArrayLike, fraction: float) -> np.ndarray:
    """The fewest tets that carry this fraction of the sum of the indicators [ntet], ascending: for
    Mesh.refine_marked (Doerfler 1996). InvalidError: the fraction is not above 0 and at most 1, or an
    indicator is negative or no number."""
    need("corot_space_mark", "marks")
    values = cv.reals(indicator, (None,), "indicator")
    count, marks = ffi.new("int *"), np.zeros(len(values), np.intc)
    check(lib.corot_space_mark(len(values), cv.doubles(values), cv.real(fraction, "fraction"), count,
                               cv.address("int *", marks)))
    return marks[: count[0]].copy()
