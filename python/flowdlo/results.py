"""What the library gives back: plain, read-only records with numpy arrays in them.

The camera frame has x right, y down, z forward, in metres. Pixels are (u, v): column and row; the
centre of the top left pixel is (0, 0).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core


class Intrinsics(NamedTuple):
    """Pinhole camera, pixels."""

    fx: float
    fy: float
    cx: float
    cy: float


@dataclass(frozen=True)
class OneRope:
    """Whether the mask is one rope, the whole of it, and all of it explained by the nodes.

    Widths are the rope's, as the mask has it.
    """

    explained: float  #: [0, 1] share of the mask's area near the nodes
    slender: float  #: length of the nodes in the image, widths
    sides: float  #: [0, 1] share of the nodes on the mask beside which the mask ends
    even: float  #: [0, 1] share of these where the mask is as wide as the rope
    left_over: float  #: length of the strands that the nodes leave out, widths
    off_mask: float  #: [0, 1] share of the nodes off the mask where nothing hides them
    bare_gap: float  #: longest stretch of nodes on plain background, widths
    goes_on: float  #: how far the rope is seen going on beyond the mask, widths
    doubts: tuple[str, ...]  #: of "no_rope", "strands_left", "bare_gap", "goes_on", "no_depth"


@dataclass(frozen=True)
class DrawReport:
    """The gate's view of one draw of the model."""

    accepted: bool
    finite: bool  #: every coordinate of the draw is finite
    length_ratio: float  #: length of the prediction / length of the prior
    max_segment_share: float  #: longest segment / length of the prediction
    mask_agreement: float  #: [0, 1]


@dataclass(frozen=True, eq=False)
class Alternative:
    """A traversal of the rope that lost to the returned one."""

    nodes: npt.NDArray[np.float32]  #: [64, 3] metres, camera frame
    score: float  #: minus the cost of its path: higher is better, within a frame
    mask_agreement: float  #: [0, 1]


@dataclass(frozen=True)
class Timings:
    """Milliseconds of each stage of one call; all but `beside_ms` sum to `total_ms`."""

    evidence_ms: float
    field_ms: float
    path_ms: float
    prior_ms: float
    readings_ms: float
    beside_ms: float
    mask_field_ms: float
    model_ms: float
    gate_ms: float
    total_ms: float
    device_ms: tuple[tuple[str, float], ...]  #: the parts of model_ms, as a device's clock saw them


@dataclass(frozen=True, eq=False)
class Estimate:
    """The ordered centerline of the rope in one frame, and how far to trust it.

    nodes: float32 [64, 3], metres, camera frame, from one end of the rope to the other.
    support: bool [64], whether a measured point backs the node.
    sigma_m: float32 [64], metres: 68 % of nodes are nearer to the truth than this, 95 % nearer
        than twice this. Not calibrated where `calibrated` is False.
    confidence: [0, 1], the probability that the nodes are within 1 cm of the truth in the mean;
        where `calibrated` is False, that they visit the rope in order; of one rope of several,
        that it is one of the frame's as well.
    source: "prediction" of the model, or "prior", which is no failure.
    origin: which of all candidates: "first_prior", "runner_up" (another way through the mask),
        "other_reading" (found by a further reading), "frame_before" (a stream's rope
        that lies where it lay) or "draw".
    draw: index of the returned draw; None where the prior was returned.
    calibrated: whether the calibrated gate decided, not that of the thesis.
    readings: of the frame; more than one where the first left doubt.
    one_rope: whether the mask is one rope; its `doubts` limit the confidence.
    mask_agreement, prior_mask_agreement: [0, 1], how well nodes and prior explain the mask.
    draws: what the gate saw of each draw.
    alternatives: traversals that came close, best first; may be empty.
    timings: milliseconds of each stage.
    closed: a ring without ends: node 63 lies where node 0 does.
    reversed: a hint made node 0 the end that it would not be without it.
    switched: a hint made another hypothesis the answer.
    left_out: what `budget_ms` left no time for, of "model", "strand_field", "readings".
    """

    nodes: npt.NDArray[np.float32]
    support: npt.NDArray[np.bool_]
    sigma_m: npt.NDArray[np.float32]
    confidence: float
    source: str
    origin: str
    draw: int | None
    calibrated: bool
    readings: int
    one_rope: OneRope
    mask_agreement: float
    prior_mask_agreement: float
    draws: tuple[DrawReport, ...]
    alternatives: tuple[Alternative, ...]
    timings: Timings
    closed: bool
    reversed: bool
    switched: bool
    left_out: tuple[str, ...]

    def curve(self, points: int) -> npt.NDArray[np.float32]:
        """float32 [points, 3] of the smooth curve through the nodes, uniform in its arclength.

        Metres, camera frame, from the first node to the last; 2 to 65536 points. Raises BadInput.
        """
        return _core.curve(self.nodes, points)

    def __repr__(self) -> str:
        return (
            f"<flowdlo.Estimate: {self.source}, confidence {self.confidence:.3f}, "
            f"{int(self.support.sum())} of {len(self.nodes)} nodes measured>"
        )


