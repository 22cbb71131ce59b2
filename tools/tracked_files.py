"""The texts of the repository."""

import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOT_TEXT = (".gz", ".lock", ".png", ".skip", ".svg", ".csv", ".json", ".ipynb")


def tracked_names():
    """Names of the files of the repository, new ones included."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=ROOT, check=True, capture_output=True).stdout.decode()
    return [name for name in sorted(set(listed.split("\0")) - {""}) if (ROOT / name).is_file()]


def read_texts(skipped=(), not_text=NOT_TEXT):
    """Name -> text of the files, without data; `skipped`: beginnings of names."""
    texts = {}
    for name in tracked_names():
        if not name.startswith(skipped) and not name.endswith(not_text):
            try:
                texts[name] = (ROOT / name).read_text()
            except UnicodeDecodeError:
                pass  # data
    return texts
