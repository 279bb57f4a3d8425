"""The exceptions of flowdlo: one class for each error code of the library, all of them `Error`."""

from __future__ import annotations


class Error(Exception):
    """What the library could not do: who, what was expected, what came, and what to do.

    `code` is the library's name for the reason; it never changes from version to version.
    """

    code: str = "internal"


class BadInput(Error, ValueError):
    """An argument, frame, file or configuration violates its contract."""

    code = "bad_input"


class NoEvidence(Error):
    """No mask pixel carries a usable depth."""

    code = "no_evidence"


class NoPath(Error):
    """The mask holds no stroke that a rope could have drawn."""

    code = "no_path"


class BadWeights(Error):
    """The weights file is missing, damaged, or of another model."""

    code = "bad_weights"


class NoDevice(Error):
    """No device fits what was asked for."""

    code = "no_device"


class DeviceLost(Error):
    """The device failed, hung past its timeout, or ran out of its own memory."""

    code = "device_lost"


class Io(Error, OSError):
    """A file could not be read or written."""

    code = "io"


class Internal(Error):
    """A defect of the library; please report it."""

    code = "internal"


class OutOfMemory(Error, MemoryError):
    """The call found no memory; nothing is broken, it may be tried again."""

    code = "out_of_memory"


_CLASSES = {
    error.code: error
    for error in (
        BadInput,
        NoEvidence,
        NoPath,
        BadWeights,
        NoDevice,
        DeviceLost,
        Io,
        Internal,
        OutOfMemory,
    )
}


def of_code(code: str) -> type[Error]:
    """The class whose `code` is this; `Error` for one that is younger than this file."""
    return _CLASSES.get(code, Error)
