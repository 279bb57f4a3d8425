"""Frames on disk, devices, and weights files."""

from __future__ import annotations

import os
from typing import Any

from . import _core, arguments
from .estimator import Path
from .results import Device, DeviceSurvey, Driver, FrameFolder, Intrinsics, TensorInfo, WeightsInfo


def default_config() -> dict[str, Any]:
    """Every keyword of `Estimator` and what it is when left out; an empty path: found by itself."""
    config = _core.default_config()
    return {name: os.fsdecode(v) if isinstance(v, bytes) else v for name, v in config.items()}


def load_frame_folder(folder: Path, with_mask: bool = True) -> FrameFolder:
    """Reads depth.png, mask.png, camera.json and, where present, color.png and truth.csv.

    with_mask: False for a folder whose mask is still to be made: the mask is 0 then.

    Raises Io, BadInput or OutOfMemory, naming the file and what to do.
    """
    found = _core.load_frame_folder(arguments.path("folder", folder), bool(with_mask))
    found["intrinsics"] = Intrinsics(*found["intrinsics"])
    return FrameFolder(**found)


def survey_devices(self_test: bool = False, probe: bool = True) -> DeviceSurvey:
    """Looks at every Vulkan device.

    With `self_test` it runs a model of known answers on each usable one, which takes a while. Never
    fails: a machine without Vulkan has no devices, and `advice` says why. `probe`: as `Estimator`'s.
    """
    found = _core.survey_devices(bool(self_test), bool(probe))
    found["drivers"] = tuple(Driver(**driver) for driver in found["drivers"])
    found["vulkan"] = tuple(Device(**device) for device in found["vulkan"])
    return DeviceSurvey(**found)


def inspect_weights(file: Path) -> WeightsInfo:
    """Reads and verifies a .fdw file. Raises Io or BadWeights, listing every mismatch."""
    found = _core.inspect_weights(arguments.path("file", file))
    found["tensors"] = tuple(TensorInfo(**tensor) for tensor in found["tensors"])
    return WeightsInfo(**found)


def export_safetensors(weights: Path, output: Path) -> None:
    """Writes a .fdw file as .safetensors, which PyTorch and others read, metadata included.

    `output` is written whole or not at all. Raises Io or BadWeights.
    """
    _core.export_safetensors(arguments.path("weights", weights), arguments.path("output", output))


def import_safetensors(input: Path, weights: Path) -> None:
    """Writes a .safetensors file as the .fdw file that `Estimator` reads.

    Tensors are named, and the metadata's keys are, as `export_safetensors` writes them. `weights` is
    written whole or not at all. Raises Io or BadWeights, listing every mismatch.
    """
    _core.import_safetensors(arguments.path("input", input), arguments.path("weights", weights))
