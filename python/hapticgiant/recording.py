"""Recordings as arrays, as tables of pandas and as data sets of xarray."""

from __future__ import annotations

import array
import fnmatch
import os
import typing
import warnings

import numpy as np

from hapticgiant import _core

if typing.TYPE_CHECKING:
    import pandas
    import xarray

_MAGIC = b"\x89MCAP0\r\n"
_MOST_BYTES = 1 << 30  # of a record; a damaged length is larger
_CHUNK_HEAD = 1 + 8 + 3 * 8 + 4 + 4 + 8  # bytes of a chunk besides its data and compression's name
_SAMPLES, _EVENTS = "/hapticgiant/sample", "/hapticgiant/events"


class Event(typing.NamedTuple):
    """Noteworthy moment of a run."""

    time_s: float
    name: str
    text: str


class ColumnFacts(typing.NamedTuple):
    """What a column of a run is."""

    unit: str  # "m", "rad or m", "N, Nm" where entries differ; "" = none
    note: str
    axis: str  # what the entries of a row belong to, "manipulator"; "" = one number per row
    labels: list[str]  # names of the entries, as far as known
    units: list[str]  # of each entry with a label


class Recording(dict):
    """Columns of a run as arrays, by name: (rows), or (rows, entries).

    events: those that were recorded. metadata: texts about the run by name: "version", "rate_Hz".
    configuration: the files that describe the run, by name. losses: a text for each part of the
    file that is damaged and left out. All are empty for run().
    """

    def __init__(self, columns=(), *, run=(), limits=(), events=(), configuration=(), losses=()):
        super().__init__(columns)
        self.losses: list[str] = list(losses)
        self.events: list[Event] = list(events)
        self.metadata: dict[str, str] = dict(run)
        self.configuration: dict[str, str] = dict(configuration)
        facts = _core.column_facts(list(run), list(limits))
        self.facts: dict[str, ColumnFacts] = {name: ColumnFacts(*known)
                                              for name, known in facts.items()}

    def _chosen(self, patterns) -> list[str]:
        """Names that the patterns choose, in the order of the columns; without patterns all."""
        if isinstance(patterns, str):
            patterns = [patterns]
        if patterns is None:
            return list(self)
        for pattern in patterns:
            if not fnmatch.filter(self, pattern):
                nearest = _core.nearest_name(pattern, list(self))
                raise _core.SetupError(
                    f"no column is called {pattern}, did you mean '{nearest}'?")
        return [name for name in self
                if any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)]

    def to_pandas(self, columns: str | typing.Iterable[str] | None = None) -> pandas.DataFrame:
        """A table with the time as its index and one number per cell.

        columns: names, with * and ?; default: all. Entries of a wide column are columns of their
        own, "robot.q_p[0]", as in `hapticgiant export`. Units are in attrs["units"] by name.
        Raises SetupError for a name that no column has. Needs pandas.
        """
        import pandas

        cells, units = {}, {}
        for name in self._chosen(columns):
            values, known = self[name], self.facts[name]
            if name == "time_s":
                continue
            if values.ndim == 1:
                cells[name], units[name] = values, known.unit
                continue
            for i, entry in enumerate(values.T):
                label = f"{name}[{i}]"
                cells[label] = entry
                units[label] = known.units[i] if i < len(known.units) else known.unit
        table = pandas.DataFrame(cells, index=pandas.Index(self["time_s"], name="time_s"))
        table.attrs["units"] = units
        return table

    def events_to_pandas(self) -> pandas.DataFrame:
        """The events as a table: time_s, name, text. Needs pandas."""
        import pandas

        return pandas.DataFrame(self.events, columns=Event._fields)

    def to_xarray(self, columns: str | typing.Iterable[str] | None = None) -> xarray.Dataset:
        """A data set over the dimension time_s.

        Entries have dimensions with names as coordinates: "manipulator" with the joints' names,
        "gantry", "joint" (both), "twin_coordinate", "twin_velocity", "limit", "direction" (x, y,
        z), "spatial" (along and about x, y, z), "rotation". Units and meanings are attributes.
        columns and errors as for to_pandas(). Needs xarray.
        """
        import xarray

        variables, coordinates = {}, {"time_s": ("time_s", self["time_s"], {"units": "s"})}
        for name in self._chosen(columns):
            values, known = self[name], self.facts[name]
            if name == "time_s":
                continue
            attributes = {"units": known.unit, "long_name": known.note}
            if values.ndim == 1:
                variables[name] = ("time_s", values, attributes)
                continue
            width = values.shape[1]
            if len(known.labels) == width:
                dimension = known.axis
                coordinates[dimension] = known.labels
            else:  # entries without names, or a column without entries
                dimension = f"{known.axis}_of_{width}"
            variables[name] = (["time_s", dimension], values, attributes)
        return xarray.Dataset(variables, coordinates, attrs=self.metadata)


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


