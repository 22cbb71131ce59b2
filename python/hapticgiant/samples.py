"""Columns, events and texts of an MCAP recording, by numpy and the package mcap alone: no compiled part.

docs/reference/recording.md. Messages of a chunk with the same layout are decoded together: every sample of a run has it,
since only counts of sequences move what lies behind them.
"""

from __future__ import annotations

import dataclasses
import os
import re
import struct
import typing

import numpy as np

MAGIC = b"\x89MCAP0\r\n"
MOST_BYTES = 1 << 30  # of a record; a damaged length is larger
CHUNK_HEAD = 1 + 8 + 3 * 8 + 4 + 4 + 8  # bytes of a chunk besides its data and compression's name
SAMPLES, EVENTS, LAB_CLOCK = "/hapticgiant/sample", "/hapticgiant/events", "/hapticgiant/lab_clock"
CDR_HEADER = 4  # bytes before what is aligned
FIELD = re.compile(r"^\s*(\w[\w/]*)(?:\[(?:<=)?(\d*)\])?\s+(\w+)\s*(?:#.*)?$")
BOUNDED = re.compile(r"\[<=")


class Event(typing.NamedTuple):
    """Noteworthy moment of a run."""

    time_s: float
    name: str
    text: str


class LabClock(typing.NamedTuple):
    """From this run time on, the local clock of the Lab Streaming Layer is run time plus the offset."""

    time_s: float
    offset_s: float


@dataclasses.dataclass
class _Layout:
    """Where the numbers and texts of a message lie that has these counts."""

    size: int
    counts: list[tuple[int, int]] = dataclasses.field(default_factory=list)
    """Place and value of every count of a sequence and length of a text."""
    parts: dict[str, list[tuple[np.dtype, int, int]]] = dataclasses.field(default_factory=dict)
    """Of a column: type, place and count, in their order."""
    texts: dict[str, tuple[int, int]] = dataclasses.field(default_factory=dict)
    """Place and length, without the zero at the end."""


class _Schema:
    """Definition of a message in the format ros2msg."""

    def __init__(self, text: str):
        self.messages: dict[str, list[tuple[str, int | None, str]]] = {}
        for number, block in enumerate(re.split(r"(?m)^=+\n", text)):
            lines = block.splitlines()
            name = lines.pop(0).removeprefix("MSG: ") if number else ""
            found = (FIELD.match(line) for line in lines if line.strip() and not line.startswith("#"))
            self.messages[name] = [(each[1], self._count(each), each[3]) for each in found if each]
        self.wide: set[str] = set()
        """Columns with several entries."""
        self.types: dict[str, np.dtype] = {}
        """Of columns."""

    @staticmethod
    def _count(field):
        """1: a single value; None: a sequence; else an array's count, negative, so that one of 1 is an array, too."""
        if field[2] is None:
            return 1
        return -int(field[2]) if field[2] and not BOUNDED.search(field[0]) else None

    def layout(self, data: bytes) -> _Layout:
        """The layout of one message. Raises IndexError and others where it is shorter."""
        found = _Layout(len(data))
        end = self._walk("", "", CDR_HEADER, data, found, False)
        if end > len(data):
            raise ValueError("a message is shorter than its fields")
        return found

    def _walk(self, message, path, at, data, found, is_wide):
        for kind, count, name in self.messages[message]:
            here = path + name
            is_list = count != 1
            if count is None:
                at, count = self._number(at, data, found)
            if kind == "string":
                for _ in range(abs(count)):
                    at, length = self._number(at, data, found)
                    found.texts[here] = at, length - 1
                    at += length
            elif kind in self.messages:
                inner = "" if here == "record" else here + "."
                if count == 0:
                    self._declare(kind, inner, found)
                for _ in range(abs(count)):
                    at = self._walk(kind, inner, at, data, found, is_wide or is_list)
            else:
                at = self._numbers(kind, here, abs(count), at, found)
                if is_wide or is_list:
                    self.wide.add(here)
        return at

    def _declare(self, message, path, found):
        """The columns of an item that this message does not have."""
        for kind, _, name in self.messages[message]:
            if kind in self.messages:
                self._declare(kind, path + name + ".", found)
            elif kind != "string":
                self._numbers(kind, path + name, 0, 0, found)
                self.wide.add(path + name)

    @staticmethod
    def _number(at, data, found):
        at += -(at - CDR_HEADER) % 4
        value = int.from_bytes(data[at:at + 4], "little")
        if value > len(data):
            raise ValueError("a count is larger than its message")
        found.counts.append((at, value))
        return at + 4, value

    def _numbers(self, kind, here, count, at, found):
        dtype = self.types.setdefault(here, np.dtype(kind).newbyteorder("<"))
        parts = found.parts.setdefault(here, [])
        if count:
            at += -(at - CDR_HEADER) % dtype.itemsize
            parts.append((dtype, at, count))
        return at + count * dtype.itemsize


