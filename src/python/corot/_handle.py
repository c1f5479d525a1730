"""Objects of C in Python: who keeps whom alive, what closing means, and one thread at a time.

A C object hangs on a `Cell`, which destroys it when nothing refers to the cell any more. A cell refers
to the cells of what its object was made of, so that C objects go in the right order whatever the
garbage collector does. An object of Python refers to its cell until it is closed; an array that shows
memory of C refers to it, too. So `close()` takes an object out of use at once, and C's memory goes as
soon as nothing needs it any more: no array is ever left pointing at nothing.
"""
from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from ._errors import ClosedError, InvalidError

Self = TypeVar("Self", bound="Handle")


class Cell:
    """A C object, destroyed with the last reference to this. Cells are also referred to by the registry
    of finalizers, so that the garbage collector never meets one in a circle, and takes them in no
    order of its own."""

    __slots__ = ("pointer", "destroy", "owners", "__weakref__")

    def __init__(self, pointer: Any, destroy: Callable[[Any], None] | None,
                 owners: tuple["Cell", ...]) -> None:
        self.pointer, self.destroy, self.owners = pointer, destroy, owners

    def __del__(self) -> None:
        if self.destroy is not None:
            self.destroy(self.pointer)


def _let_go(cell: Cell) -> None:
    """The registry's reference to a cell has ended."""


def hold(owner: Any, cell: Cell) -> Any:
    """The cell lives at least as long as `owner`."""
    finalizer = weakref.finalize(owner, _let_go, cell)
    finalizer.atexit = False
    return finalizer


class Guard:
    """One thread at a time: others wait. The same one, which would get here from a function of its own
    that an evaluation has called, is refused."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._thread: int | None = None

    def __enter__(self) -> None:
        me = threading.get_ident()
        if self._thread == me:
            raise InvalidError("a function that corot has called may not call the object that it was "
                               "called by: it is in the middle of an evaluation")
        self._lock.acquire()
        self._thread = me

    def __exit__(self, *_: object) -> None:
        self._thread = None
        self._lock.release()


class Handle:
    """What all objects of corot have in common. They are context managers: `with` closes them."""

    _cell: Cell | None = None
    _parents: tuple["Handle", ...] = ()
    _guard: Guard

    def _open(self, pointer: Any, destroy: Callable[[Any], None] | None, *parents: "Handle",
              guard: Guard | None = None) -> None:
        """Takes over a C object that needs those of `parents`."""
        self._guard = guard or Guard()
        owners = tuple(p._cell for p in parents if p._cell is not None)
        self._cell = Cell(pointer, destroy, owners)
        self._parents = parents
        self._finalizer = hold(self, self._cell)

    @property
    def closed(self) -> bool:
        """Whether this, or something it was made of, was closed."""
        return self._cell is None or any(parent.closed for parent in self._parents)

    @property
    def _pointer(self) -> Any:
        """The C object. ClosedError: there is none any more."""
        cell = self._cell
        name = type(self).__name__
        if cell is None:
            raise ClosedError(f"this {name} was closed")
        for parent in self._parents:
            if parent.closed:
                raise ClosedError(f"the {type(parent).__name__} of this {name} was closed")
        return cell.pointer

    def _borrow(self) -> tuple[Any, Cell]:
        """The C object, and what keeps it while a call that nobody has to wait for goes on."""
        with self._guard:
            pointer = self._pointer
            assert self._cell is not None
            return pointer, self._cell

    def close(self) -> None:
        """Ends its use; a second time does nothing. Everything made of it raises ClosedError from then
        on. InvalidError: it is in the middle of an evaluation, which called the caller."""
        if self._cell is not None:
            with self._guard:
                self._close()

    def _close(self) -> None:
        self._finalizer.detach()
        self._cell = None

    def __enter__(self: Self) -> Self:
        self._pointer  # noqa: B018: an object that was closed is refused
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _view(self, address: Any, shape: tuple[int, ...], dtype: Any) -> np.ndarray:
        """Memory of the C object as an array that cannot be written to, without a copy. The memory
        stays as long as the array does, though this be closed."""
        assert self._cell is not None
        return show(self._cell, int(address), shape, dtype)

    def __reduce__(self) -> Any:
        raise TypeError(f"a {type(self).__name__} cannot be pickled or copied: it is memory of C")


class _Shown:
    """What numpy asks for the memory of an array."""

    def __init__(self, interface: dict[str, Any]) -> None:
        self.__array_interface__ = interface


def show(cell: Cell, address: int, shape: tuple[int, ...], dtype: Any) -> np.ndarray:
    """The memory at an address, which is `cell`'s, as an array that is for reading."""
    if 0 in shape:
        return np.zeros(shape, dtype)
    shown = _Shown({"version": 3, "shape": shape, "typestr": np.dtype(dtype).str,
                    "data": (address, True)})
    hold(shown, cell)
    return np.asarray(shown)
