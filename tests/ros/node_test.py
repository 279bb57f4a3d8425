"""The ROS 1 node against the command: a real roscore, a bag that is played, the same nodes.

scripts/try-ros builds what is tested and calls this with FLOWDLO_NODE, FLOWDLO_COMMAND and
FLOWDLO_FRAME set.
"""

import csv
import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

rospy = pytest.importorskip("rospy")
rosbag = pytest.importorskip("rosbag")
flowdlo_msgs = pytest.importorskip("flowdlo_msgs.msg")
import dynamic_reconfigure.client  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus  # noqa: E402
from flowdlo_msgs.srv import SetEnd  # noqa: E402
from nav_msgs.msg import Path as PathMessage  # noqa: E402
from sensor_msgs.msg import CameraInfo, Image  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from visualization_msgs.msg import MarkerArray  # noqa: E402

import flowdlo  # noqa: E402

FRAME = Path(os.environ["FLOWDLO_FRAME"])
TOPICS = {"depth": "/rgbd/depth", "mask": "/rgbd/mask", "color": "/rgbd/color"}
INFO = "/rgbd/camera_info"
STAMPS = [1000.0 + 0.5 * i for i in range(6)]


def image(array, encoding, stamp):
    message = Image()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.header.frame_id = "rgbd_optical"
    message.height, message.width = array.shape[:2]
    message.encoding = encoding
    message.step = array.strides[0]
    message.data = array.tobytes()
    return message


@pytest.fixture(scope="session")
def bag(tmp_path_factory):
    """Six times the frame that ships, at 2 Hz; the colours and masks come a little later."""
    frame = flowdlo.load_frame_folder(FRAME)
    file = tmp_path_factory.mktemp("bag") / "rope.bag"
    with rosbag.Bag(str(file), "w") as out:
        for stamp in STAMPS:
            units = np.rint(frame.depth_m * 1000).astype(np.uint16)
            info = CameraInfo()
            info.header.stamp = rospy.Time.from_sec(stamp)
            info.header.frame_id = "rgbd_optical"
            info.height, info.width = units.shape
            k = frame.intrinsics
            info.K = [k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1]
            info.P = [k.fx, 0, k.cx, 0, 0, k.fy, k.cy, 0, 0, 0, 1, 0]
            info.D = [0.0] * 5
            info.distortion_model = "plumb_bob"
            out.write(TOPICS["depth"], image(units, "16UC1", stamp), rospy.Time.from_sec(stamp))
            out.write(INFO, info, rospy.Time.from_sec(stamp))
            late = stamp + 0.004
            out.write(TOPICS["mask"], image(frame.mask, "mono8", late), rospy.Time.from_sec(late))
            out.write(
                TOPICS["color"], image(frame.color_bgr, "bgr8", late), rospy.Time.from_sec(late)
            )
    return file


@pytest.fixture(scope="session")
def master(tmp_path_factory):
    with socket.socket() as probe:
        probe.bind(("", 0))
        port = probe.getsockname()[1]
    home = tmp_path_factory.mktemp("ros")
    os.environ["ROS_MASTER_URI"] = f"http://{socket.gethostname()}:{port}"
    os.environ["ROS_HOME"] = os.environ["ROS_LOG_DIR"] = str(home)
    os.environ.setdefault("ROS_PACKAGE_PATH", "/usr/share")
    os.environ.setdefault("ROS_ROOT", "/usr/share/ros")
    core = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL)
    for _ in range(100):
        try:
            rospy.get_master().getPid()
            break
        except OSError:
            time.sleep(0.2)
    rospy.init_node("listener", anonymous=True, disable_signals=True)
    yield
    core.terminate()
    core.wait(20)


class Node:
    """A node under a name of its own, and what it has published."""

    def __init__(self, name, command=None, **parameters):
        self.name, self.ropes, self.paths, self.markers, self.diagnostics = name, [], [], [], []
        for key, value in {"device": "cpu", "threads": 1, **parameters}.items():
            rospy.set_param(f"/{name}/{key}", value)
        self.subscribers = [
            rospy.Subscriber(f"/{name}/ropes", flowdlo_msgs.Ropes, self.ropes.append),
            rospy.Subscriber(f"/{name}/path", PathMessage, self.paths.append),
            rospy.Subscriber(f"/{name}/markers", MarkerArray, self.markers.append),
            rospy.Subscriber("/diagnostics", DiagnosticArray, self.diagnostics.append),
        ]
        topics = [f"{topic}:={full}" for topic, full in TOPICS.items()]
        self.process = subprocess.Popen(
            [*(command or [os.environ["FLOWDLO_NODE"]]), f"__name:={name}", f"camera_info:={INFO}"]
            + topics
        )
        rospy.wait_for_service(f"/{name}/reset", timeout=30)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for subscriber in self.subscribers:
            subscriber.unregister()
        self.process.terminate()
        self.process.wait(20)

    def wait_for(self, count):
        end = time.monotonic() + 30
        while len(self.ropes) < count and time.monotonic() < end:
            time.sleep(0.05)
        return self.ropes

    def said(self, part):
        """The latest that diagnostics said of `part`: its level, its sentence and its values."""
        of_it = [
            status
            for message in self.diagnostics
            for status in message.status
            if self.name in status.name and status.name.endswith(part)
        ]
        return of_it[-1].level, of_it[-1].message, {v.key: v.value for v in of_it[-1].values}


