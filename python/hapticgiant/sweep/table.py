"""The result of a sweep as one table: Parquet, or CSV where pyarrow is not installed.

A row per run in the order of their numbers, a column per parameter and measure. It depends on the
records only, not on who has played them when: the same sweep gives the same file, byte for byte.
"""

from __future__ import annotations

import csv
import fnmatch
import json
import os
import pathlib

from hapticgiant.sweep.reader import value_of
from hapticgiant.sweep.description import Sweep


def rows_of(sweep: Sweep, records: dict[int, dict]) -> list[dict]:
    """One dict per run that has ended: run, parameters, exit_code, state_hash, fault, measures."""
    chosen = {}  # name of a measure: is in the table

    def is_chosen(name):
        if name not in chosen:
            chosen[name] = not sweep.measures or any(
                name == wanted or fnmatch.fnmatchcase(name, wanted) for wanted in sweep.measures)
        return chosen[name]

    rows = []
    for run in sweep.runs:
        record = records.get(run.number)
        if record is None:
            continue
        if sweep.command:
            for number, result in sorted((record["results"] or {}).items(), key=lambda it: int(it[0])):
                rows.append({"run": int(number), **{
                    key: value if isinstance(value, (int, float, str, type(None))) else
                    json.dumps(value) for key, value in result.items()}})
            continue
        row = {"run": run.number}
        row |= {key: value_of(words) for key, words in run.parameters.items()}
        row |= {key: record[key] for key in ("exit_code", "state_hash", "fault")}
        for name, value in (record["measures"] or {}).items():
            if name not in row and is_chosen(name):
                row[name] = value
        rows.append(row)
    return sorted(rows, key=lambda row: row["run"])


def columns_of(rows: list[dict]) -> dict[str, list]:
    """The same by column, each of one type; None where a run has no value."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    columns = {}
    for name in names:
        values = [row.get(name) for row in rows]
        kinds = {type(value) for value in values if value is not None}
        if kinds == {int, float}:
            values = [None if value is None else float(value) for value in values]
        elif len(kinds) > 1:
            values = [None if value is None else str(value) for value in values]
        columns[name] = values
    return columns


def write_table(folder: pathlib.Path, rows: list[dict]) -> pathlib.Path:
    """Writes results.parquet or results.csv, whole or not at all; returns the file."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        pyarrow = None
    columns = columns_of(rows)
    file = folder / ("results.csv" if pyarrow is None else "results.parquet")
    partial = file.with_suffix(f".{os.uname().nodename}.{os.getpid()}")
    try:
        if pyarrow is None:
            with open(partial, "w", newline="", encoding="utf-8") as out:
                writer = csv.writer(out)
                writer.writerow(columns)
                writer.writerows(zip(*columns.values()))
        else:
            arrays = {name: pyarrow.array(values) for name, values in columns.items()}
            pyarrow.parquet.write_table(pyarrow.table(arrays), partial)
        partial.rename(file)
    finally:
        partial.unlink(missing_ok=True)
    return file
