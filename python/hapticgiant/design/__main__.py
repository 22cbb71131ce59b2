"""Command line of `hapticgiant design FILE`; docs/start/design.md.

Searches (hapticgiant-design), then checks the device, opens its door and measures how it feels, and
writes the report. Exit codes: 0 all is well, 1 the device was written, but something after it
failed, 2 bad input or a part is missing.
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import subprocess
import sys

DOOR, FEEL = "door.json", "haptify"


def parser():
    main = argparse.ArgumentParser(
        prog="hapticgiant design",
        description="Searches for a device that serves a person's arm: from requirements to a device "
                    "that runs (docs/start/design.md).")
    main.add_argument("problem", help="design problem, as models/design/haptic_giant.yaml")
    main.add_argument("-o", "--out", help="folder of the design; default: NAME.design beside the file")
    main.add_argument("--seed", type=int, help="in place of the file's; the same seed gives the same design")
    main.add_argument("--workers", type=int, default=2, help="threads; the result does not depend on them")
    main.add_argument("--quick", action="store_true", help="small populations and few poses: a look")
    main.add_argument("--no-feel", action="store_true", help="without door and Haptify table")
    return main


def program(name):
    """The program beside the one that started this."""
    own = os.environ.get("HAPTICGIANT_PROGRAM")
    if not own:
        sys.exit("design: starts as `hapticgiant design`")
    return pathlib.Path(own).parent / name


def version():
    words = subprocess.run([program("hapticgiant"), "--version"], check=False, text=True,
                           stdout=subprocess.PIPE).stdout.split()
    return words[-1] if words else ""


def search(arguments, out):
    words = [program("hapticgiant-design"), arguments.problem, "--out", out,
             "--workers", str(arguments.workers)]
    if arguments.seed is not None:
        words += ["--seed", str(arguments.seed)]
    if arguments.quick:
        words.append("--quick")
    try:
        return subprocess.run(words, check=False).returncode
    except FileNotFoundError:
        print("design: hapticgiant-design is missing; it is built where there is pagmo 2 (Debian: "
              "libpagmo-dev)", file=sys.stderr)
        return 2


def play(name, words, log, figures=None):
    """Runs `hapticgiant WORDS` with its output in a file; whether it went well. figures: the file
    in which haptify names the runs that ended early."""
    if figures:
        figures.unlink(missing_ok=True)
    with open(log, "wb") as said:
        code = subprocess.run([program("hapticgiant"), *words], check=False, stdout=said,
                              stderr=said).returncode
    is_read = figures and figures.is_file()
    stopped = json.loads(figures.read_text(encoding="utf-8"))["failures"] if is_read else []
    what = f"{len(stopped)} runs ended early" if stopped else "failed"
    print(f"{name:<11} {f'{what}, see {log}' if code else 'passed'}", flush=True)
    return code == 0


def feel(out, with_feel):
    """What was run on the device, and whether it passed."""
    device = out / "device" / "device.yaml"
    results = {"check": play("check", ["check", device], out / "check.txt")}
    if with_feel and results["check"]:
        results["door"] = play("door", ["run", "door", "--device", device, "--fast", "--no-recording",
                                        "--summary", out / DOOR], out / "door.txt")
        results["haptify"] = play("haptify", ["haptify", "--quick", "--device", device, "--out",
                                              out / FEEL], out / "haptify.txt",
                                  out / FEEL / "figures.json")
    return results


def main():
    arguments = parser().parse_args()
    problem = pathlib.Path(arguments.problem)
    out = pathlib.Path(arguments.out or problem.with_suffix(".design"))
    code = search(arguments, out)
    if code:
        return code
    results = json.loads((out / "results.json").read_text(encoding="utf-8"))
    results["version"] = version()
    results["feel"] = feel(out, not arguments.no_feel)
    (out / "results.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    report = pathlib.Path(__file__).resolve().parents[1] / "report"
    made = {"results": results, "folder": str(out.resolve()), "docs": None, "files": {}, "last_line": "",
            "kept": "", "exit_code": 0}
    document = {"version": results["version"], "reports": [made]}
    written = subprocess.run([sys.executable, "-B", report], input=json.dumps(document), text=True,
                             check=False).returncode
    if written:
        print("report      not written" + (": matplotlib or jinja2 is missing" if written == 69 else ""))
    else:
        print(f"report      {out / 'report.html'}")
    print(f"try it      hapticgiant run door --device {out / 'device' / 'device.yaml'}")
    return 0 if all(results["feel"].values()) and not written else 1


if __name__ == "__main__":
    sys.exit(main())
