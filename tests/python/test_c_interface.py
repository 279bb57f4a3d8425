"""The C interface called by a foreign language gives what the Python package gives, bit for bit."""

import ctypes
import os
import re
from pathlib import Path

import numpy as np
import pytest

from conftest import SMALL

LIBRARY = ctypes.CDLL(os.environ["FLOWDLO_LIBRARY"])
LIBRARY.flowdlo_last_error.restype = ctypes.c_char_p
LIBRARY.flowdlo_version.restype = ctypes.c_char_p
for name in ("source", "origin", "doubt"):
    getattr(LIBRARY, f"flowdlo_{name}_name").restype = ctypes.c_char_p
EXAMPLES = Path(os.environ["FLOWDLO_EXAMPLES"])
PIXEL_F32, PIXEL_U16, PIXEL_U8, PIXEL_BGR8, PIXEL_RGB8 = range(1, 6)


class Config(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        *((name, ctypes.c_char_p) for name in ("weights", "device", "field_weights")),
        ("seed", ctypes.c_uint64),
        ("rope_length_m", ctypes.c_double),
        *((name, ctypes.c_int32) for name in "quality euler_steps draws prior gate field".split()),
        *((name, ctypes.c_int32) for name in "threads max_width max_height timeout".split()),
        *((name, ctypes.c_int32) for name in ("validation", "reserved")),
        ("budget_ms", ctypes.c_double),
        *((name, ctypes.c_int32) for name in ("probe", "ropes")),
    ]


