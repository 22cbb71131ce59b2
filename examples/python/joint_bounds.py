"""How hard may a joint accelerate, for a whole grid of states at once?"""

import numpy as np

from hapticgiant import limits

joint = limits.JointLimits(q_min=-1.0, q_max=1.0, dq_max=2.0, ddq_max=10.0)
q = np.array([-1.0, -0.5, 0.0, 0.5, 0.9, 1.0])  # rad
dq = np.array([[0.0], [1.0], [2.0]])  # rad/s

lower, upper = limits.recoverable_bounds(joint, q, dq, dt=1e-3)
print("largest acceleration, rad/s^2; columns are q, rows are dq")
print("        ", "".join(f"{position:8.2f}" for position in q))
for speed, row in zip(dq[:, 0], upper):
    print(f"{speed:8.2f} ", "".join(f"{value:8.2f}" for value in row))
