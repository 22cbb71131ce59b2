"""What the tests of the program's command line share: the program, as their first argument."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
MODELS = pathlib.Path("models").resolve()


def run(*arguments, timeout=120):
    """(exit code, standard output, standard error) of the program."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


def install_program(prefix, name=PROGRAM.name):
    """A program of the build in the prefix, and the libraries where a package has them."""
    program = prefix / "bin" / name
    program.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(PROGRAM.with_name(name), program)
    except OSError:  # another file system
        shutil.copy2(PROGRAM.with_name(name), program)
    libraries = prefix / "lib" / "hapticgiant" / "lib"
    if not libraries.exists():
        libraries.parent.mkdir(parents=True)
        root = pathlib.Path(__file__).resolve().parents[2]
        (wheels,) = root.glob(".venv/lib/python3*/site-packages/cmeel.prefix/lib")
        libraries.symlink_to(wheels)
    return program


def install(prefix):
    """The programs in the prefix, with a page that is only a word and without Python code."""
    program = install_program(prefix)
    install_program(prefix, "hapticgiant-offline")
    page = prefix / "share" / "hapticgiant" / "viewer" / "dist"
    page.mkdir(parents=True)
    (page / "index.html").write_text("the page")
    return program


class TemporaryFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
