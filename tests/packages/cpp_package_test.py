"""The C++ package as a project outside sees it: installed, found, compiled with other vector flags.

Arguments: the build folder, and the folder of Eigen's package file, the only one that hqp and
limits may need.
"""

import pathlib
import platform
import re
import shutil
import subprocess
import sys

from environment import that_lets_late_cycles_pass

EXAMPLES = pathlib.Path("examples/cpp").resolve()
DRIVER = pathlib.Path("examples/driver/cpp").resolve()
MOVED = re.compile(r"the joints have moved by up to 1\.[4-6][0-9] rad in 2[0-9]{3} cycles")
DOOR_OPEN = re.compile(r"hinge at 1\.[0-9]+ rad after 10\.6 s")

REMOTE_PROJECT = """cmake_minimum_required(VERSION 3.22)
project(remote LANGUAGES CXX)
find_package(hapticgiant 0.2 REQUIRED CONFIG COMPONENTS udp)
add_executable(remote main.cpp)
target_link_libraries(remote PRIVATE hapticgiant::udp)
"""
REMOTE_PROGRAM = """#include <cstdio>
#include <exception>

#include "hg/device/udp/remote_device.h"

int main() try {
  hg::udp::RemoteDevice device(hg::udp::parse_address("--device-address", "nowhere"), {});
} catch (const std::exception& error) {
  std::puts(error.what());
  return 1;
}
"""


def run(*command, fails=False):
    """Output of a command; exits with all of it where the command does not end as expected."""
    result = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT)
    if (result.returncode != 0) != fails:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}")
    return result.stdout


def configure(build, *options, source=EXAMPLES, **keywords):
    shutil.rmtree(build, ignore_errors=True)
    return run("cmake", "-S", source, "-B", build, "-G", "Ninja", "-Wno-dev", *options, **keywords)


def check(holds, what):
    if not holds:
        sys.exit(what)


def check_pages():
    text = pathlib.Path("docs/start/packages.md").read_text()
    for example in [*EXAMPLES.glob("*.cpp"), *DRIVER.glob("*.cpp"), *DRIVER.glob("*.h")]:
        shown = example.relative_to(pathlib.Path().resolve())
        check(f"\n[{shown}](../../{shown})\n" in text, f"docs/start/packages.md does not show {shown}")


def check_libraries(prefix, tree):
    # nothing of Eigen's can be mistaken for the consumer's
    symbols = run("nm", "--demangle", prefix / "lib" / "libhg_hqp.a")
    check(not re.search(r"\bEigen::", symbols), "libhg_hqp.a shares functions of Eigen")

    # only our own program counts allocations; others keep their malloc
    malloc = re.compile(r" T malloc$", re.MULTILINE)
    check(malloc.search(run("nm", tree / "hapticgiant")), "the program does not count allocations")
    for library in sorted((prefix / "lib").glob("*.a")):
        check(not malloc.search(run("nm", library)), f"{library.name} replaces malloc")


def check_solver_alone(work, prefix, eigen, flags):
    """Solver and bounds: nothing but Eigen and zlib is found, and the flags are the consumer's own."""
    alone = work / "alone"
    found = configure(alone, f"-DCMAKE_PREFIX_PATH={prefix}", f"-DEigen3_DIR={eigen}",
                      "-DCMAKE_DISABLE_FIND_PACKAGE_pinocchio=ON", f"-DCMAKE_CXX_FLAGS={flags}")
    run("cmake", "--build", alone)
    check(not (alone / "first_feel").exists(), "first_feel was built without Pinocchio")
    check("pinocchio" not in (alone / "CMakeCache.txt").read_text().replace(
        "CMAKE_DISABLE_FIND_PACKAGE_pinocchio", ""), f"Pinocchio was looked for:\n{found}")
    if "avx2" in pathlib.Path("/proc/cpuinfo").read_text():
        check(run(alone / "solve_problem") == "solved: x = (1, 2)\n", "solve_problem")
        check("rests at 1.000000 rad" in run(alone / "joint_bounds"), "joint_bounds")


