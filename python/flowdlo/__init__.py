"""FlowDLO: the complete ordered 3D centerline of a rope from one RGB-D frame.

    import flowdlo

    frame = flowdlo.load_frame_folder("examples/frames/overhand_loop")
    with flowdlo.Estimator() as estimator:
        estimate = estimator.estimate(frame.depth_m, frame.mask, frame.intrinsics, frame.color_bgr)
    print(estimate.nodes, estimate.confidence)
"""

from ._core import NODES
from ._core import VERSION as __version__
from .errors import (
    BadInput,
    BadWeights,
    DeviceLost,
    Error,
    Internal,
    Io,
    NoDevice,
    NoEvidence,
    NoPath,
    OutOfMemory,
)
from .estimator import Estimator, Tracker
from .inspection import (
    default_config,
    export_safetensors,
    import_safetensors,
    inspect_weights,
    load_frame_folder,
    survey_devices,
)
from .masks import clean_mask, mask_from_color, mask_from_plane, mask_from_seeds
from .results import (
    Alternative,
    Device,
    DeviceSurvey,
    DrawReport,
    Driver,
    Estimate,
    FrameFolder,
    Intrinsics,
    OneRope,
    RopeCrossing,
    Ropes,
    TensorInfo,
    Timings,
    TrackedRopes,
    WeightsInfo,
)

__all__ = [
    "NODES",
    "Alternative",
    "BadInput",
    "BadWeights",
    "Device",
    "DeviceLost",
    "DeviceSurvey",
    "DrawReport",
    "Driver",
    "Error",
    "Estimate",
    "Estimator",
    "FrameFolder",
    "Internal",
    "Intrinsics",
    "Io",
    "NoDevice",
    "NoEvidence",
    "NoPath",
    "OneRope",
    "OutOfMemory",
    "RopeCrossing",
    "Ropes",
    "TensorInfo",
    "Timings",
    "TrackedRopes",
    "Tracker",
    "WeightsInfo",
    "__version__",
    "clean_mask",
    "default_config",
    "export_safetensors",
    "import_safetensors",
    "inspect_weights",
    "load_frame_folder",
    "mask_from_color",
    "mask_from_plane",
    "mask_from_seeds",
    "survey_devices",
]
