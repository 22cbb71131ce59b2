"""The wheel and the Debian package as their users have them: installed where nothing of the sources
is, used in an empty folder with an empty HOME.

    installed_test.py wheel PROGRAM WHEEL WORK    into a fresh virtual environment, by pip, and one of
                                                  every other Python that is at hand
    installed_test.py bare PROGRAM WHEEL WORK     into a bare system of this Debian with python3-venv, as deb
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
MOST_MB = 150
"""A wheel without extras: all of site-packages after its installation, pip's own files included."""
SHIPPED = ["docs/start/install.md", "docs/reference/configuration_channels.csv",
           "examples/sweep/door.yaml", "examples/notebooks/1_first_run.ipynb", "examples/notebooks/1_first_run.py",
           "examples/python/open_door.py", "examples/cpp/CMakeLists.txt", "examples/driver/cpp/robot.h",
           "examples/foxglove/hapticgiant.json", "models/scenarios/door.yaml", "README.md"]
"""Of each kind of file that an installation has, below share/hapticgiant."""
EXTRAS = {"report": ["imus", "arm.urdf"], "sweep": ["sweep", "show", "{sweep}"],
          "study": ["study", "check", "{study}"],
          "export": ["export", "recordings/latest.mcap", "--format", "parquet"]}
"""A command that needs the extra of this name."""
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


def pythons():
    """Every Python from 3.10 on that is at hand and can make an environment, one of each minor version."""
    found = {}
    folders = [pathlib.Path(folder) for folder in os.environ["PATH"].split(os.pathsep)]
    for python in [pathlib.Path(sys.executable),
                   *(folder / f"python3.{minor}" for folder in folders for minor in range(10, 20)),
                   *sorted(pathlib.Path.home().glob(".pyenv/versions/*/bin/python3"))]:
        said = subprocess.run([python, "-c", "import sys, venv, ensurepip; print(*sys.version_info[:2])"],
                              capture_output=True, text=True) if python.exists() else None
        if said and said.returncode == 0 and tuple(map(int, said.stdout.split())) >= (3, 10):
            found.setdefault(said.stdout.strip().replace(" ", "."), python)
    return found


