"""What a model is made of, and the model itself (corot/model.h)."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _convert as cv
from ._errors import InvalidError
from ._handle import Handle
from ._library import check, ffi, lib, text
from ._mesh import Mesh, Refinement

Vector = Union[Sequence[float], np.ndarray]


@dataclass(frozen=True)
class Material:
    """Isotropic visco-elastic material: sigma(e) = lambda tr(e) I + 2 mu e, and the same law with the
    damping coefficients on the strain rate. `lambda_` and `mu` [Pa], density [kg/m^3], damping [Pa s],
    damping_mass [1/s], Rayleigh's force -damping_mass M v.

    group: the tets it fills; None: all that no other material names.
    """

    lambda_: float
    mu: float
    density: float
    group: str | None = None
    damping_lambda: float = 0.0
    damping_mu: float = 0.0
    damping_mass: float = 0.0

    @classmethod
    def engineering(cls, young: float, poisson: float, density: float, **more: Any) -> Material:
        """By Young's modulus E [Pa] and Poisson's ratio nu, -1 < nu < 1/2:
        lambda = E nu / ((1 + nu) (1 - 2 nu)), mu = E / (2 (1 + nu)) (any textbook of elasticity).
        InvalidError: nu is out of this range."""
        if not -1 < poisson < 0.5:
            raise InvalidError(f"poisson = {poisson} is not between -1 and 1/2")
        lam = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        return cls(lam, young / (2 * (1 + poisson)), density, **more)


@dataclass(frozen=True)
class Amplitude:
    """A factor in time. By `linear`, `smooth` or `sine`; wherever one is wanted a list of pairs
    [(t, value), ...] will do for a linear one, and None for one at all times."""

    time: tuple[float, ...] = ()
    value: tuple[float, ...] = ()
    curve: Literal["linear", "smooth", "sine"] = "linear"
    frequency: float = 0.0
    phase: float = 0.0
    offset: float = 0.0

    @classmethod
    def linear(cls, time: Iterable[float], value: Iterable[float]) -> Amplitude:
        """Linear between points, constant beyond them; two points at one time [s] are a jump."""
        return cls(tuple(map(float, time)), tuple(map(float, value)))

    @classmethod
    def smooth(cls, time: Iterable[float], value: Iterable[float]) -> Amplitude:
        """The cubic spline through the points, flat at the first and the last."""
        return cls(tuple(map(float, time)), tuple(map(float, value)), "smooth")

    @classmethod
    def sine(cls, frequency: float, phase: float = 0.0, offset: float = 0.0) -> Amplitude:
        """offset + sin(2 pi frequency t + phase), frequency in Hz, phase in rad."""
        return cls((), (), "sine", frequency, phase, offset)


AmplitudeLike = Union[Amplitude, Iterable["tuple[float, float]"], None]


@dataclass(frozen=True)
class Fix:
    """Displacement components of a group's nodes held at zero: Fix("base"), Fix("side", "x")."""

    group: str
    components: str = "xyz"


@dataclass(frozen=True)
class Load:
    """A load, by `traction`, `pressure`, `force` or `gravity`."""

    kind: Literal["traction", "gravity", "force", "pressure"]
    group: str | None
    value: tuple[float, float, float]
    amplitude: AmplitudeLike = None

    @classmethod
    def traction(cls, group: str, value: Vector, amplitude: AmplitudeLike = None) -> Load:
        """Force per rest area [3] [Pa] on the group's triangles, in a fixed direction."""
        return cls("traction", group, _three(value), amplitude)

    @classmethod
    def pressure(cls, group: str, value: float, amplitude: AmplitudeLike = None) -> Load:
        """[Pa] on the deformed area of the group's triangles, against their outward normal."""
        return cls("pressure", group, (cv.real(value, "pressure"), 0.0, 0.0), amplitude)

    @classmethod
    def force(cls, group: str, value: Vector, amplitude: AmplitudeLike = None) -> Load:
        """Total force [3] [N], spread evenly over the group's nodes, in a fixed direction."""
        return cls("force", group, _three(value), amplitude)

    @classmethod
    def gravity(cls, value: Vector = (0.0, 0.0, -9.81), amplitude: AmplitudeLike = None) -> Load:
        """Acceleration of the whole body [3] [m/s^2]."""
        return cls("gravity", None, _three(value), amplitude)


