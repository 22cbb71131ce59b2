"""The wheel and the Debian package as their users have them: installed where nothing of the sources
is, used in an empty folder with an empty HOME.

    installed_test.py wheel PROGRAM WHEEL WORK    into a fresh virtual environment, by pip
    installed_test.py deb PROGRAM PACKAGE WORK    into a bare system of this Debian, by apt; needs root
                                                  and mmdebstrap, else exit code 77

PROGRAM is that of the build, whose runs the installed one has to repeat to the last bit.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
STATE = re.compile(r"^ +state +([0-9a-f]{16}) ", re.MULTILINE)
LINK = re.compile(r"(http://\S+)/#token=(\w+)")
# libraries that are in a package: the component of THIRD_PARTY.md, whose licence is in it, too
COMPONENTS = {
    "libassimp": "cmeel-assimp", "libboost_": "cmeel-boost", "libcoal": "libcoal",
    "libconsole_bridge": "cmeel-console-bridge", "libfmt": "libfmt-dev", "liboctom": "cmeel-octomap",
    "libpinocchio": "libpinocchio", "libqhull": "cmeel-qhull", "libsodium": "libsodium-dev",
    "libtinyxml2": "cmeel-tinyxml2", "liburdfdom": "cmeel-urdfdom", "libyaml-cpp": "libyaml-cpp-dev",
    "libzstd": "libzstd-dev",
}


def check(holds, what):
    if not holds:
        sys.exit(f"installed_test: {what}")


def run(*command, **options):
    """Output of a command; exits with all of it where the command fails."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, **options)
    check(done.returncode == 0, f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout}")
    return done.stdout


def timed(what, *command, **options):
    """Runs a command and says how long it took."""
    start = time.monotonic()
    run(*command, **options)
    print(f"{what}: {time.monotonic() - start:.1f} s", flush=True)


class Installed:
    """An installed program, its empty folder as seen from here, and the files that came with it."""

    def __init__(self, command, folder, prefix, environment, libraries):
        self.command, self.folder, self.prefix = command, folder, prefix
        self.environment, self.libraries = environment, libraries

    def options(self):
        return {"env": self.environment, "cwd": self.folder if self.folder.exists() else None}

    def run(self, *words):
        return run(*self.command, *words, **self.options())

    def test_the_run_of_the_build(self, program):
        built = STATE.search(run(program, "run", "door", "--fast", "--no-recording"))
        start = time.monotonic()
        door = self.run("run", "door", "--fast")
        print(f"first run: {time.monotonic() - start:.1f} s", flush=True)
        check("8 of 8 in order" in door, f"events of the door:\n{door}")
        state = STATE.search(door)
        check(state and built and state[1] == built[1], f"the build ends with {built}:\n{door}")

    def test_recordings(self, has_figures):
        recording = "recordings/latest.mcap"
        check((self.folder / recording).exists(), "no recording")
        check("the same bit for bit" in self.run("replay", recording), "replay")
        check("no fault" in self.run("explain", recording), "explain")
        drawn = self.run("plot", recording)
        figure = self.folder / "plots" / "figure.png"
        if has_figures:
            check(figure.exists() and figure.read_bytes().startswith(b"\x89PNG"), f"plot: {drawn}")
        else:
            check("apt install python3-scipy" in drawn, f"plot does not say what is missing: {drawn}")

    def test_files(self):
        for name in ("arm.urdf", "gate.urdf"):
            shutil.copy(ROOT / "models" / "examples" / name, self.folder)
        self.run("new", "device", "arm.urdf")
        self.run("new", "twin", "gate.urdf", "--device", "arm_device.yaml")
        self.run("check", "arm_device.yaml", "gate_twin.yaml")
        self.run("run", "--device", "arm_device.yaml", "--twin", "gate_twin.yaml", "--fast",
                 "--duration", "1", "--no-recording")
        self.run("run", "ur5e/open_cupboard", "--fast", "--no-recording")
        self.run("new", "driver", "mine")
        done = subprocess.run([*self.command, "doctor", "--seconds", "0.2"], text=True,
                              capture_output=True, **self.options())
        check(done.returncode in (0, 1) and "processors" in done.stdout, f"doctor: {done}")

    def test_the_page(self):
        process = subprocess.Popen([*self.command, "run", "door", "--no-browser", "--no-recording",
                                    "--duration", "600"], text=True, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, **self.options())
        try:
            link = next((found for found in map(LINK.search, process.stdout) if found), None)
            check(link, "no link")
            page = get(link[1] + "/", link[2])
            assets = re.findall(r'"/?(?:\./)?(assets/[^"]+)"', page)
            check(assets, f"the page: {page[:300]}")
            for asset in assets:
                check(len(get(f"{link[1]}/{asset}", link[2])) > 1000, asset)
            check('"twin"' in get(link[1] + "/scene.json", link[2]), "scene.json")
            check(get(link[1] + "/scene.json", "0" * len(link[2])) == "", "a wrong token is taken")
        finally:
            process.send_signal(signal.SIGINT)
            rest, _ = process.communicate(timeout=60)
        check(process.returncode == 0, f"the run with a page ended with {process.returncode}\n{rest}")

    def test_licences(self):
        texts = (self.prefix / "share/doc/hapticgiant/copyright").read_text()
        listed = (self.prefix / "share/doc/hapticgiant/THIRD_PARTY.md").read_text()
        check(self.libraries, "no library was found")
        for library in self.libraries:
            (component,) = [name for begin, name in COMPONENTS.items()
                            if library.name.startswith(begin)] or [None]
            check(component and f"| {component} |" in listed and
                  re.search(rf"^{component}\b", texts, re.MULTILINE),
                  f"{library.name} is in the package without a licence")
        for component in re.findall(r"\| (?:npm|crates.io) \| (\S+) .*(?:bundle|linked)", listed):
            check(re.match("win", component) or re.search(rf"^{component} ", texts, re.MULTILINE),
                  f"{component}: its licence is not in the package")

    def test_library_folders(self):
        print(run(sys.executable, ROOT / "tests/hardening/hardening_test.py",
                  *self.prefix.glob("bin/hapticgiant*"),
                  *{file.parent for file in self.libraries}, *self.prefix.glob("_core*.so")), end="")

    def test_the_bridge(self, is_in_it):
        done = subprocess.run([*self.command, "bridge", "ros2", "--help"], text=True,
                              capture_output=True, **self.options())
        if is_in_it:
            check(done.returncode == 0 and "ROS_DOMAIN_ID" in done.stdout, f"bridge ros2: {done}")
        else:
            check(done.returncode == 2 and done.stderr.count("\n") == 1 and "Debian package" in done.stderr,
                  f"bridge ros2 does not say where to get it: {done}")

    def test(self, program, has_figures):
        self.test_the_run_of_the_build(program)
        self.test_recordings(has_figures)
        self.test_files()
        self.test_the_page()
        self.test_licences()
        self.test_library_folders()