class _Rows:
    """Rows of columns, decoded message by message or many at once."""

    def __init__(self, schema: _Schema, wanted):
        self.schema, self._wanted = schema, wanted
        self._blocks: list[dict[str, np.ndarray]] = []
        self._layouts: list[_Layout] = []
        self.count = 0

    def take(self, messages: list[bytes]) -> None:
        """Appends messages, in their order."""
        begin = 0
        while begin < len(messages):  # messages that follow each other and have the same size
            size = len(messages[begin])
            end = next((i for i in range(begin, len(messages)) if len(messages[i]) != size), len(messages))
            table = np.frombuffer(b"".join(messages[begin:end]), np.uint8).reshape(end - begin, size)
            self._take_table(table)
            begin = end
        self.count += len(messages)

    def _take_table(self, table):
        while len(table):
            layout = self._layout_of(table[0].tobytes())
            fits = np.ones(len(table), bool)
            for place, value in layout.counts:
                fits &= table[:, place:place + 4].copy().view("<u4")[:, 0] == value
            same = len(table) if fits.all() else int(np.argmin(fits))
            self._blocks.append({name: self._values(table[:same], parts) for name, parts in layout.parts.items()
                                 if self._wanted is None or name in self._wanted})
            table = table[same:]

    def _layout_of(self, data):
        for layout in self._layouts:
            if layout.size == len(data) and all(int.from_bytes(data[at:at + 4], "little") == value
                                                for at, value in layout.counts):
                return layout
        self._layouts.insert(0, self.schema.layout(data))
        return self._layouts[0]

    @staticmethod
    def _values(table, parts):
        if not parts:
            return np.empty((len(table), 0))
        return np.concatenate([table[:, at:at + count * dtype.itemsize].copy().view(dtype) for dtype, at, count in parts],
                              axis=1)

    def columns(self) -> dict[str, np.ndarray]:
        """(rows), or (rows, widest); shorter rows end with NaN or 0. Without the columns that are empty in every row."""
        names = dict.fromkeys(name for block in self._blocks for name in block)
        found = {name: self._column(name, [block.get(name) for block in self._blocks]) for name in names}
        return {name: rows for name, rows in found.items() if rows is not None}

    def _column(self, name, blocks):
        filled = [block for block in blocks if block is not None and block.shape[1]]
        if not filled:
            return None
        width = max(block.shape[1] for block in filled)
        dtype = self.schema.types[name].newbyteorder("=")
        if len(filled) == len(blocks) and all(block.shape[1] == width for block in filled):
            rows = np.concatenate(blocks).astype(dtype)
        else:
            rows = np.full((self.count, width), np.nan if dtype.kind == "f" else 0, dtype)
            at = 0
            for block, count in zip(blocks, (len(next(iter(each.values()))) for each in self._blocks)):
                if block is not None:
                    rows[at:at + count, :block.shape[1]] = block
                at += count
        return rows if name in self.schema.wide else rows[:, 0]


class _Loss:
    """A chunk that is damaged, with what its index says that it held."""

    def __init__(self, place):
        self.place, self.times = place, []

    def text(self, start_ns):
        if not self.times:
            return f"chunk at byte {self.place} is damaged and left out"
        first, last = (1e-9 * (end(self.times) - start_ns) for end in (min, max))
        return (f"chunk at byte {self.place} is damaged: {len(self.times)} samples from {first:.3f} "
                f"to {last:.3f} s are lost")


@dataclasses.dataclass
class Samples:
    """What a recording holds."""

    columns: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
    """By name: (rows), or (rows, entries). Columns without any entry are left out."""
    count: int = 0
    """Rows."""
    events: list[Event] = dataclasses.field(default_factory=list)
    lab_clock: list[LabClock] = dataclasses.field(default_factory=list)
    """Empty without streams, and in recordings of version 0.2.0 and before, which have it in the words of an event alone."""
    metadata: dict[str, list[tuple[str, str]]] = dataclasses.field(default_factory=dict)
    configuration: dict[str, str] = dataclasses.field(default_factory=dict)
    """Files that describe the run, by name."""
    losses: list[str] = dataclasses.field(default_factory=list)
    """A text for each damaged chunk, which is left out."""


