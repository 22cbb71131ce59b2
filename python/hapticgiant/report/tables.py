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


def number(value):
    """Six digits; empty for what was not measured or not given."""
    return "" if value is None else f"{value:.6g}"
