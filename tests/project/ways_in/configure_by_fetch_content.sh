#!/usr/bin/env bash
# configure_by_fetch_content.sh SOURCE FOLDER COMPILER C_COMPILER: a project takes FlowDLO by a tag
# through FetchContent, for a system whose programs cannot be run here, and its build runs none of them.
# 77: there is no git or no ninja.
set -euo pipefail
source=$1 folder=$2 compiler=$3 c_compiler=$4
here=$(cd "$(dirname "$0")" && pwd)
command -v ninja >/dev/null || exit 77

rm -rf "$folder"
mkdir -p "$folder"
"$here/tagged_repository.sh" "$source" "$folder/repository" v-here
cmake -S "$here" -B "$folder/build" -G Ninja -DFLOWDLO_WAY=FetchContent -DFLOWDLO_TAG=v-here \
  -DFLOWDLO_ROOT="file://$folder/repository" -DCMAKE_TOOLCHAIN_FILE="$here/cross.cmake" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_C_COMPILER="$c_compiler"
ninja -C "$folder/build" -t commands >"$folder/commands.txt"
grep -q 'nodes\.cpp' "$folder/commands.txt"  # otherwise the next line would pass on anything
for program in $(ninja -C "$folder/build" -t targets all | sed -n 's/: CX*_EXECUTABLE_LINKER.*//p'); do
  if grep -E "(^|&& |[ /])$program " "$folder/commands.txt" | grep -vqE -- "-o $program "; then
    echo "$program is run by the build" >&2
    exit 1
  fi
done
