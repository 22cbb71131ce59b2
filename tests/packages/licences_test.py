"""`make wheel` and `make deb` work after `make demo` alone: the licences that go into a package are those
of what set-up installs for the program, not of what only the tests need.
"""

import pathlib
import re
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import third_party  # noqa: E402


def only_for_tests():
    """System packages that tools/setup.sh installs for the tests and for nothing else."""
    setup = (ROOT / "tools/setup.sh").read_text()
    return set(re.findall(r'\[ "\$purpose" != test \] \|\| need (\S+)', setup))


class Licences(unittest.TestCase):
    def test_packages_need_no_text_of_what_only_tests_install(self):
        self.assertIn("libpagmo-dev", only_for_tests())
        asked = []
        system_text = third_party.system_text
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(
                third_party, "system_text",
                lambda name, licence: asked.append(name) or system_text(name, licence)):
            third_party.write_texts(pathlib.Path(folder) / "copyright")
        self.assertIn("libsodium-dev", asked)
        self.assertFalse(only_for_tests() & set(asked))


if __name__ == "__main__":
    unittest.main()
