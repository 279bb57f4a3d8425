"""An estimate in Python is the library's, bit for bit."""

import json
import pickle
import subprocess

import numpy as np

import flowdlo
from conftest import SMALL, bits


def by_command(command, frame, out):
    subprocess.run(
        [command, "estimate", frame, "--out", out, "--quiet"]
        + ["--device", "cpu", "--steps", "2", "--draws", "2"],
        check=True,
    )
    result = out / frame.name
    nodes = np.loadtxt(result / "centerline.csv", delimiter=",", skiprows=1, dtype=np.float64)
    return nodes.astype(np.float32), json.loads((result / "estimate.json").read_text())


def seven_digits(value):
    """As estimate.json has a number; centerline.csv has all that a float holds."""
    return float(f"{value:.7g}")


def test_the_bits_are_those_of_the_command(command, examples, folder, estimator, tmp_path):
    nodes, said = by_command(command, examples / "frames" / "overhand_loop", tmp_path)
    estimate = estimator.estimate(
        folder.depth_m, folder.mask, folder.intrinsics, folder.color_bgr
    )
    assert estimate.nodes.tobytes() == nodes.tobytes()
    assert estimate.support.tolist() == [bool(h) for h in said["support"]]
    assert [seven_digits(sigma) for sigma in estimate.sigma_m] == said["sigma_m"]
    assert seven_digits(estimate.confidence) == said["confidence"]
    assert estimate.source == said["source"]
    assert estimate.origin == said["origin"]
    assert len(estimate.alternatives) == len(said["alternatives"])
    assert [draw.accepted for draw in estimate.draws] == [d["accepted"] for d in said["draws"]]


def test_doubts_and_alternatives_are_those_of_the_command(command, rose, estimator, tmp_path):
    frame = tmp_path / "rose"
    save(frame, rose)
    nodes, said = by_command(command, frame, tmp_path / "out")
    estimate = estimator.estimate(rose.units, rose.mask, rose.intrinsics, depth_scale=0.001)
    assert estimate.nodes.tobytes() == nodes.tobytes()
    assert estimate.readings > 1
    assert list(estimate.one_rope.doubts) == said["one_rope"]["doubts"]
    assert len(estimate.alternatives) == len(said["alternatives"]) > 0
    assert estimate.alternatives[0].nodes.shape == (64, 3)


def save(frame, rose):
    """The rose as a frame folder; PNG by hand takes zlib and checksums, and no other package."""
    import struct
    import zlib

    def png(pixels):
        height, width = pixels.shape
        rows = b"".join(
            b"\0" + row.astype(row.dtype.newbyteorder(">")).tobytes() for row in pixels
        )

        def chunk(kind, data):
            checksum = zlib.crc32(kind + data)
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)

        header = struct.pack(">IIBBBBB", width, height, 8 * pixels.itemsize, 0, 0, 0, 0)
        return (
            b"\x89PNG\r\n\x1a\n"
            + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows))
            + chunk(b"IEND", b"")
        )

    frame.mkdir()
    (frame / "depth.png").write_bytes(png(rose.units))
    (frame / "mask.png").write_bytes(png(rose.mask))
    camera = {"width": 320, "height": 240, "depth_scale": 0.001, **rose.intrinsics._asdict()}
    (frame / "camera.json").write_text(json.dumps(camera))


def test_shapes_and_types_are_as_documented(folder, estimator):
    estimate = estimator.estimate(folder.depth_m, folder.mask, folder.intrinsics)
    assert estimate.nodes.shape == (flowdlo.NODES, 3) and estimate.nodes.dtype == np.float32
    assert estimate.sigma_m.shape == (flowdlo.NODES,) and estimate.sigma_m.dtype == np.float32
    assert estimate.support.shape == (flowdlo.NODES,) and estimate.support.dtype == np.bool_
    assert 0 <= estimate.confidence <= 1
    assert estimate.source in ("prediction", "prior")
    assert (estimate.draw is None) == (estimate.source == "prior")
    assert (estimate.origin == "draw") == (estimate.source == "prediction")
    assert len(estimate.draws) == 2
    assert estimate.timings.total_ms > 0


def test_an_estimate_outlives_its_estimator_and_may_be_changed(folder):
    with flowdlo.Estimator(**SMALL) as estimator:
        estimate = estimator.estimate(folder.depth_m, folder.mask, folder.intrinsics)
    before = estimate.nodes.copy()
    estimate.nodes[:] += 1
    assert np.array_equal(estimate.nodes, before + 1)


def test_an_estimate_can_be_pickled(rose, estimator):
    estimate = estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics)
    assert bits(pickle.loads(pickle.dumps(estimate))) == bits(estimate)


def test_color_reaches_the_field(rose, estimator):
    """The strand field reads a frame that leaves doubt, and it looks at colour."""
    plain = estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics)
    noise = np.random.default_rng(1).integers(0, 255, (240, 320, 3), dtype=np.uint8)
    coloured = estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics, noise)
    again = estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics, noise)
    assert bits(coloured) == bits(again)
    assert bits(coloured) != bits(plain)


def test_the_seed_is_heard(rose):
    found = []
    for seed in (0, 2**64 - 1, 0):
        with flowdlo.Estimator(**SMALL, gate="thesis", seed=seed) as estimator:
            found.append(estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics))
    assert bits(found[0]) == bits(found[2])
    assert found[0].draws != found[1].draws


def test_quality_fast_takes_the_weights_own_steps_and_draws():
    with flowdlo.Estimator(device="cpu", quality="fast") as estimator:
        assert (estimator.euler_steps, estimator.draws) == (1, 1)
        assert estimator.device == "cpu"
