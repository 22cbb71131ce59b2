#!/usr/bin/env bash
# Builds the ROS 1 package against Debian's ROS 1: build/ros1. As root it installs what is missing
# (about 300 MB with rviz), otherwise it names it.
#
#   bridges/ros1/build.sh         what the bridge needs
#   bridges/ros1/build.sh test    that, and what its tests need
#
# Exit code 77: ROS 1 cannot be had here.
set -euo pipefail
cd -P "$(dirname "$0")/../.."

packages="catkin cmake g++ libdiagnostic-msgs-dev libdynamic-reconfigure-config-init-mutex-dev
  libgeometry-msgs-dev libroscpp-dev libros-rosgraph-msgs-dev libsensor-msgs-dev libstd-msgs-dev
  libstd-srvs-dev libtf2-msgs-dev liburdf-dev libvisualization-msgs-dev make nlohmann-json3-dev
  rviz python3-roslaunch python3-rosmaster rosout"
[ "${1:-}" != test ] || packages="$packages imagemagick libgl1-mesa-dri python3-diagnostic-msgs
  python3-dynamic-reconfigure python3-geometry-msgs python3-numpy python3-rospy python3-sensor-msgs
  python3-std-srvs python3-tf2-msgs python3-visualization-msgs xvfb"

missing=()
for package in $packages; do
  state=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$state" = "install ok installed" ] || missing+=("$package")
done
if [ "${#missing[@]}" -gt 0 ]; then
  if [ "$(id -u)" != 0 ]; then
    echo "ros1: skipped, missing: apt-get install ${missing[*]}" >&2
    exit 77
  fi
  echo "ros1: installing ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  if ! { apt-get update && apt-get install -y --no-install-recommends "${missing[@]}"; } \
    >/dev/null 2>&1; then
    echo "ros1: skipped, apt-get cannot install ${missing[*]}" >&2
    exit 77
  fi
fi

# CMake files of Debian's ROS call python: that of the system, not one that is first on the PATH
python=/usr/bin/python3
cmake -S bridges/ros1 -B build/ros1 -DPython3_EXECUTABLE=$python -DPYTHON_EXECUTABLE=$python \
  >build/ros1.log 2>&1 || { cat build/ros1.log >&2; exit 1; }
cmake --build build/ros1 >build/ros1.log 2>&1 || { cat build/ros1.log >&2; exit 1; }
bridge=build/ros1/devel/lib/hapticgiant_bridge/hapticgiant_bridge
for program in build/*/hapticgiant; do  # `hapticgiant bridge ros1` looks beside itself
  [ ! -f "$program" ] || ln -sf "$PWD/$bridge" "$program-ros1"
done
echo "ros1: $bridge"