def check_own_machine(both, models):
    """A program for a real machine: nothing of the simulator, its person or its faults is in it."""
    moved = run(both / "own_machine", models / "examples" / "arm.yaml",
                models / "twins" / "free_space" / "twin.yaml")
    check(MOVED.fullmatch(moved.strip()), f"own_machine: {moved}")
    link = run("ninja", "-C", both, "-t", "commands", "own_machine").strip().splitlines()[-1]
    linked = set(re.findall(r"libhg_([a-z_]+)[.]a", link))
    check({"controller", "runtime", "config"} <= linked, f"own_machine links {linked}")
    others = linked & {"simulator", "simulation", "scenario", "analysis"}
    check(not others, f"own_machine links {others}")
    symbols = run("nm", "--demangle", both / "own_machine")
    check("hg::runtime::Runtime::start" in symbols, "nm shows no names")
    check("hg::config::load_device" in symbols, "own_machine reads no device.yaml")
    found = re.findall(r"\bhg::(?:simulator|person|faults|scenario)::[A-Za-z_]+", symbols)
    found += re.findall(r"\bhg::config::load_(?:simul|scen|script)[a-z_]*", symbols)
    check(not found, f"own_machine has {found[:3]}")


def drive(driver, arm, program):
    """What a server for this machine and a run of two seconds on it print."""
    server = subprocess.Popen([driver, arm, "127.0.0.1:0", "--simulated"], text=True,
                              stdout=subprocess.PIPE)
    try:
        address = server.stdout.readline().strip()
        ran = subprocess.run([program, "run", "free_space", "--device", arm, "--device-address", address,
                              "--duration", "2", "--no-viewer", "--no-recording"], text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    finally:
        server.terminate()
    served = server.communicate()[0]
    check(server.returncode == 0, f"my_driver ended with {server.returncode}")
    return served, ran.stdout


def check_driver(work, path, tree, models):
    """The same machine behind a server of its own project, and our program as its controller."""
    driver = work / "driver"
    configure(driver, path, source=DRIVER)
    run("cmake", "--build", driver)
    arm = that_lets_late_cycles_pass(models / "examples" / "arm.yaml", driver)
    for _ in range(3):  # a busy computer may keep one of both for longer than the other waits
        served, summary = drive(driver / "my_driver", arm, tree / "hapticgiant")
        if "silent" not in served + summary:
            break
    check(re.search(r"^[0-9]+ periods for hapticgiant", served, re.MULTILINE), f"served: {served}")
    check("limits       all held" in summary and "FAULT" not in summary, f"my_driver: {summary}")
    refused = run(driver / "my_driver", arm, "nowhere", fails=True)
    check("HOST:PORT" in refused, f"my_driver: {refused}")


def check_remote(work, path):
    """A program for a machine behind a network finds all that it links."""
    remote = work / "remote"
    shutil.rmtree(remote, ignore_errors=True)
    remote.mkdir()
    (remote / "CMakeLists.txt").write_text(REMOTE_PROJECT)
    (remote / "main.cpp").write_text(REMOTE_PROGRAM)
    run("cmake", "-S", remote, "-B", remote / "build", "-G", "Ninja", "-Wno-dev", path)
    run("cmake", "--build", remote / "build")
    refused = run(remote / "build" / "remote", fails=True)
    check("--device-address" in refused, f"remote: {refused}")


def main():
    check_pages()
    tree = pathlib.Path(sys.argv[1]).resolve()
    eigen = sys.argv[2]
    wheels = pathlib.Path(eigen).parents[2]
    work = tree / "package_cpp"
    prefix = work / "prefix"
    shutil.rmtree(prefix, ignore_errors=True)
    run("cmake", "--install", tree, "--prefix", prefix, "--component", "cpp")
    check_libraries(prefix, tree)
    flags = "-mavx2 -mfma" if platform.machine() in ("x86_64", "AMD64") else ""
    check_solver_alone(work, prefix, eigen, flags)

    # everything else, with the wheels
    both = work / "both"
    path = f"-DCMAKE_PREFIX_PATH={prefix};{wheels}"
    configure(both, path)
    run("cmake", "--build", both)
    models = prefix / "share" / "hapticgiant" / "models"
    opened = run(both / "first_feel", models / "scenarios" / "door.yaml")
    check(DOOR_OPEN.fullmatch(opened.strip()), f"first_feel: {opened}")
    check_own_machine(both, models)
    check_driver(work, path, tree, models)
    check_remote(work, path)

    # what shows Eigen's types is refused where they would have another layout
    if flags:
        configure(both, path, "-DCMAKE_CXX_FLAGS=-mavx2")
        refused = run("cmake", "--build", both, "--target", "first_feel", fails=True)
        check("without AVX" in refused, f"AVX was not refused:\n{refused}")

    print("cpp package: installed, found, built with its own flags, run")


if __name__ == "__main__":
    main()
