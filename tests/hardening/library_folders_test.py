"""Libraries that are packed look for others only from where they are.

Usage: library_folders_test.py   (from the repository root)
"""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from hardening_test import open_folders, readelf

COMPILER = shutil.which("cc")


def run_path(library):
    found = re.search(r"\((?:RUNPATH|RPATH)\).*\[(.*)\]", readelf("--dynamic", library))
    return found and found[1]


@unittest.skipUnless(COMPILER, "needs a compiler")
class LibraryFolders(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def library(self, name, path, tag="--enable-new-dtags"):
        file = self.folder / f"{name}.so"
        paths = [f"-Wl,-rpath,{path}"] if path is not None else []
        subprocess.run([COMPILER, "-shared", "-x", "c", "/dev/null", "-o", file, f"-Wl,{tag}", *paths], check=True)
        return str(file)

    def test_only_entries_from_origin_are_kept(self):
        for number, (path, tag, kept) in enumerate((
                ("$ORIGIN:lib", "--enable-new-dtags", "$ORIGIN"),
                ("/tmp/build/lib:$ORIGIN/../lib", "--enable-new-dtags", "$ORIGIN/../lib"),
                ("$ORIGIN::$ORIGIN/a", "--enable-new-dtags", "$ORIGIN:$ORIGIN/a"),
                ("$ORIGINAL", "--enable-new-dtags", None),
                ("/tmp/build/lib", "--disable-new-dtags", None),
                ("$ORIGIN", "--enable-new-dtags", "$ORIGIN"),
                (None, "--enable-new-dtags", None))):
            library = self.library(f"lib{number}", path, tag)
            with self.subTest(path=path):
                self.assertEqual(bool(open_folders(library)), path != kept)
                self.assertEqual(bool(open_folders(library, is_packed=False)),
                                 path in ("$ORIGIN:lib", "$ORIGIN::$ORIGIN/a", "$ORIGINAL"))
        subprocess.run(["cmake", "-D", f"folder={self.folder}", "-P", "cmake/library_folders.cmake"], check=True)
        self.assertEqual([run_path(self.folder / f"lib{number}.so") for number in range(7)],
                         ["$ORIGIN", "$ORIGIN/../lib", "$ORIGIN:$ORIGIN/a", None, None, "$ORIGIN", None])


if __name__ == "__main__":
    unittest.main()
