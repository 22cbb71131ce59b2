"""Checks that every citation leads somewhere, and every link of a Markdown page as well.

A citation is a tag in brackets, with sections for the tags of the handbook: `[HANDBOOK] 1.5, 1.6`,
`[HANDBOOK] 4.1-4.4`, `[C] 3 and 4`, also "handbook 10.3" in words. A number like 1.2 behind a tag
of origin, `[A] 1.2`, is a section of the handbook, too. Tags have to stand in the tables of
docs/reference/references.md, sections as headings in docs/handbook. Relative links of Markdown
pages and of their tables in docs/*.csv need their file and, behind #, their heading; docs/NAME.md in
any text needs its page.

Exits with 1 and one line per fault: file:line: what is cited, what was expected, what is nearest.
"""

import csv
import difflib
import re
import sys

from tracked_files import NOT_TEXT, ROOT, read_texts

REFERENCES = "docs/reference/references.md"
SOURCES = "docs/reference/references_sources.csv"  # a table of that page
HANDBOOK = "docs/handbook/"
SKIPPED = ("tests/fuzz/", "viewer/package-lock.json", "tools/check_citations.py")
CODE = (".h", ".cpp", ".ts", ".rs", ".in")
PAGES = {"C": "control_notes.md", "G": "geometry.md"}  # whose headings a tag cites, with its letter

UNIT = r"(?:deg|Hz|kg|m|ms|mm|mrad|N|Nm|rad|s|%)\b"
SECTION = rf"E?\d{{1,3}}(?:\.\d{{1,2}})*(?![\w/%^*]|\.\d| {UNIT})"
SECTIONS = rf"{SECTION}(?:(?:\s?-\s?|,? (?:and|to) |, ){SECTION})*"
SPACE = r"(?:[ \t]|[ \t]*\n[ \t]*(?:///?|#|\*)?[ \t]*)"  # or a new line of a comment
CITATION = re.compile(rf"(?<![\w\])])\[(HANDBOOK|H|C|G)\](?:{SPACE}(?:sec\. |section )?({SECTIONS}))?")
IN_WORDS = re.compile(rf"(?<!e-)\b(handbook|control notes),?{SPACE}({SECTIONS})", re.I)
OF_ORIGIN = re.compile(r"\[[PKFAV]\] (\d{1,2}\.\d{1,2}(?:, \d{1,2}\.\d{1,2})*)"
                       r"(?=\s*$|[:;,)]|\.\s|\s+(?:has|throughout|asks)\b)", re.M)
SOURCE = re.compile(r"(?<![\w\])])\[(HG|[A-Z]{1,4}\d{2})\](?![\w(\[{*+?])")
NOTES = re.compile(r"(?<!\[)\b(DESIGN|CONTROL_NOTES|HANDBOOK|GEOMETRY)\b|\[DESIGN\]")
PAGE = re.compile(r"(?<![\w/.-])docs/[\w/-]+\.md\b")
LINK = re.compile(r"\]\(([^()\s]+)\)")


def headings(page):
    without_code = re.sub(r"^(```|~~~).*?^\1", "", page, flags=re.MULTILINE | re.DOTALL)
    return re.findall(r"^#{1,6} +(.+?) *$", without_code, re.MULTILINE)


def anchors(page):
    """What a link may have behind #, as GitHub makes it from headings."""
    found, times = set(), {}
    for title in headings(page):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        slug = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        found.add(f"{slug}-{times[slug]}" if slug in times else slug)
        times[slug] = times.get(slug, 0) + 1
    return found | set(re.findall(r'<a (?:id|name)="([^"]+)"', page))


def read_sections(files):
    """Tag -> numbers that it may cite: "4.5", "E8"; of [C] and [G] without their letter."""
    sections = {"HANDBOOK": set(), "C": set(), "G": set()}
    for name in files:
        if not name.startswith(HANDBOOK):
            continue
        tag = next((t for t, page in PAGES.items() if name == HANDBOOK + page), "HANDBOOK")
        letter = "E?" if tag == "HANDBOOK" else tag
        for title in headings(files[name]):
            for number in re.findall(rf"(?:^|, and )({letter}\d+(?:\.\d+)*) ", title):
                sections[tag].add(number.removeprefix(tag))
    return sections


def read_tags(page, table):
    """The tags in the first column of the tables of the page and of its CSV file."""
    cells = re.findall(r"^\| *([^|]+?) *\|", page, re.MULTILINE) + [row[0] for row in csv.reader(table.splitlines())]
    return {tag for cell in cells for tag in re.findall(r"\[([A-Z]+\d*)\]", cell)}


