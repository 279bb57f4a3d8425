#!/usr/bin/env bash
# ros/build.sh FLOWDLO OUT PREFIX [OPTION...]: builds the packages of ROS 1 in OUT against the library installed in
# FLOWDLO, with these options for CMake, and installs them into PREFIX, below DESTDIR where that is set.
# Ends with 77 where ROS 1 is not installed: scripts/packages lists what it takes, as "ros".
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
flowdlo=$1
out=$2
prefix=$3
shift 3
python=/usr/bin/python3
for package in catkin message_generation roscpp nodelet diagnostic_updater dynamic_reconfigure; do
  if [[ ! -d /usr/share/$package ]]; then
    echo "ros/build.sh: ROS 1 is not installed: no /usr/share/$package" >&2
    exit 77
  fi
done

export ROS_LANG_DISABLE=geneus:genlisp:gennodejs
mkdir -p "$out"
for package in flowdlo_msgs flowdlo_ros; do
  {
    cmake -S "$here/$package" -B "$out/$package" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      "-DCMAKE_PREFIX_PATH=$out/flowdlo_msgs/devel;$flowdlo" "-DCMAKE_INSTALL_PREFIX=$prefix" \
      "-DPYTHON_EXECUTABLE=$python" "-DPython3_EXECUTABLE=$python" "$@" &&
      cmake --build "$out/$package" --target install
  } >"$out/$package.log" 2>&1 || { cat "$out/$package.log" >&2; exit 1; }
done
