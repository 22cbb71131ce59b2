"""What the linker and the compiler must have put into a program or library.

Usage: hardening_test.py [--unoptimised] FILE...   reads it with readelf; exit code 1 where it is missing
"""

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


def main():
    files = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    if not files:
        sys.exit(__doc__)
    faults = [f"{file}: {what} is missing" for file in files
              for what in missing_in(file, "--unoptimised" not in sys.argv)]
    print("\n".join(faults) or f"{len(files)} hardened")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