def play(bag):
    time.sleep(1)  # until all subscribers have found each other
    subprocess.run(["rosbag", "play", "-q", "-d", "1", bag], check=True, timeout=60)


def nodes_of(message):
    return np.array([[p.x, p.y, p.z] for p in message.ropes[0].nodes])


def estimated(bag, out):
    """Nodes and confidence of each frame as the command gives them."""
    subprocess.run(
        [os.environ["FLOWDLO_COMMAND"], "estimate", bag, "--out", out, "--device", "cpu"]
        + ["--quality", "fast", "--threads", "1", "--quiet", "--mask-topic", TOPICS["mask"]]
        + ["--depth-topic", TOPICS["depth"], "--color-topic", TOPICS["color"]]
        + ["--camera-topic", INFO],
        check=True,
    )
    found = []
    for folder in sorted(out.iterdir()):
        with open(folder / "centerline.csv") as file:
            rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
        found.append((np.array(rows), json.loads((folder / "estimate.json").read_text())))
    return found


def test_a_played_bag_gives_what_the_command_gives(master, bag, tmp_path):
    expected = estimated(bag, tmp_path / "out")
    assert len(expected) == len(STAMPS)
    with Node("exact", keep_order=False, use_color=True) as node:
        play(bag)
        ropes = node.wait_for(len(STAMPS))
        assert [round(r.header.stamp.to_sec(), 3) for r in ropes] == STAMPS
        for message, (nodes, said) in zip(ropes, expected):
            assert message.header.frame_id == "rgbd_optical"
            rope = message.ropes[0]
            assert np.abs(nodes_of(message) - nodes).max() < 1e-6
            assert abs(rope.confidence - said["confidence"]) < 1e-5
            assert (rope.source, rope.origin) == (said["source"], said["origin"])
            assert not rope.closed
            assert list(rope.support) == [bool(s) for s in said["support"]]
        assert len(node.paths) == len(STAMPS) and len(node.paths[0].poses) == 64
        assert node.paths[0].header.frame_id == "rgbd_optical"
        assert {m.ns for m in node.markers[0].markers} == {"", "rope", "node_0"}


def byte_of(level):
    return bytes([level]) if isinstance(level, int) else level


def test_diagnostics_say_the_rate_and_whether_it_is_good(master, bag):
    with Node("rated", least_hz=1.0, most_hz=4.0) as node, Node("slow", least_hz=50.0) as slow:
        play(bag)
        assert len(node.wait_for(len(STAMPS))) == len(slow.wait_for(len(STAMPS)))
        time.sleep(1.2)  # diagnostics come once a second
        until = time.monotonic() + 20
        _, _, values = node.said("ropes topic status")
        while int(values["Events since startup"]) < len(STAMPS) and time.monotonic() < until:
            time.sleep(0.2)  # and later where the machine is busy
            _, _, values = node.said("ropes topic status")
        assert int(values["Events since startup"]) == len(STAMPS)
        assert 0.2 < float(values["Actual frequency (Hz)"]) < 4
        level, message, values = node.said("estimate")
        assert (byte_of(level), message) == (byte_of(DiagnosticStatus.OK), "ropes are seen")
        assert float(values["milliseconds a frame"]) > 0
        assert 0 < float(values["least confidence"]) <= 1
        level, message, _ = slow.said("ropes topic status")
        assert byte_of(level) == byte_of(DiagnosticStatus.WARN) and "too low" in message


def test_colour_takes_the_place_of_a_mask_and_may_change_while_it_runs(master, bag):
    with Node("seen_by_color", use_mask=False, rope_color=[10, 250, 10]) as node:
        play(bag)
        assert not node.ropes  # nothing is green
        rospy.set_param("/seen_by_color/rope_color", [209, 36, 36])
        time.sleep(0.5)
        play(bag)
        assert node.wait_for(len(STAMPS))


