"""Masks for those who have a camera but no mask yet.

Each call gives uint8 [height, width], 255 where the rope is, 0 elsewhere, ready for
`Estimator.estimate`; all 0 where nothing was found. What is None keeps the library's default,
which `flowdlo/mask.hpp` lists. Areas are pixels of an image 640 px wide and grow with the width.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .errors import BadInput


def mask_from_color(
    color_bgr: npt.ArrayLike,
    rgb: Sequence[int],
    *,
    tolerance: float | None = None,
    least_lightness: float | None = None,
    most_lightness: float | None = None,
    smooth: bool | None = None,
    fill_holes_px2: float | None = None,
    least_piece_px2: float | None = None,
) -> npt.NDArray[np.uint8]:
    """Pixels that have the rope's colour, however brightly they are lit.

    color_bgr: uint8 [height, width, 3], blue first.
    rgb: the rope's colour, red first, sRGB of 0 to 255 each.
    tolerance: distance of chromaticities (a/L, b/L of OKLab), over 0, at most 2.
    least_lightness, most_lightness: OKLab's L, 0..1. A black, grey or white rope differs from a
        table without colour by its lightness alone.
    smooth, fill_holes_px2, least_piece_px2: what is mended, see `clean_mask`.

    Raises BadInput or OutOfMemory.
    """
    given = _given(
        tolerance=tolerance,
        least_lightness=least_lightness,
        most_lightness=most_lightness,
        smooth=smooth,
        fill_holes_px2=fill_holes_px2,
        least_piece_px2=least_piece_px2,
    )
    return _core.mask_from_color(_needed_color(color_bgr), arguments.rgb(rgb), given)


def mask_from_plane(
    depth_m: npt.ArrayLike,
    intrinsics: Any,
    *,
    depth_scale: float | None = None,
    least_m: float | None = None,
    most_m: float | None = None,
    smooth: bool | None = None,
    fill_holes_px2: float | None = None,
    least_piece_px2: float | None = None,
) -> npt.NDArray[np.uint8]:
    """What stands out of the table, or of whatever plane fills most of the depth image.

    depth_m, intrinsics, depth_scale: as for `Estimator.estimate`.
    least_m, most_m: metres above the plane. Noise of the depth raises the lower one.
    smooth, fill_holes_px2, least_piece_px2: what is mended, see `clean_mask`.

    Raises BadInput, also where no plane holds 15 % of the measured pixels, or OutOfMemory.
    """
    given = _given(
        least_m=least_m,
        most_m=most_m,
        smooth=smooth,
        fill_holes_px2=fill_holes_px2,
        least_piece_px2=least_piece_px2,
    )
    metres = arguments.depth(depth_m, depth_scale)
    return _core.mask_from_plane(metres, arguments.intrinsics(intrinsics), given)


def mask_from_seeds(
    color_bgr: npt.ArrayLike,
    seeds: Sequence[Sequence[float]],
    depth_m: npt.ArrayLike | None = None,
    *,
    depth_scale: float | None = None,
    tolerance: float | None = None,
    lightness_tolerance: float | None = None,
    depth_step_m: float | None = None,
    smooth: bool | None = None,
    fill_holes_px2: float | None = None,
    least_piece_px2: float | None = None,
) -> npt.NDArray[np.uint8]:
    """What can be reached from pixels of the rope over neighbours of their colour.

    color_bgr: uint8 [height, width, 3], blue first.
    seeds: up to 256 pixels (column, row); one for each piece and each colour of the rope.
    depth_m, depth_scale: as for `Estimator.estimate`; None: colour alone decides.
    tolerance, lightness_tolerance: of chromaticity and of OKLab's L, over 0, at most 2.
    depth_step_m: metres between neighbours at which a region ends.
    smooth, fill_holes_px2, least_piece_px2: what is mended, see `clean_mask`.

    Raises BadInput or OutOfMemory.
    """
    given = _given(
        tolerance=tolerance,
        lightness_tolerance=lightness_tolerance,
        depth_step_m=depth_step_m,
        smooth=smooth,
        fill_holes_px2=fill_holes_px2,
        least_piece_px2=least_piece_px2,
    )
    color = _needed_color(color_bgr)
    metres = None if depth_m is None else arguments.depth(depth_m, depth_scale)
    if metres is not None:
        arguments.same_size(metres, None, color)
    return _core.mask_from_seeds(color, arguments.pixels("seeds", seeds), metres, given)


def clean_mask(
    mask: npt.ArrayLike,
    *,
    smooth: bool | None = None,
    fill_holes_px2: float | None = None,
    least_piece_px2: float | None = None,
) -> npt.NDArray[np.uint8]:
    """A mask, mended; the calls above do so themselves.

    mask: bool, or uint8 with the rope over 127, [height, width].
    smooth: lone pixels go, and pixels that six neighbours surround are filled.
    fill_holes_px2: holes up to this area are filled.
    least_piece_px2: pieces below this area are left out.

    Raises BadInput or OutOfMemory.
    """
    given = _given(
        smooth=smooth, fill_holes_px2=fill_holes_px2, least_piece_px2=least_piece_px2
    )
    return _core.clean_mask(arguments.mask(mask), given)


def _needed_color(value: npt.ArrayLike) -> npt.NDArray[np.uint8]:
    color = arguments.color(value)
    if color is None:
        raise BadInput("color_bgr: expected uint8 [height, width, 3], got None; pass the image")
    return color


def _given(**options: Any) -> dict[str, Any]:
    """What is not None, as the compiled module takes it."""
    return {
        name: bool(value) if name == "smooth" else arguments.number(name, value)
        for name, value in options.items()
        if value is not None
    }
