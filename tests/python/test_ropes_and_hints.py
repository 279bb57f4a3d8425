"""Several ropes, hints, a budget and the dense curve."""

import json
import struct
import zlib

import numpy as np
import pytest

import flowdlo
from conftest import SMALL

CAMERA = flowdlo.Intrinsics(300, 300, 160, 120)


def bars(*rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Straight ropes from left to right in those rows: depth in metres, labels from 1."""
    labels = np.zeros((240, 320), dtype=np.uint16)
    for number, row in enumerate(rows, start=1):
        labels[row - 4 : row + 5, 40 : 280 - 10 * number] = number
    return np.where(labels > 0, 0.5, 0.6).astype(np.float32), labels


def flowdlo_frame_folder(folder, depth_m: np.ndarray, labels: np.ndarray) -> None:
    """Images as PNG of 16 bits, by hand: no picture library is needed."""

    def png(file, image):
        def chunk(kind, body):
            checksum = zlib.crc32(kind + body)
            return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", checksum)

        height, width = image.shape
        bits = 8 * image.dtype.itemsize
        rows = b"".join(b"\0" + row.astype(f">u{bits // 8}").tobytes() for row in image)
        header = struct.pack(">IIBBBBB", width, height, bits, 0, 0, 0, 0)
        parts = ((b"IHDR", header), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
        file.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts))

    folder.mkdir()
    png(folder / "depth.png", np.round(depth_m * 1000).astype(np.uint16))
    png(folder / "mask.png", np.where(labels > 0, 255, 0).astype(np.uint8))
    png(folder / "instances.png", labels)
    height, width = labels.shape
    names = ("fx", "fy", "cx", "cy")
    camera = dict(zip(names, CAMERA), width=width, height=height, depth_scale=0.001)
    (folder / "camera.json").write_text(json.dumps(camera))


@pytest.fixture(scope="module")
def all_ropes():
    with flowdlo.Estimator(ropes=0, **SMALL) as made:
        yield made


def test_every_rope_is_found_longest_first(all_ropes):
    depth_m, labels = bars(60, 120, 180)
    found = all_ropes.estimate_ropes(depth_m, labels > 0, CAMERA)
    assert isinstance(found, flowdlo.Ropes)
    lengths = [np.linalg.norm(np.diff(r.nodes, axis=0), axis=1).sum() for r in found.ropes]
    assert len(lengths) == 3
    assert lengths == sorted(lengths, reverse=True)
    assert found.crossings == ()
    assert found.instances.dtype == np.uint16
    assert np.array_equal(found.instances, labels)
    assert found.total_ms > found.parting_ms > 0


def test_labels_tell_which_pixel_is_whose(estimator):
    depth_m, labels = bars(100, 112)
    found = estimator.estimate_ropes(depth_m, labels > 0, CAMERA, instances=labels.astype(np.int64))
    assert len(found.ropes) == 2


def test_a_folder_brings_its_labels(estimator, tmp_path):
    depth_m, labels = bars(100, 112)
    folder = tmp_path / "frame"
    flowdlo_frame_folder(folder, depth_m, labels)
    frame = flowdlo.load_frame_folder(folder)
    assert np.array_equal(frame.instances, labels)
    by_labels = estimator.estimate_ropes(
        frame.depth_m, frame.mask, frame.intrinsics, instances=frame.instances
    )
    assert len(by_labels.ropes) == 2
    one = estimator.estimate(
        depth_m, labels == 1, CAMERA, instances=np.where(labels == 2, 2, 0)
    )
    assert np.abs(one.nodes[:, 1].mean() - (100 - 120) / 300 * 0.5) < 0.01


@pytest.mark.parametrize(
    "labels", [np.zeros((240, 320)), np.zeros((10, 10), int), np.full((240, 320), -1)]
)
def test_labels_that_are_none_are_refused(estimator, labels):
    depth_m, bar = bars(120)
    with pytest.raises(flowdlo.BadInput, match="instances"):
        estimator.estimate_ropes(depth_m, bar > 0, CAMERA, instances=labels)


def test_the_first_end_is_the_one_that_is_named(estimator):
    depth_m, bar = bars(120)
    plain = estimator.estimate(depth_m, bar > 0, CAMERA)
    assert not plain.reversed
    turned = estimator.estimate(depth_m, bar > 0, CAMERA, first_end=(270, 120))
    assert turned.reversed
    assert np.array_equal(turned.nodes, plain.nodes[::-1])
    by_point = estimator.estimate(depth_m, bar > 0, CAMERA, first_end=turned.nodes[0])
    assert by_point.reversed


def test_the_order_of_the_frame_before_is_kept(estimator):
    depth_m, bar = bars(120)
    turned = estimator.estimate(depth_m, bar > 0, CAMERA, first_end=(270, 120))
    kept = estimator.estimate(depth_m, bar > 0, CAMERA, previous=turned)
    assert kept.nodes[0, 0] > kept.nodes[-1, 0]
    assert estimator.estimate(depth_m, bar > 0, CAMERA, previous=turned.nodes).reversed


def test_a_ring_that_a_gap_parts_is_closed_where_that_is_known(estimator):
    v, u = np.mgrid[:240, :320]
    ring = np.abs(np.hypot(u - 160, v - 120) - 80) < 5
    ring &= ~((u > 200) & (np.abs(v - 120) < 8))
    depth_m = np.where(ring, 0.5, 0.6).astype(np.float32)
    assert not estimator.estimate(depth_m, ring, CAMERA).closed
    closed = estimator.estimate(depth_m, ring, CAMERA, closed=True)
    assert closed.closed
    assert np.linalg.norm(closed.nodes[0] - closed.nodes[-1]) < 2e-3
    assert not estimator.estimate(depth_m, ring, CAMERA, closed=False).closed


@pytest.mark.parametrize(
    "hints",
    [
        {"first_end": (1, 2, 3, 4)},
        {"first_end": "here"},
        {"first_end": (9999, 120)},
        {"ends": [(1, 2), (3, 4), (5, 6)]},
        {"rope_length_m": -1.0},
        {"rope_length_m": "long"},
        {"closed": 1},
        {"closed": True, "ends": [(60, 120)]},
        {"previous": np.zeros((3, 3))},
    ],
)
def test_hints_that_cannot_be_are_refused(estimator, hints):
    depth_m, bar = bars(120)
    with pytest.raises(flowdlo.BadInput):
        estimator.estimate(depth_m, bar > 0, CAMERA, **hints)


def test_the_curve_is_as_dense_as_asked(estimator):
    depth_m, bar = bars(120)
    estimate = estimator.estimate(depth_m, bar > 0, CAMERA)
    curve = estimate.curve(500)
    assert curve.shape == (500, 3) and curve.dtype == np.float32
    assert np.allclose(curve[0], estimate.nodes[0], atol=1e-6)
    assert np.allclose(curve[-1], estimate.nodes[-1], atol=1e-6)
    with pytest.raises(flowdlo.BadInput, match="points"):
        estimate.curve(1)


def test_what_the_budget_left_out_is_said(rose):
    with flowdlo.Estimator(budget_ms=1e-6, **SMALL) as hurried:
        estimate = hurried.estimate(rose.depth_m, rose.mask, rose.intrinsics)
    assert estimate.left_out == ("model", "strand_field", "readings")
    with pytest.raises(flowdlo.BadInput, match="budget_ms"):
        flowdlo.Estimator(budget_ms=-1.0, **SMALL)
