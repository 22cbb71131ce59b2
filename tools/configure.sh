#!/usr/bin/env bash
# Configures build/PRESET, again only when the purpose or the place of the clone has changed or when
# recording was off; otherwise builds reconfigure themselves when CMakeLists.txt changes.
#   tools/configure.sh PRESET build    test libraries and recording may be missing; one for tests will do
#   tools/configure.sh PRESET test     they must be there
set -euo pipefail
cd -P "$(dirname "$0")/.."
preset=$1
purpose=$2
build=build/$preset
stamp=$build/.configured
log=$build/configure.log

options=(-DHG_REQUIRE_TESTS="$([ "$purpose" = test ] && echo ON || echo OFF)")
command -v ccache >/dev/null 2>&1 && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
case "$(cat "$stamp" 2>/dev/null)" in
  "$purpose in $PWD" | "test in $PWD") exit 0 ;;
esac

echo "build: configuring $build"
mkdir -p "$build"
if ! grep -qsxF "CMAKE_CACHEFILE_DIR:INTERNAL=$PWD/$build" "$build/CMakeCache.txt"; then
  rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles"
fi
rm -f "$stamp"
if ! cmake --preset "$preset" -Wno-dev "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
if grep 'Recording is off' "$log"; then exit 0; fi
echo "$purpose in $PWD" >"$stamp"