def get(url, token):
    """What a server answers; nothing where the token does not please it."""
    request = urllib.request.Request(url, headers={"Authorization": f"Bearer {token}"})
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.read().decode()
    except urllib.error.HTTPError as error:
        check(error.code in (401, 403), f"{url}: {error}")
        return ""


def empty_home(folder):
    (folder / "home").mkdir()
    return {"HOME": str(folder / "home"), "PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LANG": "C.UTF-8"}


def test_wheel(program, wheel, work):
    environment = empty_home(work)
    run(sys.executable, "-m", "venv", work / "venv")
    python = work / "venv" / "bin" / "python"
    # the settings and the cache of pip are the caller's
    timed("pip install", python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wheel)
    (site,) = (work / "venv" / "lib").glob("python3*/site-packages")
    print(f"size: {wheel.stat().st_size / 1e6:.1f} MB, installed with all that it needs "
          f"{int(run('du', '--summarize', '--bytes', site).split()[0]) / 1e6:.0f} MB")
    # it knows nothing of the other wheels' libraries, and says what the symbols of the system demand
    shown = " ".join(run("auditwheel", "show", wheel).split())
    tag = wheel.stem.rpartition("-")[2]
    check(f'constrains the platform tag to "{tag}"' in shown, f"auditwheel says another tag: {shown}")
    (work / "empty").mkdir()
    installed = Installed([work / "venv" / "bin" / "hapticgiant"], work / "empty", site / "hapticgiant",
                          environment, list((site / "hapticgiant.libs").iterdir()))
    installed.test(program, has_figures=True)
    installed.test_the_bridge(is_in_it=False)
    run(python, ROOT / "tests/packages/python_package_test.py", "--installed", cwd=work / "empty",
        env=environment)


def test_deb(program, package, work):
    if os.geteuid() != 0 or not shutil.which("mmdebstrap"):
        print("installed_test: skipped, the Debian package needs root and mmdebstrap")
        sys.exit(77)
    system = work / "system"
    (work / "apt.conf").write_text(run("apt-config", "dump", "Acquire"))
    release = dict(line.split("=", 1) for line in
                   pathlib.Path("/etc/os-release").read_text().splitlines() if "=" in line)
    sources = [path for path in (*pathlib.Path("/etc/apt").glob("sources.list.d/debian.sources"),
                                 pathlib.Path("/etc/apt/sources.list")) if path.exists()]
    timed("bare system", "mmdebstrap", "--quiet", "--variant=minbase", "--skip=cleanup/apt/lists",
          f"--aptopt={work / 'apt.conf'}", release["VERSION_CODENAME"], system, sources[0])
    shutil.copy(package, system / "root")
    environment = empty_home(work) | {"HOME": "/empty/home", "DEBIAN_FRONTEND": "noninteractive"}
    (system / "empty" / "home").mkdir(parents=True)
    install = ["chroot", system, "apt-get", "install", "--yes", "--no-install-recommends"]
    # programs find libraries beside themselves by /proc, as everywhere outside a bare folder
    run("mount", "--types", "proc", "proc", system / "proc")
    try:
        timed("apt install", *install, f"/root/{package.name}", env=environment)
        libraries = list((system / "usr/lib/hapticgiant/lib").iterdir())
        command = ["chroot", system, "/usr/bin/env", "-C", "/empty", "hapticgiant"]
        installed = Installed(command, system / "empty", system / "usr", environment, libraries)
        installed.test(program, has_figures=False)
        installed.test_the_bridge(is_in_it=True)
        recommended = re.search(r"Recommends: (.*)", run("dpkg-deb", "--info", package))[1].split(", ")
        timed("apt install of what it recommends", *install, *recommended, env=environment)
        installed.test_recordings(has_figures=True)
    finally:
        run("umount", system / "proc")
    print(f"size: {package.stat().st_size / 1e6:.1f} MB")


def main():
    kind, program, package, work = sys.argv[1], *map(lambda word: pathlib.Path(word).resolve(),
                                                     sys.argv[2:])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    {"wheel": test_wheel, "deb": test_deb}[kind](program, package, work)
    print(f"installed_test: {package.name} is fine")


if __name__ == "__main__":
    main()
