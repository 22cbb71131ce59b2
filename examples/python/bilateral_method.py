"""A method of bilateral control of one's own in the benchmark of teleoperation.

Springs and dampers at both ends (Nuno, Basanez, Ortega and Spong 2009): the springs pull each side
to where the other was when its packet left; with 4 b^2 > k^2 (T + T)^2, T each way, the dampers take
what the delay creates. Calm with any constant delay, and the slower the longer it is.
"""

from hapticgiant import teleoperation

STIFFNESS = 300.0  # N/m


def damping(config):
    """Ns/m, with a margin for what jitter and lost packets add to the delay."""
    return max(20.0, 1.5 * STIFFNESS * config.delay_s)


class Leader:
    def __init__(self, config):
        self.b = damping(config)

    def start(self):
        pass

    def step(self, port, arrived, is_new, packet):
        """Force on the leader, N."""
        return STIFFNESS * (arrived.x - port.x) - self.b * port.v


class Remote:
    def __init__(self, config):
        self.b = damping(config)

    def start(self, x):
        pass

    def step(self, port, arrived, is_new, packet):
        """Target of the machine's own spring and damper, here where it is, and a force."""
        return port.x, port.v, STIFFNESS * (arrived.x - port.x) - self.b * port.v


print(f"{'delay':>7} {'hand':>8} {'calm':>5} {'gives':>11} {'apart':>9} {'peak':>7} {'holds':>8}")
for case in teleoperation.play_grid(Leader, Remote, walls=[5000.0], losses=[0.1]):
    print(f"{1e3 * case.delay:4.0f} ms {case.hand:>8} {'yes' if case.is_calm else 'no':>5}"
          f" {1e3 * case.created_W:6.2f} mJ/s {1e3 * case.rest_offset:6.1f} mm"
          f" {case.peak_ratio:5.2f} x {case.regulation_rms:6.1f} N")
