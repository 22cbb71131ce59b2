#!/usr/bin/env bash
# Configures build/PRESET, again when test libraries have come or gone; otherwise builds reconfigure
# themselves when CMakeLists.txt changes.
#   tools/configure.sh PRESET
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
options=()
command -v ccache >/dev/null 2>&1 && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
stamp=build/$preset/.configured
have_tests=$(dpkg-query -W -f='${Status}' libgtest-dev librapidcheck-dev 2>/dev/null || true)
if [ ! -f "build/$preset/build.ninja" ] || [ "$(cat "$stamp" 2>/dev/null)" != "$have_tests" ]; then
  echo "build: configuring build/$preset"
  cmake --preset "$preset" "${options[@]}" >/dev/null
  echo "$have_tests" >"$stamp"
fi
