#!/usr/bin/env bash
# Does what a user does: pip install from a clean copy of HEAD into a fresh virtual environment, with
# the ordinary registries, then runs examples and those Python tests that an installation can break
# with what was installed. Takes some minutes; `make test` runs all of them on the normal build.
#
#   tools/check_pip_install.sh [WORK]    WORK: folder for all of it, default build/pip_install
set -euo pipefail
cd -P "$(dirname "$0")/.."
work=${1:-build/pip_install}
rm -rf "$work"
mkdir -p "$work/source"
git archive HEAD | tar -x -C "$work/source"

python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check "$work/source"

# from another folder, so that nothing is imported from the sources
tests=$PWD/tests/packages/python_package_test.py
cd "$work"
venv/bin/python "$tests" --installed
