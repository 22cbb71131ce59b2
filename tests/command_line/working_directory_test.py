"""Code comes from the installation: nothing of a working directory is run or served.

Usage: working_directory_test.py PROGRAM   (from the repository root)
"""

import os
import pathlib
import re
import shutil
import subprocess
import unittest
import urllib.request

from program import MODELS, PROGRAM, TemporaryFolder, install

TRAP = "import pathlib; pathlib.Path({!r}).write_text('run')\n"


class WorkingDirectory(TemporaryFolder):
    """A folder of another user: models that may be used, and code that may not."""

    def setUp(self):
        super().setUp()
        self.sprung = self.folder / "sprung"
        self.place = self.folder / "place"
        shutil.copytree(MODELS, self.place / "models")
        code = TRAP.format(str(self.sprung))
        for file in ("python/hapticgiant/figures.py", "hapticgiant/figures.py",
                     "hapticgiant/__init__.py", "matplotlib.py", "numpy.py", "sitecustomize.py"):
            self.write(file, code)
        for program in (".venv/bin/python", "python3", "xdg-open", "npm", "node"):
            self.write(program, f"#!/bin/sh\necho run > '{self.sprung}'\n").chmod(0o755)
        self.write("viewer/dist/index.html", "a trap")

    def write(self, file, text):
        path = self.place / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def run_here(self, program, *arguments, **environment):
        done = subprocess.run(
            [program, *map(str, arguments)], cwd=self.place, capture_output=True, text=True,
            timeout=300, stdin=subprocess.DEVNULL, env={**os.environ, **environment})
        self.assertFalse(self.sprung.exists(), f"{arguments} ran code of the working directory")
        return done

    def record(self):
        done = self.run_here(PROGRAM, "run", "door", "--fast", "--no-viewer", "--duration", "2",
                             "--recordings", self.folder / "recordings")
        self.assertEqual(done.stderr, "")
        return next(file for file in (self.folder / "recordings").glob("*.mcap")
                    if not file.is_symlink())

    def test_plot_runs_the_code_of_the_program(self):
        recording = self.record()
        done = self.run_here(PROGRAM, "plot", recording, "--out", "figures")
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertTrue((self.place / "figures" / "run.json").exists())
        if pathlib.Path(".venv/bin/python").exists():
            self.assertTrue((self.place / "figures" / "figure.svg").exists(), done.stdout)

    def test_an_installed_program_takes_no_module_from_here(self):
        recording = self.record()
        program = install(self.folder / "prefix")
        done = self.run_here(program, "plot", recording, "--out", "figures")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no figures", done.stdout)

    def test_the_python_package_is_no_folder_of_another_name(self):
        """A package for pip has the program in hapticgiant/bin; sources may stand beside anything."""
        for name, is_package in (("prefix", False), ("hapticgiant", True)):
            program = install(self.folder / name)
            part = self.folder / name / "study"
            part.mkdir()
            (part / "__main__.py").write_text("")
            done = self.run_here(program, "study", "plan", HAPTICGIANT_PYTHON="/bin/echo")
            self.assertEqual(str(part) in done.stdout, is_package, done)
            self.assertEqual("-m hapticgiant.study" in done.stdout, not is_package, done)

    def test_an_interpreter_that_was_chosen_takes_none_either(self):
        own = pathlib.Path(".venv/bin/python").absolute()
        done = self.run_here(PROGRAM, "plot", self.record(), "--out", "figures",
                             HAPTICGIANT_PYTHON=str(own if own.exists() else "python3"))
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_page_is_that_of_the_program(self):
        program = install(self.folder / "prefix")
        process = subprocess.Popen(
            [program, "run", "door", "--user", "none", "--no-recording", "--duration", "60"],
            cwd=self.place, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
        try:
            while not (link := re.search(r"http://\S+", process.stdout.readline())):
                self.assertIsNone(process.poll())
            with urllib.request.urlopen(link[0].split("#")[0], timeout=60) as answer:
                self.assertEqual(answer.read().decode(), "the page")
        finally:
            process.kill()
            process.communicate()
        self.assertFalse(self.sprung.exists())


if __name__ == "__main__":
    unittest.main()