def _is_complete(stream) -> bool:
    """Whether the file ends as one that was completed."""
    stream.seek(0, os.SEEK_END)
    stream.seek(max(0, stream.tell() - len(_MAGIC)))
    return stream.read() == _MAGIC


class _Reader:
    """Takes the records of a file, one by one."""

    def __init__(self):
        self.columns = {name: _Column(like) for name, like in _core.empty_columns().items()}
        self.count = 0
        self.events, self.metadata, self.configuration = [], {}, {}
        self.losses = []

    def read(self, stream):
        """Everything in a recording; of one that a crash cut short, what is there.

        A chunk whose bytes have changed is left out. Raises any exception for other damage.
        """
        try:
            from mcap import records
            from mcap.exceptions import EndOfFile
            from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk
            from mcap_ros2.decoder import DecoderFactory
        except ImportError as error:
            raise ImportError("read_recording needs: pip install hapticgiant[recording]") from error
        factory = DecoderFactory()
        schemas, takers = {}, {}
        loss = None  # of the chunk before

        def take_content(record):
            if isinstance(record, records.Message):
                if record.channel_id in takers:
                    decode, take = takers[record.channel_id]
                    take(decode(record.data))
            elif isinstance(record, records.Schema):
                schemas[record.id] = record
            elif isinstance(record, records.Channel):
                take = {_SAMPLES: self.take_sample, _EVENTS: self.take_event}.get(record.topic)
                if take and record.id not in takers:
                    schema = schemas[record.schema_id]
                    takers[record.id] = factory.decoder_for(record.message_encoding, schema), take

        try:
            for record in StreamReader(stream, emit_chunks=True, validate_crcs=True,
                                       record_size_limit=_MOST_BYTES).records:
                if isinstance(record, records.Chunk):
                    loss = None
                    try:
                        content = breakup_chunk(record, validate_crc=True)
                    except Exception:  # of the codec, the checksum or what it holds
                        loss = _Loss(stream.tell() - _CHUNK_HEAD - len(record.compression)
                                     - len(record.data))
                        self.losses.append(loss)
                        continue
                    for item in content:
                        take_content(item)
                elif isinstance(record, records.MessageIndex):
                    if loss and takers.get(record.channel_id, (None, None))[1] == self.take_sample:
                        loss.times += [time for time, _ in record.records]
                elif isinstance(record, records.Metadata):
                    self.metadata[record.name] = list(record.metadata.items())
                elif isinstance(record, records.Attachment):
                    self.configuration[record.name] = record.data.decode(errors="replace")
                else:
                    take_content(record)
        except CRCValidationError:
            if not self.losses:  # which explain it
                raise
        except EndOfFile:
            if _is_complete(stream):
                raise

    def take_sample(self, sample):
        _append(sample, "", self.columns)
        for column in self.columns.values():
            column.ends.append(len(column.values))
        self.count += 1

    def take_event(self, event):
        self.events.append(Event(event.time_s, event.name, event.text))


def read_recording(file: str | os.PathLike) -> Recording:
    """Every cycle of an MCAP recording: the same columns, shapes and types as run().

    Fields unknown to this version are left out; those that the recording does not have are
    NaN or 0. Damaged chunks are left out: each is a warning and a text in `losses`. Raises
    SetupError where the file is not a recording or damaged outside of chunks; `hapticgiant export`
    reads more of such files.
    """
    reader = _Reader()
    try:
        with open(file, "rb") as stream:
            reader.read(stream)
    except ImportError:
        raise
    except Exception as error:  # damaged bytes give errors of any kind
        why = str(error) or type(error).__name__
        raise _core.SetupError(f"{os.fspath(file)}: cannot be read as a recording: {why}") from error
    start_ns = int(dict(reader.metadata.get("run", ())).get("start_ns", 0))
    losses = [loss.text(start_ns) for loss in reader.losses]
    for loss in losses:
        warnings.warn(f"{os.fspath(file)}: {loss}", stacklevel=2)
    if reader.count == 0 and losses:
        raise _core.SetupError(f"{os.fspath(file)}: what describes its samples is damaged")
    if reader.count == 0:
        raise _core.SetupError(f"{os.fspath(file)}: no messages on {_SAMPLES}, so not a recording")
    return Recording({name: column.to_numpy() for name, column in reader.columns.items()},
                     run=reader.metadata.get("run", ()), limits=reader.metadata.get("limits", ()),
                     events=reader.events, configuration=reader.configuration, losses=losses)
