#!/usr/bin/env bash
# Packs what `make build` has made as a wheel for Python 3.10 and later into FOLDER, for computers with a
# C library as old as the symbols need that are used: auditwheel finds that out, puts it into the
# wheel's name, and bundles the system libraries that a wheel may not expect.
#
#   tools/make_wheel.sh [FOLDER]    default: build/wheel
set -euo pipefail
cd -P "$(dirname "$0")/.."
folder=${1:-build/wheel}
. tools/source_date.sh
export PATH="$PWD/.venv/bin:$PATH"

.venv/bin/python tools/third_party.py --texts build/release/copyright
rm -rf "$folder"
mkdir -p "$folder"
.venv/bin/python -m pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation \
  --wheel-dir "$folder/unaudited" .
# those of wheels are in it, cmake/install_libraries.cmake
excluded=()
for library in .venv/lib/python3*/site-packages/cmeel.prefix/lib/*.so*; do
  excluded+=(--exclude "${library##*/}")
done
if ! auditwheel repair --strip "${excluded[@]}" --wheel-dir "$folder" "$folder"/unaudited/*.whl \
    >"$folder/auditwheel.log" 2>&1; then
  cat "$folder/auditwheel.log" >&2
  exit 1
fi
rm -r "$folder/unaudited"
wheel=$(echo "$folder"/*.whl)
echo "wheel: $wheel, $(du --apparent-size -k "$wheel" | cut -f1) kB"
