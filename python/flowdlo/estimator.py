"""Frame in, centerline out."""

from __future__ import annotations

import os
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .results import (
    Alternative,
    DrawReport,
    Estimate,
    OneRope,
    RopeCrossing,
    Ropes,
    Timings,
    TrackedRopes,
)

Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]


class Estimator:
    """Owns the device and the weights: make one at start-up, call `estimate` for every frame.

    Every argument may be left out or None, which stands for the library's default
    (`flowdlo.default_config()` lists them):

    weights: a .fdw file; by default the one that FLOWDLO_WEIGHTS in the environment names, or else the
        one that comes with the library.
    device: "auto" takes the best real GPU whose self-test passes, otherwise the CPU; "cpu";
        "vulkan", any Vulkan device; or part of a device's name, or its UUID.
    quality: "auto", "full", or "fast", which takes the place of the next two. "auto" is "fast",
        and "full" with steps or draws of your own or with the thesis' gate.
    euler_steps: of the model, 1..64.
    draws: of the model for each frame, 1..64.
    seed: 0..2**64 - 1; the same seed, frame and device give the same bits.
    prior: "auto", "thesis" or "refined".
    gate: "auto", "thesis" or "calibrated".
    field: "auto"; "strands": no network moves the nodes; or "off": none sees strands, which a mask
      merges, either.
    field_weights: its .safetensors file; by default the one beside the weights.
    field_device: where what sees strands runs: "auto", on a real GPU or on the CPU, whichever a trial
        finds faster; "cpu"; or "device", that of `device`, untried.
    rope_length_m: of the whole rope, metres, where it is known: helps at crossings.
    ropes: how many `estimate_ropes` looks for, 1..32; 0: as many as there are.
    budget_ms: milliseconds that an estimate may take; what would end too late is left out, and
        `Estimate.left_out` says what. 0: as long as it takes.
    threads: of the CPU back end; 0 is one for each core.
    max_width, max_height: largest frame for which memory is set aside, pixels.
    device_timeout_ms: a frame that takes longer on a Vulkan device is `DeviceLost`; 0: chosen.
    validation: Vulkan's validation layers; slow.
    probe: Vulkan drivers are asked in processes of their own before one is loaded here; False: not.

    Raises BadInput, BadWeights, Io, NoDevice or OutOfMemory. Other threads of Python run during the
    constructor and during `estimate`. Calls from several threads on one estimator wait for each
    other; estimators of their own run at the same time. After a fork make a new one in the child.
    """

    _tracked = False  # each estimate by heed of the one before

    def __init__(
        self,
        *,
        weights: Path | None = None,
        device: str | None = None,
        quality: str | None = None,
        euler_steps: int | None = None,
        draws: int | None = None,
        seed: int | None = None,
        prior: str | None = None,
        gate: str | None = None,
        field: str | None = None,
        field_weights: Path | None = None,
        field_device: str | None = None,
        rope_length_m: float | None = None,
        ropes: int | None = None,
        budget_ms: float | None = None,
        threads: int | None = None,
        max_width: int | None = None,
        max_height: int | None = None,
        device_timeout_ms: int | None = None,
        validation: bool | None = None,
        probe: bool | None = None,
    ) -> None:
        given: dict[str, Any] = {
            "device": device,
            "quality": quality,
            "euler_steps": euler_steps,
            "draws": draws,
            "seed": seed,
            "prior": prior,
            "gate": gate,
            "field": field,
            "field_device": field_device,
            "rope_length_m": rope_length_m,
            "ropes": ropes,
            "budget_ms": budget_ms,
            "threads": threads,
            "max_width": max_width,
            "max_height": max_height,
            "device_timeout_ms": device_timeout_ms,
            "validation": validation,
            "probe": probe,
        }
        for name, file in (("weights", weights), ("field_weights", field_weights)):
            given[name] = None if file is None else arguments.path(name, file)
        self._core = _core.Estimator({k: v for k, v in given.items() if v is not None})

    def estimate(
        self,
        depth_m: npt.ArrayLike,
        mask: npt.ArrayLike,
        intrinsics: Any,
        color_bgr: npt.ArrayLike | None = None,
        *,
        depth_scale: float | None = None,
        instances: npt.ArrayLike | None = None,
        first_end: npt.ArrayLike | None = None,
        ends: Sequence[npt.ArrayLike] = (),
        rope_length_m: float | None = None,
        closed: bool | None = None,
        previous: Estimate | npt.ArrayLike | None = None,
    ) -> Estimate:
        """The centerline of the rope in one frame.

        depth_m: [height, width] metres along z (not along the ray), floats; 0 or not finite where
            nothing was measured. Integers, with `depth_scale`.
        mask: [height, width], bool, or uint8 with the rope over 127.
        intrinsics: (fx, fy, cx, cy) in pixels, or a camera matrix [3, 3].
        color_bgr: uint8 [height, width, 3], where there is colour: it helps where the mask leaves
            doubt. Of an RGB image pass image[..., ::-1].
        depth_scale: metres a unit of an integer depth; 0.001 for millimetres.
        instances: integers [height, width], where a segmentation knows which pixel is whose rope's;
            0: none or unknown. Off the mask they hide the rope.
        first_end: a place, whose nearest end becomes node 0: a pixel (u, v), or a point (x, y, z)
            of the camera frame in metres.
        ends: places of ends of the rope, two at most: evidence for the way through the mask.
        rope_length_m: of this frame's rope, metres.
        closed: True where the rope is known to be a ring without ends, `ends` being empty then;
            False where it has two ends.
        previous: the estimate of the frame before, or its nodes: the order of the ends is kept, and
            of ways that the frame does not tell apart the one near it is taken.

        Images are rectified, of one size, at most 4096 px a side, and aligned to one camera. Packed
        (C-contiguous) float32, uint8 and uint8 are read where they lie; all else is copied first.

        Raises BadInput, NoEvidence, NoPath, DeviceLost or OutOfMemory. A rejected prediction is no
        failure: the estimate is then the prior, and `source` says so.
        """
        frame = _frame(depth_m, mask, intrinsics, color_bgr, depth_scale)
        hints = _hints(first_end, ends, rope_length_m, closed, previous)
        labels = _labels(instances, frame[0])
        return _estimate(self._core.estimate(*frame, labels, hints, self._tracked))

    def estimate_ropes(
        self,
        depth_m: npt.ArrayLike,
        mask: npt.ArrayLike,
        intrinsics: Any,
        color_bgr: npt.ArrayLike | None = None,
        *,
        depth_scale: float | None = None,
        instances: npt.ArrayLike | None = None,
    ) -> Ropes:
        """Every rope of one frame: as many as `ropes` of the constructor says.

        instances: integers [height, width], where a segmentation knows which pixel is whose rope's:
            each label on the mask is one rope then; 0: none.

        Everything else is as for `estimate`.
        """
        frame = _frame(depth_m, mask, intrinsics, color_bgr, depth_scale)
        return Ropes(**_ropes(self._core.estimate_ropes(*frame, _labels(instances, frame[0]))))

    @property
    def device(self) -> str:
        """"cpu", or the name of the Vulkan device in use."""
        return self._core.device

    @property
    def field_device(self) -> str:
        """The same of what sees strands; empty where nothing does."""
        return self._core.field_device

    @property
    def euler_steps(self) -> int:
        """Steps of the model in use."""
        return self._core.euler_steps

    @property
    def draws(self) -> int:
        """Draws of the model in use."""
        return self._core.draws

    def close(self) -> None:
        """Frees device and weights now. Later calls raise BadInput; closing again does nothing."""
        self._core.close()

    def __enter__(self) -> Estimator:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()


