"""Everything of others that the program, its page or its Python package is made of: THIRD_PARTY.md.

    third_party.py            writes it; needs what `tools/setup.sh test` installs
    third_party.py --check    compares it with the lists that say what is installed: quick, offline
    third_party.py --texts FILE
                              writes the licences in full, for who gives the program away
    third_party.py --audit    queries advisory databases (cargo audit, npm audit) where they answer

Exit codes: 0 fine, 1 a component without an entry, an entry without a component, a licence that is
not in ALLOWED, or an advisory.
"""

import argparse
import importlib.metadata
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "THIRD_PARTY.md"
RUST = ROOT / "rust"

# what a program that links all of it may be given away with
ALLOWED = {"0BSD", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause",
           "BSL-1.0", "GPL-3.0-only WITH GCC-exception-3.1", "ISC", "LGPL-2.1-or-later", "LGPL-2.1+",
           "LGPL-3.0-or-later", "MIT",
           "MPL-2.0", "Qhull", "Unicode-3.0", "Unicode-DFS-2016", "Unlicense", "Zlib"}
# where the metadata of a wheel is wrong or says nothing
CORRECTED = {"cmeel-console-bridge": "BSD-3-Clause", "cmeel-eigen": "MPL-2.0", "cmeel-qhull": "Qhull"}
# of wheels without a text: a header that begins with it, below include
HEADERS = {
    "cmeel-assimp": "assimp/scene.h",
    "cmeel-boost": "boost/outcome/detail/version.hpp",
    "cmeel-console-bridge": "console_bridge/console.h",
    "cmeel-octomap": "octomap/octomap.h",
    "cmeel-tinyxml2": "tinyxml2.h",
    "cmeel-urdfdom": "urdfdom/urdf_parser/urdf_parser.h",
    "cmeel-urdfdom-headers": "urdfdom_headers/urdf_model/model.h",
}
# packages of Debian: licence of what is linked, and how
SYSTEM = {
    "g++": ("GPL-3.0-only WITH GCC-exception-3.1", "libstdc++ and libgcc, linked dynamically"),
    "libc6": ("LGPL-2.1-or-later", "linked dynamically"),
    "libcli11-dev": ("BSD-3-Clause", "headers"),
    "libfastrtps-dev": ("Apache-2.0", "linked dynamically by hapticgiant-ros2"),
    "libfmt-dev": ("MIT", "linked dynamically"),
    "libpagmo-dev": ("LGPL-3.0-or-later OR GPL-3.0-or-later",
                     "linked dynamically by hapticgiant-design"),
    "libsodium-dev": ("ISC", "linked dynamically"),
    "libyaml-cpp-dev": ("MIT", "linked dynamically"),
    "libzstd-dev": ("BSD-3-Clause", "linked dynamically"),
    "nlohmann-json3-dev": ("MIT", "headers"),
    "rustc": ("MIT OR Apache-2.0", "Rust's standard library, linked"),
    "zlib1g-dev": ("Zlib", "linked dynamically"),
}
# numbers in URDFs of models/arms, by name and version
MODELS = {
    ("Universal_Robots_ROS2_Description", "2.4.5"): ("BSD-3-Clause", "ur5e and ur10e"),
    ("example-robot-data", "6.0.0"): ("BSD-3-Clause", "xarm7"),
    ("franka_description", "1.0.1"): ("Apache-2.0", "fr3"),
    ("lbr_fri_ros2_stack", "218d723f"): ("Apache-2.0", "iiwa14"),
    ("ros2_kortex", "1fdbef34"): ("BSD-3-Clause", "gen3"),
    ("xarm_ros2", "3654ba7b"): ("BSD-3-Clause", "xarm7"),
}
# numbers of protocols, by name and version
PROTOCOLS = {
    ("libfranka-common", "d96c221"): ("Apache-2.0", "layout of messages: hg/device/franka/protocol.h"),
}
# in no package: only hapticgiant-design, which is in none, is linked with it
UNPACKED = {"libpagmo-dev"}
SPDX_TEXT = "that of this name in the SPDX list"
IMPLIED = ["g++", "libc6", "libfastrtps-dev", "libpagmo-dev", "rustc"]  # not in the list of setup.sh that libraries are in


