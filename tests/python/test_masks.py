"""Masks from Python: the library's, and clear errors."""

import subprocess

import numpy as np
import pytest

import flowdlo

RED = (209, 36, 36)  # the rope of the frame that ships


def overlap(one, other):
    one, other = one > 127, other > 127
    return (one & other).sum() / (one | other).sum()


def ways(folder):
    yield flowdlo.mask_from_color(folder.color_bgr, RED)
    yield flowdlo.mask_from_plane(folder.depth_m, folder.intrinsics)
    yield flowdlo.mask_from_seeds(folder.color_bgr, [(280, 222)], folder.depth_m)


def test_every_way_gives_the_mask_that_ships(folder):
    for mask in ways(folder):
        assert mask.dtype == np.uint8 and mask.shape == folder.mask.shape
        assert set(np.unique(mask)) == {0, 255}
        assert overlap(mask, folder.mask) > 0.8


def test_an_estimate_takes_them_as_they_come(folder, estimator):
    expected = estimator.estimate(folder.depth_m, folder.mask, folder.intrinsics)
    for mask in ways(folder):
        estimate = estimator.estimate(folder.depth_m, mask, folder.intrinsics)
        off = np.linalg.norm(estimate.nodes - expected.nodes, axis=1)
        assert off.mean() < 0.005


def test_the_command_writes_the_same_bytes(folder, examples, command, tmp_path):
    frame = examples / "frames" / "overhand_loop"
    subprocess.run(
        [command, "mask", frame, "--quiet", "--out", tmp_path, "--color", "209,36,36"], check=True
    )
    (tmp_path / "overhand_loop" / "mask_overlay.png").unlink()
    for name in ("depth.png", "camera.json"):
        content = (frame / name).read_bytes()
        (tmp_path / "overhand_loop" / name).write_bytes(content)
    written = flowdlo.load_frame_folder(tmp_path / "overhand_loop").mask
    assert np.array_equal(written, flowdlo.mask_from_color(folder.color_bgr, RED))


def test_a_folder_without_mask_is_read_when_told_so(examples, tmp_path):
    for name in ("depth.png", "camera.json", "color.png"):
        content = (examples / "frames" / "overhand_loop" / name).read_bytes()
        (tmp_path / name).write_bytes(content)
    with pytest.raises(flowdlo.Io, match="mask.png"):
        flowdlo.load_frame_folder(tmp_path)
    folder = flowdlo.load_frame_folder(tmp_path, with_mask=False)
    assert not folder.mask.any() and folder.mask.shape == folder.depth_m.shape


def test_options_reach_the_library(folder):
    wide = flowdlo.mask_from_color(folder.color_bgr, (128, 128, 128), tolerance=2)
    assert (wide == 255).mean() > 0.9
    none = flowdlo.mask_from_color(folder.color_bgr, RED, least_lightness=0.99)
    assert not none.any()
    assert not flowdlo.mask_from_plane(folder.depth_m, folder.intrinsics, least_m=5, most_m=6).any()
    dots = np.zeros((64, 64), bool)
    dots[::8, ::8] = True
    assert not flowdlo.clean_mask(dots).any()
    kept = flowdlo.clean_mask(dots, smooth=False, least_piece_px2=0)
    assert np.array_equal(kept > 0, dots)


def test_depth_in_units_is_depth_in_metres(folder):
    units = np.round(folder.depth_m * 1000).astype(np.uint16)
    metres = (units * 0.001).astype(np.float32)
    in_units = flowdlo.mask_from_plane(units, folder.intrinsics, depth_scale=0.001)
    assert np.array_equal(in_units, flowdlo.mask_from_plane(metres, folder.intrinsics))


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda f: flowdlo.mask_from_color(None, RED), "color_bgr"),
        (lambda f: flowdlo.mask_from_color(f.color_bgr, (1, 2)), "rgb"),
        (lambda f: flowdlo.mask_from_color(f.color_bgr, (1, 2, 256)), "rgb"),
        (lambda f: flowdlo.mask_from_color(f.color_bgr, RED, tolerance="wide"), "tolerance"),
        (lambda f: flowdlo.mask_from_color(f.color_bgr, RED, tolerance=-1), "tolerance"),
        (lambda f: flowdlo.mask_from_plane(f.depth_m[0], f.intrinsics), "depth_m"),
        (lambda f: flowdlo.mask_from_plane(f.depth_m * 0, f.intrinsics), "expected a table"),
        (lambda f: flowdlo.mask_from_seeds(f.color_bgr, []), "seeds"),
        (lambda f: flowdlo.mask_from_seeds(f.color_bgr, [(1, 2, 3)]), "seeds"),
        (lambda f: flowdlo.mask_from_seeds(f.color_bgr, [(-5, 2)]), "within"),
        (lambda f: flowdlo.mask_from_seeds(f.color_bgr, [(5, 2)], f.depth_m[1:]), "align"),
        (lambda f: flowdlo.clean_mask(f.mask, fill_holes_px2=-1), "fill_holes_px2"),
    ],
)
def test_what_is_wrong_is_said(folder, call, words):
    with pytest.raises(flowdlo.BadInput, match=words):
        call(folder)