class _Reader:
    """Takes the records of a file, one by one."""

    def __init__(self, wanted):
        self.found, self._wanted = Samples(), wanted
        self._schemas, self._channels = {}, {}  # channels: topic, and _Rows or _Schema
        self._rows: _Rows | None = None
        self._waiting: list[bytes] = []
        self._losses: list[_Loss] = []

    def read(self, stream) -> Samples:
        """Everything in a recording; of one that a crash cut short, what is there. Raises any exception for damage
        outside of chunks."""
        from mcap import records
        from mcap.exceptions import EndOfFile
        from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk

        loss = None  # of the chunk before
        try:
            for record in StreamReader(stream, emit_chunks=True, validate_crcs=True, record_size_limit=MOST_BYTES).records:
                if isinstance(record, records.Chunk):
                    try:
                        content, loss = breakup_chunk(record, validate_crc=True), None
                    except Exception:  # of the codec, the checksum or what it holds
                        loss = _Loss(stream.tell() - CHUNK_HEAD - len(record.compression) - len(record.data))
                        self._losses.append(loss)
                        continue
                    for item in content:
                        self._take(item, records)
                    self._decode()
                elif isinstance(record, records.MessageIndex):
                    if loss and self._channels.get(record.channel_id, ("",))[0] == SAMPLES:
                        loss.times += [time for time, _ in record.records]
                elif isinstance(record, records.Metadata):
                    self.found.metadata[record.name] = list(record.metadata.items())
                elif isinstance(record, records.Attachment):
                    self.found.configuration[record.name] = record.data.decode(errors="replace")
                else:
                    self._take(record, records)
        except CRCValidationError:
            if not self._losses:  # which explain it
                raise
        except (EndOfFile, struct.error):  # a crash has cut it
            if _is_complete(stream):
                raise
        self._decode()
        return self._finished()

    def _take(self, record, records):
        if isinstance(record, records.Message):
            topic, schema = self._channels.get(record.channel_id, ("", None))
            if topic == SAMPLES:
                self._waiting.append(record.data)
            elif topic == EVENTS:
                self._take_event(schema, record.data)
            elif topic == LAB_CLOCK:
                layout = schema.layout(record.data)
                self.found.lab_clock.append(LabClock(*(_number(layout, record.data, name) for name in LabClock._fields)))
        elif isinstance(record, records.Schema):
            self._schemas[record.id] = record
        elif isinstance(record, records.Channel) and record.topic in (SAMPLES, EVENTS, LAB_CLOCK):
            if record.id not in self._channels:
                schema = _Schema(self._schemas[record.schema_id].data.decode())
                self._channels[record.id] = record.topic, schema
                if record.topic == SAMPLES and self._rows is None:
                    self._rows = _Rows(schema, self._wanted)

    def _take_event(self, schema, data):
        layout = schema.layout(data)

        def text(name):
            place, length = layout.texts[name]
            return bytes(data[place:place + length]).decode(errors="replace")

        self.found.events.append(Event(_number(layout, data, "time_s"), text("name"), text("text")))

    def _decode(self):
        if self._waiting:
            self._rows.take(self._waiting)
            self._waiting = []

    def _finished(self):
        found = self.found
        start_ns = int(dict(found.metadata.get("run", ())).get("start_ns", 0))
        found.losses = [loss.text(start_ns) for loss in self._losses]
        if self._rows is not None:
            found.columns, found.count = self._rows.columns(), self._rows.count
        return found


def _number(layout, data, name) -> float:
    """A number of a message that is no sequence."""
    ((dtype, place, _),) = layout.parts[name]
    return float(np.frombuffer(data, dtype, 1, place)[0])


def _is_complete(stream) -> bool:
    """Whether the file ends as one that was completed."""
    stream.seek(0, os.SEEK_END)
    stream.seek(max(0, stream.tell() - len(MAGIC)))
    return stream.read() == MAGIC


def read(file: str | os.PathLike, columns=None) -> Samples:
    """What a recording holds; of the columns only these, None: all. Damaged chunks are left out.

    Raises ValueError where the file is not a recording or damaged outside of chunks, OSError where it cannot be read, and
    ImportError without the package mcap.
    """
    try:
        import mcap  # noqa: F401
    except ImportError as error:
        raise ImportError("recordings need mcap: pip install 'hapticgiant[arrays]'") from error
    try:
        with open(file, "rb") as stream:
            found = _Reader(columns).read(stream)
    except OSError:
        raise
    except Exception as error:  # damaged bytes give errors of any kind
        raise ValueError(f"{os.fspath(file)}: cannot be read as a recording: {error or type(error).__name__}") from error
    if found.count == 0:
        raise ValueError(f"{os.fspath(file)}: what describes its samples is damaged" if found.losses else
                         f"{os.fspath(file)}: no messages on {SAMPLES}, so not a recording")
    return found