@dataclass(frozen=True)
class Motion:
    """Nodes of a group on a prescribed path, by `rotate`, `translate`, `turn` or `move`."""

    kind: Literal["rotate", "translate", "turn", "move"]
    group: str
    axis: tuple[float, float, float] = (0.0, 0.0, 0.0)
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float = 0.0
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    start: float = 0.0
    stop: float = float("inf")
    angle: float = 0.0
    direction: tuple[float, float, float] = (0.0, 0.0, 0.0)
    amplitude: AmplitudeLike = None

    @classmethod
    def rotate(cls, group: str, axis: Vector, rate: float, center: Vector = (0, 0, 0),
               start: float = 0.0, stop: float = float("inf")) -> Motion:
        """About an axis [3] through a center [3] [m] at a rate [rad/s], right-handed, between two
        times [s]."""
        return cls("rotate", group, axis=_three(axis), center=_three(center), rate=rate, start=start,
                   stop=stop)

    @classmethod
    def translate(cls, group: str, velocity: Vector, start: float = 0.0,
                  stop: float = float("inf")) -> Motion:
        """At a velocity [3] [m/s], between two times [s]."""
        return cls("translate", group, velocity=_three(velocity), start=start, stop=stop)

    @classmethod
    def turn(cls, group: str, axis: Vector, angle: float, amplitude: AmplitudeLike,
             center: Vector = (0, 0, 0)) -> Motion:
        """About an axis [3] through a center [3] [m], by amplitude(t) times an angle [rad]."""
        return cls("turn", group, axis=_three(axis), center=_three(center), angle=angle,
                   amplitude=amplitude)

    @classmethod
    def move(cls, group: str, direction: Vector, amplitude: AmplitudeLike) -> Motion:
        """Displaced by amplitude(t) times a direction [3] [m]."""
        return cls("move", group, direction=_three(direction), amplitude=amplitude)


@dataclass(frozen=True)
class Hierarchy:
    """A strain measure of its own for level 0 of a refined mesh (corot_hierarchy_def). `refinement`
    comes from Mesh.refine(..., return_refinement=True), of the mesh that the model is made of."""

    refinement: Refinement = field(repr=False)
    coarse_strain: str = "green"
    frame_level: int = 0
    conservative: bool = True
    coupling: Literal["mean", "nodes", "one_way"] = "mean"


def _three(value: Any, name: str = "a vector") -> tuple[float, float, float]:
    a, b, c = cv.reals(value, (3,), name).tolist()
    return a, b, c


