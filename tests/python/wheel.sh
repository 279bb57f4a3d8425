#!/usr/bin/env bash
# wheel.sh PYTHON SOURCE BUILD FOLDER: packs what is built as a wheel, installs it where nothing else
# of ours is, and estimates a frame with it. 77: this Python has no pip, setuptools or wheel.
set -euo pipefail
python=$1 source=$2 build=$3 folder=$4
{ "$python" -m pip --version && "$python" -c 'import setuptools, wheel'; } &>/dev/null || exit 77

rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore PIP_NO_INPUT=1
FLOWDLO_BUILD_DIR=$build "$python" -m pip wheel "$source" --quiet --no-build-isolation --no-deps \
  --no-index --wheel-dir wheels
"$python" -m pip install --quiet --no-deps --no-index --target site wheels/flowdlo-*.whl
export PYTHONPATH=$folder/site PYTHONDONTWRITEBYTECODE=1
"$python" "$source/examples/python/estimate_one_frame.py" "$source/examples/frames/overhand_loop" \
  >nodes.txt
[[ $(wc -l <nodes.txt) -eq 64 ]]
"$python" - <<'END'
import pathlib
import flowdlo

site = pathlib.Path(flowdlo.__file__).resolve().parent
loaded = [line.split()[-1] for line in open("/proc/self/maps") if "libflowdlo.so" in line]
assert loaded and all(pathlib.Path(one).parent == site / "lib" for one in loaded), loaded
END