@dataclass(frozen=True)
class RopeCrossing:
    """Where one rope passes over another, or over itself, in the image."""

    over: int  #: index in Ropes.ropes of the nearer one
    under: int
    over_at_m: float  #: arclength from its node 0, metres
    under_at_m: float
    apart_m: float  #: by how much the one is nearer than the other along the ray, metres


@dataclass(frozen=True, eq=False)
class Ropes:
    """All ropes of one frame.

    ropes: an estimate of each, longest first; never empty.
    crossings: which passes over which, and where.
    instances: uint16 [height, width], which of `ropes` a pixel of the mask shows, from 1; 0: none.
    parting_ms: milliseconds for telling the ropes apart.
    total_ms: milliseconds of the call.
    """

    ropes: tuple[Estimate, ...]
    crossings: tuple[RopeCrossing, ...]
    instances: npt.NDArray[np.uint16]
    parting_ms: float
    total_ms: float


@dataclass(frozen=True, eq=False)
class TrackedRopes(Ropes):
    """The ropes of one frame of a stream: `ropes` by number, their nodes in the order of before.

    numbers: of each rope, from 1 in the order of first sight; none is given twice.
    missing: numbers of the ropes that this frame does not show and that are still waited for.
    """

    numbers: tuple[int, ...]
    missing: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class FrameFolder:
    """A frame read from disk.

    name: the folder's own name.
    depth_m: float32 [height, width], metres along z; 0 where nothing was measured.
    mask: uint8 [height, width], the rope where over 127.
    intrinsics: of the camera that all images are aligned to, pixels.
    color_bgr: uint8 [height, width, 3], or None where the folder has no color.png.
    instances: uint16 [height, width], which rope each pixel is of, from 1, 0: none or unknown; or
        None where the folder has no instances.png.
    truth: float32 [64, 3], metres, camera frame, or None where the folder has no truth.csv.
    """

    name: str
    depth_m: npt.NDArray[np.float32]
    mask: npt.NDArray[np.uint8]
    intrinsics: Intrinsics
    color_bgr: npt.NDArray[np.uint8] | None
    instances: npt.NDArray[np.uint16] | None
    truth: npt.NDArray[np.float32] | None

    def __repr__(self) -> str:
        height, width = self.depth_m.shape
        return f"<flowdlo.FrameFolder {self.name!r}: {width} x {height} px>"


@dataclass(frozen=True)
class Device:
    """A Vulkan device of this machine."""

    name: str  #: as the driver says it
    uuid: str  #: 32 hexadecimal digits
    kind: str  #: "discrete_gpu", "integrated_gpu", "virtual_gpu", "cpu" or "other"
    driver: str  #: name and version
    api_version: str
    subgroup_size: int
    shuffles: bool  #: False: kernels run that need none
    lacks: tuple[str, ...]  #: what flowdlo needs and the device has not; empty: usable
    self_test_passed: bool | None  #: None: not run
    self_test: str  #: verdict in words


@dataclass(frozen=True)
class Driver:
    """A Vulkan driver, as it behaved when it was asked in a process of its own."""

    manifest: str  #: the JSON file by which the Vulkan loader finds it
    used: bool  #: False: it crashed or hung there, and is never loaded here
    devices: int  #: that it listed there
    verdict: str  #: in words
    remembered: bool  #: asked by an earlier process


@dataclass(frozen=True)
class DeviceSurvey:
    """What this machine offers."""

    drivers: tuple[Driver, ...]  #: in the loader's order
    unseen: str  #: why drivers were loaded without having been asked before; empty: they were asked
    vulkan: tuple[Device, ...]  #: in the drivers' order
    loader: str  #: version of the Vulkan loader, or "none"
    advice: str  #: where no Vulkan device is usable: why, and what to install for one
    auto_choice: str  #: what device="auto" takes: a name, or "cpu"


@dataclass(frozen=True)
class TensorInfo:
    """One tensor of a weights file."""

    name: str
    shape: tuple[int, ...]  #: outermost first
    dtype: str  #: "f32" or "f16"


@dataclass(frozen=True)
class WeightsInfo:
    """What is in a weights file."""

    metadata: dict[str, str]
    tensors: tuple[TensorInfo, ...]
    parameters: int
    sha256: str  #: of the tensors' bytes, hexadecimal, verified