def test_dynamic_reconfigure_and_rosparam_set_the_same_parameters(master, bag):
    with Node("tuned", use_mask=False, rope_color=[10, 250, 10]) as node:
        windows = dynamic_reconfigure.client.Client("/tuned", timeout=30)
        assert windows.get_configuration()["rope_color"] == "10 250 10"
        windows.update_configuration({"rope_color": "209 36 36"})
        assert rospy.get_param("/tuned/rope_color") == "209 36 36"
        play(bag)
        assert len(node.wait_for(len(STAMPS))) == len(STAMPS)
        rospy.set_param("/tuned/color_tolerance", 0.2)
        rospy.set_param("/tuned/rope_color", [209, 40, 36])
        end = time.monotonic() + 10
        while windows.get_configuration()["rope_color"] != "209 40 36" and time.monotonic() < end:
            time.sleep(0.1)
        assert windows.get_configuration()["rope_color"] == "209 40 36"
        assert windows.get_configuration()["color_tolerance"] == 0.2
        refused = windows.update_configuration({"rope_color": "red", "keep_order": False})
        assert refused["rope_color"] == "209 40 36" and refused["keep_order"] is False
        play(bag)
        assert len(node.wait_for(2 * len(STAMPS))) == 2 * len(STAMPS)


def test_the_nodelet_sees_what_the_node_sees(master, bag, tmp_path):
    expected = estimated(bag, tmp_path / "out")
    nodelet = ["/usr/lib/nodelet/nodelet", "standalone", "flowdlo_ros/RopeNodelet"]
    with Node("in_a_manager", nodelet, keep_order=False, use_color=True) as node:
        play(bag)
        ropes = node.wait_for(len(STAMPS))
        assert len(ropes) == len(STAMPS)
        for message, (nodes, _) in zip(ropes, expected):
            assert np.abs(nodes_of(message) - nodes).max() < 1e-6


def test_an_end_that_is_set_comes_first_until_it_is_reset(master, bag):
    with Node("ends", keep_order=True) as node:
        play(bag)
        before = nodes_of(node.wait_for(len(STAMPS))[-1])
        camera = flowdlo.load_frame_folder(FRAME).intrinsics
        x, y, z = before[-1]
        u, v = camera.fx * x / z + camera.cx, camera.fy * y / z + camera.cy
        assert rospy.ServiceProxy("/ends/set_end", SetEnd)(u, v).success
        play(bag)
        after = nodes_of(node.wait_for(2 * len(STAMPS))[-1])
        assert np.abs(after[::-1] - before).max() < 1e-4
        assert rospy.ServiceProxy("/ends/reset", Trigger)().success
        play(bag)
        again = nodes_of(node.wait_for(3 * len(STAMPS))[-1])
        assert np.abs(again - before).max() < 1e-4


def test_a_rope_said_to_be_a_ring_is_closed(master, bag):
    """The rope of the bag is none: what is said is believed, and what comes is unsure."""
    with Node("ring", ring=True, use_color=True) as node:
        play(bag)
        ropes = node.wait_for(len(STAMPS))
        assert all(message.ropes[0].closed for message in ropes)
        assert all(message.ropes[0].confidence < 0.5 for message in ropes)


def test_ropes_keep_their_numbers_until_they_are_forgotten(master, bag):
    with Node("numbered", ropes=0, use_color=True) as node:
        play(bag)
        first = node.wait_for(len(STAMPS))
        assert {tuple(r.number for r in m.ropes) for m in first} == {(1,)}
        assert not any(m.missing for m in first)
        assert rospy.ServiceProxy("/numbered/reset", Trigger)().success
        play(bag)
        later = node.wait_for(2 * len(STAMPS))[len(STAMPS) :]
        assert {tuple(r.number for r in m.ropes) for m in later} == {(2,)}


def test_a_color_that_is_none_is_named_when_the_node_starts(master):
    rospy.set_param("/colorless/rope_color", [300, 0, 0])
    ran = subprocess.run(
        [os.environ["FLOWDLO_NODE"], "__name:=colorless"],
        capture_output=True,
        text=True,
        timeout=30,
    )
    assert ran.returncode == 1
    assert 'expected red, green and blue from 0 to 255, as [200, 30, 40], got "300 0 0"' in (
        ran.stdout + ran.stderr
    )


def test_a_node_that_cannot_start_says_why(master):
    rospy.set_param("/broken/weights", "/nowhere.fdw")
    ran = subprocess.run(
        [os.environ["FLOWDLO_NODE"], "__name:=broken"], capture_output=True, text=True, timeout=30
    )
    assert ran.returncode == 1 and "nowhere.fdw" in ran.stdout + ran.stderr


if __name__ == "__main__":
    sys.exit(pytest.main([__file__, "-q"]))
