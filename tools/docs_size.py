"""Counts the words of the pages in docs/: what is between spaces in *.md, code and tables included.

    docs_size.py [--pages]     --pages: every page, the longest first

Exits with 1 where all pages together have more than MOST words. Longer tables belong into a CSV file beside
their page (tools/docs_files.py draws it), which is not counted.
"""

import pathlib
import sys

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"
MOST = 95_000


def count(page):
    """Words of a page, and how many of them are in tables."""
    lines = page.read_text(encoding="utf-8").splitlines()
    return (sum(len(line.split()) for line in lines),
            sum(len(line.split()) for line in lines if line.startswith("|")))


def faults():
    words = sum(count(page)[0] for page in DOCS.rglob("*.md"))
    if words > MOST:
        yield f"docs: {words} words, expected at most {MOST}; tools/docs_size.py --pages lists the longest"


def main(has_pages):
    counts = {page: count(page) for page in DOCS.rglob("*.md")}
    if has_pages:
        for page, (words, cells) in sorted(counts.items(), key=lambda item: -item[1][0]):
            print(f"{words:6} {cells:5} in tables  {page.relative_to(DOCS)}")
    words, cells = (sum(column) for column in zip(*counts.values()))
    print(f"docs_size: {words} words in {len(counts)} pages (at most {MOST}), {cells} of them in tables")
    return int(words > MOST)


if __name__ == "__main__":
    sys.exit(main("--pages" in sys.argv[1:]))
