"""The solid as an ordinary differential equation (corot/ode.h), and what comes in while a run goes on
(corot/inputs.h)."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _convert as cv
from ._errors import ClosedError, InvalidError, RetryError
from ._handle import Handle
from ._library import Pending, check, fail, ffi, lib
from ._mesh import Mesh
from ._model import Model

_FIELDS = {  # of corot_element_fields and corot_point_fields: shape of what one tet, or point, has
    "frame": (9,), "strain": (6,), "von_mises": (), "det": (), "stress": (6,), "principal": (3,),
    "frame_at": (4, 9), "strain_at": (4, 6), "von_mises_at": (4,), "det_at": (4,),
    "stress_at": (4, 6), "principal_at": (4, 3), "energy": (), "volume": (),
}


def _make_fields(kind: str, fields: Any, n: int) -> tuple[Any, dict[str, np.ndarray]]:
    """The structure with the fields that are asked for, and their arrays."""
    known = dict(ffi.typeof(kind).fields)
    names = list(known) if fields is None else [fields] if isinstance(fields, str) else list(fields)
    struct, arrays = ffi.new(kind + " *"), {}
    for name in names:
        if name not in known:
            raise InvalidError(f"no field {name!r}; there are: {', '.join(known)}")
        arrays[name] = np.zeros((n, *_FIELDS[name]))
        setattr(struct, name, ffi.cast(known[name].type, arrays[name].ctypes.data))
    return struct, arrays


class State(Handle):
    """What the evaluations of one run need beside the model: frames and scratch.

    The unknowns are u [n], displacements of the free degrees of freedom [m], and v [n], their velocities
    [m/s], n = model.ndof; M v' = r(t, u, v), t in s. Wherever a result is an array, `out` may say which
    one to write to. A state works for one thread at a time: another that comes waits.

    RetryError where a tet is inverted, of whatever evaluates forces; InvalidError where a component of u
    or v is not finite.
    """

    def __init__(self, model: Model) -> None:
        if not isinstance(model, Model):
            raise TypeError(f"model is a {type(model).__name__}, and a corot.Model is wanted")
        out = ffi.new("corot_state **")
        with model._guard:
            check(lib.corot_state_create(model._pointer, out))
            self._open(out[0], lib.corot_state_destroy, model)
        self.model = model
        self.inputs: Inputs | None = None
        self._m = model._pointer  # alive as long as this is
        self._n = int(lib.corot_model_ndof(self._m))
        self._nnode = int(lib.corot_model_mesh(self._m).nnode)

    def __repr__(self) -> str:
        return f"<State of {self.model!r}>"

    @property
    def threads(self) -> int:
        """How many threads share out what is evaluated and solved with this state: 1 at first. Results
        are the same to the last bit for every number. 0 takes as many as pay here for a model of this
        size. InvalidError above 256, MemoryError for a thread that the system does not start."""
        with self._guard:
            return int(lib.corot_state_thread_count(self._pointer))

    @threads.setter
    def threads(self, n: int) -> None:
        with self._guard:
            check(lib.corot_state_threads(self._pointer, n))

    @contextmanager
    def _evaluate(self) -> Iterator[Any]:
        """The state's pointer, for this thread alone, its inputs included."""
        with self._guard:
            pointer = self._pointer
            inputs = self.inputs
            if inputs is None:
                yield pointer
                return
            with inputs._guard:
                inputs._pointer  # noqa: B018: who closed it has closed its feedback
                yield pointer

    def _field(self, u: ArrayLike, name: str = "u") -> np.ndarray:
        return cv.reals(u, (self._n,), name)

    # Which law

    @property
    def frames(self) -> str:
        """exact, held or extrapolated; may be set."""
        with self._guard:
            return cv.word("corot_frames", lib.corot_state_frames(self._pointer))

    @frames.setter
    def frames(self, value: str) -> None:
        kind = cv.choose("corot_frames", value, "frames")
        with self._guard:
            lib.corot_state_use(self._pointer, kind)

    def enter(self, t: float) -> None:
        """From now on evaluations belong to the time after t and before the next kink
        (corot_state_enter); nan: each time has its own law."""
        with self._guard:
            lib.corot_state_enter(self._pointer, cv.real(t, "t"))

    def stand_still(self, t: float, factor: float = 1.0) -> None:
        """From now on evaluations are for statics, under `factor` times the loads of time t."""
        with self._guard:
            lib.corot_state_stand_still(self._pointer, cv.real(t, "t"), cv.real(factor, "factor"))

    def use(self, inputs: Inputs | None) -> None:
        """From now on evaluations see these inputs; None: none. Best before an integrator is made of the
        state. InvalidError: they are of another model, or an integrator would miss their energy."""
        if inputs is not None and not isinstance(inputs, Inputs):
            raise TypeError(f"inputs is a {type(inputs).__name__}, and a corot.Inputs is wanted")
        with self._guard:
            if inputs is None:
                check(lib.corot_state_use_inputs(self._pointer, ffi.NULL))
            else:
                with inputs._guard:
                    check(lib.corot_state_use_inputs(self._pointer, inputs._pointer))
            if inputs is not None:
                # C refers to them from now on: their memory stays as long as the state's.
                assert self._cell is not None and inputs._cell is not None
                if inputs._cell not in self._cell.owners:
                    self._cell.owners = (*self._cell.owners, inputs._cell)
            self.inputs = inputs

    # Right-hand sides and derivatives

    def residual(self, t: float, u: ArrayLike, v: ArrayLike, out: np.ndarray | None = None) -> np.ndarray:
        """r(t, u, v) [n] [N]: external, less internal and viscous forces."""
        t, u, v = cv.real(t, "t"), self._field(u), self._field(v, "v")
        r = cv.apart(cv.output(out, (self._n,)), u, v)
        with self._evaluate() as state:
            self._check(lib.corot_residual(self._m, state, t, cv.doubles(u), cv.doubles(v), cv.doubles(r)))
        return r

    #: Another name of `residual`.
    force = residual

    def rhs(self, t: float, y: ArrayLike, out: np.ndarray | None = None) -> np.ndarray:
        """y' = (v, M^-1 r) [2n] for y = (u, v) [2n]: what an integrator of ODEs wants, as solve_ivp's
        `fun`. InvalidError with consistent mass, which takes a factor of M (corot.MassSolver)."""
        t, y = cv.real(t, "t"), cv.reals(y, (2 * self._n,), "y")
        ydot = cv.apart(cv.output(out, (2 * self._n,)), y)
        with self._evaluate() as state:
            self._check(lib.corot_rhs(self._m, state, t, cv.doubles(y), cv.doubles(ydot)))
        return ydot

    def _check(self, status: int) -> None:
        if self.inputs is not None:
            self.inputs._pending.check(status)
        else:
            check(status)

    def jvp(self, t: float, u: ArrayLike, v: ArrayLike, du: ArrayLike, dv: ArrayLike,
            tangent: str = "exact", out: np.ndarray | None = None) -> np.ndarray:
        """dr/du du + dr/dv dv [n] [N], nothing left out. tangent: held, exact or clamped."""
        t, u, v = cv.real(t, "t"), self._field(u), self._field(v, "v")
        du, dv = self._field(du, "du"), self._field(dv, "dv")
        jv = cv.apart(cv.output(out, (self._n,)), u, v, du, dv)
        which = _tangent(tangent)
        with self._evaluate() as state:
            self._check(lib.corot_jvp(self._m, state, t, cv.doubles(u), cv.doubles(v), which,
                                      cv.doubles(du), cv.doubles(dv), cv.doubles(jv)))
        return jv

    def _blocks(self, state: Any, t: float, u: np.ndarray, v: np.ndarray, which: int, loads: bool,
                damping: bool) -> tuple[np.ndarray, np.ndarray | None]:
        nblock = lib.corot_model_nblock(self._m)
        K = np.zeros((nblock, 9))
        D = np.zeros((nblock, 9)) if damping else None
        kind = "double (*)[9]"
        self._check(lib.corot_jacobian(self._m, state, t, cv.doubles(u), cv.doubles(v), which,
                                       cv.address(kind, K), cv.address(kind, D)))
        if loads:
            lib.corot_load_stiffness(self._m, state, t, cv.doubles(u), cv.address(kind, K))
        return K, D

    def M(self) -> Any:
        """The model's mass in use, M [n, n] [kg], as scipy.sparse.csc_array.

        Of this and the next three: the values belong to the matrix, and C has written them there; the
        indices are the model's own, shared by all its matrices and for reading. `copy()` has its own."""
        pattern = self.model._pattern
        with self._guard:
            self._pointer  # noqa: B018
            return pattern.combine(self._m, 1.0, 0.0, ffi.NULL, 0.0, ffi.NULL)

    def K(self, t: float, u: ArrayLike, tangent: str = "exact", loads: bool = True) -> Any:
        """K = -dr/du [n, n] [N/m] at v = 0 as scipy.sparse.csc_array, symmetric: what it leaves out stands
        at corot_jacobian in corot/ode.h. loads: with the symmetric part of what a pressure adds as it
        turns with the surface."""
        return self._matrices(t, u, None, tangent, loads)[0]

    def D(self, t: float, u: ArrayLike, v: ArrayLike | None = None, tangent: str = "exact") -> Any:
        """D = -dr/dv [n, n] [N s/m], symmetric, as scipy.sparse.csc_array."""
        return self._matrices(t, u, v, tangent, False)[1]

    def matrices(self, t: float, u: ArrayLike, v: ArrayLike | None = None, tangent: str = "exact",
                 loads: bool = True) -> tuple[Any, Any, Any]:
        """M, K and D of one evaluation."""
        return (self.M(), *self._matrices(t, u, v, tangent, loads))

    def _matrices(self, t: float, u: ArrayLike, v: ArrayLike | None, tangent: str,
                  loads: bool) -> tuple[Any, Any]:
        t, u = cv.real(t, "t"), self._field(u)
        rest = np.zeros(self._n) if v is None else self._field(v, "v")
        which, pattern = _tangent(tangent), self.model._pattern
        with self._evaluate() as state:
            K, D = self._blocks(state, t, u, rest, which, loads, True)
            kind = "const double (*)[9]"
            return (pattern.combine(self._m, 0.0, 0.0, ffi.NULL, 1.0, cv.address(kind, K)),
                    pattern.combine(self._m, 0.0, 1.0, cv.address(kind, D), 0.0, ffi.NULL))

    def mass_multiply(self, x: ArrayLike, out: np.ndarray | None = None) -> np.ndarray:
        """M x [n]."""
        x = self._field(x, "x")
        y = cv.apart(cv.output(out, (self._n,)), x)
        with self._guard:
            self._pointer  # noqa: B018
            lib.corot_mass_multiply(self._m, cv.doubles(x), cv.doubles(y))
        return y

    # Energies and forces

    def energies(self, t: float, u: ArrayLike, v: ArrayLike) -> cv.Record:
        """kinetic, elastic [J], power_dissipated, power_external [W], momentum [kg m/s] and others
        (corot_energies)."""
        t, u, v = cv.real(t, "t"), self._field(u), self._field(v, "v")
        out = ffi.new("corot_energies *")
        with self._evaluate() as state:
            self._check(lib.corot_energy(self._m, state, t, cv.doubles(u), cv.doubles(v), out))
        return cv.record(out)

    def elastic_force(self, t: float, u: ArrayLike) -> np.ndarray:
        """Elastic force on all nodes [nnode, 3] [N], with exact frames."""
        t, u = cv.real(t, "t"), self._field(u)
        f = np.zeros((self._nnode, 3))
        with self._evaluate() as state:
            self._check(lib.corot_elastic_force(self._m, state, t, cv.doubles(u), cv.triples(f)))
        return f

    def internal_force(self, t: float, u: ArrayLike, strain: str, lambda_part: float = 1.0,
                       mu_part: float = 1.0) -> np.ndarray:
        """The same of any strain measure: lambda_part * (lambda term) + mu_part * (mu term)."""
        t, u = cv.real(t, "t"), self._field(u)
        f, name = np.zeros((self._nnode, 3)), cv.encode(strain, "strain")
        lam, mu = cv.real(lambda_part, "lambda_part"), cv.real(mu_part, "mu_part")
        with self._evaluate() as state:
            self._check(lib.corot_internal_force(self._m, state, t, cv.doubles(u), name, lam, mu,
                                                 cv.triples(f)))
        return f

    def forces(self, t: float, u: ArrayLike, v: ArrayLike | None = None,
               a: ArrayLike | None = None) -> dict[str, np.ndarray]:
        """internal, viscous, inertial and load [nnode, 3] [N] on all nodes, of displacement, velocity and
        acceleration (zero if they are not given), and reaction, the force of the supports on the
        body: internal + viscous + inertial - load."""
        t, u = cv.real(t, "t"), self._field(u)
        v = np.zeros(self._n) if v is None else self._field(v, "v")
        a = np.zeros(self._n) if a is None else self._field(a, "a")
        parts = {k: np.zeros((self._nnode, 3)) for k in ("internal", "viscous", "inertial", "load")}
        struct = ffi.new("corot_nodal_forces *", {k: cv.triples(part) for k, part in parts.items()})
        with self._evaluate() as state:
            self._check(lib.corot_forces(self._m, state, t, cv.doubles(u), cv.doubles(v), cv.doubles(a),
                                         struct))
        parts["reaction"] = parts["internal"] + parts["viscous"] + parts["inertial"] - parts["load"]
        return parts

    def load_force(self, t: float, factor: float = 1.0,
                   displacement: ArrayLike | None = None) -> np.ndarray:
        """Loads of time t, times `factor`, on all nodes [nnode, 3] [N] of the body displaced by
        `displacement` [nnode, 3] [m] (None: at rest)."""
        t, factor = cv.real(t, "t"), cv.real(factor, "factor")
        shape = (self._nnode, 3)
        where = np.zeros(shape) if displacement is None else cv.reals(displacement, shape, "displacement")
        f = np.zeros(shape)
        with self._guard:
            self._pointer  # noqa: B018
            check(lib.corot_load_force(self._m, t, factor, cv.triples(where), cv.triples(f)))
        return f

    # All nodes

    def nodal(self, t: float, u: ArrayLike, v: ArrayLike | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and velocity of all nodes [nnode, 3], those of moving supports included."""
        t, u = cv.real(t, "t"), self._field(u)
        v = np.zeros(self._n) if v is None else self._field(v, "v")
        x, dx = np.zeros((self._nnode, 3)), np.zeros((self._nnode, 3))
        with self._evaluate() as state:
            lib.corot_state_nodal(self._m, state, t, cv.doubles(u), cv.doubles(v), cv.triples(x),
                                  cv.triples(dx))
        return x, dx

    def nodal_motion(self, t: float, v: ArrayLike, a: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and acceleration of all nodes [nnode, 3], of which v and a [n] are the free ones."""
        t, v, a = cv.real(t, "t"), self._field(v, "v"), self._field(a, "a")
        dx, ddx = np.zeros((self._nnode, 3)), np.zeros((self._nnode, 3))
        with self._evaluate() as state:
            lib.corot_nodal_motion(self._m, state, t, cv.doubles(v), cv.doubles(a), cv.triples(dx),
                                   cv.triples(ddx))
        return dx, ddx

    def free(self, nodal: ArrayLike) -> np.ndarray:
        """Of values at all nodes [nnode, 3] those of the free degrees of freedom [n]."""
        values = cv.reals(nodal, (self._nnode, 3), "nodal")
        dof = self.model.dof
        out = np.zeros(self._n)
        out[dof[dof >= 0]] = values[dof >= 0]
        return out

    # Frames

    @property
    def inverted(self) -> int:
        """The tet whose inversion made the last evaluation fail; -1: none did."""
        with self._guard:
            return int(lib.corot_state_inverted(self._pointer))

    def _change(self, function: Any, t: float, u: ArrayLike) -> cv.Record:
        t, u, out = cv.real(t, "t"), self._field(u), ffi.new("corot_frames_change *")
        with self._evaluate() as state:
            self._check(function(self._m, state, t, cv.doubles(u), out))
        return cv.record(out)

    def update_frames(self, t: float, u: ArrayLike) -> cv.Record:
        """Sets the held frames to those of u; says how far they turned (corot_frames_change)."""
        return self._change(lib.corot_frames_update, t, u)

    def frames_drift(self, t: float, u: ArrayLike) -> cv.Record:
        """The same change, without making it."""
        return self._change(lib.corot_frames_drift, t, u)

    def spin_frames(self, t: float, u: ArrayLike, v: ArrayLike) -> float:
        """After an update: the spin at which extrapolated frames turn on; the largest [rad/s]."""
        t, u, v = cv.real(t, "t"), self._field(u), self._field(v, "v")
        out = ffi.new("double *")
        with self._evaluate() as state:
            self._check(lib.corot_frames_spin(self._m, state, t, cv.doubles(u), cv.doubles(v), out))
        return float(out[0])

    # Fields

    def elements(self, t: float, u: ArrayLike, fields: Any = None) -> dict[str, np.ndarray]:
        """Fields of the tets, by the names of corot_element_fields: frame [ntet, 9], strain and stress
        [ntet, 6] (xx yy zz xy yz xz), von_mises [Pa], det, principal, energy [J], volume [m^3], and at
        the points of integration. `fields`: a name, or several; None: all."""
        t, u = cv.real(t, "t"), self._field(u)
        ntet = int(lib.corot_model_mesh(self._m).ntet)
        struct, arrays = _make_fields("corot_element_fields", fields, ntet)
        with self._evaluate() as state:
            self._check(lib.corot_elements(self._m, state, t, cv.doubles(u), struct))
        return arrays

    def deformation(self, t: float, u: ArrayLike, strain_limit: float = 0.0,
                    turn_limit: float = 0.0) -> cv.Record:
        """How far u is from small strains and turns (corot_deformation). turn_limit in rad."""
        t, u, out = cv.real(t, "t"), self._field(u), ffi.new("corot_deformation *")
        limits = cv.real(strain_limit, "strain_limit"), cv.real(turn_limit, "turn_limit")
        with self._evaluate() as state:
            lib.corot_deformation_measure(self._m, state, t, cv.doubles(u), *limits, out)
        return cv.record(out)

    def stress_jumps(self, t: float, u: ArrayLike) -> float:
        """The share of the stress that jumps between tets (Zienkiewicz & Zhu 1987)."""
        t, u, out = cv.real(t, "t"), self._field(u), ffi.new("double *")
        with self._evaluate() as state:
            self._check(lib.corot_stress_jumps(self._m, state, t, cv.doubles(u), out))
        return float(out[0])

    @property
    def nbytes(self) -> int:
        """Memory held by the state."""
        with self._guard:
            return int(lib.corot_state_bytes(self._pointer))


def _tangent(value: str) -> int:
    which = cv.choose("corot_tangent", value, "tangent")
    if which < 0:
        raise InvalidError("tangent = 'auto': one of held, exact, clamped is wanted")
    return which


class Points(Handle):
    """Places in the body, at which fields are looked at one by one: tet [n], and volume coordinates in
    it, at [n, 4], as from Mesh.locate. InvalidError: there is no such tet."""

    def __init__(self, state: State, tet: ArrayLike, at: ArrayLike) -> None:
        tet = cv.indices(tet, (None,), "tet")
        at = cv.reals(at, (len(tet), 4), "at")
        out = ffi.new("corot_points **")
        with state._guard:
            state._pointer  # noqa: B018
            check(lib.corot_points_create(state._m, len(tet), cv.address("int *", tet),
                                          cv.address("double (*)[4]", at), out))
            self._open(out[0], lib.corot_points_destroy, state, guard=state._guard)
        self.state, self._count = state, len(tet)

    def evaluate(self, t: float, u: ArrayLike, fields: Any = None) -> dict[str, np.ndarray]:
        """Fields by the names of corot_point_fields, each [n, ...]. RetryError: the body is inverted at
        one of the points."""
        t, u = cv.real(t, "t"), self.state._field(u)
        struct, arrays = _make_fields("corot_point_fields", fields, self._count)
        with self.state._evaluate() as state:
            self.state._check(lib.corot_points_evaluate(self._pointer, state, t, cv.doubles(u), struct))
        return arrays


class Blocks:
    """Where a feedback puts its derivatives, as long as its function runs."""

    def __init__(self, pointer: Any) -> None:
        self._pointer = pointer

    def add(self, i: int, j: int, K: ArrayLike | None = None, D: ArrayLike | None = None) -> None:
        """Adds K = -df_i/du_j [3, 3] [N/m] and D = -df_i/dv_j [3, 3] [N s/m]. InvalidError: the nodes are
        not in one tet, or there is no such node."""
        if self._pointer is None:
            raise ClosedError("blocks are for use inside the function that they are handed to")
        K, D = cv.maybe_reals(K, (3, 3), "K"), cv.maybe_reals(D, (3, 3), "D")
        check(lib.corot_blocks_add(self._pointer, cv.whole(i, "i"), cv.whole(j, "j"), cv.doubles(K),
                                   cv.doubles(D)))


class _Callbacks:
    """Functions of yours as C calls them."""

    def __init__(self, nnode: int, pending: Pending) -> None:
        self.nnode, self.pending = nnode, pending

    def run(self, function: Callable[[], None]) -> int:
        """A status for C of what a function of yours did."""
        try:
            function()
        except RetryError as error:
            return fail(lib.COROT_RETRY, str(error) or "a feedback asks for a shorter step")
        except BaseException as error:  # noqa: BLE001: KeyboardInterrupt, too, is raised after the call
            self.pending.keep(error)
            return fail(lib.COROT_EINVAL, f"a feedback raised {type(error).__name__}: {error}")
        return int(lib.COROT_OK)

    def rows(self, pointer: Any) -> np.ndarray:
        """C's numbers of all nodes, to write to while the function runs."""
        return np.frombuffer(ffi.buffer(pointer, 24 * self.nnode), np.float64).reshape(-1, 3)

    def add(self, pointer: Any, value: Any, what: str) -> None:
        target = self.rows(pointer)
        target += cv.reals(value, (self.nnode, 3), what)

    def force(self, function: Callable[..., Any]) -> Any:
        def run(_data: Any, t: float, u: Any, v: Any, f: Any) -> int:
            return self.run(lambda: self.add(f, function(t, self.rows(u).copy(), self.rows(v).copy()),
                                             "what the feedback returned"))
        return ffi.callback("corot_feedback_force *", run, error=lib.COROT_EINVAL)

    def blocks(self, function: Callable[..., Any]) -> Any:
        def run(_data: Any, t: float, u: Any, v: Any, pointer: Any) -> int:
            blocks = Blocks(pointer)
            try:
                return self.run(lambda: function(t, self.rows(u).copy(), self.rows(v).copy(), blocks))
            finally:
                blocks._pointer = None
        return ffi.callback("corot_feedback_blocks *", run, error=lib.COROT_EINVAL)

    def change(self, function: Callable[..., Any]) -> Any:
        def run(_data: Any, t: float, u: Any, v: Any, du: Any, dv: Any, df: Any) -> int:
            return self.run(lambda: self.add(
                df, function(t, *(self.rows(each).copy() for each in (u, v, du, dv))),
                "what change returned"))
        return ffi.callback("corot_feedback_change *", run, error=lib.COROT_EINVAL)


class Inputs(Handle):
    """What comes in while a run goes on: forces, factors of loads and materials, paths of supports, and a
    feedback of your own (corot/inputs.h). State.use(inputs) makes a state see them. Change them
    between steps, then call Integrator.changed()."""

    def __init__(self, model: Model) -> None:
        if not isinstance(model, Model):
            raise TypeError(f"model is a {type(model).__name__}, and a corot.Model is wanted")
        out = ffi.new("corot_inputs **")
        with model._guard:
            check(lib.corot_inputs_create(model._pointer, out))
            self._open(out[0], lib.corot_inputs_destroy, model)
        self.model = model
        self._pending = Pending()
        self._kept: Any = None  # callbacks of the feedback in use
        mesh: Mesh = model.mesh
        self._nnode = mesh.nnode

    def _call(self, function: Any, *arguments: Any) -> None:
        with self._guard:
            check(function(self._pointer, *arguments))

    def _nodal(self, value: ArrayLike, name: str) -> np.ndarray:
        return cv.reals(value, (self._nnode, 3), name)

    def set_force(self, force: ArrayLike | None) -> None:
        """A force on each node [nnode, 3] [N] until it is set again; None: none."""
        f = None if force is None else self._nodal(force, "force")
        self._call(lib.corot_inputs_set_force, self._nnode, cv.triples(f))

    def ramp_force(self, t0: float, start: ArrayLike, t1: float, stop: ArrayLike) -> None:
        """The same along a straight line in time: `start` at t0, `stop` at t1 [s]."""
        a, b = self._nodal(start, "start"), self._nodal(stop, "stop")
        self._call(lib.corot_inputs_ramp_force, self._nnode, cv.real(t0, "t0"), cv.triples(a),
                   cv.real(t1, "t1"), cv.triples(b))

    def set_load(self, load: int, factor: float) -> None:
        """A factor of a load of the model, by its number."""
        self._call(lib.corot_inputs_set_load, cv.whole(load, "load"), cv.real(factor, "factor"))

    def ramp_load(self, load: int, t0: float, start: float, t1: float, stop: float) -> None:
        """The same along a straight line in time."""
        self._call(lib.corot_inputs_ramp_load, cv.whole(load, "load"), cv.real(t0, "t0"),
                   cv.real(start, "start"), cv.real(t1, "t1"), cv.real(stop, "stop"))

    def set_material(self, material: int, *, lambda_: float = 1.0, mu: float = 1.0,
                     damping_lambda: float = 1.0, damping_mu: float = 1.0) -> None:
        """Factors of a material's coefficients, by its number."""
        factors = ffi.new("corot_material_factors *", {
            "lambda": cv.real(lambda_, "lambda_"), "mu": cv.real(mu, "mu"),
            "damping_lambda": cv.real(damping_lambda, "damping_lambda"),
            "damping_mu": cv.real(damping_mu, "damping_mu")})
        self._call(lib.corot_inputs_set_material, cv.whole(material, "material"), factors)

    def reset_material(self, material: int) -> None:
        """Back to the material's own coefficients."""
        self._call(lib.corot_inputs_set_material, cv.whole(material, "material"), ffi.NULL)

    def _path(self, group: str, t: float, x: ArrayLike, v: ArrayLike | None,
              a: ArrayLike | None) -> tuple[Any, Any]:
        rows = cv.reals(np.atleast_2d(np.asarray(x)), (None, 3), "x")
        arrays = [rows] + [
            None if value is None else cv.reals(np.atleast_2d(np.asarray(value)), rows.shape, name)
            for value, name in ((v, "v"), (a, "a"))]
        name = ffi.new("char[]", cv.encode(group, "group"))
        path = ffi.new("corot_path *", {"group": name, "t": cv.real(t, "t"), "n": len(rows),
                                        **dict(zip("xva", map(cv.triples, arrays)))})
        return path, (arrays, name)

    def set_path(self, group: str, t: float, x: ArrayLike, v: ArrayLike | None = None,
                 a: ArrayLike | None = None) -> None:
        """From t [s] on the group is at x + v s + a s^2 / 2 at time t + s: [3], or a row [3] for each of
        its nodes, in m, m/s, m/s^2. InvalidError: it jumps there, or the model holds nothing of it."""
        path, _keep = self._path(group, t, x, v, a)
        self._call(lib.corot_inputs_set_path, path)

    def start_path(self, group: str, t: float, x: ArrayLike, v: ArrayLike | None = None,
                   a: ArrayLike | None = None) -> None:
        """The same wherever the group has been: for the start of a run."""
        path, _keep = self._path(group, t, x, v, a)
        self._call(lib.corot_inputs_start_path, path)

    def reach(self, t0: float, group: str, t: float, x: ArrayLike, v: ArrayLike | None = None,
              a: ArrayLike | None = None) -> None:
        """On from where the group is at t0, so as to be at x at time t, with v, and a, if given."""
        path, _keep = self._path(group, t, x, v, a)
        self._call(lib.corot_inputs_reach, cv.real(t0, "t0"), path)

    def release(self, group: str, t: float) -> None:
        """Back to what the model says of the group. InvalidError: there it would jump at t."""
        name = ffi.new("char[]", cv.encode(group, "group"))
        self._call(lib.corot_inputs_release, name, cv.real(t, "t"))

    def set_feedback(self, force: Callable[..., Any] | None,
                     blocks: Callable[..., Any] | None = None,
                     change: Callable[..., Any] | None = None, name: str = "feedback") -> None:
        """A force that depends on the motion; None: none.

        force(t, u, v) returns the force on each node [nnode, 3] [N], of displacements and velocities of
        all nodes [nnode, 3]; blocks(t, u, v, blocks) adds its derivatives by blocks.add(i, j, K, D);
        change(t, u, v, du, dv) returns the change of the force in a direction [nnode, 3]. The arrays
        are yours to keep. What a function raises ends the step, and comes out of the call that
        made it; RetryError asks for a shorter step instead."""
        if force is None:
            self._call(lib.corot_inputs_set_feedback, ffi.NULL)
            self._kept = None
            return
        callbacks = _Callbacks(self._nnode, self._pending)
        kept = {"force": callbacks.force(force)}
        if blocks is not None:
            kept["blocks"] = callbacks.blocks(blocks)
        if change is not None:
            kept["change"] = callbacks.change(change)
        label = ffi.new("char[]", cv.encode(name, "name"))
        feedback = ffi.new("corot_feedback *", {"name": label, **kept})
        with self._guard:
            check(lib.corot_inputs_set_feedback(self._pointer, feedback))
            self._kept = kept  # evaluations want these inputs open, and so these are there

    @property
    def nbytes(self) -> int:
        """Memory held by the inputs."""
        with self._guard:
            return int(lib.corot_inputs_bytes(self._pointer))


