"""Whatever arrays a caller has, as the packed ones that the library reads; or a clear error."""

from __future__ import annotations

import math
import operator
import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from .errors import BadInput
from .results import Intrinsics


def path(name: str, value: Any) -> bytes:
    """The bytes of a path."""
    try:
        encoded = os.fsencode(value)
    except (TypeError, UnicodeError) as fault:
        raise BadInput(
            f"{name}: expected a path, got {value!r}; pass a str or a pathlib.Path"
        ) from fault
    if b"\0" in encoded:
        raise BadInput(f"{name}: expected a path, got one with a zero byte: {value!r}")
    return encoded


def depth(value: Any, scale: float | None) -> npt.NDArray[np.float32]:
    """Metres [height, width], float32 and packed; the caller's array where it is that already."""
    image = _image("depth_m", value, "[height, width]", 2)
    if image.dtype.kind == "f":
        if scale is not None:
            raise BadInput(
                "depth_scale: expected None, since depth_m holds floats, which are metres; "
                f"got {scale!r}; leave it out"
            )
        with np.errstate(over="ignore"):  # infinite is not measured
            return np.ascontiguousarray(image, dtype=np.float32)
    if image.dtype.kind not in "ui":
        raise BadInput(
            f"depth_m: expected floats (metres) or integers, got {image.dtype}; convert it"
        )
    if scale is None:
        raise BadInput(
            f"depth_m: expected floats (metres), got {image.dtype}; convert it, or say how many "
            "metres a unit is by depth_scale, which is 0.001 for millimetres"
        )
    if not _is_number(scale) or not 0 < scale <= 1:
        raise BadInput(
            f"depth_scale: expected metres a unit, over 0 and at most 1, got {scale!r}; a depth in "
            "millimetres has 0.001"
        )
    # The product in double precision, as frame folders are read: the same bits.
    return np.multiply(image, float(scale), dtype=np.float64, casting="unsafe").astype(np.float32)


def mask(value: Any) -> npt.NDArray[np.uint8]:
    """The rope where over 127 [height, width], uint8 and packed."""
    image = _image("mask", value, "[height, width]", 2)
    if image.dtype == np.bool_:
        return np.multiply(image, 255, dtype=np.uint8, casting="unsafe", order="C")
    if image.dtype != np.uint8:
        raise BadInput(
            f"mask: expected bool, or uint8 with the rope over 127, got {image.dtype}; pass for "
            "example mask > 0"
        )
    if image.size and image.max() == 1:
        raise BadInput(
            "mask: expected the rope over 127, got values of 0 and 1; pass mask.astype(bool)"
        )
    return np.ascontiguousarray(image)


def color(value: Any) -> npt.NDArray[np.uint8] | None:
    """Blue, green, red [height, width, 3], uint8 and packed; None stays None."""
    if value is None:
        return None
    image = _image("color_bgr", value, "[height, width, 3]", 3)
    if image.shape[2] != 3 or image.dtype != np.uint8:
        raise BadInput(
            f"color_bgr: expected uint8 [height, width, 3], got {image.dtype} {list(image.shape)}; "
            "convert it to blue, green, red of 8 bits"
        )
    return np.ascontiguousarray(image)


def intrinsics(value: Any) -> tuple[float, float, float, float]:
    """fx, fy, cx, cy of four numbers or of a camera matrix [3, 3]."""
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as fault:
        raise _bad_intrinsics(value) from fault
    if numbers.shape == (3, 3):
        k = numbers
        if k[0, 1] or k[1, 0] or k[2, 0] or k[2, 1] or k[2, 2] != 1:
            raise BadInput(
                "intrinsics: expected a camera matrix [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], got "
                f"{numbers.tolist()}; rectify the images"
            )
        numbers = np.array([k[0, 0], k[1, 1], k[0, 2], k[1, 2]])
    if numbers.shape != (4,):
        raise _bad_intrinsics(value)
    return Intrinsics(*(_single(number) for number in numbers.tolist()))


def place(name: str, value: Any) -> list[float]:
    """A pixel (u, v) or a point (x, y, z)."""
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as fault:
        raise _bad_place(name, value) from fault
    if numbers.shape not in ((2,), (3,)):
        raise _bad_place(name, value)
    return [_single(number) for number in numbers.tolist()]


def pixels(name: str, value: Any) -> list[list[float]]:
    """Pixels (column, row), at least one."""
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as fault:
        raise _bad_pixels(name, value) from fault
    if numbers.ndim != 2 or numbers.shape[1] != 2:
        raise _bad_pixels(name, value)
    return [[_single(number) for number in pixel] for pixel in numbers.tolist()]