def system_names():
    """Libraries among the packages that setup.sh installs for a build."""
    setup = (ROOT / "tools/setup.sh").read_text()
    listed = re.search(r"for package in ((?:[^;]|\\\n)*?); do", setup)[1].replace("\\\n", " ")
    tools = {"ca-certificates", "pkg-config"}
    return sorted(set(listed.split()) - tools | set(IMPLIED))


def wheel_names():
    text = (ROOT / "tools/requirements-linked.txt").read_text()
    wheels = re.findall(r"(?m)^([\w-]+)==([\w.]+)", text)
    requires = tomllib.loads((ROOT / "pyproject.toml").read_text())["build-system"]["requires"]
    return sorted(wheels + [tuple(entry.split("==")) for entry in requires
                            if entry.startswith("nanobind==")])


def crate_names():
    packages = tomllib.loads((RUST / "Cargo.lock").read_text())["package"]
    return sorted((package["name"], package["version"]) for package in packages
                  if "source" in package)


def npm_names():
    lock = json.loads((ROOT / "viewer/package-lock.json").read_text())["packages"]
    return sorted((path.rpartition("node_modules/")[2], entry["version"])
                  for path, entry in lock.items() if path and not entry.get("dev"))


def expected():
    """(where from, name, version) of every component; system packages have no version."""
    return ([("Debian", name, "") for name in system_names()] +
            [("PyPI", *wheel) for wheel in wheel_names()] +
            [("crates.io", *crate) for crate in crate_names()] +
            [("npm", *package) for package in npm_names()] +
            [("GitHub or PyPI", *model) for model in MODELS] +
            [("GitHub", *protocol) for protocol in PROTOCOLS])


def alternatives(licence):
    """The ways to fulfil an expression of SPDX, each a set; AND binds tighter than OR."""
    plain = licence.replace("/", " OR ")
    group = re.fullmatch(r"\((.*)\) AND (.*)", plain)  # "(A OR B) AND C"
    if group:
        return [left | right for left in alternatives(group[1]) for right in alternatives(group[2])]
    return [set(re.split(r"\s+AND\s+", option.strip(" ()")))
            for option in re.split(r"\s+OR\s+", plain)]


def is_allowed(licence):
    return any(option <= ALLOWED for option in alternatives(licence))


def text_in(folder):
    found = sorted(path.name for path in folder.iterdir()
                   if re.match(r"(?i)(un)?licen[cs]e|copying", path.name))
    return ", ".join(found)


def system_rows():
    for name in system_names():
        licence, how = SYSTEM[name]
        yield "Debian", name, "", licence, how, f"/usr/share/doc/{name}/copyright"


def wheel_rows():
    for name, version in wheel_names():
        found = importlib.metadata.distribution(name)
        if found.version != version:
            sys.exit(f"third_party: {name} {found.version} is installed, expected {version}")
        classifiers = found.metadata.get_all("Classifier") or []
        licence = CORRECTED.get(name) or found.metadata.get("License-Expression")
        if not licence and "License :: OSI Approved :: BSD License" in classifiers:
            licence = "BSD-3-Clause"
        texts = [str(path) for path in found.files or []
                 if re.match(r"(?i)licen[cs]e|copying", path.name)]
        how = "Python extension" if name == "nanobind" else "linked or headers"
        if name in HEADERS:
            texts.append(f"include/{HEADERS[name]}")
        text = f"in the wheel: {texts[0]}" if texts else SPDX_TEXT
        yield "PyPI", name, version, licence or "unknown", how, text


def cargos():
    """Each cargo in PATH, then Debian's: one may be a proxy without a toolchain, or too old."""
    folders = [*os.environ["PATH"].split(os.pathsep), "/usr/bin"]
    return [path for path in dict.fromkeys(os.path.join(folder, "cargo") for folder in folders)
            if os.access(path, os.X_OK)]


def crate_packages():
    """What cargo says of each crate of others."""
    said = []
    for cargo in cargos():
        done = subprocess.run(
            [cargo, "metadata", "--format-version", "1", "--offline", "--locked", "--manifest-path",
             RUST / "Cargo.toml"], capture_output=True, text=True,
            env=os.environ | {"RUSTC": os.path.join(os.path.dirname(cargo), "rustc")})
        if done.returncode == 0:
            packages = [package for package in json.loads(done.stdout)["packages"] if package["source"]]
            return sorted(packages, key=lambda package: (package["name"], package["version"]))
        said.append(f"{cargo}: {done.stderr.strip().partition(chr(10))[0]}")
    sys.exit("\n".join(["third_party: no cargo that has the crates of rust/Cargo.lock", *said]))


