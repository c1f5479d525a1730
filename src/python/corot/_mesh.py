"""Tetrahedral meshes with named groups, and refinements of them (corot/mesh.h, corot/hierarchy.h)."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, overload

import cffi
import numpy as np
from numpy.typing import ArrayLike

from . import _convert as cv
from ._errors import InvalidError
from ._handle import Handle
from ._library import check, ffi, lib, text

_AXES = {"x": 0, "y": 1, "z": 2}

_stdlib = cffi.FFI()
_stdlib.cdef("void free(void *);")
_free = _stdlib.dlopen(None).free  # of the C library that corot itself uses


@dataclass(frozen=True)
class Group:
    """A named part of a mesh: copies of its numbers, at the time it was asked for.

    node: [nnode] ascending. tri: [ntri, 3] corners; faces of the boundary wind outward.
    tet: [ntet] ascending.
    """

    name: str
    node: np.ndarray
    tri: np.ndarray
    tet: np.ndarray


def _copy_ints(pointer: Any, shape: tuple[int, ...]) -> np.ndarray:
    n = int(np.prod(shape))
    if n == 0:
        return np.zeros(shape, np.intc)
    return np.frombuffer(ffi.buffer(ffi.cast("int *", pointer), 4 * n), np.intc).reshape(shape).copy()


def _take(pointer: Any, shape: tuple[int, ...]) -> np.ndarray:
    """A copy of what C has allocated for us, which is freed."""
    try:
        return _copy_ints(pointer, shape)
    finally:
        _free(_stdlib.cast("void *", int(ffi.cast("uintptr_t", pointer))))


def _take_report(report: Any) -> list[str]:
    """What a report says; it is freed."""
    try:
        return [text(report.remark[i].text) for i in range(report.nremark)]
    finally:
        lib.corot_mesh_report_destroy(report)


class Mesh(Handle):
    """A mesh from arrays: positions `x` [nnode, 3] in m, and tets [ntet, 4] of node numbers, or
    [ntet, 10] for ten-node ones (corners, then the nodes on the edges 01 12 02 03 13 23). Both are
    copied. Or by `Mesh.read`, `Mesh.box`.

    InvalidError names the first node or tet that is not sound: out of range, flat, inside out, twice.
    """

    _lent = False  # a model's own copy, which nobody may change

    def __init__(self, x: ArrayLike, tets: ArrayLike) -> None:
        x = cv.reals(x, (None, 3), "x")
        tets = cv.indices(tets, (None, None), "tets")
        if tets.shape[1] not in (4, 10):
            raise InvalidError(f"tets has the shape {tets.shape}: rows of 4 or of 10 nodes are wanted")
        kind = "const int (*)[4]" if tets.shape[1] == 4 else "const int (*)[10]"
        create = lib.corot_mesh_create if tets.shape[1] == 4 else lib.corot_mesh_create_order_2
        out = ffi.new("corot_mesh **")
        check(create(len(x), cv.triples(x), len(tets), cv.address(kind, tets), out))
        self._own(out[0])

    def _own(self, pointer: Any) -> None:
        self._open(pointer, lib.corot_mesh_destroy)

    @classmethod
    def _make(cls, pointer: Any) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._own(pointer)
        return mesh

    @classmethod
    def _lend(cls, pointer: Any, owner: Handle) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._open(pointer, None, owner)
        mesh._lent = True
        return mesh

    @classmethod
    def read(cls, path: Any) -> Mesh:
        """Reads gmsh (1, 2.2, 4.1; ASCII or binary), TetGen (.node + .ele) and the other formats of
        corot/mesh.h, found from the content.

        SystemRefusedError: it cannot be read; FormatError: with file, and line or byte, a line for each
        fault."""
        out = ffi.new("corot_mesh **")
        check(lib.corot_mesh_read(cv.encode(path, "path"), out))
        return cls._make(out[0])

    @classmethod
    def read_mended(cls, path: Any, cut: bool = False, merge: float = 0.0,
                    scale: float = 1.0) -> tuple[Mesh, list[str]]:
        """The same; what is only written down wrongly is mended, and told in sentences: nodes in no tet
        are left out, left-handed tets turned round, tets that are there twice left out. `cut`: hexahedra,
        prisms and pyramids are cut into tets. `merge`: nodes no further apart become one [m]. `scale`:
        what the file's coordinates are multiplied by to be metres, 1e-3 for millimetres."""
        how = ffi.new("corot_mending *",
                      {"cut": bool(cut), "merge": float(merge), "scale": float(scale)})
        out, report = ffi.new("corot_mesh **"), ffi.new("corot_mesh_report **")
        check(lib.corot_mesh_read_mended(cv.encode(path, "path"), how, out, report))
        return cls._make(out[0]), _take_report(report[0])

    @classmethod
    def box(cls, size: ArrayLike, cells: ArrayLike, origin: ArrayLike = (0, 0, 0),
            split: Literal["kuhn", "alternating", "symmetric"] = "symmetric") -> Mesh:
        """A box of `size` [3] m from `origin` [3], of nx, ny, nz `cells`, each cut into six tets, with the
        groups xmin xmax ymin ymax zmin zmax. InvalidError: it makes no sense."""
        box = ffi.new("corot_box *", lib.corot_box_defaults())
        box.size = cv.reals(size, (3,), "size").tolist()
        box.cells = cv.indices(cells, (3,), "cells").tolist()
        box.origin = cv.reals(origin, (3,), "origin").tolist()
        box.split = cv.choose("corot_box_split", split, "split")
        out = ffi.new("corot_mesh **")
        check(lib.corot_mesh_box(box, out))
        return cls._make(out[0])

    # What it is

    @property
    def nnode(self) -> int:
        with self._guard:
            return int(self._pointer.nnode)

    @property
    def ntet(self) -> int:
        with self._guard:
            return int(self._pointer.ntet)

    @property
    def order(self) -> int:
        """1: four-node tets; 2: ten-node tets."""
        with self._guard:
            return int(lib.corot_mesh_order(self._pointer))

    def _shown(self, field: str, shape: tuple[int, ...], dtype: Any) -> np.ndarray:
        return self._view(ffi.cast("uintptr_t", getattr(self._pointer, field)), shape, dtype)

    @property
    def x(self) -> np.ndarray:
        """[nnode, 3] rest positions [m]; C's own memory, for reading."""
        with self._guard:
            return self._shown("x", (self._pointer.nnode, 3), np.float64)

    @property
    def tet(self) -> np.ndarray:
        """[ntet, 4] node numbers of the corners; C's own memory, for reading."""
        with self._guard:
            return self._shown("tet", (self._pointer.ntet, 4), np.intc)

    @property
    def mid(self) -> np.ndarray | None:
        """[ntet, 6] nodes on the edges 01 12 02 03 13 23, as `tet`; None at order 1."""
        with self._guard:
            if self._pointer.mid == ffi.NULL:
                return None
            return self._shown("mid", (self._pointer.ntet, 6), np.intc)

    @property
    def groups(self) -> Mapping[str, Group]:
        """All groups by name, in their order."""
        with self._guard:
            mesh = self._pointer
            return MappingProxyType(
                {g.name: g for g in (_copy_group(mesh.group[i]) for i in range(mesh.ngroup))})

    def group(self, name: str) -> Group:
        """The group of this name. KeyError: there is none."""
        with self._guard:
            found = lib.corot_mesh_find_group(self._pointer, cv.encode(name, "name"))
            if found == ffi.NULL:
                known = [text(self._pointer.group[i].name) for i in range(self._pointer.ngroup)]
                raise KeyError(f"no group {name!r}; there are: {', '.join(known) or 'none'}")
            return _copy_group(found[0])

    def measure(self) -> cv.Record:
        """Size and shape: min, max [m], volume [m^3], edges [m], dihedral angles [degree], shapes;
        corot_mesh_quality in corot/mesh.h."""
        with self._guard:
            return cv.record(lib.corot_mesh_measure(self._pointer))

    def __repr__(self) -> str:
        if self.closed:
            return "<Mesh, closed>"
        return f"<Mesh of {self.nnode} nodes, {self.ntet} tets of order {self.order}>"

    # Groups are added by their parts

    def _add(self, function: Any, name: str, *arguments: Any) -> None:
        if self._lent:
            raise InvalidError("this is a model's own mesh, which never changes: add groups to the mesh "
                               "that a model is made of")
        with self._guard:
            check(function(self._pointer, cv.encode(name, "name"), *arguments))

    def group_nodes(self, name: str, nodes: ArrayLike) -> None:
        """Adds a group by its nodes [n]; faces of the boundary and tets whose corners are all in it
        belong to it. InvalidError: the name is taken or no name, a node is out of range, none is listed;
        so of all that follow."""
        nodes = cv.indices(nodes, (None,), "nodes")
        self._add(lib.corot_mesh_group_nodes, name, len(nodes), cv.address("int *", nodes))

    def group_plane(self, name: str, axis: int | Literal["x", "y", "z"], at: float,
                    tol: float = 0.0) -> None:
        """Adds the nodes with |x[axis] - at| <= tol; 0: a millionth of the mesh's diagonal."""
        number = _AXES[axis] if axis in _AXES else cv.whole(axis, "axis")
        self._add(lib.corot_mesh_group_plane, name, number, cv.real(at, "at"), cv.real(tol, "tol"))

    def group_box(self, name: str, min: ArrayLike, max: ArrayLike, tol: float = 0.0) -> None:
        """Adds the nodes with min - tol <= x <= max + tol in each coordinate [3]."""
        low, high = cv.reals(min, (3,), "min"), cv.reals(max, (3,), "max")
        self._add(lib.corot_mesh_group_box, name, cv.doubles(low), cv.doubles(high),
                  cv.real(tol, "tol"))

    def group_sphere(self, name: str, center: ArrayLike, radius: float, tol: float = 0.0) -> None:
        """Adds the nodes at most radius + tol from a point [3]; InvalidError: none is, with the nearest."""
        middle = cv.reals(center, (3,), "center")
        self._add(lib.corot_mesh_group_sphere, name, cv.doubles(middle), cv.real(radius, "radius"),
                  cv.real(tol, "tol"))

    def group_cylinder(self, name: str, start: ArrayLike, end: ArrayLike, radius: float,
                       tol: float = 0.0) -> None:
        """Adds the nodes in a round cylinder, the centers of whose ends are `start` and `end` [3]."""
        first, last = cv.reals(start, (3,), "start"), cv.reals(end, (3,), "end")
        self._add(lib.corot_mesh_group_cylinder, name, cv.doubles(first), cv.doubles(last),
                  cv.real(radius, "radius"), cv.real(tol, "tol"))

    def group_half_space(self, name: str, point: ArrayLike, normal: ArrayLike, tol: float = 0.0) -> None:
        """Adds the nodes on the side of a plane through `point` [3] that `normal` [3] points to."""
        at, along = cv.reals(point, (3,), "point"), cv.reals(normal, (3,), "normal")
        self._add(lib.corot_mesh_group_half_space, name, cv.doubles(at), cv.doubles(along),
                  cv.real(tol, "tol"))

    def group_normal(self, name: str, direction: ArrayLike, angle: float) -> None:
        """Adds the faces of the boundary whose outward normals are within `angle` rad of a direction
        [3], with their nodes and no tets."""
        along = cv.reals(direction, (3,), "direction")
        self._add(lib.corot_mesh_group_normal, name, cv.doubles(along), cv.real(angle, "angle"))

    def group_near(self, name: str, other: str, distance: float) -> None:
        """Adds the nodes at most `distance` m from nodes, faces and tets of another group."""
        self._add(lib.corot_mesh_group_near, name, cv.encode(other, "other"),
                  cv.real(distance, "distance"))

    def group_combine(self, name: str, operation: Literal["union", "intersection", "difference"],
                      others: Sequence[str]) -> None:
        """Adds what is in one of the other groups, in all of them, or in the first alone: of nodes, of
        faces and of tets, each by themselves."""
        texts = [ffi.new("char[]", cv.encode(other, "others")) for other in others]
        self._add(lib.corot_mesh_group_combine, name,
                  cv.choose("corot_set_operation", operation, "operation"), len(texts),
                  ffi.new("const char *[]", texts))

    def group_tets(self, name: str, tets: ArrayLike) -> None:
        """Adds a group of listed tets [n], with their nodes and no triangles: what a material fills."""
        tets = cv.indices(tets, (None,), "tets")
        self._add(lib.corot_mesh_group_tets, name, len(tets), cv.address("int *", tets))

    def group_triangles(self, name: str, triangles: ArrayLike) -> None:
        """Adds a group of listed triangles [n, 3], faces of tets by their corners, with their nodes and
        no tets: what a traction or a pressure acts on."""
        tri = cv.indices(triangles, (None, 3), "triangles")
        self._add(lib.corot_mesh_group_triangles, name, len(tri), cv.address("int (*)[3]", tri))

    # Other meshes of this one

    def copy(self) -> Mesh:
        """Another mesh, with all groups, that may be changed."""
        out = ffi.new("corot_mesh **")
        with self._guard:
            check(lib.corot_mesh_copy(self._pointer, out))
        return Mesh._make(out[0])

    def change_order(self, order: int) -> Mesh:
        """The same tets with four nodes (1) or ten (2). InvalidError: another order."""
        out = ffi.new("corot_mesh **")
        with self._guard:
            check(lib.corot_mesh_change_order(self._pointer, cv.whole(order, "order"), out))
        return Mesh._make(out[0])

    @overload
    def refine(self, levels: int = ..., diagonal: str = ..., *,
               return_refinement: Literal[False] = ...) -> Mesh: ...
    @overload
    def refine(self, levels: int = ..., diagonal: str = ..., *,
               return_refinement: Literal[True]) -> tuple[Mesh, Refinement]: ...

    def refine(self, levels: int = 1, diagonal: str = "consistent", *,
               return_refinement: bool = False) -> Any:
        """Cuts every tet into eight, `levels` times; along the diagonal "consistent" (Bey's) or
        "shortest". With `return_refinement` also how the nodes descend, which a hierarchical model and
        multigrid want. InvalidError: levels is negative, or there would be too many tets."""
        out, how = ffi.new("corot_mesh **"), ffi.new("corot_refinement **")
        along = cv.choose("corot_diagonal", diagonal, "diagonal")
        with self._guard:
            check(lib.corot_mesh_refine(self._pointer, cv.whole(levels, "levels"), along, out,
                                        how if return_refinement else ffi.NULL))
        fine = Mesh._make(out[0])
        return (fine, Refinement._make(how[0])) if return_refinement else fine

    @overload
    def refine_marked(self, marks: ArrayLike, *, return_parent: Literal[False] = ...) -> Mesh: ...
    @overload
    def refine_marked(self, marks: ArrayLike, *,
                      return_parent: Literal[True]) -> tuple[Mesh, np.ndarray]: ...

    def refine_marked(self, marks: ArrayLike, *, return_parent: bool = False) -> Any:
        """Cuts the tets `marks` [n] into at least eight, and neighbours as far as faces have to match;
        with `return_parent` also [ntet] of which tet each is a part. InvalidError: no such tet."""
        marks = cv.indices(marks, (None,), "marks")
        out, parent = ffi.new("corot_mesh **"), ffi.new("int **")
        with self._guard:
            check(lib.corot_mesh_refine_marked(self._pointer, len(marks), cv.address("int *", marks), out,
                                               parent if return_parent else ffi.NULL))
        fine = Mesh._make(out[0])
        return (fine, _take(parent[0], (fine.ntet,))) if return_parent else fine

    def write(self, path: Any) -> None:
        """Writes gmsh 2.2 ASCII with all groups. SystemRefusedError: that failed, and what was there
        is left."""
        with self._guard:
            check(lib.corot_mesh_write(self._pointer, cv.encode(path, "path")))

    def write_as(self, path: Any, format: str | None = None) -> list[str]:
        """The same as "gmsh" (4.1), "gmsh-2.2", "vtu", "vtk", "tetgen", "medit" or "abaqus"; None: by
        the suffix. What of the groups the format cannot hold, in sentences. InvalidError: there is no
        such format."""
        report = ffi.new("corot_mesh_report **")
        name = ffi.NULL if format is None else cv.encode(format, "format")
        with self._guard:
            check(lib.corot_mesh_write_as(self._pointer, cv.encode(path, "path"), name, report))
        return _take_report(report[0])

    # Where things are

    def boundary(self) -> np.ndarray:
        """[n, 3] the faces that belong to one tet only, winding outward."""
        n, tri = ffi.new("int *"), ffi.new("int (**)[3]")
        with self._guard:
            check(lib.corot_mesh_boundary(self._pointer, n, tri))
        return _take(tri[0], (n[0], 3))

    def face_nodes(self, triangles: ArrayLike) -> np.ndarray:
        """[n, 6] at order 2: corners, then the nodes on the edges 01 12 20, of triangles [n, 3] that are
        faces of tets. InvalidError: the mesh is of order 1, or one is no face."""
        tri = cv.indices(triangles, (None, 3), "triangles")
        out = ffi.new("int (**)[6]")
        with self._guard:
            self._check_nodes(tri, "triangles")
            check(lib.corot_mesh_face_nodes(self._pointer, len(tri), cv.address("int (*)[3]", tri), out))
        return _take(out[0], (len(tri), 6))

    def _check_nodes(self, nodes: np.ndarray, name: str) -> None:
        if nodes.size and not (nodes.min() >= 0 and nodes.max() < self._pointer.nnode):
            raise InvalidError(f"{name} has a node that the mesh of {self._pointer.nnode} has not")

    def nearest(self, point: ArrayLike) -> int:
        """The node nearest to a point [3]; the lower number wins a tie. InvalidError: not finite."""
        where = cv.reals(point, (3,), "point")
        if not np.isfinite(where).all():
            raise InvalidError(f"point = {where.tolist()} is not finite")
        with self._guard:
            return int(lib.corot_mesh_nearest(self._pointer, cv.doubles(where)))

    def locate(self, point: ArrayLike) -> cv.Record:
        """The tet at a point [3], or of one outside the nearest of the surface: tet, at [4], node [n],
        weight [n] (a nodal field f is weight @ f[node] there), x [3], distance [m].
        InvalidError: the point is not finite."""
        where, out = cv.reals(point, (3,), "point"), ffi.new("corot_location *")
        with self._guard:
            check(lib.corot_mesh_locate(self._pointer, cv.doubles(where), out))
        return _cut(cv.record(out))

    def locate_node(self, node: int) -> cv.Record:
        """The place of a node, in the first tet that has it. InvalidError: there is no such node."""
        node = cv.whole(node, "node")
        with self._guard:
            self._check_nodes(np.array([node]), "node")
            return _cut(cv.record(lib.corot_mesh_locate_node(self._pointer, node)))


