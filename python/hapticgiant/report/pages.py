"""Files of a report: pages from templates, and pages of the documentation that hold figures."""

import pathlib

import jinja2

from .. import figures

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- figures: begin -->\n", "<!-- figures: end -->"


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


def refresh(page, text, svg=None):
    """Replaces what stands between the two marks of a page, and the picture of the same name."""
    content = page.read_text(encoding="utf-8")
    before, begin, rest = content.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise SystemExit(f"{page}: must have the lines '{BEGIN.strip()}' and '{END}'")
    save(page, f"{before}{begin}\n{text}\n{end}{after}")
    if svg:
        save(page.with_suffix(".svg"), svg)
