"""What goes wrong, as exceptions: one for each status of corot/base.h, under `Error`."""
from __future__ import annotations

__all__ = [
    "Error", "RetryError", "OutOfMemoryError", "InvalidError", "FormatError", "SingularError",
    "SystemRefusedError", "IntegrationError", "ClosedError", "LibraryError", "ProgramError",
]


class Error(Exception):
    """Whatever corot refuses or fails to do. The text is corot's own message, which says what and
    where, with the numbers that matter.

    status: the name of the status in corot/base.h, as "COROT_EINVAL"; "" where Python found it.
    """

    status = ""


class RetryError(Error, ArithmeticError):
    """An evaluation has no value there, as where a tet is inverted: a shorter step may help. Raised
    inside a feedback, it asks the integrator for a shorter step."""

    status = "COROT_RETRY"


class OutOfMemoryError(Error, MemoryError):
    """An allocation failed."""

    status = "COROT_ENOMEM"


class InvalidError(Error, ValueError):
    """An argument or a definition makes no sense."""

    status = "COROT_EINVAL"


class FormatError(Error, ValueError):
    """A file does not say what it should."""

    status = "COROT_EFORMAT"


class SingularError(Error, ArithmeticError):
    """A matrix has no usable factor, or nothing holds the body."""

    status = "COROT_ESINGULAR"


class SystemRefusedError(Error, OSError):
    """The operating system refused to read or write."""

    status = "COROT_EIO"


class IntegrationError(Error, RuntimeError):
    """The integrator gave up, or load stepping found no equilibrium."""

    status = "COROT_EINTEGRATE"


class ClosedError(Error, ValueError):
    """An object is used after it was closed, or after one that it belongs to was."""


class LibraryError(Error, ImportError):
    """The shared library of corot is not there, is another version's, or was built without a part."""


class ProgramError(Error, RuntimeError):
    """The program corot ended with an exit code that says it failed.

    code: the exit code (see `corot --help`); output: what it wrote to stderr.
    """

    def __init__(self, message: str, code: int, output: str) -> None:
        super().__init__(message)
        self.code = code
        self.output = output