def crate_rows():
    for package in crate_packages():
        folder = pathlib.Path(package["manifest_path"]).parent
        is_macro = any("proc-macro" in target["kind"] for target in package["targets"])
        yield ("crates.io", package["name"], package["version"], package["license"],
               "while compiling" if is_macro else "linked, as far as used",
               "in the crate: " + text_in(folder) if text_in(folder)
               else SPDX_TEXT)


def npm_rows():
    lock = json.loads((ROOT / "viewer/package-lock.json").read_text())["packages"]
    for name, version in npm_names():
        folder = ROOT / "viewer/node_modules" / name
        yield ("npm", name, version, lock[f"node_modules/{name}"]["license"], "in the page's bundle",
               "in the package: " + text_in(folder) if text_in(folder) else SPDX_TEXT)


def model_rows():
    for (name, version), (licence, arms) in MODELS.items():
        yield ("GitHub or PyPI", name, version, licence, f"numbers in URDFs: {arms}",
               "models/arms/LICENSES.md")


def protocol_rows():
    for (name, version), (licence, what) in PROTOCOLS.items():
        yield "GitHub", name, version, licence, what, SPDX_TEXT


def write():
    rows = [*system_rows(), *wheel_rows(), *crate_rows(), *npm_rows(), *model_rows(),
            *protocol_rows()]
    lines = [
        "# Third parties", "",
        "<!-- Generated by tools/third_party.py: run it after a change of dependencies. -->", "",
        "What the program, its page, its Python package and its models are made of besides our own, with",
        "licences as SPDX names them. What only builds, tests or draws figures is not listed: nothing",
        "of it is given away. Debian's packages have the version of the system.", "",
        "| from | component | version | licence | how | text |", "| --- | --- | --- | --- | --- | --- |",
    ]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    PAGE.write_text("\n".join(lines) + "\n")


MIT = """Permission is hereby granted, free of charge, to any person obtaining a copy of this software and
associated documentation files (the "Software"), to deal in the Software without restriction,
including without limitation the rights to use, copy, modify, merge, publish, distribute, sublicense,
and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do so,
subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or substantial
portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT
LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN
NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY,
WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE
SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE."""


def standard_text(name, licence, authors=""):
    """The text of a licence of which the component has no copy of its own."""
    ids = set().union(*alternatives(licence))
    holders = f"Copyright (c) {authors or 'the authors of ' + name}\n\n"
    if "MIT" in ids:
        return holders + MIT
    for known in ("Apache-2.0", "MPL-2.0"):
        if known in ids:
            return holders + pathlib.Path("/usr/share/common-licenses", known).read_text()
    sys.exit(f"third_party: {name}: no text of its licence {licence}")


def first_comment(header):
    """What stands in the first comment of a C++ header."""
    comment = re.search(r"/\*+(.*?)\*+/", header.read_text(), re.DOTALL)[1]
    return "\n".join(re.sub(r"^ ?\*", "", line) for line in comment.splitlines())


def system_text(name, licence):
    found = pathlib.Path("/usr/share/doc", name, "copyright")
    return found.read_text(errors="replace") if found.exists() else standard_text(name, licence)


def wheel_text(name, licence):
    found = importlib.metadata.distribution(name)
    for path in found.files or []:
        if re.match(r"(?i)licen[cs]e|copying", path.name):
            return pathlib.Path(found.locate_file(path)).read_text()
    if name in HEADERS:
        return first_comment(pathlib.Path(found.locate_file("cmeel.prefix/include")) / HEADERS[name])
    return standard_text(name, licence)


def folder_text(folder, name, licence, authors=""):
    """The licences in the folder of a crate or npm package; a licence to choose from is chosen."""
    names = [path for path in text_in(folder).split(", ") if path and (folder / path).is_file()]
    mit = [path for path in names if "mit" in path.lower()]
    if not names:
        return standard_text(name, licence, authors)
    return "\n\n".join((folder / path).read_text(errors="replace") for path in (mit or names))


