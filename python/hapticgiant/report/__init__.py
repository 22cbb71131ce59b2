"""Reports of `hapticgiant haptify`, `bench`, `faults`, `tune` and `check --map`: text and pictures.

    python report FOLDER [--docs DOCS]      also: python -m hapticgiant.report FOLDER [--docs DOCS]

FOLDER holds results.json, which the program writes; the report is written beside it. The same
results give the same files. Needs scipy, matplotlib and jinja2, not the compiled part of the
package.
"""
