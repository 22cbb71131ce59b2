"""Tables in the forms of a report. Rows are lists of text; the first one is the head."""

import csv
import io


def markdown(rows):
    lines = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join([lines[0], "|" + " --- |" * len(rows[0]), *lines[1:]]) + "\n"


def as_csv(rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def widths_of(rows):
    return [max(map(len, column)) for column in zip(*rows)]


def padded(row, widths, left):
    return [cell.ljust(width) if index in left else cell.rjust(width)
            for index, (cell, width) in enumerate(zip(row, widths))]


def as_text(rows, left=(0,)):
    """Aligned for a terminal; columns whose index is in `left` to the left, the others to the
    right."""
    widths = widths_of(rows)
    return "".join("  ".join(padded(row, widths, left)).rstrip() + "\n" for row in rows)


def aligned_markdown(rows, left=(0,)):
    """A Markdown table that can be read as it is; `left` as for as_text()."""
    widths = [max(width, 3) for width in widths_of(rows)]
    rule = ["-" * width if index in left else "-" * (width - 1) + ":"
            for index, width in enumerate(widths)]
    return "".join(f"| {' | '.join(padded(row, widths, left))} |\n"
                   for row in [rows[0], rule, *rows[1:]])


def number(value):
    """Six digits; empty for what was not measured or not given."""
    return "" if value is None else f"{value:.6g}"
