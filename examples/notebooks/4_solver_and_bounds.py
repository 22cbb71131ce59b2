# %% [markdown]
# # 4 Solver and bounds on their own
#
# The heart of a cycle are two small libraries that know no robot: bounds on the acceleration that
# keep a joint inside its limits, and a solver for least squares with priorities. Needs matplotlib.

# %%
import matplotlib.pyplot as plt
import numpy as np

from hapticgiant import hqp, limits

# %% [markdown]
# A joint accelerates towards its stop at 1 rad as hard as it may. With recoverable bounds it arrives
# at rest, and is never asked for more than its rating.

# %%
joint = limits.JointLimits(q_min=-1.0, q_max=1.0, dq_max=2.0, ddq_max=10.0)
dt, q, dq = 1e-3, 0.0, 0.0
way = []
for _ in range(1500):
    _, ddq = limits.recoverable_bounds(joint, q, dq, dt=dt)
    way.append((q, dq, float(ddq)))
    q, dq = q + dt * dq + 0.5 * dt**2 * float(ddq), dq + dt * float(ddq)
way = np.array(way)
print(f"ends at {q:.6f} rad with {dq:.1e} rad/s; fastest {way[:, 1].max():.3f} rad/s, "
      f"hardest {abs(way[:, 2]).max():.2f} rad/s^2")
assert q <= 1.0 and abs(q - 1.0) < 1e-4 and abs(way[:, 2]).max() <= 10.0 + 1e-6

# %% [markdown]
# Priorities: a planar arm reaches with its tip, but no joint may be faster than 1 rad/s. The wish
# that cannot be met is met as well as possible, and the solver says what holds it back.

# %%
angles = np.cumsum([0.3, 0.6, 0.5])
jacobian = np.array([[-np.sin(angles[i:]).sum() for i in range(3)],
                     [np.cos(angles[i:]).sum() for i in range(3)]])
problem = hqp.Problem(variables=3)
problem.add_level()
problem.add_bounds(lb=-1.0, ub=1.0)
problem.add_level()
tip = problem.add_rows(jacobian, lb=[0.0, 0.0], ub=[0.0, 0.0])

wishes = np.linspace(0.0, 6.0, 61)
got = []
active = None
for wish in wishes:
    for row, value in zip(tip, (-wish, 0.2 * wish)):
        problem.set_bounds(row, value, value)
    solution = hqp.solve(problem, active) if active is not None else hqp.solve(problem)
    active = solution.active_set
    got.append(solution.x.copy())
got = np.array(got)
assert abs(got).max() <= 1.0 + 1e-9
print(solution.explain(level=1))

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
left.plot(np.arange(len(way)) * dt, way[:, 0], label="position, rad")
left.plot(np.arange(len(way)) * dt, way[:, 1], label="speed, rad/s")
left.set(xlabel="s", title="To a stop at 1 rad")
left.legend()
right.plot(wishes, got)
right.set(xlabel="wished speed of the tip, m/s", ylabel="speeds of the joints, rad/s",
          title="As fast as the joints can")
plt.show()
