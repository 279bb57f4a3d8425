"""The package as a whole: its version, its types, its documents, its examples."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import flowdlo

FOLDER = Path(flowdlo.__file__).parent


def test_the_version_is_the_projects():
    assert flowdlo.__version__ == os.environ["FLOWDLO_VERSION"]


def test_everything_public_is_documented():
    for name in flowdlo.__all__:
        one = getattr(flowdlo, name)
        if callable(one):
            assert one.__doc__ and not one.__doc__.startswith(f"{name}("), name
    for name, method in vars(flowdlo.Estimator).items():
        if not name.startswith("_"):
            assert method.__doc__, name


def test_nothing_public_is_left_out():
    names = {name for name in vars(flowdlo) if not name.startswith("_")}
    modules = {path.stem for path in FOLDER.glob("*.py")}
    assert names - modules == set(flowdlo.__all__) - {"__version__"}


def test_types_are_marked_and_the_stub_knows_the_compiled_module():
    assert (FOLDER / "py.typed").exists()
    stub = (FOLDER / "_core.pyi").read_text()
    said = set(re.findall(r"^(?:def |class )?([A-Za-z]\w*)(?:: |\(|:$)", stub, re.MULTILINE))
    assert said == {name for name in vars(flowdlo._core) if not name.startswith("_")}
    methods = set(re.findall(r"^    def ([a-z]\w*)", stub, re.MULTILINE))
    assert methods == {name for name in vars(flowdlo._core.Estimator) if not name.startswith("_")}


def test_types_hold(tmp_path):
    mypy = subprocess.run([sys.executable, "-m", "mypy", "--version"], capture_output=True)
    if mypy.returncode != 0:
        pytest.skip("mypy is not installed for this Python")
    ran = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", f"--cache-dir={tmp_path}", FOLDER],
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stdout


def example(examples, name, *arguments, **environment):
    return subprocess.run(
        [sys.executable, examples / "python" / name, *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
    )


def test_the_example_prints_the_nodes(examples):
    ran = example(examples, "estimate_one_frame.py", examples / "frames" / "overhand_loop")
    assert ran.returncode == 0, ran.stderr
    nodes = np.loadtxt(ran.stdout.splitlines())
    assert nodes.shape == (64, 3) and (nodes[:, 2] > 0).all()


def test_the_example_says_what_is_wrong(examples, tmp_path):
    ran = example(examples, "estimate_one_frame.py", tmp_path / "nowhere")
    assert ran.returncode == 1 and "nowhere" in ran.stderr and "Traceback" not in ran.stderr


def test_the_plot_is_drawn_where_matplotlib_is(examples, tmp_path):
    picture = tmp_path / "rope.png"
    frame = examples / "frames" / "overhand_loop"
    ran = example(
        examples, "plot_estimate.py", frame, picture, MPLBACKEND="Agg", MPLCONFIGDIR=str(tmp_path)
    )
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        assert ran.returncode == 2 and "matplotlib" in ran.stderr
        return
    assert ran.returncode == 0, ran.stderr
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 20_000
