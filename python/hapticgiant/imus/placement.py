"""Where inertial sensors observe best the speeds and accelerations of the joints.

After Fennel et al., Observability-based placement of inertial sensors on robotic manipulators for
kinematic state estimation, IFAC-PapersOnLine 56(2), 2023. Two measures:

- covariance: the error covariance of a Kalman filter for (q, dq, ddq) with white jerk, by its
  Riccati recursion along the motion;
- gramian: the empirical observability Gramian of the same model without process noise, over short
  windows, added to the information of the prior. Its logdet is monotone and submodular, so that
  greedy choice has a proven quality.

How a sensor is turned does not matter: its noise is white and the same in all directions, so that a
rotation C gives (C H)^T (C H) / sigma^2 = H^T H / sigma^2, the same information.
"""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np

from .chain import InputError

MEASURES = ("covariance", "gramian")
WINDOWS, WINDOW_S = 4, 0.03  # where and how long placements are compared during the search
PRIOR_Q = 0.5  # rad or m, before the first measurement
SAME = 1e-9  # relative difference of scores that is none
SWEEPS = 8  # of the exchange
BATCH = 64  # placements at a time


@dataclasses.dataclass(frozen=True)
class Noise:
    """Spectral densities of the sensors, errors of the encoders per sample, and of the jerk."""

    gyro: float = 2.4e-4  # rad/s/sqrt(Hz)
    accelerometer: float = 1.7e-3  # m/s^2/sqrt(Hz)
    encoder_rad: float = 2e-6
    encoder_m: float = 3e-6
    jerk_rad: float = 100.0  # rad/s^3/sqrt(Hz)
    jerk_m: float = 20.0  # m/s^3/sqrt(Hz)
    encoders: bool = True


@dataclasses.dataclass(frozen=True)
class Candidate:
    """A place for a sensor: r (m) in the frame of a link."""

    link: str
    r: tuple[float, float, float]


def candidates(chain, grid=2, links=None):
    """Per moving link the middle of what it carries and a grid of so many points along each edge of
    the box about its shapes, in its frame; without shapes (meshes are not read) points from its
    origin to the next joints."""
    found = []
    for link in chain.moving_links():
        if links is not None and link not in links:
            continue
        corners = [box.centre + box.rotation @ (box.half * sign) for box in chain.boxes(link)
                   for sign in itertools.product((-1, 1), repeat=3)]
        if corners:
            low, high = np.min(corners, 0), np.max(corners, 0)
            points = [(low + high) / 2]
            points += [low + (high - low) * np.array(share)
                       for share in itertools.product(np.linspace(0, 1, grid), repeat=3)]
        else:
            points = [np.zeros(3)]
            points += [share * end for end in chain.places_of_children(link)
                       for share in np.linspace(0, 1, grid + 1)[1:]]
        unique = dict.fromkeys(tuple(float(x) for x in np.round(point, 4) + 0.0)
                               for point in points)
        found += [Candidate(link, point) for point in unique]
    return found


