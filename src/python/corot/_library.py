"""Finds the shared library, loads it, and turns its statuses into exceptions.

The library is libcorot_integrate.so, which brings the other two with it; where that was not built
(COROT_SOLVE=OFF), libcorot_core.so alone: then integrators, equilibria and modes say so when they are
asked for. Where it is looked for, the first that is there:

  1. the file, or the folder, that the environment variable COROT_LIBRARY names, and nowhere else then;
  2. where CMake has installed it, by way from this package (_installed.py);
  3. where the loader looks.
"""
from __future__ import annotations

import os
import re
import sys
from types import ModuleType
from typing import Any

try:
    import cffi
except ImportError as error:  # pragma: no cover: tests skip without
    raise ImportError("corot needs cffi: apt-get install python3-cffi, or pip install cffi") from error

from . import _errors, _headers

HERE = os.path.dirname(os.path.abspath(__file__))
NAMES = ("libcorot_integrate", "libcorot_core")

_installed: ModuleType | None
try:
    from . import _installed  # made by CMake: LIBRARY and PROGRAM, folders by way from here
except ImportError:
    _installed = None


def _read_declarations() -> str:
    """The text that CMake made of the headers as it installed this package; in a tree of sources, what
    the headers themselves say."""
    made = os.path.join(HERE, "_cdef.h")
    if os.path.exists(made):
        with open(made, encoding="utf-8") as file:
            return file.read()
    headers = os.path.join(HERE, "..", "..", "..", "include", "corot")
    try:
        return _headers.read_headers(headers)
    except FileNotFoundError as error:
        raise _errors.LibraryError(
            f"corot's declarations are not there: neither {made}, which installing makes, nor the "
            f"headers of a tree of sources in {os.path.normpath(headers)}") from error


ffi: Any = cffi.FFI()
_declarations = _read_declarations()
ffi.cdef(_declarations)

#: Numbers that the headers define: COROT_EXTRAPOLATION_CAP and the version's.
numbers = _headers.read_numbers(_declarations)
HEADER_VERSION = ".".join(
    str(int(numbers[f"COROT_VERSION_{part}"])) for part in ("MAJOR", "MINOR", "PATCH"))
#: What declarations there are, by the headers: a function that is not among them is not in this corot.
declared = frozenset(re.findall(r"\b(corot_\w+)\(", _declarations))


def installed_folder(what: str) -> str | None:
    """The folder of "LIBRARY" or "PROGRAM" that CMake has written down; None: it has not."""
    way = getattr(_installed, what, None)
    return os.path.normpath(os.path.join(HERE, way)) if way else None


def _suffixes() -> tuple[str, str]:
    """Of files of this version, as the loader knows them, and of any."""
    major, minor, _ = HEADER_VERSION.split(".")
    return f".so.{major}.{minor}" if major == "0" else f".so.{major}", ".so"


def _list_candidates() -> tuple[list[str], str]:
    """Paths or names to load, and where they come from."""
    names = [name + suffix for name in NAMES for suffix in _suffixes()]
    said = os.environ.get("COROT_LIBRARY")
    if said:
        if os.path.isdir(said):
            return [os.path.join(said, name) for name in names], f"COROT_LIBRARY={said}"
        return [said], f"COROT_LIBRARY={said}"
    folder = installed_folder("LIBRARY")
    beside = [os.path.join(folder, name) for name in names] if folder else []
    return beside + names, "where corot was installed, and where the loader looks"


def _refuse(reason: str) -> _errors.LibraryError:
    return _errors.LibraryError(
        f"{reason}. Build the shared library (cmake -S corot -B build/lib -DCOROT_APP=OFF "
        "-DBUILD_SHARED_LIBS=ON && cmake --build build/lib) and set COROT_LIBRARY to "
        "libcorot_integrate.so there, in build/lib/src/solve, or to the folder that holds it")


def _load() -> tuple[Any, str]:
    candidates, where = _list_candidates()
    reasons = []
    for path in candidates:
        if os.sep in path and not os.path.exists(path):
            continue
        try:
            return ffi.dlopen(path), path
        except OSError as error:
            reasons.append(str(error))
    # What is there and cannot be loaded says more than what is not.
    telling = [reason for reason in reasons if "No such file" not in reason] or reasons
    because = f": {telling[0]}" if telling else ": it is not there"
    raise _refuse(f"corot's shared library cannot be loaded ({where}){because}")


def _check_version(library: Any, path: str) -> None:
    try:
        version = ffi.string(library.corot_version()).decode()
    except AttributeError:
        raise _refuse(f"{path} is no library of corot, or one that shows none of its functions") from None
    if version != HEADER_VERSION:
        raise _refuse(f"{path} is corot {version}, and this package is for {HEADER_VERSION}")


lib: Any
lib, library_path = _load()
_check_version(lib, library_path)


def has(name: str) -> bool:
    """Whether the headers declare a function and the library has it."""
    return name in declared and hasattr(lib, name)


def need(name: str, what: str) -> None:
    """LibraryError where the library has no such function."""
    if not has(name):
        raise _errors.LibraryError(
            f"{what}: {library_path} was built without this part (COROT_SOLVE=OFF); load "
            "libcorot_integrate.so instead, by COROT_LIBRARY")


_BY_STATUS = {
    getattr(lib, kind.status): kind
    for kind in (_errors.RetryError, _errors.OutOfMemoryError, _errors.InvalidError,
                 _errors.FormatError, _errors.SingularError, _errors.SystemRefusedError,
                 _errors.IntegrationError)
}


def check(status: int) -> None:
    """Raises what a status stands for, with the message of the last failure on this thread."""
    if status != 0:
        message = ffi.string(lib.corot_error()).decode(errors="replace")
        raise _BY_STATUS.get(status, _errors.Error)(message or f"status {status}")


def text(pointer: Any) -> str:
    """A string of C's."""
    return "" if pointer == ffi.NULL else ffi.string(pointer).decode(errors="replace")


class Pending:
    """An exception of a function of yours that C has called: kept until the call returns, which then
    raises it."""

    def __init__(self) -> None:
        self.exception: BaseException | None = None

    def keep(self, error: BaseException) -> None:
        if self.exception is None:
            self.exception = error

    def raise_kept(self) -> None:
        if self.exception is not None:
            error, self.exception = self.exception, None
            raise error

    def check(self, status: int) -> None:
        """As the function `check`; what was kept comes first."""
        self.raise_kept()
        check(status)


def fail(status: int, message: str) -> int:
    """Leaves a message for C, and returns the status."""
    return int(lib.corot_fail(status, b"%s", ffi.new("char[]", message.encode())))


if sys.maxsize < 2**32:  # pragma: no cover
    raise ImportError("corot's package for Python wants 64 bits")
