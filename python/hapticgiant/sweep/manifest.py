"""The folder of a sweep: who made it, and a line per run that has ended.

sweep.json says for which runs, program and files the lines hold. manifest.jsonl, or for a shard
manifest.1of8.jsonl, has a line of JSON per run. A line is written whole, at once and at the end, so
that a sweep that is killed loses the runs that are being played and nothing else.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pathlib
import re
import sys

HEADER = "sweep.json"
KEYS = {"format", "title", "runs", "sweep", "version", "program", "files"}  # of the header
LINES = re.compile(r"manifest(\.\d+of\d+)?\.jsonl")
OF_RUN = {"run": int, "exit_code": int, "state_hash": str | None, "fault": str | int | None, "measures": dict | None}
TABLES = ("results.parquet", "results.csv", "repeat.sh")


class SweepError(RuntimeError):
    """A sweep that cannot be begun, continued or merged; the message says what to do."""


class Folder:
    """The folder of a sweep."""

    def __init__(self, path: pathlib.Path):
        self.path = path

    def header(self) -> dict | None:
        """None for a folder without a sweep. Raises SweepError."""
        try:
            header = json.loads((self.path / HEADER).read_text(encoding="utf-8"))
        except FileNotFoundError:
            if self._has_runs():
                raise SweepError(f"{self.path} has runs, but no {HEADER} that says of what: "
                                 "--again forgets them") from None
            self._refuse_files_of_others()
            return None
        except (ValueError, RecursionError):
            header = None
        if not isinstance(header, dict) or not KEYS <= header.keys():
            raise SweepError(f"{self.path / HEADER}: is damaged: --again forgets the runs")
        return header

    def settle(self, header: dict) -> dict:
        """Writes the header unless there is one; returns the one that is there now."""
        self.path.mkdir(parents=True, exist_ok=True)
        partial = self.path / f"{HEADER}.{os.uname().nodename}.{os.getpid()}"
        try:
            partial.write_text(json.dumps(header, indent=2) + "\n", encoding="utf-8")
            os.link(partial, self.path / HEADER)  # of several shards the first one
        except FileExistsError:
            pass
        finally:
            partial.unlink(missing_ok=True)
        return self.header()

    def records(self) -> dict[int, dict]:
        """By number of the run, of all shards; of several lines about a run one with a result."""
        records = {}
        for file in self._manifests():
            with open(file, encoding="utf-8", errors="replace") as lines:
                for number, line in enumerate(lines, 1):
                    if not line.endswith("\n"):
                        continue  # was being written
                    record = _read(line)
                    if record is None:
                        print(f"{file}:{number}: is damaged; its run is played again",
                              file=sys.stderr)
                    elif record["run"] not in records or record["state_hash"] is not None:
                        records[record["run"]] = record
        return records

    def forget(self) -> None:
        """Deletes everything of the sweep, and nothing else. Raises BlockingIOError while another
        process writes there, SweepError where the files are of no sweep."""
        if not self._has_header() and not self._has_runs():
            self._refuse_files_of_others()
        with contextlib.ExitStack() as stack:
            files = self._manifests()
            for file in files:
                descriptor = os.open(file, os.O_RDWR)
                stack.callback(os.close, descriptor)
                _lock(descriptor)
            for file in files:
                file.unlink()
            for name in (*TABLES, HEADER):  # last: see header()
                (self.path / name).unlink(missing_ok=True)

    def _manifests(self):
        return sorted(file for file in self.path.glob("manifest*.jsonl")
                      if LINES.fullmatch(file.name))

    def _has_header(self):
        try:
            header = json.loads((self.path / HEADER).read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError):
            return False
        return isinstance(header, dict) and KEYS <= header.keys()

    def _has_runs(self):
        for file in self._manifests():
            with open(file, encoding="utf-8", errors="replace") as lines:
                if any(_read(line) for line in lines):
                    return True
        return False

    def _refuse_files_of_others(self):
        for file in (*self._manifests(), *(self.path / name for name in (*TABLES, HEADER))):
            if file.is_file() and file.stat().st_size:
                raise SweepError(f"{file}: is of no sweep and would be replaced: take another --out")


def _read(line):
    def refuse(word):
        raise ValueError(word)

    try:
        record = json.loads(line, parse_constant=refuse)
    except (ValueError, RecursionError):
        return None
    is_whole = isinstance(record, dict) and all(
        key in record and isinstance(record[key], kind) for key, kind in OF_RUN.items())
    return record if is_whole and _is_table(record.get("results")) else None


def _is_table(results):
    """Whether these are the results of a command: none, or by the number of the part what it has found."""
    return results is None or isinstance(results, dict) and all(
        number.isdecimal() and isinstance(found, dict) for number, found in results.items())


def _lock(descriptor):
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:
        pass  # a file system without locks


class Manifest:
    """Lines of one sweep or shard. Raises BlockingIOError while another process writes them."""

    def __init__(self, folder: Folder, shard: tuple[int, int] | None):
        name = "manifest.jsonl" if shard is None else f"manifest.{shard[0]}of{shard[1]}.jsonl"
        self._path = folder.path / name
        while True:
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
            try:
                _lock(self._file)
                is_there = os.path.samestat(os.fstat(self._file), os.stat(self._path))
            except FileNotFoundError:
                is_there = False
            except BlockingIOError:
                os.close(self._file)
                raise
            if is_there:
                break
            os.close(self._file)  # somebody has just forgotten it
        self._drop_partial_line()

    def _drop_partial_line(self):
        end = os.fstat(self._file).st_size
        while end > 0:
            begin = max(0, end - 65536)
            newline = os.pread(self._file, end - begin, begin).rfind(b"\n")
            if newline >= 0:
                os.ftruncate(self._file, begin + newline + 1)
                return
            end = begin
        os.ftruncate(self._file, 0)

    def append(self, record: dict) -> None:
        data = (json.dumps(record) + "\n").encode()
        try:
            while data:
                data = data[os.write(self._file, data):]
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(self._path)) from None

    def close(self) -> None:
        os.close(self._file)
