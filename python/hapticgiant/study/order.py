"""Orders of conditions: who plays what in which order, by a seed."""

from __future__ import annotations

import collections
import itertools
import math
import random

MOST_OF_A_FULL_ORDER = 6


def latin_square(count: int) -> list[list[int]]:
    """Rows in which each condition stands once at each place: a cyclic square."""
    return [[(row + column) % count for column in range(count)] for row in range(count)]


def williams(count: int) -> list[list[int]]:
    """A Latin square in which each condition also follows each other one equally often.

    Williams, Australian Journal of Scientific Research A 2, 1949: one square for an even count, a
    square and its mirror image for an odd one.
    """
    zigzag = [0]
    for i in range(1, count):
        zigzag.append((zigzag[-1] + (i if i % 2 else -i)) % count)
    rows = [[(entry + row) % count for entry in zigzag] for row in range(count)]
    return rows if count % 2 == 0 else rows + [row[::-1] for row in rows]


def full(count: int) -> list[list[int]]:
    """All orders."""
    return [list(row) for row in itertools.permutations(range(count))]


ORDERS = {"latin_square": latin_square, "williams": williams, "full": full,
          "block_random": None, "random": None}


def orders(design, count: int) -> list[list[int]]:
    """The conditions of each participant in their order, as numbers from 0 on.

    Rows of a square are given out in blocks, each shuffled by the seed, and its conditions are
    named at random, so that the first condition of study.yaml is not always the first of a row.
    block_random: within people each order is drawn, and the first conditions are balanced in
    blocks; between people each block has each condition once.
    """
    dice = random.Random(design.seed)
    names = list(range(count))
    dice.shuffle(names)
    found: list[list[int]] = []
    while len(found) < design.participants:
        if design.kind == "between":
            block = [[name] for name in names]
            if design.order == "random":
                block = [[dice.randrange(count)]]
        elif design.order == "random":
            block = [dice.sample(names, count)]
        elif design.order == "block_random":
            block = [[first, *dice.sample([n for n in names if n != first], count - 1)]
                     for first in names]
        else:
            block = [[names[entry] for entry in row] for row in ORDERS[design.order](count)]
        dice.shuffle(block)
        found += block
    return found[:design.participants]


def rows_of(design, count: int) -> int:
    """After how many participants the order is balanced again."""
    if design.kind == "between" or design.order in ("random", "block_random", "latin_square"):
        return count
    return math.factorial(count) if design.order == "full" else count * (1 + count % 2)


def imbalance(found: list[list[int]], count: int) -> tuple[int, int]:
    """Largest differences: how often conditions stand at a place, and how often one follows another.

    (0, 0) is balanced. Between people: how often each occurs, and 0.
    """
    places = collections.Counter((place, condition) for row in found
                                 for place, condition in enumerate(row))
    widest = max(map(len, found))
    by_place = [[places[place, condition] for condition in range(count)] for place in range(widest)]
    pairs = collections.Counter(pair for row in found for pair in itertools.pairwise(row))
    follows = [pairs[pair] for pair in itertools.permutations(range(count), 2)]
    return (max(max(row) - min(row) for row in by_place),
            max(follows) - min(follows) if widest > 1 else 0)
