"""Frames on disk, devices, and weights files."""

import hashlib
import json
import os
import subprocess

import numpy as np
import pytest

import flowdlo


def test_a_frame_folder_holds_what_is_documented(examples, folder):
    camera = json.loads((examples / "frames" / "overhand_loop" / "camera.json").read_text())
    shape = (camera["height"], camera["width"])
    assert folder.name == "overhand_loop"
    assert folder.depth_m.shape == shape and folder.depth_m.dtype == np.float32
    assert folder.mask.shape == shape and folder.mask.dtype == np.uint8
    assert folder.color_bgr.shape == (*shape, 3) and folder.color_bgr.dtype == np.uint8
    assert folder.truth.shape == (64, 3) and folder.truth.dtype == np.float32
    assert folder.intrinsics == tuple(np.float32(camera[name]) for name in ("fx", "fy", "cx", "cy"))
    assert 0.3 < np.median(folder.depth_m[folder.mask > 127]) < 1
    csv = np.loadtxt(
        examples / "frames" / "overhand_loop" / "truth.csv", delimiter=",", skiprows=1
    )
    assert np.array_equal(folder.truth, csv.astype(np.float32))


def test_its_arrays_outlive_it(examples):
    depth = flowdlo.load_frame_folder(examples / "frames" / "overhand_loop").depth_m
    again = flowdlo.load_frame_folder(examples / "frames" / "overhand_loop").depth_m
    assert np.array_equal(depth, again) and not np.shares_memory(depth, again)
    depth[0, 0] = 7
    assert depth[0, 0] == 7


def test_a_folder_without_color_and_truth_has_none(examples, tmp_path):
    for name in ("depth.png", "mask.png", "camera.json"):
        content = (examples / "frames" / "overhand_loop" / name).read_bytes()
        (tmp_path / name).write_bytes(content)
    folder = flowdlo.load_frame_folder(tmp_path)
    assert folder.color_bgr is None and folder.truth is None


def test_devices_are_those_of_the_command(command):
    said = json.loads(subprocess.run([command, "devices", "--json"], capture_output=True).stdout)
    survey = flowdlo.survey_devices(self_test=True)
    assert [device.uuid for device in survey.vulkan] == [one["uuid"] for one in said["vulkan"]]
    assert survey.loader == said["loader"]
    assert not survey.unseen and len(survey.drivers) == len(said["drivers"])
    for driver, one in zip(survey.drivers, said["drivers"]):
        assert (driver.manifest, driver.used) == (one["manifest"], one["used"])
        assert (driver.devices, driver.verdict) == (one["devices"], one["verdict"])
    unasked = flowdlo.survey_devices(probe=False)
    assert not unasked.drivers and "Config::probe" in unasked.unseen
    for device in survey.vulkan:
        assert device.kind in ("discrete_gpu", "integrated_gpu", "virtual_gpu", "cpu", "other")
        assert len(device.uuid) == 32
        assert device.lacks or device.self_test_passed is not None
    assert survey.auto_choice


def test_devices_are_not_tried_unless_asked():
    assert all(device.self_test_passed is None for device in flowdlo.survey_devices().vulkan)


def test_weights_can_be_looked_into():
    file = os.environ["FLOWDLO_DEFAULT_WEIGHTS"]
    info = flowdlo.inspect_weights(file)
    assert info.parameters == sum(int(np.prod(tensor.shape)) for tensor in info.tensors)
    assert {tensor.dtype for tensor in info.tensors} <= {"f32", "f16"}
    assert len(bytes.fromhex(info.sha256)) == hashlib.sha256().digest_size
    assert info.metadata


def test_weights_go_out_and_come_back(tmp_path, rose):
    file = os.environ["FLOWDLO_DEFAULT_WEIGHTS"]
    tensors = tmp_path / "model.safetensors"
    back = tmp_path / "model.fdw"
    flowdlo.export_safetensors(file, tensors)
    length = int.from_bytes(tensors.read_bytes()[:8], "little")
    header = json.loads(tensors.read_bytes()[8 : 8 + length])
    before = flowdlo.inspect_weights(file)
    for tensor in before.tensors:
        assert tuple(header[tensor.name]["shape"]) == tuple(tensor.shape)
    flowdlo.import_safetensors(tensors, back)
    after = flowdlo.inspect_weights(back)
    assert (after.sha256, after.tensors) == (before.sha256, before.tensors)
    with flowdlo.Estimator(weights=back, device="cpu", field="off", euler_steps=1, draws=1) as estimator:
        assert estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics).nodes.shape == (64, 3)


def test_weights_that_are_none_leave_no_file(tmp_path):
    wrong = tmp_path / "wrong.safetensors"
    wrong.write_bytes(b"no tensors at all")
    with pytest.raises(flowdlo.BadWeights):
        flowdlo.import_safetensors(wrong, tmp_path / "model.fdw")
    with pytest.raises(flowdlo.BadWeights):
        flowdlo.export_safetensors(wrong, tmp_path / "model.safetensors")
    with pytest.raises(flowdlo.Io):
        flowdlo.export_safetensors(tmp_path / "missing.fdw", tmp_path / "model.safetensors")
    with pytest.raises(flowdlo.BadInput, match="output: expected a path"):
        flowdlo.export_safetensors(wrong, 3)
    assert sorted(tmp_path.iterdir()) == [wrong]
