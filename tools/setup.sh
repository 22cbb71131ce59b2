#!/usr/bin/env bash
# Prepares everything that building needs: system packages, the private .venv with the rigid-body
# wheels, and the viewer's packages. Prints what it does; quick when there is nothing to do.
#
#   tools/setup.sh build    what the program needs; continues without recording or page
#   tools/setup.sh test     that, and what the tests need; fails where anything is missing
#   tools/setup.sh bench    as build, and what `hapticgiant bench` is compared with
#   tools/setup.sh count    as build, and what counts instructions
#   tools/setup.sh wheel    as build, and what packs a wheel or a Debian package
#   tools/setup.sh sanitize as build, and a compiler with all sanitizers: SANITIZER_CXX, or clang++-22
#
# Works without root when the system packages are there, and names them otherwise.
set -euo pipefail
cd -P "$(dirname "$0")/.."

purpose=${1:-build}
case "$purpose" in
  build | test | bench | count | wheel | sanitize) ;;
  *)
    echo "setup: expected 'build', 'test', 'bench', 'count', 'wheel' or 'sanitize', got '$purpose'" >&2
    exit 2
    ;;
esac

say() { echo "setup: $*"; }
at_least() { printf '%s\n' "$1" "$2" | sort --check=quiet --version-sort; }  # at_least LEAST VERSION

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
find_python() {  # prints the first python3 that can make a .venv and has the wheels of our lists
  local candidate
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import venv, ensurepip, sys
assert (3, 11) <= sys.version_info < (3, 14)' >/dev/null 2>&1; then
      echo "$candidate"
      return
    fi
  done
}
[ -n "$(find_python)" ] || need python3-venv
for package in ca-certificates libyaml-cpp-dev libcli11-dev libfmt-dev \
  libsodium-dev libzstd-dev nlohmann-json3-dev pkg-config zlib1g-dev; do
  need "$package"
done
if [ "$purpose" = test ]; then
  need clang-format clang-format
  for package in libgtest-dev librapidcheck-dev chromium iproute2; do need "$package"; done
fi
if [ "$purpose" = test ] || [ "$purpose" = wheel ]; then
  "$(find_python)" -c 'import os, sysconfig
os.stat(sysconfig.get_path("include") + "/Python.h")' >/dev/null 2>&1 || need python3-dev
fi

[ "$purpose" != wheel ] || need dpkg-dev dpkg-shlibdeps
[ "$purpose" != count ] || need valgrind valgrind
sanitizers_work() {
  echo 'int main() {}' |
    "${SANITIZER_CXX:-clang++-22}" -fsanitize=realtime -fopenmp -x c++ - -o /dev/null 2>/dev/null
}
if [ "$purpose" = sanitize ] && ! sanitizers_work; then
  for package in clang-22 libclang-rt-22-dev libomp-22-dev; do need "$package"; done
fi

# Recordings and EtherCAT need a small Rust library. Debian's plain cargo may be too old for it; CMake
# tries the same places.
least_rust=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' rust/Cargo.toml)
rust_works() {
  local cargo version
  for cargo in $(type -aP cargo) /usr/bin/cargo; do
    "$cargo" --version >/dev/null 2>&1 || continue
    version=$("${cargo%/*}/rustc" --version 2>/dev/null) || continue
    version=${version#rustc }
    if at_least "$least_rust" "${version%% *}"; then return 0; fi
  done
  return 1
}
if ! rust_works; then
  if [ "$purpose" = test ] || [ "$(id -u)" = 0 ]; then
    need cargo-web
    need rustc-web
  fi
fi

# The bridge to ROS 2 is built where Fast DDS is.
if [ "$purpose" = test ] || [ "$(id -u)" = 0 ]; then
  need libfastrtps-dev
fi

# The search for designs is built where pagmo is, which brings a lot.
[ "$purpose" != test ] || need libpagmo-dev

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
if [ "$purpose" = sanitize ] && ! sanitizers_work && ! SANITIZER_CXX='' sanitizers_work; then
  echo "setup: no compiler with RealtimeSanitizer, also not ${SANITIZER_CXX:-clang++-22}" >&2
  exit 1
fi
if ! rust_works; then
  say "recording and EtherCAT will be off: no cargo with rustc $least_rust or newer (Debian: cargo-web rustc-web)"
  [ "$purpose" != test ] || exit 1
fi

# --- wheels ------------------------------------------------------------------------------------
# The programs of a .venv name its folder: one that was moved, or whose python is gone, is remade.
if [ -d .venv ] && ! { .venv/bin/python -c '' && grep -qF "$PWD/.venv/bin/" .venv/bin/pip; } \
    >/dev/null 2>&1; then
  say "removing a .venv that does not work here"
  rm -rf .venv
fi
# these files and no others: their hashes are in the list
install_wheels() {
  .venv/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps \
    --only-binary=:all: -r "$1"
}
install_list() {  # install_list LIST STAMP WHAT
  if cmp -s "$1" "$2"; then return; fi
  say "installing wheels into .venv ($3)"
  if ! [ -d .venv ]; then
    if [ -z "$(find_python)" ]; then
      echo "setup: expected Python 3.11 to 3.13, got $(python3 --version)" >&2
      exit 2
    fi
    "$(find_python)" -m venv .venv
  fi
  install_wheels "$1"
  cp "$1" "$2"
}
install_list tools/requirements-linked.txt .venv/.hapticgiant-requirements-linked \
  "Pinocchio, Coal, Eigen, Boost headers"
install_list tools/requirements.txt .venv/.hapticgiant-requirements "figures, reader of recordings"
if [ "$purpose" = test ]; then
  install_list tools/requirements-test.txt .venv/.hapticgiant-requirements-test "robots, nanobind and MuJoCo for the tests, clang-tidy"
fi
if [ "$purpose" = bench ]; then
  install_list tools/requirements-bench.txt .venv/.hapticgiant-requirements-bench \
    "eiquadprog, below the paper's solver"
fi
if [ "$purpose" = wheel ]; then
  install_list tools/requirements-wheel.txt .venv/.hapticgiant-requirements-wheel "nanobind, what packs wheels"
fi

# --- viewer page -------------------------------------------------------------------------------
if [ "$purpose" = test ]; then
  tools/build_page.sh test || { echo "setup: the page could not be built" >&2; exit 1; }
else
  tools/build_page.sh || say "the page could not be built; the program runs without it"
fi
say "ready"
