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


def as_text(rows, left=1):
    """Aligned for a terminal; the first `left` columns to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "".join("  ".join(cell.ljust(width) if number < left else cell.rjust(width)
                             for number, (cell, width) in enumerate(zip(row, widths))).rstrip() + "\n"
                   for row in rows)


def number(value):
    """Six digits; empty for what was not measured or not given."""
    return "" if value is None else f"{value:.6g}"
