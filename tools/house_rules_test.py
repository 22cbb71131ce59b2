"""The rules of the house, each with text that breaks it and text that keeps it.

Usage: house_rules_test.py   (from anywhere)
"""

import unittest

import function_lengths
import house_rules

LONG = "\n".join(["  x();"] * 59)  # with its first and last line a function has 61


def sizes(rule, name, text):
    """where -> size of the findings of one rule about a file."""
    return {finding.where: finding.size for finding in rule(name, text)}


class FunctionLength(unittest.TestCase):
    def test_a_function_may_have_60_lines(self):
        for name, head, tail in (("a.cpp", "int f() {\n", "\n}\n"),
                                 ("a.rs", "pub(crate) fn f<'a>(text: &'a str) -> [u8; 4] {\n", "\n}\n"),
                                 ("a.ts", "export function f(a: string): number {\n", "\n}\n")):
            self.assertEqual(sizes(house_rules.long_functions, name, head + LONG + tail), {f"{name}:f": 61})
            self.assertEqual(sizes(house_rules.long_functions, name, head + LONG[7:] + tail), {})
        self.assertEqual(sizes(house_rules.long_functions, "a.py", f"def f():\n{LONG}\n  x();\n"),
                         {"a.py:f": 61})
        self.assertEqual(sizes(house_rules.long_functions, "a.py", f"def f():\n{LONG}\n"), {})

    def test_functions_of_cpp_are_found_by_their_braces(self):
        text = """
#define SET(x) do { x = 1; } while (0)
namespace a {
template <typename T = int, typename U = std::vector<T>>
class alignas(64) A : public B {
 public:
  A(int a) : a_{a}, b_(a) { f(); }
  bool operator==(const A& other) const = default;
  bool operator<(const A& other) const {
    return "}{" < R"x(}})x" && '{' < 1'000;  // }}}
  }
 private:
  int a_{1};
};
constexpr std::array kTable = {Row{1, f(2)}, Row{2, f(3)}};
auto g(int x, Options options = {}) -> decltype(x) try {
  if (x) {
    return [&] { return 1; }();
  }
} catch (...) {
}
void B::h() const noexcept override
{
}
}  // namespace a
"""
        self.assertEqual(function_lengths.cpp_functions(text),
                         [("A", 7, 1), ("operator<", 9, 3), ("g", 16, 5), ("B::h", 22, 3)])

    def test_functions_of_typescript_are_found_by_their_indents(self):
        text = """export class Panel {
  constructor(
    private readonly a: number,
  ) {
    if (a) {
      this.b();
    }
  }

  private b(): void {}
  async c(): Promise<void> {
    d.map((x) => {
      return x;
    });
  }
}
const e = (x: number) => {
  f();
};
"""
        found = function_lengths.typescript_functions(text)
        self.assertEqual([f for f in found if f[0] in ("constructor", "c", "e")],
                         [("constructor", 2, 7), ("c", 11, 5), ("e", 17, 3)])
        self.assertNotIn("if", [name for name, _, _ in found])

    def test_functions_of_rust_are_found_by_their_braces(self):
        text = """
trait Part {
    fn without_body(&self) -> [u8; 2];
}
impl<'a> Part for A<'a> {
    #[inline]
    pub async unsafe fn f<const N: usize>(
        &'a self, of: [u8; 3],
    ) -> Option<[u8; 2]>
    where
        Self: Sized,
    {
        let t = ("}{", r#"}"}"#, b'}', '\\'', '\\u{7d}'); // }}
        /* fn no() { */
        fn inner() {}
        of.map(|x| { x });
    }
}
extern "C" {
    fn lseek(file: i32) -> i64;
}
pub extern "C" fn g() {
}
"""
        self.assertEqual(function_lengths.rust_functions(text), [("f", 7, 11), ("inner", 15, 1), ("g", 22, 2)])

    def test_functions_inside_others_count_for_themselves_in_python(self):
        text = "class A:\n    def f(self):\n        if x:\n            def g():\n                pass\n"
        self.assertEqual(sorted(function_lengths.python_functions(text)), [("f", 2, 4), ("g", 4, 2)])


