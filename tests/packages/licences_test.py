"""`make wheel` and `make deb` work after `make demo` alone: the licences that go into a package are those
of what set-up installs for the program, not of what only the tests need.
"""

import pathlib
import re
import sys
import tempfile
import tomllib
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import third_party  # noqa: E402


def only_for_tests():
    """System packages that tools/setup.sh installs for the tests and for nothing else."""
    setup = (ROOT / "tools/setup.sh").read_text()
    return set(re.findall(r'\[ "\$purpose" != test \] \|\| need (\S+)', setup))

LEAST = {"aiohttp": "3.14.3", "jinja2": "3.1.6", "pyarrow": "14.0.1", "pyyaml": "5.4"}
"""Versions before have known holes that an attacker reaches here: CVE-2026-69243, CVE-2025-27516, CVE-2023-47248,
CVE-2020-14343."""


def number(version):
    return tuple(map(int, version.split(".")))


class Versions(unittest.TestCase):
    def test_none_that_may_be_installed_has_a_known_hole(self):
        bounds = re.findall(r'"([\w-]+)>=([0-9.]+)"', (ROOT / "pyproject.toml").read_text())
        self.assertLessEqual(set(LEAST), {name for name, _ in bounds})
        for name, version in bounds:
            self.assertGreaterEqual(number(version), number(LEAST.get(name, "0")), name)
        least = dict(bounds)
        for file in (ROOT / "tools").glob("requirements*.txt"):
            for name, version in re.findall(r"(?m)^([\w-]+)==([0-9.]+)", file.read_text()):
                self.assertGreaterEqual(number(version.strip(".")), number(least.get(name, "0")), (file.name, name))


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


class Extras(unittest.TestCase):
    def test_every_extra_that_is_named_exists(self):
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
        extras = project["optional-dependencies"]
        named = {}
        for folder in ("apps", "hg", "python", "docs/start", "pyproject.toml"):
            for file in [ROOT / folder] if (ROOT / folder).is_file() else (ROOT / folder).rglob("*.*"):
                if file.suffix in (".cpp", ".h", ".py", ".md", ".toml"):
                    for words in re.findall(r"hapticgiant(?:-[\w.-]*whl)?\[([a-z,]+)\]", file.read_text()):
                        named |= dict.fromkeys(words.split(","), file)
        self.assertLessEqual({"arrays", "report", "sweep", "study", "export"}, set(named))
        for name, file in named.items():
            self.assertIn(name, extras, file)

    def test_a_run_needs_no_package_but_that_of_the_extensions(self):
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
        self.assertEqual([re.match(r"[\w-]+", needed)[0] for needed in project["dependencies"]], ["nanobind-backend"])


if __name__ == "__main__":
    unittest.main()
