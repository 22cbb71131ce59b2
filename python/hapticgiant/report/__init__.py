"""Reports of the program's commands: pages with pictures, Markdown, LaTeX, CSV and text.

    python report < DOCUMENT      also: python -m hapticgiant.report

The program measures and then becomes this one, which reads the results from its standard input,
computes, draws, prints, writes all files and ends with the exit code of the command; see __main__.py
for the document. The same results give the same files. Needs scipy, matplotlib and jinja2, not the package's compiled part.
"""
