"""Between Python and C: arrays, words of enumerations, structures, definitions from keywords.

**Arrays that go in** are converted where nothing is lost: a list, integers, single precision, another
order or stride become a contiguous array of doubles, by a copy; an array of contiguous doubles is
handed to C as it is. Of the wrong shape, or of numbers that are none (complex, text), they are refused.
**Arrays to be written to** (`out`) have to be what C wants: doubles, contiguous, writeable.
"""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from ._errors import InvalidError
from ._library import ffi, numbers, text

# --- Arrays ---------------------------------------------------------------------------------------


def _say(shape: tuple[Any, ...]) -> str:
    inside = ", ".join("n" if s is None else str(s) for s in shape)
    return f"({inside},)" if len(shape) == 1 else f"({inside})"


def _has_shape(array: np.ndarray, shape: tuple[int | None, ...]) -> bool:
    return array.ndim == len(shape) and all(s is None or s == n for s, n in zip(shape, array.shape))


def _as_array(value: Any, name: str) -> np.ndarray:
    try:
        array = np.asarray(value)
    except ValueError as error:  # rows of different lengths
        raise InvalidError(f"{name} is no array of numbers: {error}") from None
    if array.dtype.kind not in "iufb":
        raise TypeError(f"{name} has the type {array.dtype}, and real numbers are wanted")
    return array


def reals(value: Any, shape: tuple[int | None, ...], name: str) -> np.ndarray:
    """An array of contiguous doubles. `None` in a shape: any length. InvalidError: another shape;
    TypeError: no real numbers."""
    array = _as_array(value, name)
    if not _has_shape(array, shape):
        raise InvalidError(f"{name} has the shape {_say(array.shape)}, and {_say(shape)} is wanted")
    return np.ascontiguousarray(array, dtype=np.float64)


def maybe_reals(value: Any, shape: tuple[int | None, ...], name: str) -> np.ndarray | None:
    """The same, or None."""
    return None if value is None else reals(value, shape, name)


def indices(value: Any, shape: tuple[int | None, ...], name: str) -> np.ndarray:
    """The same of whole numbers that fit an int of C."""
    array = _as_array(value, name)
    if array.size == 0 and _has_shape(array, shape):
        return np.zeros(array.shape, np.intc)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} has the type {array.dtype}, and whole numbers are wanted")
    if not _has_shape(array, shape):
        raise InvalidError(f"{name} has the shape {_say(array.shape)}, and {_say(shape)} is wanted")
    if int(array.max()) > 2**31 - 1 or int(array.min()) < -(2**31):
        raise InvalidError(f"{name} has a number that does not fit 32 bits")
    return np.ascontiguousarray(array, dtype=np.intc)


def output(out: Any, shape: tuple[int, ...], name: str = "out") -> np.ndarray:
    """An array to write to: a new one, or `out` if it is what C wants. InvalidError, TypeError: it is
    not."""
    if out is None:
        return np.zeros(shape)
    if not isinstance(out, np.ndarray) or out.dtype != np.float64:
        raise TypeError(f"{name} is to be an array of doubles (float64): it is written to in place")
    if out.shape != shape:
        raise InvalidError(f"{name} has the shape {_say(out.shape)}, and {_say(shape)} is wanted")
    if not (out.flags.c_contiguous and out.flags.writeable and out.flags.aligned):
        raise InvalidError(f"{name} is to be contiguous and writeable: it is written to in place")
    return out


def apart(out: np.ndarray, *arrays: np.ndarray | None) -> np.ndarray:
    """InvalidError: `out` shares memory with an input, which C would read after it is written."""
    for array in arrays:
        if array is not None and np.may_share_memory(out, array):
            raise InvalidError("out may not share memory with an input")
    return out


def address(ctype: str, array: np.ndarray | None) -> Any:
    """What C is handed: a pointer of the type, NULL for None. The array has to live until the call has
    returned."""
    return ffi.NULL if array is None else ffi.cast(ctype, array.ctypes.data)


def doubles(array: np.ndarray | None) -> Any:
    return address("double *", array)


def triples(array: np.ndarray | None) -> Any:
    return address("double (*)[3]", array)


def real(value: Any, name: str) -> float:
    """A number. TypeError: it is none."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} = {value!r} is not a number") from None


def whole(value: Any, name: str) -> int:
    """A whole number that fits an int of C. TypeError, InvalidError: it is none."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} = {value!r} is not a whole number")
    if not -(2**31) <= value < 2**31:
        raise InvalidError(f"{name} = {value} does not fit 32 bits")
    return int(value)


