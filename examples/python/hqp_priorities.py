"""Lexicographic least squares: a planar arm reaches for a point, keeps its joints, stays near home.

Every level gets what it wants as far as the levels above leave it free: nothing is weighed against
anything of another level.
"""

import numpy as np

from hapticgiant import hqp

angles = np.cumsum([0.3, 0.6, 0.5])  # three links of 1 m; x is the velocity of the joints, rad/s
jacobian = np.array([[-np.sin(angles[i:]).sum() for i in range(3)],
                     [np.cos(angles[i:]).sum() for i in range(3)]])

problem = hqp.Problem(variables=3)
problem.add_level()  # 0: no joint faster than 1 rad/s, at any rate
problem.add_bounds(lb=-1.0, ub=1.0)
problem.add_level()  # 1: the tip moves, in m/s
tip = problem.add_rows(jacobian, lb=[-1.0, 0.5], ub=[-1.0, 0.5])
problem.add_level()  # 2: the joints rather stand still, the first one most of all
problem.add_bounds(lb=0.0, ub=0.0, weights=[10.0, 1.0, 1.0])

solution = hqp.solve(problem)
print("slow tip: ", solution.x.round(3), "misses by", solution.slack[tip].round(3) + 0.0)

for row, wish in zip(tip, (-5.0, 1.0)):  # faster than the joints can
    problem.set_bounds(row, wish, wish)
solution = hqp.solve(problem, solution.active_set)  # warm: starts from the last active set
print("fast tip: ", solution.x.round(3), "misses by", solution.slack[tip].round(3) + 0.0)

print(solution.explain(level=1))  # who holds the tip back, and how hard