def rgb(value: Any) -> tuple[int, int, int]:
    """Red, green, blue of 0 to 255."""
    parts = list(value) if isinstance(value, (list, tuple, np.ndarray)) else []
    if len(parts) != 3 or not all(isinstance(p, (int, np.integer)) and 0 <= p <= 255 for p in parts):
        raise BadInput(f"rgb: expected three integers of 0 to 255, red first, got {value!r}")
    return int(parts[0]), int(parts[1]), int(parts[2])


def number(name: str, value: Any) -> float:
    """A finite number."""
    if not _is_number(value):
        raise BadInput(f"{name}: expected a number, got {value!r}")
    return float(value)


def flag(name: str, value: Any) -> bool:
    """True or False, and nothing that counts as one."""
    if not isinstance(value, (bool, np.bool_)):
        raise BadInput(f"{name}: expected True, False or None, got {value!r}")
    return bool(value)


def whole(name: str, value: Any) -> int:
    """An integer that C has as well."""
    try:
        integer = operator.index(value)
    except TypeError:
        raise BadInput(f"{name}: expected an integer, got {value!r}") from None
    if not -(2**31) <= integer < 2**31:
        raise BadInput(f"{name}: expected an integer of 32 bits, got {value!r}")
    return integer


def nodes(name: str, value: Any) -> npt.NDArray[np.float32]:
    """[64, 3], float32 and packed."""
    points = _image(name, value, "[64, 3]", 2)
    if points.shape != (_core.NODES, 3):
        raise BadInput(
            f"{name}: expected an estimate or its nodes [64, 3], got {_described(value, points)}"
        )
    with np.errstate(over="ignore"):  # the library ignores nodes that are not finite
        return np.ascontiguousarray(points, dtype=np.float32)


def labels(value: Any, depth_m: npt.NDArray[Any]) -> npt.NDArray[np.uint16]:
    """Whose rope a pixel shows [height, width], uint16 and packed."""
    image = _image("instances", value, "[height, width]", 2)
    if image.dtype.kind not in "ui":
        raise BadInput(f"instances: expected integers, got {image.dtype}; convert them")
    if image.shape != depth_m.shape:
        raise BadInput(
            f"instances: expected {depth_m.shape[1]} x {depth_m.shape[0]} px as depth_m, got "
            f"{image.shape[1]} x {image.shape[0]}; align the images"
        )
    if image.size and (image.min() < 0 or image.max() > 65535):
        raise BadInput(
            f"instances: expected labels of 0 to 65535, got {image.min()} to {image.max()}; "
            "number them anew"
        )
    return np.ascontiguousarray(image, dtype=np.uint16)


def same_size(
    depth_m: npt.NDArray[Any],
    mask_image: npt.NDArray[Any] | None,
    color_bgr: npt.NDArray[Any] | None,
) -> None:
    """Refuses images of several sizes."""
    for name, image in (("mask", mask_image), ("color_bgr", color_bgr)):
        if image is not None and image.shape[:2] != depth_m.shape:
            raise BadInput(
                f"{name}: expected {depth_m.shape[1]} x {depth_m.shape[0]} px as depth_m, got "
                f"{image.shape[1]} x {image.shape[0]}; align the images"
            )


def _image(name: str, value: Any, shape: str, dimensions: int) -> npt.NDArray[Any]:
    try:
        image = np.asarray(value)
    except Exception as fault:  # whatever an object's own conversion raises
        raise BadInput(f"{name}: expected an array {shape}, got {type(value).__name__}") from fault
    if image.dtype.kind not in "buif" or image.ndim != dimensions:
        raise BadInput(
            f"{name}: expected an array {shape}, got {_described(value, image)}; pass one image"
        )
    return image


def _described(value: Any, image: npt.NDArray[Any]) -> str:
    if isinstance(value, np.ndarray):
        return f"{image.dtype} {list(image.shape)}"
    return f"{type(value).__name__} of shape {list(image.shape)}"


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and math.isfinite(value)


def _single(number: float) -> float:
    with np.errstate(over="ignore"):  # the library refuses what is infinite, and says so
        return float(np.float32(number))


def _bad_place(name: str, value: Any) -> BadInput:
    return BadInput(
        f"{name}: expected a pixel (u, v) or a point (x, y, z) in metres, got {value!r}"
    )


def _bad_pixels(name: str, value: Any) -> BadInput:
    return BadInput(f"{name}: expected pixels [[column, row], ...], got {value!r}")


def _bad_intrinsics(value: Any) -> BadInput:
    return BadInput(
        "intrinsics: expected (fx, fy, cx, cy) in pixels or a camera matrix [3, 3], got "
        f"{value!r}; pass flowdlo.Intrinsics(fx, fy, cx, cy)"
    )
