"""Files of a report: pages from templates, and pages of the documentation that hold figures."""

import datetime
import math
import pathlib

import jinja2

from .. import figures
from . import tables

HERE = pathlib.Path(__file__).resolve().parent
version = ""  # of the program whose figures these are
BEGIN, END = "<!-- figures: begin -->\n", "<!-- figures: end -->"


def with_numbers(entry):
    """`entry` with NaN for the null that stands for infinite and undefined results."""
    if isinstance(entry, dict):
        return {key: math.nan if value is None else with_numbers(value) for key, value in entry.items()}
    return [with_numbers(value) for value in entry] if isinstance(entry, list) else entry


def save(file, text):
    file.write_text(text, encoding="utf-8")


def render(template, **facts):
    """One self-contained page."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True,
                                     trim_blocks=True, lstrip_blocks=True)
    return environment.get_template(template).render(**facts)


def draw(folder, paint):
    """Draws figure.svg and figure.png into `folder`; returns the SVG as an element of a page."""
    figures.save(folder, paint)
    svg = (folder / "figure.svg").read_text(encoding="utf-8")
    return svg[svg.index("<svg"):]


class PageTables:
    """Tables of a page of the documentation. Short ones stand in the page; longer ones become
    PAGE_NAME.csv beside it, which the page links to and the site draws (tools/docs_files.py)."""

    def __init__(self, page):
        self.page = page

    def __call__(self, rows, name, most=8):
        """Markdown of a table of at most `most` rows without the head, otherwise a link to its file."""
        if len(rows) - 1 <= most:
            return tables.markdown(rows)
        file = self.page.with_name(f"{self.page.stem}_{name}.csv")
        save(file, tables.as_csv(rows))
        return f"[Table: {file.name}]({file.name})\n"


def in_text(rows, _name, most=8):
    """As PageTables, for a report that has all tables in its text."""
    del most
    return tables.markdown(rows)


def stamp():
    """Version of the program and date of figures."""
    return f"Version {version}, {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d}."


def refresh(page, text, svg=None):
    """Replaces what stands between the two marks of a page, and the picture of the same name. The
    stamp is added."""
    content = page.read_text(encoding="utf-8")
    before, begin, rest = content.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise SystemExit(f"{page}: must have the lines '{BEGIN.strip()}' and '{END}'")
    save(page, f"{before}{begin}\n{text.rstrip()}\n\n{stamp()}\n\n{end}{after}")
    if svg:
        save(page.with_suffix(".svg"), svg)
