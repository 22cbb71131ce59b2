"""Statistics of `hapticgiant study` against published data and R.

The expected values are what R 4.2.2 and lme4 1.1-31 print for the same data, so that the test needs
no R; the call stands at each. Data: sleep (Student, Biometrika 6, 1908), rounding times (Hollander
and Wolfe, Nonparametric Statistical Methods, 1973, p. 140), Hamilton depression (the same, p. 29),
warpbreaks (Tippett, Technological Applications of Statistics, 1950), Machines (Milliken and Johnson,
Analysis of Messy Data, 1992; the mixed model of Pinheiro and Bates, 2000), sleepstudy (Belenky et al.,
Journal of Sleep Research 12, 2003).
"""

import itertools
import types
import unittest
import warnings

import numpy as np
from scipy import stats

import without_compiled_part  # noqa: F401
from hapticgiant.study import analysis, inference

SLEEP = ([0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0],
         [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4])
DEPRESSION = ([0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29],
              [1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30])
ROUNDING = np.array([
    5.40, 5.50, 5.55, 5.85, 5.70, 5.75, 5.20, 5.60, 5.50, 5.55, 5.50, 5.40, 5.90, 5.85, 5.70, 5.45,
    5.55, 5.60, 5.40, 5.40, 5.35, 5.45, 5.50, 5.35, 5.25, 5.15, 5.00, 5.85, 5.80, 5.70, 5.25, 5.20,
    5.10, 5.65, 5.55, 5.45, 5.60, 5.35, 5.45, 5.05, 5.00, 4.95, 5.50, 5.50, 5.40, 5.45, 5.55, 5.50,
    5.55, 5.55, 5.35, 5.45, 5.50, 5.55, 5.50, 5.45, 5.25, 5.65, 5.60, 5.40, 5.70, 5.65, 5.55, 6.30,
    6.30, 6.25]).reshape(22, 3)
BREAKS = np.array([
    26, 30, 54, 25, 70, 52, 51, 26, 67, 18, 21, 29, 17, 12, 18, 35, 30, 36,
    36, 21, 24, 18, 10, 43, 28, 15, 26, 27, 14, 29, 19, 29, 31, 41, 20, 44,
    42, 26, 19, 16, 39, 28, 21, 39, 29, 20, 21, 24, 17, 13, 15, 15, 16, 28])
WOOL, TENSION = "A" * 27 + "B" * 27, ("L" * 9 + "M" * 9 + "H" * 9) * 2
MACHINES = np.array([  # three machines, six workers, three scores
    52.0, 52.8, 53.1, 51.8, 52.8, 53.1, 60.0, 60.2, 58.4, 51.1, 52.3, 50.3, 50.9, 51.8, 51.4, 46.4,
    44.8, 49.2, 62.1, 62.6, 64.0, 59.7, 60.0, 59.0, 68.6, 65.8, 69.7, 63.2, 62.8, 62.2, 64.8, 65.0,
    65.4, 43.7, 44.2, 43.0, 67.5, 67.2, 66.9, 61.5, 61.7, 62.3, 70.8, 70.6, 71.0, 64.1, 66.2, 64.0,
    72.1, 72.0, 71.1, 62.0, 61.4, 60.5])
