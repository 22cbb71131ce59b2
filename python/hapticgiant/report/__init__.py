"""Reports of the program's commands: pages with pictures, Markdown, LaTeX, CSV and text.

    python report FOLDER [RUN...] [--docs DOCS]      also: python -m hapticgiant.report ...

FOLDER holds results.json, which the program writes; or each folder RUN holds run.json and
signals.npy. The report is written into FOLDER, and what a terminal shows is printed. The same
results give the same files. Needs scipy, matplotlib and jinja2, not the package's compiled part.
"""