class _Writer:
    """Writes what a model is made of into structures of C, and keeps what they point to."""

    def __init__(self) -> None:
        self.keep: list[Any] = []

    def name(self, value: str | None, what: str) -> Any:
        if value is None:
            return ffi.NULL
        self.keep.append(ffi.new("char[]", cv.encode(value, what)))
        return self.keep[-1]

    def numbers(self, value: Iterable[float], what: str) -> Any:
        self.keep.append(cv.reals(list(value), (None,), what))
        return cv.doubles(self.keep[-1])

    def array(self, kind: str, items: Sequence[Any], write: Any, wanted: type, what: str) -> Any:
        if not items:
            return ffi.NULL
        array = ffi.new(f"{kind}[]", len(items))
        self.keep.append(array)
        for i, item in enumerate(items):
            if not isinstance(item, wanted):
                raise TypeError(f"{what} {i} is a {type(item).__name__}, and a corot."
                                f"{wanted.__name__} is wanted")
            write(array[i], item)
        return array

    def amplitude(self, to: Any, value: AmplitudeLike) -> None:
        if value is None:
            return
        if not isinstance(value, Amplitude):
            pairs = cv.reals(value if isinstance(value, np.ndarray) else list(value), (None, 2),
                             "an amplitude")
            value = Amplitude(tuple(pairs[:, 0]), tuple(pairs[:, 1]))
        if len(value.time) != len(value.value):
            raise InvalidError(f"an amplitude has {len(value.time)} times and {len(value.value)} values")
        to.n = len(value.time)
        to.time = self.numbers(value.time, "the times of an amplitude")
        to.value = self.numbers(value.value, "the values of an amplitude")
        to.curve = cv.choose("corot_curve", value.curve, "the curve of an amplitude")
        for name in ("frequency", "phase", "offset"):
            setattr(to, name, cv.real(getattr(value, name), name))

    def material(self, to: Any, m: Material) -> None:
        to.group = self.name(m.group, "the group of a material")
        for name in ("lambda", "mu", "density", "damping_lambda", "damping_mu", "damping_mass"):
            given = m.lambda_ if name == "lambda" else getattr(m, name)
            setattr(to, name, cv.real(given, name))

    def fix(self, to: Any, f: Fix) -> None:
        to.group = self.name(f.group, "the group of a fix")
        if not f.components or set(f.components) - set("xyz"):
            raise InvalidError(f"a fix of '{f.group}' holds '{f.components}': letters of xyz are wanted")
        to.component = [c in f.components for c in "xyz"]

    def load(self, to: Any, load: Load) -> None:
        to.kind = cv.choose("corot_load_kind", load.kind, "the kind of a load")
        to.group = self.name(load.group, "the group of a load")
        to.value = list(_three(load.value, "the value of a load"))
        self.amplitude(to.amplitude, load.amplitude)

    def motion(self, to: Any, m: Motion) -> None:
        to.kind = cv.choose("corot_motion_kind", m.kind, "the kind of a motion")
        to.group = self.name(m.group, "the group of a motion")
        for name in ("axis", "center", "velocity", "direction"):
            setattr(to, name, list(_three(getattr(m, name), f"the {name} of a motion")))
        to.rate, to.angle = cv.real(m.rate, "rate"), cv.real(m.angle, "angle")
        setattr(to, "from", cv.real(m.start, "start"))
        to.to = cv.real(m.stop, "stop")
        self.amplitude(to.amplitude, m.amplitude)

    def hierarchy(self, h: Hierarchy) -> Any:
        to = ffi.new("corot_hierarchy_def *")
        lib.corot_hierarchy_set_defaults(to, ffi.sizeof("corot_hierarchy_def"))
        to.refinement = h.refinement._pointer
        to.coarse_strain = self.name(h.coarse_strain, "coarse_strain")
        to.frame_level = cv.whole(h.frame_level, "frame_level")
        to.conservative = bool(h.conservative)
        to.coupling = cv.choose("corot_coupling", h.coupling, "coupling")
        self.keep.append(to)
        return to


def _listed(value: Any, kind: type) -> Sequence[Any]:
    """One of them, or any number."""
    return [value] if isinstance(value, kind) else list(value)


