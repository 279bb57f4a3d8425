"""Streams of frames: ropes keep their numbers and the order of their nodes."""

import numpy as np
import pytest

import flowdlo
from conftest import SMALL

CAMERA = flowdlo.Intrinsics(300, 300, 160, 120)


def bars(*rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Straight ropes from left to right in those rows, the first the longest: depth in metres, mask."""
    mask = np.zeros((240, 320), dtype=bool)
    for number, row in enumerate(rows, start=1):
        mask[row - 4 : row + 5, 40 : 280 - 10 * number] = True
    return np.where(mask, 0.5, 0.6).astype(np.float32), mask


@pytest.fixture()
def tracker():
    with flowdlo.Tracker(ropes=0, most_moved_m=0.05, patience=1, **SMALL) as made:
        yield made


def test_ropes_keep_their_numbers_whatever_their_length(tracker):
    first = tracker.estimate_ropes(*bars(60, 160), CAMERA)
    assert isinstance(first, flowdlo.TrackedRopes)
    assert first.numbers == (1, 2)
    assert first.missing == ()
    second = tracker.estimate_ropes(*bars(158, 62), CAMERA)  # the lower one is the longer now
    assert second.numbers == (1, 2)
    for before, now in zip(first.ropes, second.ropes):
        assert np.abs(before.nodes[:, 1] - now.nodes[:, 1]).max() < 0.01


def test_a_rope_is_missing_for_as_long_as_patience_lasts(tracker):
    tracker.estimate_ropes(*bars(60, 160), CAMERA)
    assert tracker.estimate_ropes(*bars(60), CAMERA).missing == (2,)
    back = tracker.estimate_ropes(*bars(60, 160), CAMERA)
    assert back.numbers == (1, 2)
    tracker.forget()
    assert tracker.estimate_ropes(*bars(60, 160), CAMERA).numbers == (3, 4)


def test_one_rope_keeps_the_order_of_its_ends(tracker):
    frame = bars(120)
    turned = tracker.estimate(*frame, CAMERA, first_end=(270, 120))
    assert turned.reversed
    assert np.array_equal(tracker.estimate(*frame, CAMERA).nodes, turned.nodes)
    tracker.forget()
    assert not tracker.estimate(*frame, CAMERA).reversed


def test_a_tracker_is_an_estimator_and_closes_as_one():
    tracker = flowdlo.Tracker(**SMALL)
    assert isinstance(tracker, flowdlo.Estimator)
    assert tracker.device == "cpu"
    tracker.close()
    for call in (tracker.forget, lambda: tracker.estimate(*bars(120), CAMERA)):
        with pytest.raises(flowdlo.BadInput, match="closed"):
            call()


@pytest.mark.parametrize(
    "wrong",
    [
        {"most_moved_m": 0.0},
        {"most_moved_m": "far"},
        {"patience": -1},
        {"patience": 1.5},
        {"patience": 2**40},
    ],
)
def test_what_cannot_be_is_refused_by_name(wrong):
    with pytest.raises(flowdlo.BadInput, match=next(iter(wrong))):
        flowdlo.Tracker(**wrong, **SMALL)