def encode(value: Any, name: str) -> bytes:
    """A text for C. TypeError: it is none; InvalidError: it has a NUL, where C would end it."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name} = {value!r} is not a text")
    raw = os.fsencode(value)
    if b"\0" in raw:
        raise InvalidError(f"{name} has a NUL character, where C would end it")
    return raw


# --- Enumerations as words ------------------------------------------------------------------------


@lru_cache(maxsize=None)
def words(name: str) -> dict[str, int]:
    """The words of an enumeration of the headers: those of corot_frames are exact, held, extrapolated.
    A word is the enumerator in small letters without what it has of the type's name, or what all have
    in common."""
    values = ffi.typeof(name).relements
    plain = {key.removeprefix("COROT_"): value
             for key, value in sorted(values.items(), key=lambda pair: pair[1])}
    own = name.removeprefix("corot_").upper() + "_"
    common = os.path.commonprefix(list(plain))
    common = common[: common.rfind("_") + 1]
    return {(key[len(own):] if key.startswith(own) else key.removeprefix(common)).lower(): value
            for key, value in plain.items()}


def choose(name: str, value: Any, argument: str) -> int:
    """The enumerator of a word. InvalidError: there is none, with those that there are."""
    known = words(name)
    key = value.replace("-", "_") if isinstance(value, str) else value
    if key not in known:
        raise InvalidError(f"{argument} = {value!r}: one of {', '.join(known)} is wanted")
    return known[key]


def word(name: str, value: int) -> str:
    """The word of an enumerator."""
    return next(key for key, v in words(name).items() if v == int(value))


# --- Structures -----------------------------------------------------------------------------------


class Record(Mapping[str, Any]):
    """Numbers under the names that a structure of the headers gives them, where they are explained:
    `record.t`, `record["t"]`, `dict(record)`. Enumerations are words, arrays are arrays."""

    def __init__(self, kind: str, values: dict[str, Any]) -> None:
        self.__dict__["_kind"], self.__dict__["_values"] = kind, values

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_values"][name]
        except KeyError:
            known = ", ".join(self.__dict__["_values"])
            raise AttributeError(f"a {self._kind} has no '{name}'; it has {known}") from None

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a {self._kind} is for reading")

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._values})

    def __repr__(self) -> str:
        return f"{self._kind}({', '.join(f'{k}={v!r}' for k, v in self._values.items())})"

    def __reduce__(self) -> Any:
        return Record, (self._kind, self._values)


def _value(field: Any, ctype: Any) -> Any:
    if ctype.kind == "enum":
        return word(ctype.cname.removeprefix("enum "), int(ffi.cast("int", field)))
    if ctype.kind == "array":
        item = ctype.item
        shape = (ctype.length,)
        while item.kind == "array":
            shape, item = (*shape, item.length), item.item
        dtype = np.intc if item.cname == "int" else np.float64
        return np.frombuffer(ffi.buffer(field), dtype).reshape(shape).copy()
    if ctype.kind == "pointer" and ctype.item.cname == "char":
        return text(field)
    return field


def record(struct: Any, **more: Any) -> Record:
    """A structure of C's as a Record; of pointers only texts are taken over."""
    ctype = ffi.typeof(struct)
    if ctype.kind == "pointer":
        struct, ctype = struct[0], ctype.item
    values = {}
    for name, field in ctype.fields:
        kind = field.type
        if kind.kind == "function" or (kind.kind == "pointer" and kind.item.cname != "char"):
            continue
        values[name] = _value(getattr(struct, name), kind)
    values.update(more)
    return Record(ctype.cname.removeprefix("corot_").replace("struct corot_", ""), values)


# --- Definitions ----------------------------------------------------------------------------------


def _assign(struct: Any, name: str, ctype: Any, value: Any, keep: list[Any]) -> None:
    kind = ctype.kind
    if kind == "enum":
        setattr(struct, name, choose(ctype.cname.removeprefix("enum "), value, name))
    elif kind == "struct":
        given = value if isinstance(value, Mapping) else {ctype.fields[0][0]: value}
        fill(getattr(struct, name), given, keep, ctype.cname.removeprefix("corot_"))
    elif kind == "pointer" and ctype.item.cname == "char":
        if value is not None:
            keep.append(ffi.new("char[]", encode(value, name)))
            setattr(struct, name, keep[-1])
    elif kind == "pointer":  # an object of ours
        if value is not None and not hasattr(value, "_pointer"):
            raise TypeError(f"{name} = {value!r}: a {ctype.item.cname} of this package is wanted")
        setattr(struct, name, ffi.NULL if value is None else value._pointer)
        keep.append(value)
    elif ctype.cname == "_Bool":
        if not isinstance(value, (bool, np.bool_)):
            raise TypeError(f"{name} = {value!r}: True or False is wanted")
        setattr(struct, name, bool(value))
    elif ctype.cname == "double":
        setattr(struct, name, real(value, name))
    else:
        setattr(struct, name, whole(value, name))


def fill(struct: Any, given: Mapping[str, Any], keep: list[Any], what: str,
         without: tuple[str, ...] = ()) -> None:
    """Sets the fields of a definition by keywords of their names; texts go to `keep`, which has to live
    as long as the definition is read. TypeError: a keyword that is no field, or a value of another
    type; InvalidError: a word that is none."""
    ctype = ffi.typeof(struct)
    fields = dict((ctype.item if ctype.kind == "pointer" else ctype).fields)
    known = [name for name in fields if name not in ("bytes", *without)]
    for name, value in given.items():
        if name not in known:
            raise TypeError(f"{what} has no setting '{name}'; it has {', '.join(known)}")
        _assign(struct, name, fields[name].type, value, keep)


#: Extrapolated frames are never turned further than this [rad]: COROT_EXTRAPOLATION_CAP.
EXTRAPOLATION_CAP = numbers["COROT_EXTRAPOLATION_CAP"]
