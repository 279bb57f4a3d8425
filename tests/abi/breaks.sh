#!/usr/bin/env bash
# tests/abi/breaks.sh BUILD: scripts/abi on headers that were changed. What breaks programs that are
# already built has to be found, what is only added has to pass. Ends with 77 where scripts/abi does.
set -euo pipefail
cd "$(dirname "$0")/../.."

build=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
scripts/abi "$build" || exit $?

# expect STATUS HEADER SED WHAT: scripts/abi ends with STATUS after SED on HEADER.
expect() {
  rm -rf "$out/flowdlo"
  cp -r include/flowdlo "$out/flowdlo"
  sed -i -E "$3" "$out/flowdlo/$2"
  if cmp -s "include/flowdlo/$2" "$out/flowdlo/$2"; then
    echo "$4: $2 has no such line" >&2
    exit 1
  fi
  local status=0
  FLOWDLO_HEADERS=$out/flowdlo scripts/abi "$build" >/dev/null 2>"$out/log" || status=$?
  if [[ $status -ne $1 ]]; then
    cat "$out/log" >&2
    echo "$4: expected scripts/abi to end with $1, got $status" >&2
    exit 1
  fi
}

expect 4 estimate.hpp 's/^struct Estimate \{/&\n  int new_one = 0;/' "a field before others"
expect 4 flowdlo.h 's/FLOWDLO_NO_PATH = 3/FLOWDLO_NO_PATH = 33/' "another value of a constant"
expect 0 estimate.hpp 's/^struct RopeCrossing/struct NewOne { int x; };\n&/' "a type beside others"
