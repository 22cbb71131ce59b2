"""Methods of bilateral control that are written in Python, in the benchmark's trials."""

import unittest

from hapticgiant import SetupError, teleoperation


class Leader:
    """Position-force: feels what the machine measures."""

    def __init__(self, config):
        self.starts = 0

    def start(self):
        self.starts += 1

    def step(self, port, arrived, is_new, packet):
        packet.wave = port.x
        return arrived.f


class Remote:
    def __init__(self, config):
        assert config.machine_stiffness > 0.0 and config.dt == 1e-3

    def start(self, x):
        self.x = x

    def step(self, port, arrived, is_new, packet):
        assert arrived.wave == arrived.x  # what the other half has put there
        return arrived.x, arrived.v, 0.0


class PlayGrid(unittest.TestCase):
    def play(self, leader=Leader, remote=Remote, **grid):
        grid = {"delays": [0.0], "losses": [0.0], "walls": [5e3], "hands": ["normal"]} | grid
        return teleoperation.play_grid(leader, remote, **grid)

    def test_position_force_in_python_is_position_force(self):
        (case,) = self.play()
        self.assertTrue(case.is_calm)
        self.assertEqual(case.peak_ratio, 1.0)
        self.assertEqual((case.delay, case.loss, case.wall, case.hand), (0.0, 0.0, 5e3, "normal"))

    def test_delay_makes_it_shake_and_create_energy(self):
        (case,) = self.play(delays=[0.05])
        self.assertFalse(case.is_calm)
        self.assertGreater(case.created_leader_W, 0.1)

    def test_what_the_leader_returns_is_felt(self):
        class Deaf(Leader):
            def step(self, port, arrived, is_new, packet):
                super().step(port, arrived, is_new, packet)
                return 0.0

        (case,) = self.play(leader=Deaf)
        self.assertEqual(case.regulation_ratio, 1.0)
        self.assertLess(self.play()[0].regulation_ratio, 0.5)

    def test_the_grid_is_the_product_of_what_is_given(self):
        cases = self.play(delays=[0.0, 0.02], hands=["normal", "stiff"])
        self.assertEqual([(case.delay, case.hand) for case in cases],
                         [(0.0, "normal"), (0.0, "stiff"), (0.02, "normal"), (0.02, "stiff")])

    def test_errors_of_a_method_end_the_trials(self):
        class Broken(Leader):
            def step(self, port, arrived, is_new, packet):
                raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            self.play(leader=Broken)
        with self.assertRaises(TypeError):
            self.play(remote=lambda config: None, leader=lambda: None)

        class NotATarget(Remote):
            def step(self, port, arrived, is_new, packet):
                return 0.0

        with self.assertRaises(TypeError):
            self.play(remote=NotATarget)

    def test_unknown_hands_and_impossible_links_are_refused(self):
        with self.assertRaisesRegex(SetupError, "stiff"):
            self.play(hands=["stif"])
        with self.assertRaisesRegex(SetupError, "delay"):
            self.play(delays=[-1.0])


if __name__ == "__main__":
    unittest.main()