def write_texts(file):
    """Our licence and those of all that is in a package, each text once."""
    crates = {(package["name"], package["version"]):
              (pathlib.Path(package["manifest_path"]).parent, ", ".join(package["authors"]))
              for package in crate_packages()}
    texts = {}  # by text: the components that have it
    rows = [*system_rows(), *wheel_rows(), *crate_rows(), *npm_rows(), *protocol_rows()]
    for source, name, version, licence, how, _ in rows:
        if (source == "Debian" and name in UNPACKED | {"g++", "libc6"} or how == "while compiling" or
                re.match(r"windows|winapi", name) or source == "npm" and not (ROOT / "viewer/dist").exists()):
            continue  # not in it
        if source == "Debian":
            text = system_text(name, licence)
        elif source == "PyPI":
            text = wheel_text(name, licence)
        elif source == "crates.io":
            text = folder_text(crates[name, version][0], name, licence, crates[name, version][1])
        elif source == "npm":
            text = folder_text(ROOT / "viewer/node_modules" / name, name, licence)
        else:
            text = standard_text(name, licence)
        lines = [line.rstrip() for line in text.strip("\n").splitlines()]
        texts.setdefault("\n".join(lines), []).append(f"{name} {version}".strip() + f" ({licence})")
    line = "=" * 100
    parts = ["HapticGiant\n\n" + (ROOT / "LICENSE").read_text() +
             "\nIt is made of the components below, THIRD_PARTY.md, and of models with licences of their own,"
             "\nmodels/arms/LICENSES.md."]
    parts += ["\n".join(sorted(names)) + "\n\n" + text for text, names in texts.items()]
    file.write_text(f"\n\n{line}\n".join(parts) + "\n")


def unpinned():
    """What a script of ours would install as it comes: wheels without a version or a hash, and packages of
    the page that run a script of theirs."""
    found = []
    for file in sorted((ROOT / "tools").glob("requirements*.txt")):
        text = file.read_text().replace("\\\n", " ")
        for line in text.splitlines():
            if line and not line.startswith("#") and not re.match(r"[\w.-]+(\[\w+\])?==.* --hash=sha256:", line):
                found.append(f"tools/{file.name}: {line.split()[0]} has no version or no hash")
    if "ignore-scripts=true" not in (ROOT / "viewer/.npmrc").read_text().split():
        found.append("viewer/.npmrc: npm runs the install scripts of packages: needs ignore-scripts=true")
    return found


def faults():
    rows = [tuple(cell.strip() for cell in line.strip("|\n").split("|"))
            for line in PAGE.read_text().splitlines() if line.startswith("| ")][2:]
    listed = {row[:3] for row in rows}
    wanted = set(expected())
    found = [f"{' '.join(component).strip()}: has no entry in THIRD_PARTY.md, run tools/third_party.py"
             for component in sorted(wanted - listed)]
    found += [f"{' '.join(component).strip()}: is in THIRD_PARTY.md but no longer used"
              for component in sorted(listed - wanted)]
    found += [f"{row[1]}: licence '{row[3]}' is not among those allowed" for row in rows
              if not is_allowed(row[3])]
    found += unpinned()
    return found


def audit():
    """What advisory databases say; False after an advisory."""
    is_fine = True
    tools = [("cargo audit", ["cargo", "audit"], RUST, "cargo-audit"),
             ("npm audit", ["npm", "audit", "--omit=dev"], ROOT / "viewer", "npm")]
    for name, command, folder, program in tools:
        if shutil.which(program) is None:
            print(f"{name}: not installed, not checked")
            continue
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        answer = done.stdout + done.stderr
        if re.search(r"(?i)vulnerabilit(y|ies) found|severity:|\d+ (low|moderate|high|critical)",
                     answer) and "found 0 vulnerabilities" not in answer:
            print(f"{name}:\n{answer}")
            is_fine = False
        else:
            print(f"{name}: {'nothing known' if done.returncode == 0 else 'no answer'}")
    return is_fine


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--audit", action="store_true")
    parser.add_argument("--texts", type=pathlib.Path, metavar="FILE")
    arguments = parser.parse_args()
    if arguments.texts:
        write_texts(arguments.texts)
        return
    if arguments.audit:
        sys.exit(0 if audit() else 1)
    if not arguments.check:
        write()
    found = faults()
    for fault in found:
        print(f"third_party: {fault}")
    if not found:
        print(f"third_party: {len(expected())} components, licences allowed")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
