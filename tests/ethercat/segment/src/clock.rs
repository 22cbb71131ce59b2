//! The clock of one slave: it drifts, and follows the time of a reference clock when a master sends
//! it around. Times in ns.

/// Time that a frame takes from one slave to the next, in ns.
pub const HOP_NS: u64 = 345;
const FOLLOWED_SHARE: i64 = 4; // of a difference, at each correction

pub struct Clock {
    start_ns: u64,
    drift_ppm: f64,
    correction_ns: i64,
    difference_ns: i64,
    hops_before: u64,
    hops_behind: u64,
}

impl Clock {
    /// A clock of the slave at this position of the line.
    pub fn new(position: usize, drift_ppm: f64) -> Clock {
        Clock {
            // when slaves were switched on: differs by more than 32 bits
            start_ns: 10_000_000_000 + position as u64 * 7_000_000_007,
            drift_ppm,
            correction_ns: 0,
            difference_ns: 0,
            hops_before: position as u64,
            hops_behind: 0,
        }
    }

    /// How many slaves stand behind this one; 0: its second port is open.
    pub fn set_hops_behind(&mut self, hops: usize) {
        self.hops_behind = hops as u64;
    }

    /// Local time at an instant of the simulation.
    pub fn at(&self, real_ns: u64) -> u64 {
        let drift_ns = (real_ns as f64 * self.drift_ppm * 1e-6) as i64;
        (self.start_ns + real_ns).wrapping_add_signed(drift_ns + self.correction_ns)
    }

    /// Local time when a frame that left the master at `now_ns` passes.
    pub fn local_ns(&self, now_ns: u64) -> u64 {
        self.at(now_ns + self.hops_before * HOP_NS)
    }

    /// Local times at which a frame passes on its way out, and back where slaves stand behind.
    pub fn receive_times(&self, now_ns: u64) -> (u64, Option<u64>) {
        let out_ns = now_ns + self.hops_before * HOP_NS;
        let back_ns = out_ns + 2 * self.hops_behind * HOP_NS;
        (self.at(out_ns), (self.hops_behind > 0).then(|| self.at(back_ns)))
    }

    /// Moves the clock a little towards the reference; `difference_ns`: how far it is ahead.
    pub fn follow(&mut self, difference_ns: i32) {
        self.difference_ns = i64::from(difference_ns);
        self.correction_ns -= self.difference_ns / FOLLOWED_SHARE;
    }

    pub fn forget_difference(&mut self) {
        self.difference_ns = 0;
    }

    /// The last difference as its register shows it: sign and magnitude.
    pub fn difference_register(&self) -> u32 {
        let magnitude = self.difference_ns.unsigned_abs() as u32 & 0x7FFF_FFFF;
        magnitude | if self.difference_ns < 0 { 0x8000_0000 } else { 0 }
    }
}
