# %% [markdown]
# # 2 What stops the hand: limits and their forces
#
# Every cycle says of every limit how far it is and how hard it pushes. As a data set of xarray the
# columns have names instead of numbers. Needs xarray and matplotlib.

# %%
import matplotlib.pyplot as plt
import numpy as np

import hapticgiant as hg

door = hg.run("door").to_xarray(["limits.*", "twin.q_a", "robot.w_h", "felt_limit"])
print(dict(door.sizes))
print("limits:", ", ".join(door.limit.values))

# %% [markdown]
# Which of them ever pushed, and how hard at most? Reactions of joints are torques, of slides forces.

# %%
reaction = abs(door["limits.reaction"]).max("time_s")
for name in door.limit.values[reaction > 0.1]:
    print(f"{name:12} at most {reaction.sel(limit=name).item():6.1f}")

# %% [markdown]
# The hinge: locked while the lever is up, closed at 0, open at 1.75 rad. Its reaction is there only
# where it is held or at an end of its range: a limit that is not reached does not push.

# %%
hinge = door["twin.q_a"].sel(twin_coordinate="hinge")
pushes = door["limits.reaction"].sel(limit="hinge")
acts = door["limits.state"].sel(limit="hinge") != int(hg.LimitState.INACTIVE.value)
free = pushes.where(~acts, 0.0)
print(f"hinge acts in {100 * acts.mean().item():.0f} % of the cycles; "
      f"elsewhere its reaction is at most {abs(free).max().item():.1e} Nm")
assert abs(free).max() < 1e-9

# %%
figure, (upper, lower) = plt.subplots(2, sharex=True)
hinge.plot(ax=upper)
upper.set(xlabel="", ylabel="hinge, rad", title="")
pushes.plot(ax=lower, linewidth=0.8)
lower.fill_between(door.time_s, 0, 1, where=acts, alpha=0.15, transform=lower.get_xaxis_transform())
lower.set(xlabel="s", ylabel="reaction, Nm", title="")
figure.suptitle("The hinge pushes back only where it is held (shaded)")
plt.show()
