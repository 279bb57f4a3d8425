#!/usr/bin/env bash
# by_pkg_config.sh LIBDIR COMPILER C_COMPILER BUILD_DIR FRAME EXAMPLES: the consumer, and the example
# in C, with pkg-config alone.
set -euo pipefail
libdir=$1 compiler=$2 c_compiler=$3 build_dir=$4 frame=$5 examples=$6
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
  "$c_compiler" -std=c99 -Wall -pedantic -Werror "$examples/estimate_one_frame.c" "${flags[@]}" \
    -Wl,-rpath,"$libdir" -o "$build_dir/in_c"
  "$build_dir/in_c" "$frame" | awk 'NF == 3 { ++nodes } END { exit nodes != 64 }'
else
  "$build_dir/consumer" "$frame" "$(pkg-config --variable=datadir flowdlo)/flowdlo.fdw"
fi
