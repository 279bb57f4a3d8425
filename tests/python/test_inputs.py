"""Arrays of every kind: taken where they can be, refused with a clear error where they cannot."""

import numpy as np
import pytest

import flowdlo
from conftest import bits
from flowdlo import arguments


@pytest.fixture(scope="module")
def expected(rose, estimator):
    return bits(estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics))


def padded(image):
    wide = np.zeros((image.shape[0], image.shape[1] + 7), image.dtype)
    wide[:, : image.shape[1]] = image
    return wide[:, : image.shape[1]]


def test_packed_arrays_are_not_copied(rose):
    color = np.zeros((240, 320, 3), np.uint8)
    assert arguments.depth(rose.depth_m, None) is rose.depth_m
    assert arguments.mask(rose.mask) is rose.mask
    assert arguments.color(color) is color


@pytest.mark.parametrize(
    "depth",
    [
        lambda rose: np.asfortranarray(rose.depth_m),
        lambda rose: padded(rose.depth_m),
        lambda rose: rose.depth_m[::-1][::-1],
        lambda rose: rose.depth_m.astype(">f4"),
        lambda rose: rose.depth_m.astype(np.float64),
        lambda rose: rose.depth_m.tolist(),
        lambda rose: np.frombuffer(b"x" + rose.depth_m.tobytes(), np.uint8)[1:]
        .view(np.float32)
        .reshape(240, 320),
    ],
    ids=["columns", "padded", "flipped", "big endian", "double", "list", "unaligned"],
)
def test_depth_of_any_layout_gives_the_same_bits(rose, estimator, expected, depth):
    assert bits(estimator.estimate(depth(rose), rose.mask, rose.intrinsics)) == expected


def test_depth_that_is_not_writable_is_read(rose, estimator, expected):
    depth = rose.depth_m.copy()
    depth.flags.writeable = False
    assert bits(estimator.estimate(depth, rose.mask, rose.intrinsics)) == expected


@pytest.mark.parametrize("kind", [np.uint16, np.int32, np.uint64, ">u2"])
def test_units_of_depth_give_the_bits_of_their_metres(rose, estimator, expected, kind):
    found = estimator.estimate(
        rose.units.astype(kind), rose.mask, rose.intrinsics, depth_scale=0.001
    )
    assert bits(found) == expected


@pytest.mark.parametrize(
    "mask",
    [
        lambda rose: rose.mask > 127,
        lambda rose: np.asfortranarray(rose.mask > 127),
        lambda rose: padded(rose.mask),
        lambda rose: np.dstack([rose.mask] * 3)[:, :, 1],
        lambda rose: (rose.mask // 255 * 128).astype(np.uint8),
    ],
    ids=["bool", "bool by columns", "padded", "a channel", "just over 127"],
)
def test_a_mask_of_any_layout_gives_the_same_bits(rose, estimator, expected, mask):
    found = estimator.estimate(rose.depth_m, mask(rose), rose.intrinsics)
    assert found.nodes.tobytes() == expected[0]


def test_a_camera_may_be_a_matrix(rose, estimator, expected):
    matrix = [[300, 0, 160], [0, 300, 120], [0, 0, 1]]
    for camera in (matrix, np.array(matrix, np.float32), (300, 300, 160, 120)):
        assert bits(estimator.estimate(rose.depth_m, rose.mask, camera)) == expected


def test_missing_depth_may_be_anything_that_is_no_number(rose, estimator):
    found = []
    for nothing in (0, np.nan, np.inf, -1, 1e300):
        depth = rose.depth_m.astype(np.float64)
        depth[:, 160:180] = nothing
        found.append(bits(estimator.estimate(depth, rose.mask, rose.intrinsics)))
    assert all(one == found[0] for one in found)


REFUSED_DEPTHS = {
    "units without a scale": (lambda rose: rose.units, "depth_scale"),
    "three dimensions": (lambda rose: rose.depth_m[..., None], r"\[height, width\]"),
    "one dimension": (lambda rose: rose.depth_m.ravel(), r"\[height, width\]"),
    "complex": (lambda rose: rose.depth_m.astype(complex), r"\[height, width\]"),
    "bool": (lambda rose: rose.mask > 0, "expected floats"),
    "text": (lambda rose: "depth", "depth_m"),
    "nothing": (lambda rose: None, "depth_m"),
    "ragged": (lambda rose: [[1.0], [1.0, 2.0]], "depth_m"),
    "objects": (lambda rose: np.full((240, 320), None), "depth_m"),
    "empty": (lambda rose: np.zeros((0, 0), np.float32), "320 x 240|0 x 0|1 to 4096"),
    "another size": (lambda rose: rose.depth_m[:-1], "expected 320 x 239 px as depth_m"),
}


@pytest.mark.parametrize("depth, words", REFUSED_DEPTHS.values(), ids=REFUSED_DEPTHS.keys())
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore:Creating an ndarray")
def test_a_depth_that_is_none_is_refused(rose, estimator, depth, words):
    with pytest.raises(flowdlo.BadInput, match=words):
        estimator.estimate(depth(rose), rose.mask, rose.intrinsics)


@pytest.mark.parametrize("scale", [0, -0.001, 2, float("nan"), "0.001"])
def test_a_scale_that_is_none_is_refused(rose, estimator, scale):
    with pytest.raises(flowdlo.BadInput, match="depth_scale: expected metres a unit"):
        estimator.estimate(rose.units, rose.mask, rose.intrinsics, depth_scale=scale)


def test_a_scale_of_metres_is_refused(rose, estimator):
    with pytest.raises(flowdlo.BadInput, match="depth_scale: expected None"):
        estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics, depth_scale=0.001)