def single(numbers):
    """"1.5, 1.6" and "4.1-4.4" one by one."""
    words = re.findall(r"E?\d+(?:\.\d+)*|-|to", numbers)
    for i, word in enumerate(words):
        if word not in ("-", "to"):
            yield word
            continue
        chapter, dot, first = words[i - 1].rpartition(".")
        last = words[i + 1].rpartition(".")[2]
        if first.isdigit() and last.isdigit():
            yield from (f"{chapter}{dot}{n}" for n in range(int(first) + 1, int(last)))


def nearest(word, words):
    close = difflib.get_close_matches(word, sorted(words), n=1, cutoff=0.0)
    return f"nearest: {close[0] if close else 'none'}"


def nearest_section(number, known):
    """Of the same chapter, if it has any."""
    chapter = [other for other in known if other.partition(".")[0] == number.partition(".")[0]]
    return nearest(number, chapter or known)


class Checker:
    def __init__(self, files):
        self.files = files
        self.sections = read_sections(files)
        self.tags = read_tags(files[REFERENCES], files[SOURCES])
        self.faults = []
        self.citations = 0

    def fault(self, name, at, text):
        self.faults.append(f"{name}:{self.files[name].count(chr(10), 0, at) + 1}: {text}")

    def check_tag(self, name, at, tag):
        self.citations += 1
        if tag not in self.tags:
            self.fault(name, at, f"[{tag}], expected a tag of {REFERENCES}; {nearest(tag, self.tags)}")

    def check_sections(self, name, match, tag, numbers):
        known = self.sections["HANDBOOK" if tag == "H" else tag]
        for number in single(numbers or ""):
            if number not in known:
                what = re.sub(r"\s+(?:///?|#|\*)?\s*", " ", match.group(0))
                self.fault(name, match.start(), f"{what}, expected a heading {number} in {HANDBOOK}; "
                                                f"{nearest_section(number, known)}")

    def check_citations(self, name):
        text = self.files[name]
        for match in CITATION.finditer(text):
            before = text[text.rfind("\n", 0, match.start()) + 1:match.start()]
            if name.endswith(CODE) and not re.search(r'//|"|#|^\s*\*', before):
                continue  # a lambda or an index
            self.check_tag(name, match.start(), match.group(1))
            self.check_sections(name, match, match.group(1), match.group(2))
        for match in IN_WORDS.finditer(text):
            tag = "C" if match.group(1).lower() == "control notes" else "HANDBOOK"
            self.check_sections(name, match, tag, match.group(2))
        for match in OF_ORIGIN.finditer(text):
            self.check_sections(name, match, "HANDBOOK", match.group(1))
        for match in SOURCE.finditer(text):
            self.check_tag(name, match.start(), match.group(1))
        for match in NOTES.finditer(text):
            self.fault(name, match.start(), f"{match.group(0)}, expected a tag of {REFERENCES} with its "
                                            f"section; {nearest(match.group(0), self.tags)}")
        for match in PAGE.finditer(text):
            if not (ROOT / match.group(0)).is_file():
                pages = [other for other in self.files if other.endswith(".md")]
                self.fault(name, match.start(),
                           f"{match.group(0)}, expected a page; {nearest(match.group(0), pages)}")

    def check_links(self, name):
        code = re.compile(r"^(```|~~~).*?^\1|`[^`\n]*`", re.MULTILINE | re.DOTALL)
        text = code.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), self.files[name])
        for match in LINK.finditer(text):
            link = match.group(1)
            target, _, anchor = link.partition("#")
            if re.match(r"[a-z+]+:", target):
                continue  # elsewhere
            self.citations += 1
            path = ((ROOT / name).parent / target).resolve() if target else ROOT / name
            if not path.exists():
                others = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
                self.fault(name, match.start(),
                           f"link to {link}, expected a file; {nearest(path.name, others)}")
            elif anchor and path.suffix == ".md":
                known = anchors(path.read_text())
                if anchor not in known:
                    self.fault(name, match.start(),
                               f"link to {link}, expected a heading of it; {nearest(anchor, known)}")


def main():
    files = read_texts(SKIPPED, tuple(set(NOT_TEXT) - {".csv"}))
    checker = Checker({name: text for name, text in files.items()
                       if not name.endswith(".csv") or name.startswith("docs/")})
    for name in checker.files:
        checker.check_citations(name)
        if name.endswith((".md", ".csv")):
            checker.check_links(name)
    for fault in checker.faults:
        print(fault)
    print(f"check_citations: {checker.citations} citations and links, {len(checker.faults)} faults")
    return 1 if checker.faults else 0


if __name__ == "__main__":
    sys.exit(main())
