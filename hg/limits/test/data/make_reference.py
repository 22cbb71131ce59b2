"""Writes recoverable_bounds.csv and paper_bounds.csv: bounds R, A, B and C by independent formulas.

R and B solve quadratic equations in the acceleration, where the C++ code of R solves for the speed
at the end of the sample. Run with Python and numpy in this folder; the seed is fixed.
"""

import csv

import numpy as np


def upper_R(q, v, hi, V, A, dt, tau, A_rec, v_rec, tau_rec):
    u = min(A, (V - v) / dt)
    if np.isfinite(hi):
        d = hi - q - dt * v
        k = dt + dt * dt / (2 * (tau if q <= hi else tau_rec))
        if q <= hi:
            a = (d / tau - v) / k
            if d - dt * dt * a / 2 > A * tau * tau:
                b = dt * (2 * v + A * dt)
                c = v * v - A * (2 * d - A * tau * tau)
                a = (-b + np.sqrt(b * b - 4 * dt * dt * c)) / (2 * dt * dt)
            u = min(u, a)
        else:
            u = min(u, max((d / tau_rec - v) / k, (-v_rec - v) / dt))
    return max(u, -A_rec)


def bounds_R(q, v, lo, hi, V, A, dt, tau, factor, v_rec, tau_rec):
    rest = (V, A, dt, tau, factor * A, v_rec, tau_rec)
    ub, lb = upper_R(q, v, hi, *rest), -upper_R(-q, -v, -lo, *rest)
    if lb > ub:
        lb = ub = ub if abs(ub) > abs(lb) else lb
    return lb, ub


def position(q, v, lo, hi, dt):
    stop = -v / dt
    ub = 2 * ((hi - q) - dt * v) / dt**2
    lb = 2 * ((lo - q) - dt * v) / dt**2
    if v > 0 and ub <= stop:
        ub = min(stop, -v * v / (2 * (hi - q)))
    if v < 0 and lb >= stop:
        lb = max(stop, v * v / (2 * (q - lo)))
    return lb, ub


def viability(q, v, lo, hi, A, dt):
    stop = -v / dt
    b, c = dt * (2 * v + A * dt), v * v - 2 * A * ((hi - q) - dt * v)
    D = b * b - 4 * dt * dt * c
    ub = max(stop, (-b + np.sqrt(D)) / (2 * dt * dt)) if D >= 0 else stop
    b, c = dt * (2 * v - A * dt), v * v - 2 * A * ((q - lo) + dt * v)
    D = b * b - 4 * dt * dt * c
    lb = min(stop, (-b - np.sqrt(D)) / (2 * dt * dt)) if D >= 0 else stop
    return lb, ub


def nearest(weaker, stronger):
    """The intersection, or else the point of `stronger` nearest to `weaker`."""
    lb, ub = max(weaker[0], stronger[0]), min(weaker[1], stronger[1])
    if lb > ub:
        lb = ub = stronger[0] if weaker[1] < stronger[0] else stronger[1]
    return lb, ub


def bounds_AB(q, v, lo, hi, V, A, dt):
    """Bounds A and B, or None where position or viability has no solution (tiny ranges)."""
    q = min(max(q, lo), hi)
    v = max(v, -V, -np.sqrt(2 * A * (q - lo)))
    v = min(v, V, np.sqrt(2 * A * (hi - q)))
    p, s = position(q, v, lo, hi, dt), ((-V - v) / dt, (V - v) / dt)
    w = viability(q, v, lo, hi, A, dt)
    if p[0] > p[1] or w[0] > w[1]:
        return None
    return nearest(s, p), nearest(nearest(nearest((-A, A), w), s), p)


def bounds_C(q, v, lo, hi, T):
    return 2 / T**2 * (lo - q - T * v), 2 / T**2 * (hi - q - T * v)


def short(x, digits=5):
    return float(f"{x:.{digits}g}")


def random_state(rng):
    """Limits, a state that is viable in about one case of two, and a period; short decimals."""
    A, V = short(10 ** rng.uniform(0.3, 2.3)), short(rng.uniform(0.3, 5))
    lo, hi = short(-rng.uniform(0.05, 2)), short(rng.uniform(0.05, 2))
    dt = float(rng.choice([1e-3, 5e-4, 1e-4, 2e-3]))
    near = 10 ** rng.uniform(-6, 0)
    q = {0: rng.uniform(lo, hi), 1: hi - near, 2: hi + near, 3: lo + near, 4: lo - near}
    q = short(q[int(rng.integers(5))], 9)
    v = short(rng.uniform(-1.2, 1.2) * V * 10 ** rng.uniform(-3, 0))
    if rng.random() < 0.1:
        lo, hi = [(-np.inf, hi), (lo, np.inf), (-np.inf, np.inf)][int(rng.integers(3))]
    if rng.random() < 0.05:
        V = np.inf
    return q, v, lo, hi, V, A, dt


def write(name, columns, rows):
    with open(name, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[repr(float(x)) for x in row] for row in rows])


def main():
    rng = np.random.default_rng(20)
    state = ["q", "dq", "q_min", "q_max", "dq_max", "ddq_max", "dt"]

    rows = []
    for _ in range(2000):
        s = random_state(rng)
        tau = s[6] * short(rng.uniform(1, 4))
        options = (tau, short(rng.uniform(1, 3)), min(0.5, s[4] / 4), short(rng.uniform(0.01, 0.05)))
        rows.append(s + options + bounds_R(*s, *options))
    options = ["tau", "ddq_rec_factor", "v_rec", "tau_rec"]
    write("recoverable_bounds.csv", state + options + ["lb", "ub"], rows)

    rows = []
    while len(rows) < 1500:
        s = random_state(rng)
        T_C = short(s[6] * rng.uniform(1, 40))
        ab = bounds_AB(*s)
        if ab is not None:
            rows.append(s + (T_C,) + ab[0] + ab[1] + bounds_C(*s[:4], T_C))
    ends = [f"{end}_{kind}" for kind in "ABC" for end in ("lb", "ub")]
    write("paper_bounds.csv", state + ["T_C"] + ends, rows)


if __name__ == "__main__":
    main()