SLEEPSTUDY = np.array([  # 18 people, days 0 to 9, ms
    [249.56, 258.7047, 250.8006, 321.4398, 356.8519, 414.6901, 382.2038, 290.1486, 430.5853, 466.3535],
    [222.7339, 205.2658, 202.9778, 204.707, 207.7161, 215.9618, 213.6303, 217.7272, 224.2957, 237.3142],
    [199.0539, 194.3322, 234.32, 232.8416, 229.3074, 220.4579, 235.4208, 255.7511, 261.0125, 247.5153],
    [321.5426, 300.4002, 283.8565, 285.133, 285.7973, 297.5855, 280.2396, 318.2613, 305.3495, 354.0487],
    [287.6079, 285, 301.8206, 320.1153, 316.2773, 293.3187, 290.075, 334.8177, 293.7469, 371.5811],
    [234.8606, 242.8118, 272.9613, 309.7688, 317.4629, 309.9976, 454.1619, 346.8311, 330.3003, 253.8644],
    [283.8424, 289.555, 276.7693, 299.8097, 297.171, 338.1665, 332.0265, 348.8399, 333.36, 362.0428],
    [265.4731, 276.2012, 243.3647, 254.6723, 279.0244, 284.1912, 305.5248, 331.5229, 335.7469, 377.299],
    [241.6083, 273.9472, 254.4907, 270.8021, 251.4519, 254.6362, 245.4523, 235.311, 235.7541, 237.2466],
    [312.3666, 313.8058, 291.6112, 346.1222, 365.7324, 391.8385, 404.2601, 416.6923, 455.8643, 458.9167],
    [236.1032, 230.3167, 238.9256, 254.922, 250.7103, 269.7744, 281.5648, 308.102, 336.2806, 351.6451],
    [256.2968, 243.4543, 256.2046, 255.5271, 268.9165, 329.7247, 379.4445, 362.9184, 394.4872, 389.0527],
    [250.5265, 300.0576, 269.8939, 280.5891, 271.8274, 304.6336, 287.7466, 266.5955, 321.5418, 347.5655],
    [221.6771, 298.1939, 326.8785, 346.8555, 348.7402, 352.8287, 354.4266, 360.4326, 375.6406, 388.5417],
    [271.9235, 268.4369, 257.2424, 277.6566, 314.8222, 317.2135, 298.1353, 348.1229, 340.28, 366.5131],
    [225.264, 234.5235, 238.9008, 240.473, 267.5373, 344.1937, 281.1481, 347.5855, 365.163, 372.2288],
    [269.8804, 272.4428, 277.8989, 281.7895, 279.1705, 284.512, 259.2658, 304.6306, 350.7807, 369.4692],
    [269.4117, 273.474, 297.5968, 310.6316, 287.1726, 329.6076, 334.4818, 343.2199, 369.1417, 364.1236],
])