class Model(Handle):
    """A mesh with material, strain measure, supports and loads: immutable, and shared by any number of
    states and threads. Everything it is made of is copied; the mesh may change or close afterwards.

    material: one, or several, so that every tet has exactly one, by group or by `tet_material`
      [ntet], the entry that fills each tet (as from an image or a table).
    strain: cauchy, warp, polar, hybrid or green (corot/ode.h; Hauth & Strasser 2004).
    fix, motion, load: one, or any number. gravity [3] [m/s^2] is a load more, at the end of the list.
    viscosity: corotated, objective, auto. mass: lumped, consistent, auto.
    dilatation: local, nodal, element; dilatation_local: of nodal, see corot_model_def.
    hierarchy: a strain measure of its own for level 0 of a refined mesh.

    InvalidError names what does not fit, an entry of a list by its index.
    """

    def __init__(self, mesh: Mesh, material: Material | Iterable[Material], *, strain: str = "polar",
                 fix: Fix | Iterable[Fix] = (), motion: Motion | Iterable[Motion] = (),
                 load: Load | Iterable[Load] = (), gravity: Vector | None = None,
                 viscosity: Literal["corotated", "objective", "auto"] = "auto",
                 mass: Literal["lumped", "consistent", "auto"] = "auto",
                 dilatation: Literal["local", "nodal", "element"] = "local",
                 dilatation_local: float = 1.0, tet_material: ArrayLike | None = None,
                 hierarchy: Hierarchy | None = None) -> None:
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh is a {type(mesh).__name__}, and a corot.Mesh is wanted")
        write, to = _Writer(), ffi.new("corot_model_def *")
        lib.corot_model_set_defaults(to, ffi.sizeof("corot_model_def"))
        materials, fixes = _listed(material, Material), _listed(fix, Fix)
        motions, loads = _listed(motion, Motion), _listed(load, Load)
        if gravity is not None:
            loads = [*loads, Load.gravity(gravity)]
        to.strain = write.name(strain, "strain")
        to.nmaterial, to.nfix = len(materials), len(fixes)
        to.nmotion, to.nload = len(motions), len(loads)
        to.material = write.array("corot_material", materials, write.material, Material, "material")
        to.fix = write.array("corot_fix", fixes, write.fix, Fix, "fix")
        to.motion = write.array("corot_motion", motions, write.motion, Motion, "motion")
        to.load = write.array("corot_load", loads, write.load, Load, "load")
        to.viscosity = cv.choose("corot_viscosity", viscosity, "viscosity")
        to.mass = cv.choose("corot_mass", mass, "mass")
        to.dilatation = cv.choose("corot_dilatation", dilatation, "dilatation")
        to.dilatation_local = cv.real(dilatation_local, "dilatation_local")
        out = ffi.new("corot_model **")
        with mesh._guard:
            to.mesh = mesh._pointer
            if tet_material is not None:
                which = cv.indices(tet_material, (to.mesh.ntet,), "tet_material")
                to.tet_material = cv.address("int *", which)
                write.keep.append(which)
            if hierarchy is not None:
                to.hierarchy = write.hierarchy(hierarchy)
            check(lib.corot_model_create(to, out))
        self._open(out[0], lib.corot_model_destroy)
        #: The loads in their order, by which Inputs name them, and the materials.
        self.loads, self.materials = tuple(loads), tuple(materials)
        # The definition once more, for corot_space_error; what it points to is kept, its mesh is not.
        to.mesh = ffi.NULL
        self._definition, self._kept = to, (write.keep, hierarchy)

    def __repr__(self) -> str:
        return "<Model, closed>" if self.closed else f"<Model, {self.strain}, {self.ndof} degrees of freedom>"

    def _close(self) -> None:
        super()._close()
        for name in ("mesh", "_pattern"):  # what shows the model's memory
            if name in self.__dict__:
                self.__dict__.pop(name).close()

    def _ask(self, function: Any, *arguments: Any) -> Any:
        with self._guard:
            return function(self._pointer, *arguments)

    @cached_property
    def mesh(self) -> Mesh:
        """The model's own copy of the mesh, which never changes."""
        return Mesh._lend(self._ask(lib.corot_model_mesh), self)

    @property
    def strain(self) -> str:
        """The strain measure; with a hierarchy both, as "green+polar"."""
        return text(self._ask(lib.corot_model_strain))

    @property
    def viscosity(self) -> str:
        """The viscous law in use: corotated or objective."""
        return cv.word("corot_viscosity", self._ask(lib.corot_model_viscosity))

    @property
    def mass_kind(self) -> str:
        """lumped or consistent."""
        return cv.word("corot_mass", self._ask(lib.corot_model_mass_kind))

    @property
    def ndof(self) -> int:
        """n, the length of u, v and r everywhere."""
        return int(self._ask(lib.corot_model_ndof))

    @property
    def nblock(self) -> int:
        """Stored 3x3 blocks of the matrices' pattern."""
        return int(self._ask(lib.corot_model_nblock))

    @property
    def dof(self) -> np.ndarray:
        """[nnode, 3] the degree of freedom of each node's components, -1: held; C's own memory."""
        with self._guard:
            nnode = lib.corot_model_mesh(self._pointer).nnode
            return self._view(ffi.cast("uintptr_t", lib.corot_model_dof(self._pointer)), (nnode, 3), np.intc)

    @property
    def mass(self) -> np.ndarray:
        """[n] lumped mass of each degree of freedom [kg], whichever mass is in use; C's own memory."""
        with self._guard:
            n = lib.corot_model_ndof(self._pointer)
            return self._view(ffi.cast("uintptr_t", lib.corot_model_mass(self._pointer)), (n,), np.float64)

    @property
    def length(self) -> float:
        """Twice the largest distance from the centroid [m]."""
        return float(self._ask(lib.corot_model_length))

    @property
    def frequency(self) -> float:
        """The smallest shear wave speed over the length [1/s]."""
        return float(self._ask(lib.corot_model_frequency))

    @property
    def damping_time(self) -> float:
        """The smallest ratio of damping to stiffness [s]."""
        return float(self._ask(lib.corot_model_damping_time))

    @property
    def moves(self) -> bool:
        """Whether supports move."""
        return bool(self._ask(lib.corot_model_moves))

    @property
    def matrices_by_frames(self) -> bool:
        """Whether K and D stay while the frames are held."""
        return bool(self._ask(lib.corot_model_matrices_by_frames))

    @property
    def approximate_stiffness(self) -> bool:
        """Whether K leaves out so much that it does not tell whether an equilibrium is stable."""
        return bool(self._ask(lib.corot_model_approximate_stiffness))

    @property
    def nbytes(self) -> int:
        """Memory held by the model."""
        return int(self._ask(lib.corot_model_bytes))

    def kinks(self, t0: float, t1: float) -> np.ndarray:
        """The times between t0 and t1 [s] where a load or a motion has a kink or a jump, ascending."""
        t0, t1 = cv.real(t0, "t0"), cv.real(t1, "t1")
        with self._guard:
            n = lib.corot_model_kinks(self._pointer, t0, t1, 0, ffi.NULL)
            times = np.zeros(n)
            lib.corot_model_kinks(self._pointer, t0, t1, n, cv.doubles(times))
        return times

    def horizon(self, t: float) -> float:
        """The latest time to which one step from t should go [s]; inf: any."""
        return float(self._ask(lib.corot_model_horizon, cv.real(t, "t")))

    @cached_property
    def _pattern(self) -> _Pattern:
        return _Pattern(self)


