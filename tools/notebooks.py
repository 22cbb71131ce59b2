#!/usr/bin/env python3
"""Notebooks from their sources: examples/notebooks/NAME.ipynb from NAME.py.

    notebooks.py            writes them
    notebooks.py --check    compares them; exit code 1 where one differs

A source is a plain program whose cells begin with "# %%" (of text: "# %% [markdown]"), the percent
format that Jupyter, Spyder and Visual Studio Code know. The notebooks hold no outputs.
"""

import argparse
import json
import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "examples/notebooks"


def cell(number, head, body):
    text = body.strip("\n")
    if "[markdown]" in head:
        text = re.sub(r"^# ?", "", text, flags=re.MULTILINE)
    lines = text.splitlines(keepends=True)
    common = {"id": f"cell-{number}", "metadata": {}, "source": lines}
    if "[markdown]" in head:
        return {"cell_type": "markdown", **common}
    return {"cell_type": "code", "execution_count": None, **common, "outputs": []}


def notebook(source):
    parts = re.split(r"^(# %%.*)\n", source.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    cells = [cell(i, *pair) for i, pair in enumerate(zip(parts[::2], parts[1::2]))]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return json.dumps({"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4,
                       "nbformat_minor": 5}, indent=1) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true")
    is_check = parser.parse_args().check
    different = []
    for source in sorted(FOLDER.glob("*.py")):
        file, text = source.with_suffix(".ipynb"), notebook(source)
        if file.exists() and file.read_text(encoding="utf-8") == text:
            continue
        different.append(file.name)
        if not is_check:
            file.write_text(text, encoding="utf-8")
    if is_check and different:
        print(f"{', '.join(different)}: not made from the source beside it; run tools/notebooks.py")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