class Paired(unittest.TestCase):
    def test_student_1908(self):
        """t.test(group 2, group 1, paired = TRUE)"""
        found = inference.paired_t(*SLEEP)
        self.assertAlmostEqual(found.value, 4.0621277, 6)
        self.assertEqual(found.df, 9)
        self.assertAlmostEqual(found.p, 0.00283289, 8)
        self.assertAlmostEqual(found.estimate, 1.58, 12)
        self.assertAlmostEqual(found.low, 0.7001142367, 9)
        self.assertAlmostEqual(found.high, 2.4598857633, 9)
        self.assertAlmostEqual(found.size, 4.0621277 / np.sqrt(10), 6)

    def test_signed_ranks_with_ties(self):
        """wilcox.test(group 2, group 1, paired = TRUE, exact = FALSE)"""
        found = inference.wilcoxon(*SLEEP, is_exact=False)
        self.assertEqual(found.value, 45)
        self.assertAlmostEqual(found.p, 0.009090698, 9)

    def test_signed_ranks_exact(self):
        """wilcox.test(x, y, paired = TRUE, conf.int = TRUE), the example of ?wilcox.test"""
        found = inference.wilcoxon(*DEPRESSION)
        self.assertEqual(found.value, 40)
        self.assertAlmostEqual(found.p, 0.0390625, 12)
        self.assertAlmostEqual(found.estimate, 0.46, 9)
        self.assertAlmostEqual(found.low, 0.010, 9)
        self.assertAlmostEqual(found.high, 0.786, 9)

    def test_ties_are_those_of_the_data_and_not_of_rounding(self):
        """Means of six scales of 5, as the raw TLX: differences are whole sixths, so that six times the data have the
        same ranks; also for two groups and for three conditions."""
        dice = np.random.default_rng(0)
        for _ in range(40):
            sums = dice.integers(0, 21, (3, 12, 6)) * 5.0
            means = np.array([[sum(row.tolist()) / 6 for row in group] for group in sums])
            a, b, c = sums.sum(axis=2)
            for found, wanted in ((inference.wilcoxon(*means[:2]), inference.wilcoxon(a, b)),
                                  (inference.mann_whitney(*means[:2]), inference.mann_whitney(a, b)),
                                  (inference.friedman(dict(zip("abc", means + 0.1 + 0.2))),
                                   inference.friedman(dict(zip("abc", (a, b, c)))))):
                self.assertAlmostEqual(found.value, wanted.value, 9)
                self.assertAlmostEqual(found.p, wanted.p, 12)

    def test_ties_are_exact_over_all_signs(self):
        """Ties and zeros: the share of all 2^n signs of the ranks that are as far from the middle, and never below the
        least p of the plan; five answers that all differ by the same step give 2 / 2^5."""
        self.assertEqual(inference.wilcoxon([4] * 5, [5] * 5).p, 0.0625)
        dice = np.random.default_rng(1)
        for difference in ([1] * 4, [1] * 6, [1] * 7 + [-1], [1, 1, 1, 1, 2], [1, 1, 1, 1, 1, 0, 0],
                           *(dice.integers(-3, 6, count) for count in range(2, 11) for _ in range(5))):
            kept = np.array(difference, float)[np.array(difference) != 0]
            ranks = stats.rankdata(abs(kept))
            v, middle = ranks[kept > 0].sum(), ranks.sum() / 2
            sums = [sum(itertools.compress(ranks, signs)) for signs in itertools.product((0, 1), repeat=len(kept))]
            found = inference.wilcoxon(np.full(len(difference), 4.0), np.array(difference) + 4.0).p
            self.assertAlmostEqual(found, np.mean([abs(each - middle) >= abs(v - middle) for each in sums]), 12)
            self.assertGreaterEqual(found, inference.least_p("wilcoxon", [len(difference)]))

    def test_pairs_that_count_and_ties_are_reported(self):
        """pingouin 0.7.0 leaves zeros out, too: wilcoxon(SLEEP) RBC = 1.0, of the depression data 0.777778. V and p of
        wilcox.exact() of R's exactRankTests 0.8-35."""
        found = inference.wilcoxon(*SLEEP)
        self.assertEqual((found.counted, found.value, found.p, found.size), ("9 of 10", 45, 0.00390625, 1))
        self.assertEqual(found.note, "1 of 10 pairs do not differ and are left out: 9 count; 2 of 9 differences share a rank")
        found = inference.wilcoxon(*DEPRESSION)
        self.assertEqual((found.counted, found.note), ("9 of 9", ""))
        self.assertAlmostEqual(found.size, 0.777778, 6)
        # pvalue(wilcoxsign_test(distribution = "exact", zero.method = "Wilcoxon")) of R's coin 1.4-2
        found = inference.wilcoxon([3, 4, 3, 3, 4, 3, 3, 2, 4], [4, 4, 5, 3, 5, 6, 2, 4, 5])
        self.assertEqual((found.counted, found.p), ("7 of 9", 0.078125))

    def test_the_interval_is_that_of_the_test(self):
        """It has the shifts that the test does not reject, whatever ties and zeros; 0 is one of them where p >= alpha."""
        dice = np.random.default_rng(4)
        for _ in range(150):
            people = dice.integers(6, 14)
            a, b, c = (dice.integers(1, 9, count).astype(float) for count in (people, people, dice.integers(4, 9)))
            kept = (b - a)[b != a]
            for found, p_of, shifts in (
                    (inference.wilcoxon(a, b), lambda shift: inference.signed_rank_p(kept - shift), np.add.outer(kept, kept) / 2),
                    (inference.mann_whitney(a, c), lambda shift: inference.rank_sum_p(a, c - shift), np.subtract.outer(c, a))):
                edges = np.unique(shifts)
                for shift in [edges[0] - 1, *(edges[1:] + edges[:-1]) / 2, edges[-1] + 1]:
                    self.assertEqual(found.low < shift < found.high, p_of(shift) >= 0.05, (a, b, c, shift))
                is_above = found.low < 0 or found.low == 0 and found.open_end != "low"
                is_below = found.high > 0 or found.high == 0 and found.open_end != "high"
                self.assertEqual(is_above and is_below, found.p >= 0.05, (a, b, c))
                self.assertTrue(found.open_end == "" or found.p < 0.05, (a, b, c))
                self.assertTrue(found.low <= found.estimate <= found.high)

    def test_an_end_at_a_0_that_is_rejected_is_printed_as_open(self):
        """Ratings of 7 points: a Walsh average, or a difference of two people, is 0 where p begins to reject."""
        plan = types.SimpleNamespace(plan={"alpha": 0.05, "correction": "none"})
        for test, a, b, high in (("wilcoxon", [1, 4, 4, 5, 4, 2, 6, 6], [2, 6, 6, 7, 7, 1, 7, 7], "2.5"),
                                 ("mann_whitney", [1, 2, 2, 6, 2, 7, 2], [3, 6, 7, 4, 7, 7, 6], "5")):
            people = [*range(len(a))] * 2 if test == "wilcoxon" else range(2 * len(a))
            for values, wanted in (([*a, *b], f"above 0 to {high}"), ([*b, *a], f"-{high} to below 0")):
                found = inference.run(test, values, ["x"] * len(a) + ["y"] * len(a), people)
                self.assertLess(found.p, 0.05)
                self.assertEqual(analysis.pair_rows(plan, [("rating", found, found.p)])[1][4], wanted)
        self.assertEqual(analysis.interval(-0.0, 2), "0 to 2")
        self.assertEqual(analysis.interval(0, np.inf, "low"), "above 0 to no end")

    def test_an_end_is_moved_to_a_0_that_is_rejected(self):
        """Where p falls at 0 and rises again beyond, the end on the other side of the estimate is an open 0."""
        for p, estimate, wanted in ((0.04, 1.0, (0, 3, "low")), (0.04, -1.0, (-2, 0, "high")), (0.05, 1.0, (-2, 3, ""))):
            found = inference.not_rejected(np.array([-2.0, -1.0, 1.0, 3.0]), lambda shift: 0.06 if -2 < shift < 3 else 0.01,
                                           p, estimate, 0.05)
            self.assertEqual(found, wanted)

    def test_no_difference_at_all_is_no_error(self):
        self.assertEqual(inference.wilcoxon([1, 2, 3], [1, 2, 3]).p, 1)
        self.assertEqual(inference.paired_t([1, 2, 3], [1, 2, 3]).p, 1)


