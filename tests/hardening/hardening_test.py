"""What the linker and the compiler must have put into a program or library.

Usage: hardening_test.py [--unoptimised] [--packed] FILE|FOLDER...
reads them with readelf; exit code 1 where something is missing. Of a FOLDER all programs and libraries
are read, and only for where they look for libraries: not in the working directory, and what is packed,
each FILE and with --packed also each FOLDER, only from $ORIGIN on.
"""

import pathlib
import re
import subprocess
import sys


def readelf(option, file):
    return subprocess.run(["readelf", "--wide", option, file], check=True, capture_output=True,
                          text=True, env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"}).stdout


def missing_in(file, is_optimised):
    headers, dynamic = readelf("--program-headers", file), readelf("--dynamic", file)
    symbols = readelf("--dyn-syms", file)
    stack = re.search(r"GNU_STACK(?:\s+0x\w+){5}\s+([RWE]+)", headers)
    is_library = "SONAME" in dynamic or ".so" in file
    held = {
        "RELRO": "GNU_RELRO" in headers,
        "relocations before the start (now)": bool(re.search(r"BIND_NOW|Flags:.*\bNOW\b", dynamic)),
        "a stack that is not executable": bool(stack) and "E" not in stack[1],
        "position-independent code": "DYN" in readelf("--file-header", file)
        and (is_library or bool(re.search(r"FLAGS_1.*\bPIE\b", dynamic))),
        "no text relocations": "TEXTREL" not in dynamic,
        "stack protectors": "__stack_chk_fail" in symbols,
    }
    if is_optimised:
        held["checked calls of the C library"] = bool(re.search(r"\b__\w+_chk\b", symbols))
    return [what for what, is_held in held.items() if not is_held]


def open_folders(file, is_packed=True):
    """Entries of its RUNPATH where others may write: empty and relative ones, and, as the computer on
    which something packed runs has other folders, all that do not begin where the file is."""
    found = re.findall(r"\((?:RUNPATH|RPATH)\).*\[(.*)\]", readelf("--dynamic", file))
    fixed = r"\$ORIGIN(/|$)" if is_packed else r"/|\$ORIGIN(/|$)"
    return [entry for path in found for entry in path.split(":") if not re.match(fixed, entry)]


def linked_files(folder):
    """Programs and libraries below `folder`."""
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.is_file() and not path.is_symlink() and (".so" in path.suffixes or path.stat().st_mode & 1):
            with path.open("rb") as file:
                if file.read(4) == b"\x7fELF":
                    yield str(path)


def main():
    arguments = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    if not arguments:
        sys.exit(__doc__)
    folders = [argument for argument in arguments if pathlib.Path(argument).is_dir()]
    files = [argument for argument in arguments if argument not in folders]
    faults = [f"{file}: {what} is missing" for file in files
              for what in missing_in(file, "--unoptimised" not in sys.argv)]
    linked = {file: "--packed" in sys.argv for folder in folders for file in linked_files(folder)}
    linked.update({file: True for file in files})
    faults += [f"{file}: looks for libraries in '{entry}', where others may write"
               for file, is_packed in linked.items() for entry in open_folders(file, is_packed)]
    print("\n".join(faults) or f"{len(files)} hardened, {len(linked)} without an open RUNPATH")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