class Tracker(Estimator):
    """An estimator for a stream of frames: each rope keeps its number, and its nodes their order.

    most_moved_m: metres; a rope that moved farther from one frame to the next is another rope.
    patience: frames that a rope may be missing from and keep its number.

    `estimate` is Estimator's, whose `previous`, if it is left out, is the estimate of the frame
    before. After a frame that raised, the one before it counts; after more than `patience` of them,
    none.

    Every other argument is Estimator's. One tracker for each camera. Raises as Estimator does.
    """

    _tracked = True

    def __init__(
        self, *, most_moved_m: float = 0.1, patience: int = 30, **estimator: Any
    ) -> None:
        super().__init__(**estimator)
        self._core.configure_tracking(
            arguments.number("most_moved_m", most_moved_m), arguments.whole("patience", patience)
        )

    def estimate_ropes(
        self,
        depth_m: npt.ArrayLike,
        mask: npt.ArrayLike,
        intrinsics: Any,
        color_bgr: npt.ArrayLike | None = None,
        *,
        depth_scale: float | None = None,
        instances: npt.ArrayLike | None = None,
    ) -> TrackedRopes:
        """The ropes in the stream's next frame: Estimator.estimate_ropes, by number. Which rope is
        which is decided for all at once, so that they move least in total.
        """
        frame = _frame(depth_m, mask, intrinsics, color_bgr, depth_scale)
        found = self._core.track_ropes(*frame, _labels(instances, frame[0]))
        return TrackedRopes(**_ropes(found))

    def forget(self) -> None:
        """Forgets the ropes of the frames before; numbers go on from where they were."""
        self._core.forget()