class Installed:
    """An installed program, its empty folder as seen from here, and the files that came with it."""

    def __init__(self, command, folder, prefix, environment, libraries, root="/"):
        self.command, self.folder, self.prefix, self.root = command, folder, prefix, root
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
            check(re.search(r"'hapticgiant\[report\]', or apt install python3-scipy", drawn),
                  f"plot does not say what is missing: {drawn}")

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

    def share(self):
        return self.prefix / "share/hapticgiant"

    def files(self):
        """A sweep and a study that are shipped, where the program sees them."""
        studies = sorted(self.prefix.rglob("door_and_path.yaml"))
        check(studies, "no study file is in the package")
        return {"sweep": pathlib.Path("/", (self.share() / "examples/sweep/door.yaml").relative_to(self.root)),
                "study": pathlib.Path("/", studies[0].relative_to(self.root))}

    def test_what_is_shipped(self):
        for name in SHIPPED:
            check((self.share() / name).is_file(), f"{name} is not in the package")
        helps = self.all_helps()
        where = pathlib.Path("/", self.share().relative_to(self.root))
        check(f"\nFiles that this names are in {where}\n" in helps, "no help says where its files are")
        named = re.findall(r"\b(?:docs|examples|models|tests)/[\w./-]*\w", helps)
        check("docs/start/design.md" in named and len(set(named)) > 15, f"helps name {sorted(set(named))}")
        for name in set(named):
            check((self.share() / name).exists(), f"a help names {name}, which is not in the package")

    def all_helps(self, *words):
        """The help of every command and subcommand, one after the other."""
        done = subprocess.run([*self.command, *words, "--help"], text=True, capture_output=True, **self.options())
        below = re.findall(r"(?m)^  ([a-z][a-z0-9-]*)  +[A-Z][a-z]", done.stdout) if len(words) < 2 else []
        check(words or len(below) > 20, f"commands: {below}")
        return done.stdout + "".join(self.all_helps(*words, name) for name in below)

    def test_what_an_extra_brings_is_named(self):
        """Where no extra is installed."""
        for extra, words in EXTRAS.items():
            done = subprocess.run([*self.command, *(word.format(**self.files()) for word in words)], text=True,
                                  capture_output=True, **self.options())
            said = done.stdout + done.stderr
            check(f"pip install 'hapticgiant[{extra}]'" in said and "Traceback" not in said,
                  f"{' '.join(words)} does not name [{extra}]: {done}")
        python = self.command[0].parent / "python"
        done = subprocess.run([python, "-c", "import hapticgiant"], text=True, capture_output=True, **self.options())
        check(done.returncode == 1 and done.stderr.endswith(
            "ModuleNotFoundError: import hapticgiant needs numpy: pip install 'hapticgiant[arrays]'\n"),
            f"import hapticgiant does not name [arrays]: {done}")

    def test_sweep_and_study(self):
        listed = self.run("sweep", "show", self.files()["sweep"])
        check("hapticgiant run" in listed, f"sweep: {listed}")
        plan = self.run("study", "plan", self.files()["study"])
        check("P01" in plan, f"study: {plan}")

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
        print(run(sys.executable, ROOT / "tests/hardening/hardening_test.py", "--packed",
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

    def test(self, program):
        """Without figures."""
        self.test_the_run_of_the_build(program)
        self.test_recordings(has_figures=False)
        self.test_files()
        self.test_what_is_shipped()
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


def environment_with(python, folder, *packages):
    """A fresh virtual environment of this Python, with these packages; its folder site-packages."""
    run(python, "-m", "venv", folder)
    # the settings and the cache of pip are the caller's
    timed(f"pip install for {folder.name}", folder / "bin" / "python", "-m", "pip", "install", "--quiet",
          "--disable-pip-version-check", *packages)
    (site,) = (folder / "lib").glob("python3*/site-packages")
    return site


def test_wheel(program, wheel, work):
    environment = empty_home(work)
    site = environment_with(sys.executable, work / "venv", wheel)
    python = work / "venv" / "bin" / "python"
    installed_mb = int(run("du", "--summarize", "--bytes", site).split()[0]) / 1e6
    print(f"size: {wheel.stat().st_size / 1e6:.1f} MB, site-packages with all that it needs and pip {installed_mb:.0f} MB")
    check(installed_mb <= MOST_MB, f"{installed_mb:.0f} MB are installed, expected {MOST_MB} at most")
    # it says what the symbols of the system demand
    shown = " ".join(run("auditwheel", "show", wheel).split())
    tag = wheel.stem.rpartition("-")[2]
    check(f'constrains the platform tag to "{tag}"' in shown, f"auditwheel says another tag: {shown}")
    (work / "empty").mkdir()
    installed = Installed([work / "venv" / "bin" / "hapticgiant"], work / "empty", site / "hapticgiant", environment,
                          [*(site / "hapticgiant.libs").iterdir(), *(site / "hapticgiant/lib").rglob("*.so*")])
    installed.test(program)
    installed.test_what_an_extra_brings_is_named()
    installed.test_the_bridge(is_in_it=False)
    timed("pip install of extras", python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
          f"{wheel}[study,tables]")
    installed.test_recordings(has_figures=True)
    installed.test_sweep_and_study()
    run(python, ROOT / "tests/packages/python_package_test.py", "--installed", cwd=work / "empty",
        env=environment)
    test_other_pythons(program, wheel, work, environment)


def test_other_pythons(program, wheel, work, environment):
    """The same wheel in the other versions of Python: the program, and the extensions."""
    built = STATE.search(run(program, "run", "door", "--fast", "--no-recording"))[1]
    own = f"{sys.version_info.major}.{sys.version_info.minor}"
    for version, python in pythons().items():
        if version == own:
            continue
        environment_with(python, work / version, f"{wheel}[arrays]")
        options = {"env": environment, "cwd": work / "empty"}
        door = run(work / version / "bin/hapticgiant", "run", "door", "--fast", "--no-recording", **options)
        check(built in door, f"Python {version}: another door than that of the build, {built}:\n{door}")
        run(work / version / "bin/python", "-c", "import hapticgiant as hg\n"
            "played = hg.play('door', fast=True, recording=False)\n"
            f"assert played.summary['state_hash'] == '{built}', played\n"
            "assert hg.run('door', 0.1)['robot.w_h'].shape[1] == 6\n"
            "print(hg.limits.bounds_A, hg.hqp.Problem)", **options)
        print(f"Python {version}: fine")


class Bare:
    """A bare system of this Debian in a folder, with /proc while it is in use."""

    def __init__(self, work, *packages):
        if os.geteuid() != 0 or not shutil.which("mmdebstrap"):
            print("installed_test: skipped, a bare system needs root and mmdebstrap")
            sys.exit(77)
        self.folder = work / "system"
        (work / "apt.conf").write_text(run("apt-config", "dump", "Acquire"))
        release = dict(line.split("=", 1) for line in
                       pathlib.Path("/etc/os-release").read_text().splitlines() if "=" in line)
        sources = [path for path in (*pathlib.Path("/etc/apt").glob("sources.list.d/debian.sources"),
                                     pathlib.Path("/etc/apt/sources.list")) if path.exists()]
        timed("bare system", "mmdebstrap", "--quiet", "--variant=minbase", "--skip=cleanup/apt/lists",
              *(f"--include={name}" for name in packages), f"--aptopt={work / 'apt.conf'}",
              release["VERSION_CODENAME"], self.folder, sources[0])
        (self.folder / "empty" / "home").mkdir(parents=True)

    # programs find libraries beside themselves by /proc, as everywhere outside a bare folder
    def __enter__(self):
        run("mount", "--types", "proc", "proc", self.folder / "proc")
        return self

    def __exit__(self, *_):
        run("umount", self.folder / "proc")


def test_bare(program, wheel, work):
    """From pip install to the door, felt in real time, where nothing but Python is."""
    environment = empty_home(work) | {"HOME": "/empty/home"}
    environment |= {name: value for name, value in os.environ.items() if name.startswith("PIP_")}
    with Bare(work, "python3-venv") as bare:
        shutil.copy(wheel, bare.folder / "root")
        for name in ("etc/resolv.conf", "etc/pip.conf", "etc/ssl/certs/ca-certificates.crt"):  # the caller's
            if pathlib.Path("/", name).exists():
                (bare.folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(pathlib.Path("/", name), bare.folder / name)
        inside = ["chroot", bare.folder, "/usr/bin/env", "-C", "/empty"]
        start = time.monotonic()
        timed("python3 -m venv", *inside, "python3", "-m", "venv", "/venv", env=environment)
        timed("pip install", *inside, "/venv/bin/pip", "install", "--quiet", f"/root/{wheel.name}", env=environment)
        door = subprocess.run([*map(str, inside), "/venv/bin/hapticgiant", "run", "door"], env=environment, text=True,
                              capture_output=True, stdin=subprocess.DEVNULL)
        print(f"from a bare system to the end of the door in real time: {time.monotonic() - start:.1f} s", flush=True)
        if "rule 203" not in door.stdout + door.stderr:  # which ends a run on a computer that is too busy
            check("8 of 8 in order" in door.stdout, f"events of the door:\n{door}")
        (site,) = (bare.folder / "venv/lib").glob("python3*/site-packages")
        installed = Installed([*inside, "/venv/bin/hapticgiant"], bare.folder / "empty", site / "hapticgiant",
                              environment, [], bare.folder)
        installed.test_the_run_of_the_build(program)
        installed.test_recordings(has_figures=False)
        installed.test_what_is_shipped()
        installed.test_the_page()


def test_deb(program, package, work):
    with Bare(work) as bare:
        system = bare.folder
        shutil.copy(package, system / "root")
        environment = empty_home(work) | {"HOME": "/empty/home", "DEBIAN_FRONTEND": "noninteractive"}
        install = ["chroot", system, "apt-get", "install", "--yes", "--no-install-recommends"]
        timed("apt install", *install, f"/root/{package.name}", env=environment)
        libraries = list((system / "usr/lib/hapticgiant/lib").iterdir())
        command = ["chroot", system, "/usr/bin/env", "-C", "/empty", "hapticgiant"]
        installed = Installed(command, system / "empty", system / "usr", environment, libraries,
                              system)
        installed.test(program)
        installed.test_the_bridge(is_in_it=True)
        recommended = re.search(r"Recommends: (.*)", run("dpkg-deb", "--info", package))[1].split(", ")
        timed("apt install of what it recommends", *install, *recommended, env=environment)
        installed.test_recordings(has_figures=True)
        installed.test_sweep_and_study()
    print(f"size: {package.stat().st_size / 1e6:.1f} MB")


def main():
    kind, program, package, work = sys.argv[1], *map(lambda word: pathlib.Path(word).resolve(),
                                                     sys.argv[2:])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    {"wheel": test_wheel, "bare": test_bare, "deb": test_deb}[kind](program, package, work)
    print(f"installed_test: {package.name} is fine")


if __name__ == "__main__":
    main()
