"""Hook of MkDocs: a line that is only a link to a CSV file or to an example is followed by what is in that file.

Cells are Markdown, their links are those of the page. In a view without this hook the link opens the file.
"""

import csv
import pathlib
import re

TABLE = re.compile(r"^\[[^\]]+\]\(([^()\s:]+\.csv)\)$", re.MULTILINE)
EXAMPLE = re.compile(r"^\[[^\]]+\]\(((?:\.\./)+examples/[^()\s]+\.(?:py|cpp|h))\)$", re.MULTILINE)
LANGUAGES = {".py": "python", ".cpp": "cpp", ".h": "cpp"}


def line(cells):
    return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def table(file):
    with file.open(newline="", encoding="utf-8") as stream:
        head, *rows = csv.reader(stream)
    return "\n".join([line(head), line(["---"] * len(head)), *map(line, rows)])


def example(file):
    return f"```{LANGUAGES[file.suffix]}\n{file.read_text(encoding='utf-8')}```"


def on_page_markdown(markdown, page, **_):
    folder = pathlib.Path(page.file.abs_src_path or "").parent
    markdown = TABLE.sub(lambda link: f"{link[0]}\n\n{table(folder / link[1])}\n", markdown)
    return EXAMPLE.sub(lambda link: f"{link[0]}\n\n{example(folder / link[1])}\n", markdown)
