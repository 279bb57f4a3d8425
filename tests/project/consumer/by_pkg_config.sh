#!/usr/bin/env bash
# by_pkg_config.sh LIBDIR COMPILER BUILD_DIR FRAME: the consumer with pkg-config alone.
set -euo pipefail
libdir=$1 compiler=$2 build_dir=$3 frame=$4
here=$(cd "$(dirname "$0")" && pwd)

export PKG_CONFIG_PATH="$libdir/pkgconfig"
export PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
pkg-config --atleast-version 0.1 flowdlo
read -ra flags <<<"$(pkg-config --cflags --libs flowdlo)"

rm -rf "$build_dir"
mkdir -p "$build_dir"
"$compiler" -std=c++20 "$here/consumer.cpp" "${flags[@]}" -Wl,-rpath,"$libdir" \
  -o "$build_dir/consumer"
if [[ -e $libdir/libflowdlo.so ]]; then
  "$build_dir/consumer" "$frame"
else
  "$build_dir/consumer" "$frame" "$(pkg-config --variable=datadir flowdlo)/flowdlo.fdw"
fi
