"""What the tests of the Python package share: a frame that ships, a drawn one, and an estimator."""

import os
from pathlib import Path

import numpy as np
import pytest

import flowdlo

SMALL = {"device": "cpu", "euler_steps": 2, "draws": 2}


@pytest.fixture(scope="session")
def examples() -> Path:
    return Path(os.environ["FLOWDLO_EXAMPLES"])


@pytest.fixture(scope="session")
def command() -> str:
    if "FLOWDLO_COMMAND" not in os.environ:
        pytest.skip("the flowdlo command was not built")
    return os.environ["FLOWDLO_COMMAND"]


@pytest.fixture(scope="session")
def folder(examples) -> flowdlo.FrameFolder:
    return flowdlo.load_frame_folder(examples / "frames" / "overhand_loop")


@pytest.fixture(scope="session")
def estimator():
    with flowdlo.Estimator(**SMALL) as made:
        yield made


class Rose:
    """A rope laid in three petals, 320 x 240 px: nobody can see which goes on into which."""

    def __init__(self) -> None:
        v, u = np.mgrid[0:240, 0:320]
        rope = np.zeros((240, 320), bool)
        for angle in np.linspace(0, np.pi, 1000, endpoint=False):
            from_centre = 100 * np.cos(3 * angle)
            away = np.hypot(
                u - 160 - from_centre * np.cos(angle), v - 120 - from_centre * np.sin(angle)
            )
            rope |= away <= 5
        self.mask = np.where(rope, 255, 0).astype(np.uint8)
        self.units = np.where(rope, 500, 510).astype(np.uint16)
        self.depth_m = np.where(rope, 0.5, 0.51).astype(np.float32)
        self.intrinsics = flowdlo.Intrinsics(300, 300, 160, 120)


@pytest.fixture(scope="session")
def rose() -> Rose:
    return Rose()


def bits(estimate: flowdlo.Estimate) -> tuple:
    """Everything an estimate says but how long it took, to be compared bit for bit."""
    return (
        estimate.nodes.tobytes(),
        estimate.support.tobytes(),
        estimate.sigma_m.tobytes(),
        estimate.confidence,
        estimate.source,
        estimate.draw,
        estimate.calibrated,
        estimate.readings,
        estimate.one_rope,
        estimate.mask_agreement,
        estimate.prior_mask_agreement,
        estimate.draws,
        tuple((a.nodes.tobytes(), a.score, a.mask_agreement) for a in estimate.alternatives),
    )
