"""Recordings as arrays, as tables of pandas and as data sets of xarray."""

from __future__ import annotations

import array
import fnmatch
import os
import typing

import numpy as np

from hapticgiant import _core

if typing.TYPE_CHECKING:
    import pandas
    import xarray

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
    configuration: the files that describe the run, by name. All are empty for run().
    """

    def __init__(self, columns=(), *, run=(), limits=(), events=(), configuration=()):
        super().__init__(columns)
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


class _Reader:
    """Takes the records of a file, one by one."""

    def __init__(self):
        self.columns = {name: _Column(like) for name, like in _core.empty_columns().items()}
        self.count = 0
        self.events, self.metadata, self.configuration = [], {}, {}

    def read(self, stream):
        """Everything in a recording; of one that a crash cut short, what is there."""
        try:
            from mcap import records
            from mcap.exceptions import EndOfFile
            from mcap.stream_reader import StreamReader
            from mcap_ros2.decoder import DecoderFactory
        except ImportError as error:
            raise ImportError("read_recording needs: pip install hapticgiant[recording]") from error
        factory = DecoderFactory()
        schemas, takers = {}, {}
        try:
            for record in StreamReader(stream).records:
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
                elif isinstance(record, records.Metadata):
                    self.metadata[record.name] = list(record.metadata.items())
                elif isinstance(record, records.Attachment):
                    self.configuration[record.name] = record.data.decode(errors="replace")
        except EndOfFile:
            return

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
    NaN or 0. Raises SetupError where the file is not a recording.
    """
    try:
        from mcap.exceptions import McapError
    except ImportError:
        McapError = ()
    reader = _Reader()
    try:
        with open(file, "rb") as stream:
            reader.read(stream)
    except (OSError, McapError) as error:
        raise _core.SetupError(f"{os.fspath(file)}: cannot be read as a recording: {error}") from error
    if reader.count == 0:
        raise _core.SetupError(f"{os.fspath(file)}: no messages on {_SAMPLES}, so not a recording")
    return Recording({name: column.to_numpy() for name, column in reader.columns.items()},
                     run=reader.metadata.get("run", ()), limits=reader.metadata.get("limits", ()),
                     events=reader.events, configuration=reader.configuration)
