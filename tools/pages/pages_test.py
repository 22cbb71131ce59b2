"""Text of generated pages, from facts that are not the code's.

Usage: pages_test.py   (from anywhere)
"""

import pathlib
import re
import sys
import tempfile
import types
import unittest

import pages

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import docs_api  # noqa: E402
import docs_files  # noqa: E402

RULE = {"number": 107, "name": "jump", "meaning": "It jumped.", "threshold": "monitor.jump_factor, 3 in a row",
        "warn_from": 1.0, "samples": 1, "seconds": 0.0, "reaction": "STO", "release": "it is back"}


class Pages(unittest.TestCase):
    def test_only_the_text_between_the_marks_is_replaced(self):
        page = "a\n<!-- rules -->\nold\n<!-- end -->\nb <!-- end -->\n"
        self.assertEqual(pages.replace_marked(page, "rules", "new\n"),
                         "a\n<!-- rules -->\n\nnew\n\n<!-- end -->\nb <!-- end -->\n")
        for wrong in ("<!-- rules -->\n", "<!-- end -->", "<!-- stops -->\n<!-- end -->"):
            with self.assertRaises(SystemExit):
                pages.replace_marked(wrong, "rules", "")

    def test_a_rule_has_keys_as_code_and_its_time(self):
        self.assertEqual(pages.rule_rows([RULE])[1],
                         [107, "jump", "`monitor.jump_factor`, 3 in a row", "-", "at once", "STO", "It jumped.",
                          "it is back"])
        slow = {**RULE, "warn_from": 0.8, "samples": 4, "seconds": 0.02}
        self.assertEqual(pages.rule_rows([slow])[1][3:6], ["80 %", "20 ms", "STO"])
        self.assertEqual(pages.rule_rows([{**slow, "seconds": 0.0}])[1][4], "4 samples")

    def test_a_threshold_that_is_no_key_ends_the_program(self):
        pages.check_thresholds([RULE], [["`monitor.jump_factor`", "3", "1 .. 9", "factor"]])
        with self.assertRaisesRegex(SystemExit, "jump: no key monitor.jump_factor"):
            pages.check_thresholds([RULE], [["`monitor.other_factor`", "3", "1 .. 9", "factor"]])

    def test_transitions_name_the_next_state(self):
        rows = pages.transition_rows({"states": ["off", "ready"],
                                      "transitions": [["good sample", "ready", "-"],
                                                      ["request: run", "refused", "off"]]})
        self.assertEqual(pages.as_csv(rows), "event,off,ready\ngood sample,**ready**,-\n"
                                             "request: run,refused,**off**\n")

    def test_fields_of_all_messages_stand_in_one_table(self):
        rows = pages.datagram_rows([{"title": "Ready", "type": 3, "bytes": 36,
                                     "rows": [[32, "u32", "checksum", ""]]}])
        self.assertEqual(rows[1:], [["ready", 32, "u32", "checksum", ""]])

    def test_a_message_is_an_interface(self):
        text = pages.typescript([{"name": "Hand", "note": "where it is",
                                  "fields": [["p", "Vec3", "in m"], ["is_held", "boolean", ""]]}])
        self.assertTrue(text.endswith("\n// where it is\nexport interface Hand {\n  p: Vec3; // in m\n"
                                      "  is_held: boolean;\n}\n"))


class Site(unittest.TestCase):
    def test_a_line_that_is_a_link_to_a_table_is_followed_by_it(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "t.csv").write_text('a,b\n1,"x | y, z"\n')
            page = types.SimpleNamespace(file=types.SimpleNamespace(abs_src_path=str(folder / "page.md")))
            text = docs_files.on_page_markdown("See [it](t.csv).\n\n[Table: t.csv](t.csv)\n", page)
        self.assertEqual(text, "See [it](t.csv).\n\n[Table: t.csv](t.csv)\n\n"
                               "| a | b |\n| --- | --- |\n| 1 | x \\| y, z |\n\n")

    def test_headers_of_the_api_pages_are_those_that_are_installed(self):
        shown = [header for _, text in docs_api.cpp_pages().values()
                 for header in re.findall(r"^## (\S+)$", text, re.MULTILINE)]
        installed = (ROOT / "cmake" / "public_headers.txt").read_text()
        self.assertEqual(sorted(shown), sorted(re.findall(r"^hg/.*", installed, re.MULTILINE)))


if __name__ == "__main__":
    unittest.main()