class FewPeople(unittest.TestCase):
    def test_ties_of_two_groups_are_exact(self):
        """All choices of the ranks; three equal answers against three higher ones give 2 / 20."""
        self.assertAlmostEqual(inference.mann_whitney([1] * 3, [2] * 3).p, 0.1, 12)
        dice = np.random.default_rng(2)
        for sizes in ((2, 3), (4, 4), (3, 6), (5, 2)):
            for _ in range(10):
                a, b = (dice.integers(1, 5, size).astype(float) for size in sizes)
                ranks = stats.rankdata([*a, *b])
                sums = np.array([sum(each) for each in itertools.combinations(ranks, len(a))])
                at = ranks[:len(a)].sum()
                wanted = min(1.0, 2 * min(np.mean(sums <= at), np.mean(sums >= at)))
                self.assertAlmostEqual(inference.mann_whitney(a, b).p, wanted, 12)

    def test_two_groups_exact(self):
        """wilcox.test(A, B, conf.int = TRUE), permeability data of ?wilcox.test (Hollander and Wolfe, p. 69)"""
        a = [1.15, 0.88, 0.90, 0.74, 1.21]
        found = inference.mann_whitney(a, [0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46])
        self.assertEqual((found.value, found.counted), (35, "5 + 10"))
        for value, wanted in ((found.p, 0.2544), (found.estimate, 0.305), (found.low, -0.15), (found.high, 0.76)):
            self.assertAlmostEqual(value, wanted, 4)

    def test_an_interval_that_few_people_cannot_have_has_no_ends(self):
        found = inference.wilcoxon([1, 2, 3, 4], [6, 8, 10, 12])
        self.assertEqual((found.low, found.high, found.estimate), (-np.inf, np.inf, 6.5))
        self.assertEqual(analysis.interval(found.low, found.high), "none")
        found = inference.run("wilcoxon", [1, 2, 3, 4, 5, 6, 1, 2, 5, 7, 9, 11], list("aaaaaabbbbbb"), [*range(6)] * 2)
        self.assertIn("with 4 pairs that differ no p below 0.125", found.notes[0])

    def test_the_least_p_of_ranks_is_reported(self):
        """wilcox.test(1:3, 4:6)$p.value is 0.1; of four differences above 0 it is 0.125"""
        found = inference.run("mann_whitney", [1, 2, 3, 4, 5, 6], list("aaabbb"), range(6))
        self.assertAlmostEqual(found.p, 0.1, 12)
        self.assertIn("with 6 people no p below 0.1 can come out", found.notes[0])
        self.assertFalse(inference.run("mann_whitney", [1, 2, 3, 4, 5, 6, 7, 8], list("aaaabbbb"), range(8)).notes)
        found = inference.run("wilcoxon", [1, 2, 3, 4, 6, 8, 10, 12], list("aaaabbbb"), [*range(4)] * 2)
        self.assertAlmostEqual(found.p, 0.125, 12)
        self.assertIn("no p below 0.125", found.notes[0])

    def test_nothing_warns(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for values in ([1, 2, 3, 4, 5, 7], [1, 1, 1, 1, 1, 2], [1, 1, 2, 2, 3, 4], [1, 1, 1, 1, 1, 1]):
                for test in ("anova", "kruskal", "welch_t", "mann_whitney"):
                    try:
                        inference.run(test, values, list("aabbcc" if test in ("anova", "kruskal") else "aaabbb"), range(6))
                    except ValueError:
                        pass
                for test in ("paired_t", "wilcoxon", "mixed", "friedman"):
                    try:
                        inference.run(test, values, list("ababab"), [1, 1, 2, 2, 3, 3])
                    except ValueError:
                        pass


class Friedman(unittest.TestCase):
    def test_rounding_first_base(self):
        """friedman.test(RoundingTimes); pairwise.wilcox.test(paired, exact = FALSE, digits.rank = 7, holm): without
        digits.rank, R's ranks depend on how 5.40 - 5.50 is rounded"""
        found = inference.friedman(dict(zip("123", ROUNDING.T)), is_exact=False)
        self.assertAlmostEqual(found.value, 11.142857, 6)
        self.assertEqual(found.df, (2,))
        self.assertAlmostEqual(found.p, 0.003805041, 9)
        adjusted = {each.first + each.second: each.p_adjusted for each in found.comparisons}
        for pair, p in (("12", 0.4489622), ("13", 0.0374263), ("23", 0.0051196)):
            self.assertAlmostEqual(adjusted[pair], p, 6, pair)

    def test_holm(self):
        """p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm")"""
        np.testing.assert_allclose(inference.adjusted([0.01, 0.04, 0.03, 0.005], "holm"),
                                   [0.03, 0.06, 0.06, 0.02])


class Groups(unittest.TestCase):
    def by(self, labels):
        names = list(dict.fromkeys(labels))
        return {name: BREAKS[np.array(list(labels)) == name] for name in names}

    def test_anova_and_kruskal(self):
        """aov(breaks ~ tension), kruskal.test(breaks ~ tension), pairwise.t.test(pool.sd = FALSE)"""
        found = inference.between(self.by(TENSION), "anova")
        self.assertAlmostEqual(found.value, 7.20611, 5)
        self.assertEqual(found.df, (2, 51))
        self.assertAlmostEqual(found.p, 0.0017528, 7)
        np.testing.assert_allclose([each.p_adjusted for each in found.comparisons],
                                   [0.0650496, 0.0069804, 0.1145571], atol=1e-7)
        found = inference.between(self.by(TENSION), "kruskal")
        self.assertAlmostEqual(found.value, 10.809265, 6)
        self.assertAlmostEqual(found.p, 0.004495706, 9)

    def test_two_groups(self):
        """t.test(breaks ~ wool), wilcox.test(breaks ~ wool, exact = FALSE); R: first minus second"""
        wool = self.by(WOOL)
        found = inference.welch_t(wool["A"], wool["B"])
        self.assertAlmostEqual(-found.value, 1.6335371, 6)
        self.assertAlmostEqual(found.df, 42.005548, 5)
        self.assertAlmostEqual(found.p, 0.1098303, 7)
        self.assertAlmostEqual(-found.high, -1.360096085, 8)
        self.assertAlmostEqual(-found.low, 12.915651640, 8)
        found = inference.mann_whitney(wool["A"], wool["B"], is_exact=False)
        self.assertEqual(27 * 27 - found.value, 431)
        self.assertAlmostEqual(found.p, 0.2530851, 7)
        self.assertEqual(found.estimate, -4)
        self.assertEqual((-found.high, -found.low), (-3, 10))
        self.assertAlmostEqual(found.size, -0.182442, 6)  # RBC of pingouin 0.7.0: mwu(B, A)


class ByName(unittest.TestCase):
    """What the report calls gives the same as the tests above, and takes means of repeated trials."""

    def test_each_test(self):
        people = np.tile(np.arange(22), 3)
        found = inference.run("friedman", ROUNDING.T.ravel(), np.repeat(list("123"), 22), people)
        self.assertAlmostEqual(found.value, 11.142857, 6)
        for name, value in (("anova", 7.20611), ("kruskal", 10.809265)):
            found = inference.run(name, BREAKS, list(TENSION), range(54))
            self.assertAlmostEqual(found.value, value, 5)
        for name, value in (("welch_t", -1.6335371), ("mann_whitney", 27 * 27 - 431)):
            self.assertAlmostEqual(inference.run(name, BREAKS, list(WOOL), range(54)).value, value, 6)
        values, conditions = np.concatenate(SLEEP), ["a"] * 10 + ["b"] * 10
        for name, value in (("paired_t", 4.0621277), ("wilcoxon", 45)):
            self.assertAlmostEqual(inference.run(name, values, conditions, [*range(10)] * 2).value, value, 6)
        twice = np.concatenate([values - 1, values + 1])
        found = inference.run("paired_t", twice, conditions * 2, [*range(10)] * 4)
        self.assertAlmostEqual(found.value, 4.0621277, 6)
        self.assertIn("a person's trials of a condition are averaged", found.notes)

    def test_a_person_without_a_condition_is_left_out_and_reported(self):
        values, conditions = np.concatenate([*SLEEP, [9.0]]), ["a"] * 10 + ["b"] * 11
        found = inference.run("paired_t", values, conditions, [*range(10), *range(10), 10])
        self.assertAlmostEqual(found.value, 4.0621277, 6)
        self.assertIn("1 people without values in every condition are left out", found.notes)


class Mixed(unittest.TestCase):
    def test_trials_that_repeat(self):
        """lmer(score ~ 0 + Machine + (1 | Worker) + (1 | Worker:Machine)); F: aov(score ~ Machine +
        Error(Worker / Machine))"""
        machines, workers = np.repeat(list("ABC"), 18), np.tile(np.repeat(range(6), 3), 3)
        found = inference.mixed(MACHINES, machines, workers)
        self.assertAlmostEqual(found.variances["person"], 22.858444523, 2)
        self.assertAlmostEqual(found.variances["person x condition"], 13.909456853, 2)
        self.assertAlmostEqual(found.variances["rest"], 0.924629628, 4)
        self.assertAlmostEqual(found.value, 20.57608, 2)
        self.assertEqual(found.df, (2, 10))
        self.assertAlmostEqual(found.p, 0.00028555, 6)
        gaps = {each.first + each.second: each.estimate for each in found.comparisons}
        self.assertAlmostEqual(gaps["AB"], 60.32222222 - 52.35555556, 6)
        self.assertAlmostEqual(gaps["AC"], 66.27222222 - 52.35555556, 6)
        # what the power analysis uses is the same for balanced data
        means = MACHINES.reshape(3, 6, 3).mean(axis=2).T
        f, df, p = inference.repeated_anova(means)
        self.assertAlmostEqual(f, 20.57608, 5)
        self.assertAlmostEqual(p, 0.00028555, 8)

    def test_one_value_of_each(self):
        """lmer(Reaction ~ 0 + factor(Days) + (1 | Subject)); aov(Reaction ~ Days + Error(Subject / Days))"""
        days, people = np.tile(range(10), 18), np.repeat(range(18), 10)
        found = inference.mixed(SLEEPSTUDY.ravel(), days, people)
        self.assertAlmostEqual(found.variances["person"] / 1375.4653313, 1, 4)
        self.assertAlmostEqual(found.variances["rest"] / 987.5884867, 1, 4)
        self.assertAlmostEqual(found.value, 18.7027, 3)
        self.assertEqual(found.df, (9, 153))
        first = found.comparisons[0]
        self.assertAlmostEqual(first.estimate, 264.4957556 - 256.6518056, 4)

    def test_people_who_do_not_differ(self):
        """One value of each: F of aov(y ~ condition + Error(person / condition)) where the variance is above 0."""
        dice = np.random.default_rng(3)
        people, conditions = np.repeat(range(12), 3), np.tile(list("abc"), 12)
        for share in [0] * 10 + [0.2] * 10 + [0.5] * 10:
            table = dice.standard_normal((12, 3)) * np.sqrt(1 - share) + dice.standard_normal((12, 1)) * np.sqrt(share)
            found = inference.run("mixed", table.ravel(), conditions, people)
            self.assertIn("residuals", found.assumptions[0])
            if found.variances["person"] > 0:
                self.assertAlmostEqual(found.value / inference.repeated_anova(table)[0], 1, 6)
            else:  # one-way analysis of variance
                self.assertAlmostEqual(found.value, inference.between(dict(zip("abc", table.T)), "anova").value, 9)

    def test_trials_that_are_missing(self):
        """lmer(score ~ Machine + (1 | Worker) + (1 | Worker:Machine)) without rows 1, 6, 21, 22, 23, 41; anova() of it"""
        machines, workers = np.repeat(list("ABC"), 18), np.tile(np.repeat(range(6), 3), 3)
        kept = np.delete(np.arange(54), [0, 5, 20, 21, 22, 40])
        found = inference.mixed(MACHINES[kept], machines[kept], workers[kept])
        self.assertAlmostEqual(found.variances["person"], 23.1434, 3)
        self.assertAlmostEqual(found.variances["person x condition"], 13.5254, 3)
        self.assertAlmostEqual(found.variances["rest"], 0.994813, 5)
        self.assertAlmostEqual(found.value, 21.02542, 4)
        self.assertAlmostEqual(found.comparisons[0].estimate, 7.768737, 5)

    def test_a_variance_of_zero(self):
        """lmer of means of workers, less the mean of each worker; trials give the same F, since they are balanced"""
        machines, workers = np.repeat(list("ABC"), 18), np.tile(np.repeat(range(6), 3), 3)
        scores = MACHINES - np.array([MACHINES[workers == each].mean() for each in range(6)])[workers]
        found = inference.mixed(scores.reshape(18, 3).mean(axis=1), machines[::3], workers[::3])
        self.assertEqual(found.variances["person"], 0)
        self.assertAlmostEqual(found.variances["rest"], 9.478444444, 6)
        self.assertAlmostEqual(found.value, 30.86412445, 5)
        self.assertIn("people do not differ in their mean (variance 0)", found.notes)
        self.assertAlmostEqual(inference.mixed(scores, machines, workers).value, 30.86412445, 4)

    def test_trials_that_are_all_the_same_count_once(self):
        """F of aov(y ~ condition + Error(person / condition)), as of one value of each"""
        table = np.array([[1, 2, 4], [4, 6, 5], [3, 3, 7], [2, 5, 6.0]])
        people, conditions = np.repeat(range(4), 6), np.tile(list("aabbcc"), 4)
        found = inference.mixed(np.repeat(table.ravel(), 2), conditions, people)
        self.assertAlmostEqual(found.value, inference.repeated_anova(table)[0], 6)
        self.assertIn("they count once", found.notes[0])

    def test_nothing_beside_people_and_conditions(self):
        with self.assertRaisesRegex(ValueError, "does not vary beside people and conditions"):
            inference.mixed([0.1, 1.1, 0.2, 1.2, 0.7, 1.7], list("ababab"), [1, 1, 2, 2, 3, 3])

    def test_what_cannot_be_tested_says_why(self):
        people, conditions = np.repeat(range(4), 4), ["a", "a", "b", "b"] * 4
        for test, people, message in (("mixed", people, "does not vary within"), ("mixed", [1] * 16, "fewer than two"),
                                      ("welch_t", range(16), "does not vary within"), ("anova", range(16), "does not vary")):
            with self.assertRaisesRegex(ValueError, message):
                inference.run(test, [0.1 + 0.2, 0.3, 6, 6] * 4, conditions, people)

    def test_a_value_that_is_no_number_gives_no_figure(self):
        for test in inference.TESTS:
            people = list(range(12)) if test in ("welch_t", "mann_whitney", "anova", "kruskal") else [i // 2 for i in range(12)]
            for wrong in (np.nan, np.inf, -np.inf, 1e308, 1e101):
                with self.assertRaisesRegex(ValueError, "is among the values", msg=test):
                    inference.run(test, [wrong, *range(11)], ["a", "b"] * 6, people)
            if test != "friedman":  # needs three conditions
                self.assertTrue(0 <= inference.run(test, [1e100, *range(11)], ["a", "b"] * 6, people).p <= 1, test)


if __name__ == "__main__":
    unittest.main()
