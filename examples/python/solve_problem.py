"""Wishes with priorities: x0 <= 1 at any rate, then x0 + x1 = 3, then both close to zero."""

from hapticgiant import hqp

problem = hqp.Problem(variables=2)
problem.add_level()
problem.add_bound(0, ub=1.0)
problem.add_level()
total = problem.add_row([1.0, 1.0], lb=3.0, ub=3.0)
problem.add_level()
for i in range(2):
    problem.add_bound(i, lb=0.0, ub=0.0)

solution = hqp.solve(problem)
print(solution.status.name, solution.x)

problem.set_bounds(total, 4.0, 4.0)  # a similar problem starts from the last active set
solution = hqp.solve(problem, solution.active_set)
print(solution.status.name, solution.x, "after", solution.iterations, "active set")
