"""Tables of a recording in files of other tools, for `hapticgiant export`.

Standard input: a line of JSON with facts, events and names of files; then rows as arrays of numpy
(.npy), one after another; then the line "end". All columns of the arrays are in facts["columns"],
which are also the data dictionary that goes into the files.
"""

import importlib.util
import json
import sys

import numpy as np

LIBRARIES = {"parquet": ["numpy", "pyarrow"], "hdf5": ["numpy", "h5py"]}


def missing(export_format):
    return [name for name in LIBRARIES[export_format] if importlib.util.find_spec(name) is None]


class Pipe:
    """A stream that numpy reads without looking for a file behind it."""

    def __init__(self, stream):
        self.stream = stream
        self.begun = b""

    def read(self, count):
        begun, self.begun = self.begun[:count], self.begun[count:]
        return begun + self.stream.read(count - len(begun))

    def arrays(self):
        while True:
            self.begun = self.stream.read(4)
            if self.begun == b"end\n":
                return
            if len(self.begun) < 4:
                raise EOFError("the rows end too early")
            yield np.lib.format.read_array(self)


def entry_names(column):
    """Names of the columns of a table with one number per cell: robot.q_p[0], robot.q_p[1]."""
    if "width" not in column:
        return [column["name"]]
    return [f"{column['name']}[{i}]" for i in range(column["width"])]


class Parquet:
    def __init__(self, head):
        import pyarrow
        import pyarrow.parquet

        self.arrow = pyarrow
        facts = head["facts"]
        fields = []
        for column in facts["columns"]:
            kind = "bool" if column["type"] == "bool" else column["type"]
            kind = pyarrow.from_numpy_dtype(np.dtype(kind))
            for i, name in enumerate(entry_names(column)):
                known = i < len(column.get("units", ()))
                fields.append(pyarrow.field(name, kind, metadata={
                    "unit": column["units"][i] if known else column["unit"],
                    "label": column["labels"][i] if known else "",
                    "description": column["description"]}))
        self.columns = facts["columns"]
        self.schema = pyarrow.schema(fields, metadata={"hapticgiant": json.dumps(facts)})
        self.writer = pyarrow.parquet.ParquetWriter(head["file"], self.schema, compression="zstd",
                                                    compression_level=1, use_dictionary=False)
        times, names, texts = zip(*head["events"]) if head["events"] else ((), (), ())
        events = pyarrow.table({"time_s": pyarrow.array(times, pyarrow.float64()),
                                "name": pyarrow.array(names, pyarrow.string()),
                                "text": pyarrow.array(texts, pyarrow.string())})
        events = events.replace_schema_metadata({"exported_by": facts["exported_by"]})
        pyarrow.parquet.write_table(events, head["events_file"])

    def write(self, rows):
        arrays = []
        for column in self.columns:
            values = rows[column["name"]]
            for entry in values.T if "width" in column else [values]:
                arrays.append(self.arrow.array(np.ascontiguousarray(entry)))
        self.writer.write_batch(self.arrow.record_batch(arrays, schema=self.schema),
                                row_group_size=len(rows))

    def close(self):
        self.writer.close()


class Hdf5:
    CHUNK_BYTES = 1 << 18

    def __init__(self, head):
        import h5py

        self.file = h5py.File(head["file"], "w")
        facts = head["facts"]
        self.columns = [column["name"] for column in facts["columns"]]
        self.samples = self.file.create_group("samples")
        for column in facts["columns"]:
            width = [column["width"]] if "width" in column else []
            dtype = np.dtype(column["type"])
            rows = max(64, self.CHUNK_BYTES // (dtype.itemsize * max([1, *width])))
            data = self.samples.create_dataset(
                column["name"], shape=[0, *width], maxshape=[None, *width], dtype=dtype,
                chunks=(rows, *width), compression="gzip", compression_opts=1, shuffle=True)
            for name in ("unit", "description", "axis"):
                data.attrs[name] = column.get(name, "")
            for name in ("labels", "units"):
                if name in column:
                    data.attrs[name] = np.array(column[name], h5py.string_dtype())
        for name, value in facts["run"].items():
            self.file.attrs[name] = value
        for name in ("file", "exported_by", "is_complete", "losses"):
            self.file.attrs[name] = facts[name]
        events = self.file.create_group("events")
        times, names, texts = zip(*head["events"]) if head["events"] else ((), (), ())
        events["time_s"] = np.array(times, float)
        events["time_s"].attrs["unit"] = "s"
        for name, values in (("name", names), ("text", texts)):
            events.create_dataset(name, data=np.array(values, object), dtype=h5py.string_dtype())

    def write(self, rows):
        for name in self.columns:
            data = self.samples[name]
            begin = len(data)
            data.resize(begin + len(rows), axis=0)
            data[begin:] = rows[name]

    def close(self):
        self.file.close()


def write(export_format, stream):
    head = json.loads(stream.readline())
    table = {"parquet": Parquet, "hdf5": Hdf5}[export_format](head)
    for rows in Pipe(stream).arrays():
        table.write(rows)
    table.close()


def main(export_format, only_checks):
    absent = missing(export_format)
    if absent:
        print(" and ".join(absent), end="")
        return 69
    if not only_checks:
        write(export_format, sys.stdin.buffer)
    return 0
