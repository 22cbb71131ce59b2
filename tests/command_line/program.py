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


def install(prefix):
    """The program in the prefix, with a page that is only a word and without Python code."""
    (prefix / "bin").mkdir(parents=True)
    program = prefix / "bin" / PROGRAM.name
    try:
        os.link(PROGRAM, program)
    except OSError:  # another file system
        shutil.copy2(PROGRAM, program)
    page = prefix / "share" / "hapticgiant" / "viewer" / "dist"
    page.mkdir(parents=True)
    (page / "index.html").write_text("the page")
    return program


class TemporaryFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
