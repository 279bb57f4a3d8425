# The compiled module. Callers use the package, which is typed where it stands.
from typing import Any

import numpy as np
import numpy.typing as npt

NODES: int
VERSION: str
ERROR_CODES: tuple[str, ...]

def default_config() -> dict[str, Any]: ...
def curve(nodes: npt.NDArray[np.float32], points: int) -> npt.NDArray[np.float32]: ...
def load_frame_folder(folder: bytes, with_mask: bool) -> dict[str, Any]: ...
def survey_devices(self_test: bool, probe: bool) -> dict[str, Any]: ...
def inspect_weights(file: bytes) -> dict[str, Any]: ...
def export_safetensors(weights: bytes, output: bytes) -> None: ...
def import_safetensors(input: bytes, weights: bytes) -> None: ...
def mask_from_color(
    color_bgr: npt.NDArray[np.uint8], rgb: tuple[int, int, int], given: dict[str, Any]
) -> npt.NDArray[np.uint8]: ...
def mask_from_plane(
    depth_m: npt.NDArray[np.float32],
    intrinsics: tuple[float, float, float, float],
    given: dict[str, Any],
) -> npt.NDArray[np.uint8]: ...
def mask_from_seeds(
    color_bgr: npt.NDArray[np.uint8],
    seeds: list[list[float]],
    depth_m: npt.NDArray[np.float32] | None,
    given: dict[str, Any],
) -> npt.NDArray[np.uint8]: ...
def clean_mask(
    mask: npt.NDArray[np.uint8], given: dict[str, Any]
) -> npt.NDArray[np.uint8]: ...

class Estimator:
    def __init__(self, config: dict[str, Any]) -> None: ...
    def estimate(
        self,
        depth_m: npt.NDArray[np.float32],
        mask: npt.NDArray[np.uint8],
        intrinsics: tuple[float, float, float, float],
        color_bgr: npt.NDArray[np.uint8] | None,
        instances: npt.NDArray[np.uint16] | None,
        hints: dict[str, Any],
        tracked: bool = ...,
    ) -> dict[str, Any]: ...
    def estimate_ropes(
        self,
        depth_m: npt.NDArray[np.float32],
        mask: npt.NDArray[np.uint8],
        intrinsics: tuple[float, float, float, float],
        color_bgr: npt.NDArray[np.uint8] | None,
        instances: npt.NDArray[np.uint16] | None,
    ) -> dict[str, Any]: ...
    def track_ropes(
        self,
        depth_m: npt.NDArray[np.float32],
        mask: npt.NDArray[np.uint8],
        intrinsics: tuple[float, float, float, float],
        color_bgr: npt.NDArray[np.uint8] | None,
        instances: npt.NDArray[np.uint16] | None,
    ) -> dict[str, Any]: ...
    def configure_tracking(self, most_moved_m: float, patience: int) -> None: ...
    def forget(self) -> None: ...
    def close(self) -> None: ...
    @property
    def device(self) -> str: ...
    @property
    def field_device(self) -> str: ...
    @property
    def euler_steps(self) -> int: ...
    @property
    def draws(self) -> int: ...
