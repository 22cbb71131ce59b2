#!/usr/bin/env bash
# Builds the viewer page into viewer/dist, where its sources have changed. Node 18 with npm 10, or
# newer, does it; without a system one it comes as a wheel into .venv. Fails where neither is to be had.
#
#   tools/build_page.sh         the page
#   tools/build_page.sh test    also node and the packages that its tests need
set -euo pipefail
cd -P "$(dirname "$0")/.."
export PATH="$PWD/.venv/bin:$PATH"

say() { echo "setup: $*"; }
at_least() { printf '%s\n' "$1" "$2" | sort --check=quiet --version-sort; }  # at_least LEAST VERSION

node_works() {
  local node npm
  node=$(node --version 2>/dev/null) && npm=$(npm --version 2>/dev/null) || return 1
  at_least 18 "${node#v}" && at_least 10 "$npm"
}
install_node() {
  if node_works; then return; fi
  [ -x .venv/bin/python ] || return 1
  say "installing node into .venv"
  .venv/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps \
    --only-binary=:all: -r tools/requirements-node.txt && node_works
}
page_packages=viewer/node_modules/.hapticgiant-lock
install_page_packages() {
  if cmp -s viewer/package-lock.json "$page_packages"; then return; fi
  install_node || return 1
  say "installing the viewer's packages"
  (cd viewer && npm ci --ignore-scripts --loglevel=error --no-audit --no-fund >/dev/null) &&
    cp viewer/package-lock.json "$page_packages"
}
page_stamp=viewer/dist/.hapticgiant-sources
page_sources=$(find viewer/*.json viewer/*.ts viewer/index.html viewer/study viewer/src viewer/public -type f \
  -exec sha256sum {} + | LC_ALL=C sort)
build_page() {
  if [ "$(cat "$page_stamp" 2>/dev/null)" = "$page_sources" ]; then return; fi
  install_page_packages || return 1
  say "building the viewer page"
  (cd viewer && npm run --loglevel=error build >/dev/null) && echo "$page_sources" >"$page_stamp"
}
if [ "${1:-}" = test ]; then
  install_node && install_page_packages || exit 1
fi
build_page
