"""Exceptions are of a class for each of the library's codes."""

import inspect
import pickle

import numpy as np
import pytest

import flowdlo
from conftest import SMALL
from flowdlo import _core, errors


def test_each_code_of_the_library_has_a_class_of_its_own():
    classes = [errors.of_code(code) for code in _core.ERROR_CODES]
    assert [one.code for one in classes] == list(_core.ERROR_CODES)
    assert len(set(classes)) == len(classes) == 9
    for one in classes:
        assert issubclass(one, flowdlo.Error) and getattr(flowdlo, one.__name__) is one


def test_they_are_pythons_own_kinds_as_well():
    assert issubclass(flowdlo.BadInput, ValueError)
    assert issubclass(flowdlo.Io, OSError)
    assert issubclass(flowdlo.OutOfMemory, MemoryError)


def test_a_code_of_a_later_library_is_an_error_all_the_same():
    assert errors.of_code("something_new") is flowdlo.Error


def test_they_can_be_pickled():
    error = pickle.loads(pickle.dumps(flowdlo.Io("who: expected A, got B")))
    assert type(error) is flowdlo.Io and str(error) == "who: expected A, got B"


def test_a_frame_without_evidence(rose, estimator):
    with pytest.raises(flowdlo.NoEvidence) as caught:
        estimator.estimate(np.zeros_like(rose.depth_m), rose.mask, rose.intrinsics)
    assert caught.value.code == "no_evidence" and str(caught.value)


def test_a_missing_folder_is_named(tmp_path):
    for missing in (tmp_path / "missing", str(tmp_path / "missing"), bytes(tmp_path / "missing")):
        with pytest.raises(flowdlo.Io, match="missing"):
            flowdlo.load_frame_folder(missing)


def test_a_path_of_any_bytes_is_an_error_not_a_crash(tmp_path):
    with pytest.raises(flowdlo.Io):
        flowdlo.load_frame_folder(bytes(tmp_path) + b"/\xff\xfe")
    for no_path in ("a\0b", 7, None, ["a"]):
        with pytest.raises(flowdlo.BadInput, match="expected a path"):
            flowdlo.load_frame_folder(no_path)


def test_weights_that_are_none(tmp_path):
    file = tmp_path / "broken.fdw"
    file.write_bytes(b"no weights")
    with pytest.raises(flowdlo.BadWeights, match="broken.fdw"):
        flowdlo.Estimator(**SMALL, weights=file)
    with pytest.raises(flowdlo.BadWeights, match="broken.fdw"):
        flowdlo.inspect_weights(file)


def test_a_device_that_is_not_there():
    with pytest.raises(flowdlo.NoDevice, match="no such device"):
        flowdlo.Estimator(device="no such device")


@pytest.mark.parametrize(
    "given, words",
    [
        ({"euler_steps": 0}, "Config.euler_steps: expected 1 to 64, got 0"),
        ({"draws": "two"}, "draws: expected an int"),
        ({"draws": 2.5}, "draws: expected an int"),
        ({"threads": 2**40}, "threads: expected an int of 32 bits"),
        ({"seed": -1}, "seed: expected an int"),
        ({"rope_length_m": "long"}, "rope_length_m: expected a float"),
        ({"rope_length_m": -1}, "Config.rope_length_m"),
        ({"quality": "best"}, 'quality: expected one of "auto", "full", "fast", got \'best\''),
        ({"prior": 1}, 'prior: expected one of "auto", "thesis", "refined", got 1'),
        ({"gate": "open"}, "gate: expected one of"),
        ({"field": True}, "field: expected one of"),
        ({"device": 0}, "device: expected a str"),
        ({"device": ""}, "Config.device"),
        ({"field_device": "gpu"}, 'field_device: expected one of "auto", "cpu", "device"'),
        ({"weights": 7}, "weights: expected a path"),
        ({"max_width": 0, "max_height": 0}, "(?s)Config.max_width.*Config.max_height"),
        ({"device_timeout_ms": -1}, "Config.device_timeout_ms"),
    ],
)
def test_a_config_that_is_none_is_refused(given, words):
    with pytest.raises(flowdlo.BadInput, match=words):
        flowdlo.Estimator(**{**SMALL, **given})


def test_a_keyword_that_is_none_is_pythons_own_error():
    with pytest.raises(TypeError, match="euler_stepz"):
        flowdlo.Estimator(euler_stepz=2)


def test_every_field_of_the_config_is_a_keyword():
    keywords = set(inspect.signature(flowdlo.Estimator).parameters)
    assert keywords == set(flowdlo.default_config())


def test_the_defaults_can_be_given():
    given = {k: v for k, v in flowdlo.default_config().items() if "weights" not in k}
    with flowdlo.Estimator(**{**given, "device": "cpu"}) as estimator:
        assert (estimator.device, estimator.field_device) == ("cpu", "cpu")
        with flowdlo.Estimator(device="cpu") as usual:
            assert (estimator.euler_steps, estimator.draws) == (usual.euler_steps, usual.draws)


def test_a_closed_estimator_says_so(rose):
    estimator = flowdlo.Estimator(**SMALL)
    estimator.close()
    estimator.close()
    with pytest.raises(flowdlo.BadInput, match="closed"):
        estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics)
    with pytest.raises(flowdlo.BadInput, match="closed"):
        print(estimator.device)


def test_the_compiled_module_holds_its_callers_to_packed_arrays(rose):
    core = _core.Estimator({"device": "cpu", "euler_steps": 1, "draws": 1})
    camera = tuple(rose.intrinsics)
    with pytest.raises(TypeError):
        core.estimate(np.asfortranarray(rose.depth_m), rose.mask, camera, None, None)
    with pytest.raises(flowdlo.BadInput, match="two dimensions"):
        core.estimate(rose.depth_m.ravel(), rose.mask, camera, None, None)
    with pytest.raises(flowdlo.BadInput, match="Frame.mask"):
        core.estimate(rose.depth_m, rose.mask[:5].copy(), camera, None, None)