class Image(ctypes.Structure):
    _fields_ = [
        ("data", ctypes.c_void_p),
        ("row_bytes", ctypes.c_ssize_t),
        ("pixel_bytes", ctypes.c_ssize_t),
        ("pixel", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
    ]


class Frame(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        *((name, Image) for name in ("depth", "mask", "color")),
        ("depth_scale_m", ctypes.c_double),
        *((name, ctypes.c_int32) for name in ("width", "height")),
        *((name, ctypes.c_float) for name in ("fx", "fy", "cx", "cy")),
        *((name, ctypes.c_int32) for name in ("roi_u", "roi_v", "roi_width", "roi_height")),
    ]


class Estimate(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        ("nodes", ctypes.c_float * 3 * 64),
        ("sigma_m", ctypes.c_float * 64),
        ("support", ctypes.c_uint8 * 64),
        *((name, ctypes.c_float) for name in ("confidence", "agreement", "prior_agreement")),
        *((name, ctypes.c_int32) for name in ("source", "draw", "calibrated", "readings")),
        ("doubts", ctypes.c_uint32),
        *((name, ctypes.c_int32) for name in ("alternatives", "accepted_draws")),
        ("one_rope", ctypes.c_float * 8),
        ("milliseconds", ctypes.c_double * 9),
        ("left_out", ctypes.c_uint32),
        ("closed", ctypes.c_int32),
        ("origin", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
    ]


def check(status):
    assert status == 0, LIBRARY.flowdlo_last_error().decode()


def filled(kind, initialise):
    one = kind()
    check(initialise(ctypes.byref(one), ctypes.c_size_t(ctypes.sizeof(one))))
    return one


@pytest.fixture(scope="module")
def handle():
    config = filled(Config, LIBRARY.flowdlo_config_init)
    config.device = SMALL["device"].encode()
    config.euler_steps = SMALL["euler_steps"]
    config.draws = SMALL["draws"]
    made = ctypes.c_void_p()
    check(LIBRARY.flowdlo_estimator_create(ctypes.byref(config), ctypes.byref(made)))
    yield made
    LIBRARY.flowdlo_estimator_destroy(made)


def image(array, pixel, pixel_bytes=0):
    return Image(array.ctypes.data, array.strides[0], pixel_bytes, pixel, 0)


def estimated(handle, depth, mask, camera, color=None, roi=(0, 0, 0, 0)):
    frame = filled(Frame, LIBRARY.flowdlo_frame_init)
    frame.depth = image(depth, PIXEL_U16 if depth.dtype == np.uint16 else PIXEL_F32)
    frame.mask = image(mask, PIXEL_U8)
    if color is not None:
        frame.color = image(color, PIXEL_RGB8)
    frame.height, frame.width = depth.shape
    frame.fx, frame.fy, frame.cx, frame.cy = camera
    frame.roi_u, frame.roi_v, frame.roi_width, frame.roi_height = roi
    estimate = filled(Estimate, LIBRARY.flowdlo_estimate_init)
    check(
        LIBRARY.flowdlo_estimator_estimate(handle, ctypes.byref(frame), ctypes.byref(estimate))
    )
    return estimate


def assert_same(in_c, in_python):
    assert bytes(in_c.nodes) == in_python.nodes.tobytes()
    assert bytes(in_c.sigma_m) == in_python.sigma_m.tobytes()
    assert bytes(in_c.support) == in_python.support.tobytes()
    assert in_c.confidence == in_python.confidence
    assert LIBRARY.flowdlo_source_name(in_c.source).decode() == in_python.source
    assert LIBRARY.flowdlo_origin_name(in_c.origin).decode() == in_python.origin
    assert in_c.alternatives == len(in_python.alternatives)
    bits = (1 << bit for bit in range(32) if in_c.doubts >> bit & 1)
    doubts = {LIBRARY.flowdlo_doubt_name(bit).decode() for bit in bits}
    assert doubts == set(in_python.one_rope.doubts)


def test_versions_are_the_same():
    assert LIBRARY.flowdlo_version().decode() == os.environ["FLOWDLO_VERSION"]


def test_a_frame_with_color(handle, folder, estimator):
    rgb = np.ascontiguousarray(folder.color_bgr[..., ::-1])
    in_c = estimated(handle, folder.depth_m, folder.mask, folder.intrinsics, rgb)
    assert_same(
        in_c, estimator.estimate(folder.depth_m, folder.mask, folder.intrinsics, folder.color_bgr)
    )


def test_units_in_padded_rows(handle, rose, estimator):
    wide = np.full((240, 333), 9999, np.uint16)
    wide[:, :320] = rose.units
    in_c = estimated(handle, wide[:, :320], rose.mask, rose.intrinsics)
    assert_same(in_c, estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics))


def test_a_region_of_interest_is_the_images_part(handle, rose, estimator):
    u, v, width, height = 40, 21, 250, 211
    part = (slice(v, v + height), slice(u, u + width))
    fx, fy, cx, cy = rose.intrinsics
    in_c = estimated(handle, rose.depth_m, rose.mask, rose.intrinsics, roi=(u, v, width, height))
    assert_same(
        in_c, estimator.estimate(rose.depth_m[part], rose.mask[part], (fx, fy, cx - u, cy - v))
    )


RUST_TYPES = {
    "usize": ctypes.c_size_t,
    "isize": ctypes.c_ssize_t,
    "i32": ctypes.c_int32,
    "f32": ctypes.c_float,
    "f64": ctypes.c_double,
    "u8": ctypes.c_uint8,
    "*const c_void": ctypes.c_void_p,
}


def rust_type(words, known):
    array = re.fullmatch(r"\[(.*); (\d+)\]", words)
    if array:
        return rust_type(array[1], known) * int(array[2])
    return known[words] if words in known else RUST_TYPES[words]


def test_the_structs_of_the_rust_example_are_those_of_the_header():
    text = (EXAMPLES / "estimate_one_frame.rs").read_text()
    known = {}
    for name, body in re.findall(r"#\[repr\(C\)\]\nstruct (\w+) \{\n(.*?)\n\}", text, re.S):
        fields = re.findall(r"^ +(\w+): (.*?),(?: //.*)?$", body, re.M)
        assert len(fields) == len(body.splitlines()), name
        fields = [(field, rust_type(words, known)) for field, words in fields]
        known[name] = type(name, (ctypes.Structure,), {"_fields_": fields})
    assert set(known) == {"Image", "Frame", "Estimate"}
    for kind in (Image, Frame, Estimate):
        assert ctypes.sizeof(known[kind.__name__]) == ctypes.sizeof(kind), kind
    filled(known["Frame"], LIBRARY.flowdlo_frame_init)
    filled(known["Estimate"], LIBRARY.flowdlo_estimate_init)
    for field in ("nodes", "sigma_m", "support", "confidence"):
        assert getattr(known["Estimate"], field).offset == getattr(Estimate, field).offset, field
