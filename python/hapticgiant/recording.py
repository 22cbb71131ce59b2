"""Recordings as arrays, as tables of pandas and as data sets of xarray."""

from __future__ import annotations

import fnmatch
import os
import typing
import warnings

import numpy as np

from hapticgiant import _core, samples
from hapticgiant.samples import Event

if typing.TYPE_CHECKING:
    import pandas
    import xarray


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


def read_recording(file: str | os.PathLike) -> Recording:
    """Every cycle of an MCAP recording: the same columns, shapes and types as run().

    Fields unknown to this version are left out; those that the recording does not have are
    NaN or 0. Damaged chunks are left out: each is a warning and a text in `losses`. Raises
    SetupError where the file is not a recording or damaged outside of chunks; `hapticgiant export`
    reads more of such files.
    """
    try:
        found = samples.read(file)
    except (ValueError, OSError) as error:
        text = str(error) if isinstance(error, ValueError) else f"{os.fspath(file)}: cannot be read as a recording: {error}"
        raise _core.SetupError(text) from error
    for loss in found.losses:
        warnings.warn(f"{os.fspath(file)}: {loss}", stacklevel=2)
    columns = {name: _as(like, found.columns.get(name), found.count) for name, like in _core.empty_columns().items()}
    return Recording(columns, run=found.metadata.get("run", ()), limits=found.metadata.get("limits", ()),
                     events=found.events, configuration=found.configuration, losses=found.losses)


def _as(like, values, count):
    """The rows of a column with type and dimensions of another; None: NaN or 0."""
    if values is None:
        filler = np.nan if like.dtype.kind == "f" else 0
        return np.full((count, 1) if like.ndim == 2 else count, filler, like.dtype)
    if values.ndim < like.ndim:
        values = values[:, None]
    elif values.ndim > like.ndim:
        values = values[:, 0]
    return values.astype(like.dtype, copy=False)
