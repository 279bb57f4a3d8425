"""The wheel of the Python package: CMake builds and installs it, setuptools packs what came.

FLOWDLO_BUILD_DIR names a build folder that holds a built package already (a preset's, for example),
which is then packed as it is. Its Python must be the one that runs this.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
BUILT = os.environ.get("FLOWDLO_BUILD_DIR")
LEFT_BEHIND = (Path(BUILT).resolve() if BUILT else ROOT / "build") / "wheel"
PARTS_LEFT_OUT = (
    "TOOLS",
    "TESTS",
    "BENCHMARKS",
    "EXAMPLES",
    "LAB",
    "TRAINING",
    "RECORDINGS",
    "SYNTH",
)


def version() -> str:
    found = re.search(r"project\(flowdlo VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    if not found:
        raise SystemExit("setup.py: expected project(flowdlo VERSION ...) in CMakeLists.txt")
    return found.group(1)


def run(*command) -> None:
    subprocess.run([str(part) for part in command], check=True)


class BuildByCMake(build_ext):
    def run(self) -> None:
        folder = Path(BUILT or self.build_temp).resolve()
        if not BUILT:
            run(
                "cmake",
                "-S",
                ROOT,
                "-B",
                folder,
                *(["-G", "Ninja"] if shutil.which("ninja") else []),
                "-DCMAKE_BUILD_TYPE=Release",
                "-DFLOWDLO_BUILD_PYTHON=ON",
                f"-DPython_EXECUTABLE={sys.executable}",
                *(f"-DFLOWDLO_BUILD_{part}=OFF" for part in PARTS_LEFT_OUT),
            )
            run("cmake", "--build", folder, "--parallel", os.cpu_count() or 1)
        package = Path(self.build_lib).resolve()
        shutil.rmtree(package / "flowdlo", ignore_errors=True)  # an earlier build's
        run("cmake", "--install", folder, "--component", "wheel", "--prefix", package)


LEFT_BEHIND.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    packages=[],
    ext_modules=[Extension("flowdlo._core", sources=[])],  # the wheel is one of this machine
    cmdclass={"build_ext": BuildByCMake},
    options={
        "build": {"build_base": str(LEFT_BEHIND)},
        "egg_info": {"egg_base": str(LEFT_BEHIND)},
    },
)