class _Pattern(Handle):
    """The compressed columns that all matrices of a model share."""

    def __init__(self, model: Model) -> None:
        out = ffi.new("corot_csc **")
        with model._guard:
            check(lib.corot_csc_create(model._pointer, lib.COROT_FULL, out))
        self._open(out[0], lib.corot_csc_destroy, model)
        csc = out[0]
        self.n, self.nnz = int(csc.n), int(csc.nnz)
        self.colptr = self._view(ffi.cast("uintptr_t", csc.colptr), (self.n + 1,), np.intc)
        self.row = self._view(ffi.cast("uintptr_t", csc.row), (self.nnz,), np.intc)

    def combine(self, model: Any, a: float, b: float, D: Any, c: float, K: Any) -> Any:
        """a M + b D + c K as a scipy.sparse.csc_array; D and K are blocks of C's, or NULL. C writes the
        values where the matrix has them; its indices are those of this pattern, shared."""
        try:
            from scipy.sparse import csc_array
        except ImportError as error:
            raise ImportError("matrices are those of scipy.sparse: apt-get install python3-scipy, or "
                              "pip install scipy") from error
        value = np.zeros(self.nnz)
        lib.corot_csc_combine(model, self._pointer, a, b, D, c, K, cv.doubles(value))
        matrix = csc_array((value, self.row, self.colptr), shape=(self.n, self.n))
        matrix.has_sorted_indices = matrix.has_canonical_format = True
        return matrix


def strains() -> list[cv.Record]:
    """The strain measures and what each is like (corot_strain_kind)."""
    return _list_kinds(lib.corot_strain_traits)


def _list_kinds(function: Any) -> list[cv.Record]:
    kinds: list[cv.Record] = []
    while (kind := function(len(kinds))) != ffi.NULL:
        kinds.append(cv.record(kind))
    return kinds
