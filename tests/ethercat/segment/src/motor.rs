//! A motor with inertia, friction, a brake and a load, and the loops of its drive. SI units.

const INERTIA: f64 = 2e-4; // kg m^2, with what it drives
const VISCOUS: f64 = 1e-3; // Nm s/rad
const DRY: f64 = 0.01; // Nm
const BRAKE: f64 = 2.0; // Nm
const SPEED_GAIN: f64 = 400.0; // 1/s
const POSITION_GAIN: f64 = 100.0; // 1/s
const STEPS: u32 = 10; // in a period

/// What the drive wants of its motor in a period.
#[derive(Clone, Copy)]
pub enum Wish {
    Nothing,
    /// From one angle to the other within the period, in rad.
    Angle {
        from: f64,
        to: f64,
    },
    /// In rad/s.
    Speed(f64),
    /// In Nm.
    Torque(f64),
}

#[derive(Default)]
pub struct Motor {
    pub angle: f64,
    pub speed: f64,
    pub torque: f64,
    pub load: f64,
    pub brake_is_closed: bool,
    pub is_limited: bool,
}

impl Motor {
    /// Moves for a period in s; `offset` is added to the torque, `most` limits it.
    pub fn step(&mut self, wish: Wish, offset: f64, most: f64, period: f64) {
        let dt = period / f64::from(STEPS);
        self.is_limited = false;
        for i in 1..=STEPS {
            let share = f64::from(i) / f64::from(STEPS);
            let wanted = match wish {
                Wish::Nothing => 0.0,
                Wish::Torque(torque) => torque + offset,
                Wish::Speed(speed) => self.follow_speed(speed) + offset,
                Wish::Angle { from, to } => {
                    let lag = from + share * (to - from) - self.angle;
                    self.follow_speed((to - from) / period + POSITION_GAIN * lag) + offset
                }
            };
            self.torque = wanted.clamp(-most, most);
            self.is_limited |= self.torque != wanted;
            self.move_on(dt);
        }
    }

    fn follow_speed(&self, speed: f64) -> f64 {
        INERTIA * SPEED_GAIN * (speed - self.speed) + VISCOUS * speed
    }

    fn move_on(&mut self, dt: f64) {
        let free = self.speed + dt / INERTIA * (self.torque + self.load - VISCOUS * self.speed);
        // dry friction takes speed away, at most all of it
        let dry = DRY + if self.brake_is_closed { BRAKE } else { 0.0 };
        let taken = (dry * dt / INERTIA).min(free.abs());
        self.speed = free - taken.copysign(free);
        self.angle += self.speed * dt;
    }
}