REFUSED_MASKS = {
    "zeros and ones": (lambda rose: rose.mask // 255, "values of 0 and 1"),
    "floats": (lambda rose: rose.mask.astype(np.float32), "expected bool, or uint8"),
    "integers": (lambda rose: rose.mask.astype(np.int64), "expected bool, or uint8"),
    "three channels": (lambda rose: np.dstack([rose.mask] * 3), r"\[height, width\]"),
    "another size": (lambda rose: rose.mask[:, 1:], "mask: expected 320 x 240 px"),
    "nothing": (lambda rose: None, "mask"),
}


@pytest.mark.parametrize("mask, words", REFUSED_MASKS.values(), ids=REFUSED_MASKS.keys())
def test_a_mask_that_is_none_is_refused(rose, estimator, mask, words):
    with pytest.raises(flowdlo.BadInput, match=words):
        estimator.estimate(rose.depth_m, mask(rose), rose.intrinsics)


@pytest.mark.parametrize(
    "color",
    [
        np.zeros((240, 320, 4), np.uint8),
        np.zeros((240, 320), np.uint8),
        np.zeros((240, 320, 3), np.float32),
        np.zeros((240, 321, 3), np.uint8),
        "red",
    ],
    ids=["four channels", "grey", "floats", "another size", "text"],
)
def test_a_color_that_is_none_is_refused(rose, estimator, color):
    with pytest.raises(flowdlo.BadInput, match="color_bgr"):
        estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics, color)


@pytest.mark.parametrize(
    "camera",
    [
        None,
        "camera",
        (300, 300, 160),
        (0, 300, 160, 120),
        (300, float("nan"), 160, 120),
        (1e300, 300, 160, 120),
        [[300, 5, 160], [0, 300, 120], [0, 0, 1]],
        [[300, 0, 160], [0, 300, 120], [0, 0, 2]],
    ],
)
def test_a_camera_that_is_none_is_refused(rose, estimator, camera):
    with pytest.raises(flowdlo.BadInput, match="intrinsics"):
        estimator.estimate(rose.depth_m, rose.mask, camera)


def test_an_image_that_is_too_large_is_refused(estimator):
    depth = np.broadcast_to(np.float32(0.5), (4097, 1))
    with pytest.raises(flowdlo.BadInput, match="Frame.height: expected 1 to 4096 px, got 4097"):
        estimator.estimate(depth, np.zeros((4097, 1), bool), (300, 300, 0, 0))
