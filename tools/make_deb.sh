#!/usr/bin/env bash
# Packs what `make build` has made as a package for this Debian, with the libraries that come as wheels,
# into FOLDER.
#
#   tools/make_deb.sh [FOLDER]    default: build/deb
set -euo pipefail
cd -P "$(dirname "$0")/.."
folder=$PWD/${1:-build/deb}
. tools/source_date.sh
export PATH="$PWD/.venv/bin:$PATH"
umask 022

.venv/bin/python tools/third_party.py --texts build/release/copyright
rm -rf "$folder"
mkdir -p "$folder"
if ! (cd build/release && cpack -G DEB -B "$folder") >"$folder/cpack.log" 2>&1; then
  cat "$folder/cpack.log" >&2
  exit 1
fi
rm -r "$folder/_CPack_Packages"
package=$(echo "$folder"/*.deb)
echo "deb: ${package#"$PWD"/}, $(du --apparent-size -k "$package" | cut -f1) kB"