class Problem:
    """Candidates along a motion of a chain, and what placements of them are worth.

    A placement is a tuple of indices of candidates. Inside, the state is (q / h^2, dq / h, ddq)
    with the sample time h, which keeps covariances well conditioned, and measurements are divided
    by their errors.
    """

    def __init__(self, chain, motion, places, noise, gravity=True, measure="covariance",
                 criterion="logdet", one_per_link=False):
        self.one_per_link = one_per_link
        self.chain, self.motion, self.places, self.noise = chain, motion, places, noise
        self.measure, self.criterion = measure, criterion
        n, h = chain.n, 1 / motion.rate_hz
        self.scale = np.repeat([h * h, h, 1.0], n)
        slide = np.array([joint.unit == "m" for joint in chain.moving])
        self.F = np.kron([[1, 1, 0.5], [0, 1, 1], [0, 0, 1]], np.eye(n))
        jerk = np.where(slide, noise.jerk_m, noise.jerk_rad)
        self.Q = np.kron(h * np.array([[1 / 20, 1 / 8, 1 / 6], [1 / 8, 1 / 3, 1 / 2],
                                       [1 / 6, 1 / 2, 1]]), np.diag(jerk ** 2))
        self.prior = np.concatenate([np.full(n, PRIOR_Q), motion.scales()])
        self.P0 = np.diag((self.prior / self.scale) ** 2)
        self.gravity, self._whole = gravity, None
        root = math.sqrt(motion.rate_hz)
        self._sigma = np.repeat([noise.gyro * root, noise.accelerometer * root], 3)[:, None]
        encoder = np.where(slide, noise.encoder_m, noise.encoder_rad)
        self._encoder = (np.diag(self.scale[:n] / encoder) @ np.eye(n, 3 * n) if noise.encoders
                         else np.zeros((0, 3 * n)))
        count = max(4, round(WINDOW_S * motion.rate_hz))
        starts = np.linspace(0, len(motion) - count, WINDOWS).astype(int)
        self._window = starts[:, None] + np.arange(count)
        moved = self._moved(self._window.ravel())
        self._H = np.array([self._rows(place, moved).reshape(*self._window.shape, 6, 3 * n)
                            for place in places])
        if measure == "gramian":
            self._gramians()

    def _moved(self, samples):
        links = {place.link for place in self.places}
        motion = self.motion
        return self.chain.motion(motion.q[samples], motion.dq[samples], motion.ddq[samples],
                                 self.gravity, links)

    def _rows(self, place, moved):
        """(T, 6, 3 n) of a candidate."""
        return moved[place.link].measured(np.array(place.r))[1] * self.scale / self._sigma

    def _gramians(self):
        """Per candidate and window the Gramian, in units of the prior."""
        steps, power = self._window.shape[1], np.eye(len(self.F))
        root = self.prior / self.scale
        W = np.zeros((*self._H.shape[:2], len(root), len(root)))
        base = np.zeros_like(W[0, 0])
        for k in range(steps):
            H = self._H[:, :, k] @ power
            W += np.swapaxes(H, -1, -2) @ H
            E = self._encoder @ power
            base += E.T @ E
            power = self.F @ power
        outer = np.outer(root, root)
        self._W, self._base = W * outer, base * outer + np.eye(len(root))

    def filter(self, H, visit):
        """Riccati recursion; H (B, K, m, 3 n). visit(k, P) sees each covariance (B, 3 n, 3 n)."""
        count, steps, rows, size = H.shape
        E = self._encoder
        P, one = np.tile(self.P0, (count, 1, 1)), np.eye(rows + len(E))
        for k in range(steps):
            if k:
                P = self.F @ P @ self.F.T + self.Q
            here = np.concatenate([np.tile(E, (count, 1, 1)), H[:, k]], 1)
            if here.shape[1]:
                cross = here @ P
                gain = np.swapaxes(np.linalg.solve(
                    cross @ np.swapaxes(here, 1, 2) + one, cross), 1, 2)
                rest = np.eye(size) - gain @ here
                P = rest @ P @ np.swapaxes(rest, 1, 2) + gain @ np.swapaxes(gain, 1, 2)
            visit(k, P)

    def fits(self, placement):
        """Whether no place, and with one_per_link no link, is taken twice."""
        taken = [self.places[i].link if self.one_per_link else i for i in placement]
        return len(set(taken)) == len(taken)

    def most(self):
        """How many sensors there is room for."""
        return len({place.link for place in self.places} if self.one_per_link else self.places)

    def scores(self, placements):
        """(placements) what is left of the motion's size as error, less is better.

        logdet: geometric mean over the states, lambda_min: in the worst direction, trace: root mean
        square. States are dq and ddq over their root mean square in the motion (covariance), or all
        over the prior (gramian).
        """
        found = [self._batch(placements[i:i + BATCH]) for i in range(0, len(placements), BATCH)]
        return np.concatenate(found)

    def _batch(self, placements):
        chosen = np.array(placements, int).reshape(len(placements), -1)
        if self.measure == "gramian":
            Y = self._W[chosen].sum(1) + self._base
            if self.criterion == "logdet":
                return np.exp(-np.linalg.slogdet(Y)[1].mean(1) / 2 / Y.shape[-1])
            eigenvalues = np.linalg.eigvalsh(Y)
            if self.criterion == "lambda_min":
                return np.sqrt(1 / eigenvalues[:, :, 0]).mean(1)
            return np.sqrt((1 / eigenvalues).mean((1, 2)))
        windows, steps = self._window.shape
        size = len(self.scale)
        H = self._H[chosen]  # (B, count, W, K, 6, 3 n)
        H = np.moveaxis(H, 1, 3).reshape(len(chosen) * windows, steps, -1, size)
        total = np.zeros((len(H), size, size))

        def visit(k, P):
            nonlocal total
            if k >= steps // 2:
                total += P

        self.filter(H, visit)
        P = total.reshape(len(chosen), windows, size, size).mean(1) / (steps - steps // 2)
        n = self.chain.n
        unit = self.scale[n:] / self.motion.scales()
        P = P[:, n:, n:] * np.outer(unit, unit)
        if self.criterion == "logdet":
            return np.exp(np.linalg.slogdet(P)[1] / 2 / len(unit))
        if self.criterion == "lambda_min":
            return np.sqrt(np.linalg.eigvalsh(P)[:, -1])
        return np.sqrt(np.trace(P, axis1=1, axis2=2) / len(unit))

    def information(self, scores):
        """What logdet of the Gramian is, in nats, of its scores: the sum that is submodular."""
        return -np.log(scores) * len(self.scale)

    def covariances(self, placement):
        """(T, 3 n, 3 n) covariance of the error of (q, dq, ddq) along the whole motion."""
        found = np.empty((len(self.motion), len(self.scale), len(self.scale)))
        unit = np.outer(self.scale, self.scale)

        def visit(k, P):
            found[k] = P[0] * unit

        self.filter(self._all_rows(placement)[None], visit)
        return found

    def _all_rows(self, placement):
        if self._whole is None:
            self._whole = self._moved(np.arange(len(self.motion)))
        rows = [self._rows(self.places[i], self._whole) for i in placement]
        return np.concatenate(rows or [np.zeros((len(self.motion), 0, len(self.scale)))], 1)

    def errors(self, placements):
        """(placements, 3 n) root mean square errors of (q, dq, ddq), over the motion's second half."""
        steps, found = len(self.motion), []
        for placement in placements:
            total = np.zeros(len(self.scale))

            def visit(k, P, total=total):
                if k >= steps // 2:
                    total += np.diagonal(P[0])

            self.filter(self._all_rows(placement)[None], visit)
            found.append(np.sqrt(total / (steps - steps // 2)) * self.scale)
        return np.array(found)


@dataclasses.dataclass
class Choice:
    """A placement, its score, by which search, and what is known about its quality."""

    placement: tuple[int, ...]
    score: float
    search: str
    evaluated: int
    bound: float | None = None  # no placement of so many has a lower score than this


def _first_best(scores):
    """The first of those that are the best up to rounding."""
    return int(np.flatnonzero(scores <= scores.min() * (1 + SAME))[0])


def exhaustive(problem, count):
    """The best of all placements."""
    every = [each for each in itertools.combinations(range(len(problem.places)), count)
             if problem.fits(each)]
    scores = problem.scores(every)
    best = _first_best(scores)
    return Choice(every[best], float(scores[best]), "exhaustive", len(every), float(scores[best]))


def greedy(problem, count, start=()):
    """Adds the sensor that helps most, one after the other."""
    chosen, evaluated, score = tuple(start), 0, math.inf
    while len(chosen) < count:
        rest = [i for i in range(len(problem.places)) if problem.fits((*chosen, i))]
        scores = problem.scores([(*chosen, i) for i in rest])
        best = _first_best(scores)
        chosen, score = (*chosen, rest[best]), float(scores[best])
        evaluated += len(rest)
    return Choice(chosen, score, "greedy", evaluated)


def exchange(problem, choice):
    """Moves one sensor at a time to its best place, until none can be moved for the better."""
    chosen, score, evaluated = list(choice.placement), choice.score, choice.evaluated
    still = 0
    for turn in range(SWEEPS * len(chosen)):
        slot = turn % len(chosen)
        options = [(*chosen[:slot], i, *chosen[slot + 1:]) for i in range(len(problem.places))]
        options = [each for each in options if each != tuple(chosen) and problem.fits(each)]
        if not options or still == len(chosen):
            break
        scores = problem.scores(options)
        best = _first_best(scores)
        evaluated += len(options)
        if scores[best] < score * (1 - SAME):
            chosen, score, still = list(options[best]), float(scores[best]), 0
        else:
            still += 1
    return Choice(tuple(chosen), score, "greedy with exchange", evaluated)


def submodular_bound(problem, placement):
    """A score that no placement of as many sensors is below (gramian, logdet).

    f is monotone and submodular (also where a link carries one only): f(best) <= f(S) + sum of the largest gains at S, and
    f(best) <= f(empty) + (f(greedy) - f(empty)) / (1 - 1/e) for a greedy S.
    """
    if (problem.measure, problem.criterion) != ("gramian", "logdet"):
        raise ValueError("only logdet of the Gramian is submodular")
    here = float(problem.information(problem.scores([placement]))[0])
    rest = [i for i in range(len(problem.places)) if i not in placement]
    gains = problem.information(problem.scores([(*placement, i) for i in rest])) - here
    most = here + np.sort(gains)[::-1][:len(placement)].sum()
    return float(math.exp(-most / len(problem.scale)))


def place(problem, count, limit=600):
    """The best placement of `count` sensors: of all where there are at most `limit`, else greedy
    with exchange, for each number up to count: a list of Choice."""
    if count > problem.most():
        raise InputError(f"--count: {count} sensors, there is room for {problem.most()}")
    found, start = [], ()
    for size in range(1, count + 1):
        if math.comb(len(problem.places), size) <= limit:
            best = exhaustive(problem, size)
        else:
            best = exchange(problem, greedy(problem, size, start))
            if (problem.measure, problem.criterion) == ("gramian", "logdet"):
                best.bound = submodular_bound(problem, best.placement)
        found.append(best)
        start = best.placement
    return found
