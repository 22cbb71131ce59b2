"""Whole-body inverse kinematics with 30 joints and 6 levels: every wish gets what those above leave.

A planar tree with links of 0.1 m: a trunk of 6 joints, on top of it two arms of 12. x is the
velocity of the joints, rad/s.
"""

import numpy as np

from hapticgiant import hqp

TRUNK, RIGHT, LEFT = np.r_[0:6], np.r_[0:18], np.r_[0:6, 18:30]  # joints from the ground to a tip
q = np.full(30, 0.1)
q[[6, 18]] = -1.6, 1.2


def jacobian(chain):
    """Of the tip of the chain: x, y (up); a column per joint."""
    angles = np.cumsum(q[chain])  # from the vertical
    turned = -0.1 * np.array([np.cos(angles), np.sin(angles)])
    result = np.zeros((2, 30))
    result[:, chain] = turned[:, ::-1].cumsum(axis=1)[:, ::-1]
    return result


balance = (jacobian(TRUNK) + jacobian(RIGHT) + jacobian(LEFT))[:1] / 3
upright = np.isin(np.arange(30), TRUNK)[None, :].astype(float)
levels = {  # rows, lb, ub
    "joint speeds": (np.eye(30), -1.0, 1.0),
    "balance": (balance, -0.05, 0.05),
    "right hand": (jacobian(RIGHT), [0.3, 0.2], [0.3, 0.2]),
    "left hand": (jacobian(LEFT), [-1.5, 0.5], [-1.5, 0.5]),  # faster than it can
    "trunk upright": (upright, 0.0, 0.0),
    "joints at rest": (np.eye(30), 0.0, 0.0),
}

problem = hqp.Problem(variables=30)
for rows, lb, ub in levels.values():
    problem.add_level()
    problem.add_rows(rows, lb, ub)
solution = hqp.solve(problem)

for name, squared in zip(levels, solution.slack_squared):
    print(f"{name:15} misses by {np.sqrt(squared):.3f}")
print(solution.status.name, "with", np.isclose(abs(solution.x), 1.0).sum(), "joints at their limit")
