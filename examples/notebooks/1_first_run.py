# %% [markdown]
# # 1 A first run, and its recording as a table
#
# A simulated hand opens the rendered door. `hg.play` does what `hapticgiant run` does, here as fast
# as it can, and names its recording; `hg.run` plays the same without one. Needs pandas and matplotlib.

# %%
import matplotlib.pyplot as plt
import numpy as np

import hapticgiant as hg

outcome = hg.play("door", fast=True)
door = hg.read_recording(outcome.recording)

# %% [markdown]
# Every column is an array; `to_pandas` makes a table of those that are asked for. The time is the
# index, and the units are attributes.

# %%
table = door.to_pandas(["twin.q_a", "robot.w_h", "mode"])
units = table.attrs["units"]
print(table.describe().T[["mean", "min", "max"]].round(3))
print({name: units[name] for name in ("twin.q_a[0]", "robot.w_h[0]", "robot.w_h[3]")})

# %% [markdown]
# What did the door feel like? While it is locked the hand pushes and pulls in vain. It opens when
# the lever is down.

# %%
force = np.linalg.norm(table[[f"robot.w_h[{i}]" for i in range(3)]], axis=1)
hinge, lever = table["twin.q_a[0]"], table["twin.q_a[1]"]
opens = hinge.index[hinge > 0.05][0]
in_vain = force[table.index < 4.0].max()
print(f"locked: up to {in_vain:.0f} N, and the door moves by {1e3 * hinge[:4.0].max():.2f} mrad")
print(f"open from {opens:.2f} s on, with the lever at {lever[opens]:.2f} rad")
assert in_vain > 20 and hinge[:4.0].max() < 1e-3 and lever[opens] > 0.5

# %%
figure, (upper, lower) = plt.subplots(2, sharex=True)
upper.plot(hinge, label="hinge")
upper.plot(lever, label="lever")
upper.axvline(opens, color="grey", linestyle=":")
upper.set_ylabel("rad")
upper.legend()
lower.plot(table.index, force, linewidth=0.8)
lower.set_ylabel("force of the hand, N")
lower.set_xlabel("s")
figure.suptitle("The door gives way when the lever is down")
plt.show()
