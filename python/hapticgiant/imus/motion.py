"""Motions along which sensors are judged: sums of sines by seed, or a table of positions."""

from __future__ import annotations

import csv
import io
import dataclasses
import math

import numpy as np

from .chain import InputError

SINES = 3  # of each joint
FREQUENCIES_HZ = (0.3, 1.5)
SPEED_SHARE = 0.5  # of the speed that a joint may have
RANGE_SHARE = 0.8  # of the way to its nearer limit
FIT_S = 0.03  # length of the parabolas that are put through a table


@dataclasses.dataclass
class Motion:
    """q, dq, ddq, each (T, n), at a rate."""

    q: np.ndarray
    dq: np.ndarray
    ddq: np.ndarray
    rate_hz: float

    def __len__(self):
        return len(self.q)

    def scales(self):
        """(2 n) root mean squares of dq, then ddq; 1e-3 of the largest for what hardly moves."""
        sizes = [np.sqrt(np.mean(each ** 2, 0)) for each in (self.dq, self.ddq)]
        return np.concatenate([np.maximum(size, max(1e-3 * size.max(), 1e-6)) for size in sizes])


def sines(chain, seed, duration_s, rate_hz, centre=None):
    """Each joint moves as a sum of sines about `centre` (default: the middle of its range), within
    its positions and half of its speed."""
    random = np.random.default_rng(seed)
    low = np.array([max(joint.q_min, -math.pi if joint.unit == "rad" else -10)
                    for joint in chain.moving])
    high = np.array([min(joint.q_max, math.pi if joint.unit == "rad" else 10)
                     for joint in chain.moving])
    middle = (low + high) / 2 if centre is None else np.clip(centre, low, high)
    room = np.minimum(high - middle, middle - low)
    # a start at a limit moves about the middle of its half instead
    tight = room < 0.1 * (high - low)
    middle = np.where(tight, (middle + (low + high) / 2) / 2, middle)
    room = RANGE_SHARE * np.minimum(high - middle, middle - low)
    t = np.arange(int(round(duration_s * rate_hz)))[:, None, None] / rate_hz
    w = 2 * math.pi * random.uniform(*FREQUENCIES_HZ, (1, SINES, chain.n))
    phase = random.uniform(0, 2 * math.pi, w.shape)
    size = random.uniform(0.5, 1.0, w.shape) / w
    speed = SPEED_SHARE * np.array([joint.dq_max for joint in chain.moving])
    size *= np.minimum(room / size.sum(1), speed / (size * w).sum(1))[:, None]
    angle = w * t + phase
    return Motion(middle + (size * np.sin(angle)).sum(1), (size * w * np.cos(angle)).sum(1),
                  (-size * w * w * np.sin(angle)).sum(1), rate_hz)


def from_table(chain, file, rate_hz, names=None):
    """Motion of a CSV file with `time_s` and a column of positions (rad or m) for each joint, by the
    joint's name or by names[joint] (columns of `hapticgiant export`)."""
    names = names or {}
    try:
        with open(file, newline="", encoding="utf-8-sig") as stream:
            text = stream.read()
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: no text; expected CSV, as of hapticgiant export") from None
    # a spreadsheet writes the list separator and the decimal comma of its country
    separator = max(",;\t", key=text.partition("\n")[0].count)
    lines = list(csv.reader(io.StringIO(text, newline=""), delimiter=separator))
    header = lines[0] if lines else []
    columns = []
    for joint in ["time_s", *(joint.name for joint in chain.moving)]:
        known = [name for name in (joint, names.get(joint)) if name in header]
        if not known:
            also = f" or '{names[joint]}'" if joint in names else ""
            raise InputError(f"{file}:1: expected a column '{joint}'{also}")
        columns.append(header.index(known[0]))
    rows = []
    for number, line in enumerate(lines[1:], 2):
        try:
            row = [float(line[column] if separator == "," else line[column].replace(",", "."))
                   for column in columns]
        except (ValueError, IndexError):
            raise InputError(f"{file}:{number}: expected a number in each column of the motion") from None
        if not np.isfinite(row).all() or (rows and row[0] <= rows[-1][0]):
            raise InputError(f"{file}:{number}: expected finite numbers and increasing time_s")
        rows.append(row)
    table = np.array(rows)
    half = max(2, round(FIT_S * rate_hz))
    if len(table) < 2 or (table[-1, 0] - table[0, 0]) * rate_hz < 4 * half:
        raise InputError(f"{file}: expected at least {4 * half / rate_hz:g} s of motion")
    t = np.arange(table[0, 0], table[-1, 0], 1 / rate_hz)
    q = np.array([np.interp(t, table[:, 0], column) for column in table[:, 1:].T]).T
    # least squares with a polynomial of degree 4 about each sample
    steps = np.arange(-half, half + 1) / rate_hz
    weights = np.linalg.pinv(np.vander(steps, 5, increasing=True))
    fit = [np.array([np.convolve(column, weight[::-1], "valid") for column in q.T]).T
           for weight in weights[:3]]
    return Motion(fit[0], fit[1], 2 * fit[2], rate_hz)
