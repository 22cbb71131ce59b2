"""Program of the reports, which the commands of `hapticgiant` become once they have measured.

Standard input has one JSON document, {"version": of the program, "reports": [REPORT...]}. A REPORT has
  results    what was measured; its "kind" names the writer of the report
  folder     of all files of the report; null: none is kept
  docs       folder of documentation whose page of this report is refreshed; null: none
  files      files of the report by their names, and where each is written
  last_line  what is printed at the end
  kept       what has the data, in a line; printed where the report cannot be written
  exit_code  of the measurements
Exit codes: the worst of these and of the reports (0 as expected, 1 not, 2 not usable, 3 a fault), 4 a file or
standard output could not be written; with --check 69: a library is missing.
"""

import argparse
import contextlib
import importlib
import importlib.util
import io
import json
import os
import pathlib
import re
import signal
import sys
import tempfile
import types

NOT_WRITTEN = 4
MISSING = 69
# the module that reports on results of this kind; others have the name of their kind
MODULES = {"goals": "haptify", "contact": "series", "free-space": "series", "impedance": "series",
           "inertial": "series", "seeds": "series", "stability-map": "series", "cartesian": "experiments",
           "excavator": "experiments", "door": "experiments", "path": "experiments", "any": "recordings",
           "compare": "recordings"}
# control characters, directions of writing, tags, and what is no character (hg/core/visible.cpp)
HIDDEN = re.compile("[\\x00-\\x08\\x0b-\\x1f\\x7f-\\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069"
                    "\ud800-\udfff\ufeff\ufff9-\ufffb\U000e0000-\U000e007f]")


def visible(text):
    """`text` without what a terminal obeys or hides: its bytes are shown as \\xNN."""
    return HIDDEN.sub(lambda found: "".join(f"\\x{byte:02x}"
                                            for byte in found[0].encode("utf-8", "surrogatepass")), text)


def complain(text):
    """Writes to standard error, at once: that it cannot be written is no error of its own, neither now nor at the end."""
    with contextlib.suppress(OSError):
        os.write(sys.stderr.fileno(), text.encode())


class Output:
    """Standard output, whose errors are an exit code; that its reader has gone is none."""

    def __init__(self):
        self.error = None

    def show(self, text):
        rest = visible(text).encode()
        try:
            while rest and not self.error:
                rest = rest[os.write(sys.stdout.fileno(), rest):]
        except BrokenPipeError:
            pass
        except OSError as error:
            self.error = error

    def write_file(self, file, text):
        """Replaces `file` as a whole; where it is standard output, after what was printed."""
        with contextlib.suppress(OSError):
            if os.path.samestat(os.stat(file), os.fstat(sys.stdout.fileno())):
                return self.show(text)
        is_replaced = not os.path.lexists(file) or (os.path.isfile(file) and not os.path.islink(file))
        written = f"{file}.partial" if is_replaced else file
        try:
            pathlib.Path(written).write_text(text, encoding="utf-8")
            if is_replaced:
                os.replace(written, file)
        except OSError:
            if is_replaced:
                pathlib.Path(written).unlink(missing_ok=True)
            raise
        return None

    def code(self, code):
        """`code`, or that output could not be written."""
        if not self.error:
            return code
        complain(f"standard output could not be written: {self.error.strerror}\n")
        return code or NOT_WRITTEN


def make(report, output):
    """Writes and prints one report; returns its exit code."""
    results = report["results"]
    module = importlib.import_module(f"hapticgiant.report.{MODULES.get(results['kind'], results['kind'])}")
    docs = report["docs"] and pathlib.Path(report["docs"])
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(report["folder"] or stack.enter_context(tempfile.TemporaryDirectory()))
        with (contextlib.redirect_stdout(io.StringIO()) as text,
              contextlib.redirect_stderr(io.StringIO()) as complaints):
            verdict = module.write(results, folder, docs=docs) or 0
        output.show(text.getvalue() + report["last_line"])
        complain(visible(complaints.getvalue()))
        for name, file in report["files"].items():
            output.write_file(file, (folder / name).read_text(encoding="utf-8"))
    return max(verdict, report["exit_code"])


def make_all(document):
    """Writes and prints all reports; returns the worst of their exit codes."""
    output, code = Output(), 0
    pages = importlib.import_module("hapticgiant.report.pages")
    pages.version = document["version"]
    for report in document["reports"]:
        try:
            code = max(code, make(report, output))
        except OSError as error:
            complain(visible(f"{error.filename or 'report'}: {error.strerror}\n{report['kept']}"))
            code = NOT_WRITTEN
    return output.code(code)


def main():
    parser = argparse.ArgumentParser(prog="hapticgiant.report")
    parser.add_argument("--check", action="store_true", help="only check whether it would work")
    parser.add_argument("--export", choices=("parquet", "hdf5"),
                        help="write the table that standard input has; see export.py")
    arguments = parser.parse_args()
    if not __package__:
        # Run as a folder: the package's own __init__ would need its compiled part.
        package = types.ModuleType("hapticgiant")
        package.__path__ = [str(pathlib.Path(__file__).resolve().parents[1])]
        sys.modules["hapticgiant"] = package
    if arguments.export:
        if importlib.util.find_spec("numpy") is None:
            print("numpy", end="")
            return MISSING
        export = importlib.import_module("hapticgiant.report.export")
        return export.main(arguments.export, arguments.check)
    needed = ("numpy", "scipy", "matplotlib", "jinja2")
    if not all(importlib.util.find_spec(name) for name in needed):
        return MISSING
    if arguments.check:
        return 0
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return make_all(json.load(sys.stdin.buffer))


if __name__ == "__main__":
    sys.exit(main())