def _cut(place: cv.Record) -> cv.Record:
    """A location with as many nodes as it has."""
    n = place["nnode"]
    return cv.Record("location", {**place, "node": place["node"][:n], "weight": place["weight"][:n]})


def _copy_group(g: Any) -> Group:
    return Group(text(g.name), _copy_ints(g.node, (g.nnode,)), _copy_ints(g.tri, (g.ntri, 3)),
                 _copy_ints(g.tet, (g.ntet,)))


class Refinement(Handle):
    """How a refined mesh descends from the one it was made of, level 0 (by `Mesh.refine`)."""

    def __init__(self) -> None:
        raise TypeError("a Refinement is made by Mesh.refine(..., return_refinement=True)")

    @classmethod
    def _make(cls, pointer: Any) -> Refinement:
        refinement = cls.__new__(cls)
        refinement._open(pointer, lib.corot_refinement_destroy)
        return refinement

    @property
    def nlevel(self) -> int:
        with self._guard:
            return int(self._pointer.nlevel)

    @property
    def nnode(self) -> np.ndarray:
        """[nlevel + 1] the nodes of level l, and of those before it, are the first nnode[l]."""
        with self._guard:
            return _copy_ints(self._pointer.nnode, (self._pointer.nlevel + 1,))

    @property
    def ntet(self) -> np.ndarray:
        """[nlevel + 1] tets of each level."""
        with self._guard:
            return _copy_ints(self._pointer.ntet, (self._pointer.nlevel + 1,))

    @property
    def parent(self) -> np.ndarray:
        """[nnode[nlevel] - nnode[0], 2] the two ends of the edge of which each new node is the middle."""
        with self._guard:
            n = self._pointer.nnode
            return _copy_ints(self._pointer.parent, (n[self._pointer.nlevel] - n[0], 2))

    @property
    def node(self) -> np.ndarray | None:
        """[nnode[nlevel]] the mesh's number of each node; None: these are the numbers."""
        with self._guard:
            if self._pointer.node == ffi.NULL:
                return None
            return _copy_ints(self._pointer.node, (self._pointer.nnode[self._pointer.nlevel],))

    def raise_order(self, raised: Mesh) -> None:
        """Adds a level: that the finest mesh has become `raised`, of ten-node tets.
        InvalidError: it is not that."""
        with self._guard, raised._guard:
            check(lib.corot_refinement_raise(self._pointer, raised._pointer))

    def lower_order(self, mesh: Mesh) -> None:
        """Adds a level below: the corners of level 0, `mesh`, of ten-node tets. InvalidError: it is not
        that."""
        with self._guard, mesh._guard:
            check(lib.corot_refinement_lower(self._pointer, mesh._pointer))

    def _sweep(self, function: Any, values: ArrayLike) -> np.ndarray:
        with self._guard:
            n = self._pointer.nnode[self._pointer.nlevel]
            result = cv.reals(values, (n, 3), "values").copy()
            function(self._pointer, cv.triples(result))
        return result

    def to_nodal(self, values: ArrayLike, transposed: bool = False) -> np.ndarray:
        """T v [nnode, 3]: from hierarchical to nodal values (or T' v, of forces); corot/hierarchy.h."""
        return self._sweep(lib.corot_hierarchy_apply_transposed if transposed
                           else lib.corot_hierarchy_apply, values)

    def to_hierarchical(self, values: ArrayLike, transposed: bool = False) -> np.ndarray:
        """T^-1 v [nnode, 3]: from nodal to hierarchical values (or T'^-1 v, of forces)."""
        return self._sweep(lib.corot_hierarchy_solve_transposed if transposed
                           else lib.corot_hierarchy_solve, values)