def _frame(
    depth_m: npt.ArrayLike,
    mask: npt.ArrayLike,
    intrinsics: Any,
    color_bgr: npt.ArrayLike | None,
    depth_scale: float | None,
) -> tuple[
    npt.NDArray[np.float32],
    npt.NDArray[np.uint8],
    tuple[float, float, float, float],
    npt.NDArray[np.uint8] | None,
]:
    metres = arguments.depth(depth_m, depth_scale)
    rope = arguments.mask(mask)
    color = arguments.color(color_bgr)
    arguments.same_size(metres, rope, color)
    return metres, rope, arguments.intrinsics(intrinsics), color


def _labels(
    instances: npt.ArrayLike | None, depth_m: npt.NDArray[np.float32]
) -> npt.NDArray[np.uint16] | None:
    return None if instances is None else arguments.labels(instances, depth_m)


def _hints(
    first_end: npt.ArrayLike | None,
    ends: Sequence[npt.ArrayLike],
    rope_length_m: float | None,
    closed: bool | None,
    previous: Estimate | npt.ArrayLike | None,
) -> dict[str, Any]:
    hints: dict[str, Any] = {}
    if first_end is not None:
        hints["first_end"] = arguments.place("first_end", first_end)
    if len(ends) > 0:
        hints["ends"] = [arguments.place("ends", end) for end in ends]
    if rope_length_m is not None:
        hints["rope_length_m"] = arguments.number("rope_length_m", rope_length_m)
    if closed is not None:
        hints["closed"] = arguments.flag("closed", closed)
    if previous is not None:
        nodes = previous.nodes if isinstance(previous, Estimate) else previous
        hints["previous"] = arguments.nodes("previous", nodes)
    return hints


def _ropes(found: dict[str, Any]) -> dict[str, Any]:
    found["ropes"] = tuple(_estimate(rope) for rope in found["ropes"])
    found["crossings"] = tuple(RopeCrossing(**crossing) for crossing in found["crossings"])
    return found


def _estimate(found: dict[str, Any]) -> Estimate:
    found["one_rope"] = OneRope(**found["one_rope"])
    found["draws"] = tuple(DrawReport(**draw) for draw in found["draws"])
    found["alternatives"] = tuple(Alternative(**other) for other in found["alternatives"])
    found["timings"] = Timings(**found["timings"])
    return Estimate(**found)
