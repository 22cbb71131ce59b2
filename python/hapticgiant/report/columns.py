"""Tables with aligned columns, for a terminal. Rows are lists of text; the first one is the head."""


def widths_of(rows):
    return [max(map(len, column)) for column in zip(*rows)]


def aligned(rows, left=(0,)):
    """Without lines; columns whose index is in `left` begin at the left, the others end right."""
    widths = widths_of(rows)
    lines = ("  ".join(cell.ljust(width) if index in left else cell.rjust(width)
                       for index, (cell, width) in enumerate(zip(row, widths))) for row in rows)
    return "".join(line.rstrip() + "\n" for line in lines)


def markdown(rows, left=(0,)):
    """A Markdown table that can be read as it is."""
    widths = [max(width, 3) for width in widths_of(rows)]
    rule = ["-" * width if index in left else "-" * (width - 1) + ":"
            for index, width in enumerate(widths)]
    lines = ([cell.ljust(width) if index in left else cell.rjust(width)
              for index, (cell, width) in enumerate(zip(row, widths))]
             for row in [rows[0], rule, *rows[1:]])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
