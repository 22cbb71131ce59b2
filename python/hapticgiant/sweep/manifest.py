"""The folder of a sweep: who made it, and a line per run that has ended.

study.json says for which study, program and files the lines hold. manifest.jsonl, or for a shard
manifest.1of8.jsonl, has a line of JSON per run. A line is written whole, at once and at the end, so
that a sweep that is killed loses the runs that are being played and nothing else.
"""

from __future__ import annotations

import fcntl
import json
import os
import pathlib

HEADER = "study.json"


class Folder:
    """The folder of a sweep."""

    def __init__(self, path: pathlib.Path):
        self.path = path

    def header(self) -> dict | None:
        try:
            return json.loads((self.path / HEADER).read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None

    def settle(self, header: dict) -> dict:
        """Writes the header unless there is one; returns the one that is there now."""
        self.path.mkdir(parents=True, exist_ok=True)
        partial = self.path / f"{HEADER}.{os.uname().nodename}.{os.getpid()}"
        partial.write_text(json.dumps(header, indent=2) + "\n", encoding="utf-8")
        try:
            os.link(partial, self.path / HEADER)  # of several shards the first one
        except FileExistsError:
            pass
        finally:
            partial.unlink()
        return self.header()

    def records(self) -> dict[int, dict]:
        """By number of the run, of all shards; of several lines about a run one with a result."""
        records = {}
        for file in sorted(self.path.glob("manifest*.jsonl")):
            with open(file, encoding="utf-8") as lines:
                for line in lines:
                    if not line.endswith("\n"):
                        continue  # was being written
                    record = json.loads(line)
                    if record["run"] not in records or record["state_hash"] is not None:
                        records[record["run"]] = record
        return records

    def forget(self) -> None:
        """Deletes everything of the sweep, and nothing else."""
        for pattern in (HEADER, "manifest*.jsonl", "results.*", "repeat.sh"):
            for file in self.path.glob(pattern):
                file.unlink()


class Manifest:
    """Lines of one sweep or shard. Raises BlockingIOError while another process writes them."""

    def __init__(self, folder: Folder, shard: tuple[int, int] | None):
        name = "manifest.jsonl" if shard is None else f"manifest.{shard[0]}of{shard[1]}.jsonl"
        self._file = os.open(folder.path / name, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(self._file)
            raise
        except OSError:
            pass  # a file system without locks
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
        while data:
            data = data[os.write(self._file, data):]

    def close(self) -> None:
        os.close(self._file)
