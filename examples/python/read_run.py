"""A recording, or a run made on the spot, as arrays. Argument: an MCAP file, or nothing."""

import sys

import numpy as np

import hapticgiant as hg

data = hg.read_recording(sys.argv[1]) if len(sys.argv) > 1 else hg.run("door")
time = data["time_s"]  # (n)
force = np.linalg.norm(data["robot.w_h"][:, :3], axis=1)  # (n)
hinge = data["twin.q_a"][:, 0]  # (n)
print(f"{len(time)} cycles, {time[-1]:.1f} s, force at most {force.max():.1f} N")
print(f"hinge at most {hinge.max():.3f} rad, open from {time[hinge > 0.1][0]:.2f} s on")
