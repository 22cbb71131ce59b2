"""Recordings as arrays."""

from __future__ import annotations

import array
import os

import numpy as np

from hapticgiant import _core

_TOPIC = "/hapticgiant/sample"


class _Column:
    """The numbers of one field, row after row."""

    def __init__(self, like: np.ndarray):
        self.like = like  # type and number of dimensions
        self.values = array.array("B" if like.dtype == bool else like.dtype.char)
        self.ends = []

    def to_numpy(self) -> np.ndarray:
        """(rows), or (rows, widest); shorter rows end with NaN or 0."""
        counts = np.diff(self.ends, prepend=0)
        width = max(1, counts.max(initial=0))
        filler = np.nan if self.like.dtype.kind == "f" else 0
        rows = np.full((len(counts), width), filler, self.like.dtype)
        rows[np.arange(width) < counts[:, None]] = self.values
        return rows if self.like.ndim == 2 else rows[:, 0]


def _append(message, path, columns):
    """Appends every number of a message; the items of a list of messages share their columns."""
    for name in message.__slots__:
        value = getattr(message, name)
        here = path + name
        items = value if isinstance(value, list) else [value]
        if items and hasattr(items[0], "__slots__"):
            for item in items:
                _append(item, "" if here == "record" else here + ".", columns)
        elif here in columns:
            columns[here].values.extend(items)


def _samples(stream):
    """The decoded samples of a recording; of one that a crash cut short, those that are there."""
    try:
        from mcap.exceptions import EndOfFile
        from mcap.reader import NonSeekingReader
        from mcap_ros2.decoder import DecoderFactory
    except ImportError as error:
        raise ImportError("read_recording needs: pip install hapticgiant[recording]") from error
    reader = NonSeekingReader(stream, decoder_factories=[DecoderFactory()])
    try:
        for _, _, _, sample in reader.iter_decoded_messages([_TOPIC], log_time_order=False):
            yield sample
    except EndOfFile:
        return


def read_recording(file: str | os.PathLike) -> dict[str, np.ndarray]:
    """Every cycle of an MCAP recording as arrays: the same keys, shapes and types as run().

    Fields unknown to this version are left out; those that the recording does not have are
    NaN or 0. Raises SetupError where the file is not a recording.
    """
    columns = {name: _Column(like) for name, like in _core.empty_columns().items()}
    try:
        from mcap.exceptions import McapError
    except ImportError:
        McapError = ()
    count = 0
    try:
        with open(file, "rb") as stream:
            for sample in _samples(stream):
                _append(sample, "", columns)
                for column in columns.values():
                    column.ends.append(len(column.values))
                count += 1
    except (OSError, McapError) as error:
        raise _core.SetupError(f"{os.fspath(file)}: cannot be read as a recording: {error}") from error
    if count == 0:
        raise _core.SetupError(f"{os.fspath(file)}: no messages on {_TOPIC}, so not a recording")
    return {name: column.to_numpy() for name, column in columns.items()}