class Files(unittest.TestCase):
    def test_a_header_may_have_150_lines(self):
        self.assertEqual(sizes(house_rules.long_header, "a.h", "\n" * 151), {"a.h": 151})
        self.assertEqual(sizes(house_rules.long_header, "a.h", "\n" * 150), {})
        self.assertEqual(sizes(house_rules.long_header, "a.cpp", "\n" * 151), {})

    def test_the_changelog_may_have_250_lines(self):
        self.assertEqual(sizes(house_rules.long_changelog, "CHANGELOG.md", "\n" * 251), {"CHANGELOG.md": 251})
        self.assertEqual(sizes(house_rules.long_changelog, "CHANGELOG.md", "\n" * 250), {})
        self.assertEqual(sizes(house_rules.long_changelog, "a.py", "\n" * 251), {})

    def test_a_file_is_not_empty(self):
        self.assertEqual(sizes(house_rules.empty_file, "a.h", "\n"), {"a.h": 1})
        self.assertEqual(sizes(house_rules.empty_file, "a.h", "#pragma once\n"), {})
        self.assertEqual(sizes(house_rules.empty_file, "a/__init__.py", ""), {})

    def test_random_numbers_do_not_come_from_the_standard_library(self):
        text = "std::mt19937 random(1);\nstd::normal_distribution<double> normal;\n"
        self.assertEqual(sizes(house_rules.random_numbers, "hg/a.cpp", text), {"hg/a.cpp": 2})
        self.assertEqual(sizes(house_rules.random_numbers, "hg/test/a.cpp", text), {})
        self.assertEqual(sizes(house_rules.random_numbers, "hg/a.cpp", "Random random(1);"), {})


class Words(unittest.TestCase):
    def test_household_words_are_found_in_comments_names_and_messages(self):
        for text in ("// is told", "Nobody", "told_at()", "isTold", "told()", "trouble_of(x)", "it goes\n  /// on",
                     "goes_on_", "by itself", '"tells"', "# begins anew", "somebody's"):
            self.assertEqual(sizes(house_rules.household_words, "a.h", text), {"a.h": 1}, text)
        for text in ("reported", "satellite", "stold", "renewed", "goes once", "intelligible", "kTolde", "stream.tell()"):
            self.assertEqual(sizes(house_rules.household_words, "a.h", text), {}, text)

    def test_each_word_is_counted(self):
        self.assertEqual(sizes(house_rules.household_words, "a.md", "told, told\nand told"), {"a.md": 3})


class PublicHeaders(unittest.TestCase):
    def findings(self, headers, **texts):
        texts = {f"hg/{name}.h": text for name, text in texts.items()}
        texts[house_rules.PUBLIC_HEADERS] = "# list\n" + "".join(f"{header}\n" for header in headers)
        return [line for finding in house_rules.public_headers(texts) for line in finding.lines]

    def test_a_public_header_includes_public_ones_only(self):
        texts = {"a": '#include <vector>\n#include "hg/b.h"\n', "b": "x\n"}
        self.assertEqual(self.findings(["hg/a.h", "hg/b.h"], **texts), [])
        found, = self.findings(["hg/a.h"], **texts)
        self.assertRegex(found, "hg/a.h:2: a public header includes hg/b.h")

    def test_the_list_names_headers_that_are_there_once(self):
        found, = self.findings(["hg/c.h"], a="x")
        self.assertRegex(found, "hg/c.h, expected a header")
        found, = self.findings(["hg/a.h", "hg/a.h"], a="x")
        self.assertRegex(found, "hg/a.h stands there twice")

    def test_the_list_has_at_most_80_headers(self):
        texts = {f"h{i}": "x" for i in range(81)}
        found, = self.findings([f"hg/{name}.h" for name in texts], **texts)
        self.assertRegex(found, "has 81 headers, expected at most 80")


class Exceptions(unittest.TestCase):
    TEXT = "# why\nheader  200  a.h  one table\nwords  3  b.md  is being rewritten\n"

    def judge(self, **sizes_of):
        names = {"a": ("header", "a.h"), "b": ("words", "b.md")}
        findings = [house_rules.Finding(*names[key], size, [f"line of {key}"]) for key, size in sizes_of.items()]
        return house_rules.judge(findings, house_rules.read_exceptions(self.TEXT)), findings

    def test_the_size_of_an_exception_is_the_present_one(self):
        self.assertEqual(self.judge(a=200, b=3)[0], [])
        self.assertEqual(self.judge(a=201, b=3)[0][0], "line of a")
        self.assertRegex(self.judge(a=201, b=3)[0][1], "header a.h has grown from 200 to 201")
        self.assertRegex(self.judge(a=199, b=3)[0][0], "header a.h is down from 200 to 199")

    def test_an_exception_that_is_not_needed_is_a_fault(self):
        self.assertRegex(self.judge(a=200)[0][0], "words b.md is no longer needed")

    def test_a_finding_without_exception_is_a_fault(self):
        self.assertEqual(house_rules.judge([house_rules.Finding("empty", "c", 1, ["line of c"])], {}),
                         ["line of c"])

    def test_update_writes_smaller_sizes_only(self):
        _, findings = self.judge(a=180)
        self.assertEqual(house_rules.updated(self.TEXT, findings), "# why\nheader  180  a.h  one table\n")
        _, findings = self.judge(a=300, b=3)
        self.assertEqual(house_rules.updated(self.TEXT, findings), self.TEXT)


if __name__ == "__main__":
    unittest.main()
