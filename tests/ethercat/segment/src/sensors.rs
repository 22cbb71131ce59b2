//! Slaves that measure: an inertial unit, a force and torque sensor, and digital inputs and outputs.

use crate::device::{common_objects, Device};
use crate::dictionary::{
    Access, Dictionary, Mapped, PdoEntry, INPUT_ASSIGNMENT, OUTPUT_ASSIGNMENT,
};
use crate::plant::{Demand, Part, Sensed};

const VALUES: u16 = 0x6000; // six, 32 bit with sign
const STATUS: u16 = 0x6010;
const COUNTER: u16 = 0x6020;

/// Six values with a scale, a status word and a counter of samples.
pub struct Sensor {
    objects: Dictionary,
    channels: &'static [&'static str],
    per_unit: [f64; 6],
    is_broken: bool,
}

impl Sensor {
    /// Accelerations in 1e-4 m/s^2 and rates in 1e-6 rad/s.
    pub fn inertial(name: &str, identity: [u32; 4]) -> Sensor {
        let channels = &["ax", "ay", "az", "wx", "wy", "wz"];
        Sensor::new(name, identity, channels, [1e4, 1e4, 1e4, 1e6, 1e6, 1e6])
    }

    /// Forces in 1e-6 N and torques in 1e-6 Nm.
    pub fn force(name: &str, identity: [u32; 4]) -> Sensor {
        Sensor::new(name, identity, &["fx", "fy", "fz", "tx", "ty", "tz"], [1e6; 6])
    }

    fn new(
        name: &str,
        identity: [u32; 4],
        channels: &'static [&'static str],
        per_unit: [f64; 6],
    ) -> Sensor {
        let mut objects = common_objects(0, name, identity);
        objects.add(VALUES, 0, &[6], Access::ReadOnly, Mapped::Never);
        let mut entries = Vec::new();
        for subindex in 1..=6 {
            objects.add(VALUES, subindex, &[0; 4], Access::ReadOnly, Mapped::AsInput);
            entries.push(PdoEntry { index: VALUES, subindex, bits: 32 });
        }
        for index in [STATUS, COUNTER] {
            objects.add(index, 0, &[0; 4], Access::ReadOnly, Mapped::AsInput);
            entries.push(PdoEntry { index, subindex: 0, bits: 32 });
        }
        objects.add_pdo(0x1A00, &entries);
        objects.add_assignment(OUTPUT_ASSIGNMENT, &[]);
        objects.add_assignment(INPUT_ASSIGNMENT, &[0x1A00]);
        Sensor { objects, channels, per_unit, is_broken: false }
    }
}

impl Device for Sensor {
    fn objects(&self) -> &Dictionary {
        &self.objects
    }
    fn objects_mut(&mut self) -> &mut Dictionary {
        &mut self.objects
    }
    fn step(&mut self, _pulses_ns: Option<u32>) {
        if !self.is_broken {
            let counter = self.objects.get(COUNTER, 0) as u32;
            self.objects.set(COUNTER, 0, i64::from(counter.wrapping_add(1)));
        }
    }
    fn channels(&self) -> &'static [&'static str] {
        self.channels
    }
    fn set_channel(&mut self, channel: usize, value: f64) {
        let raw = (value * self.per_unit[channel]).round();
        let raw = raw.clamp(f64::from(i32::MIN), f64::from(i32::MAX));
        self.objects.set(VALUES, channel as u8 + 1, raw as i64);
    }
    fn feel(&mut self, sensed: &Sensed) {
        let values = if self.channels[0] == "fx" { &sensed.wrench } else { &sensed.motion };
        for (channel, &value) in values.iter().enumerate() {
            self.set_channel(channel, value);
        }
    }
    // its status says so, and its counter of samples stands
    fn trip(&mut self, code: u16) -> bool {
        self.is_broken = code != 0;
        self.objects.set(STATUS, 0, i64::from(code));
        true
    }
    fn describe(&self) -> String {
        format!(",\"samples\":{}", self.objects.get(COUNTER, 0) as u32)
    }
}

const DIGITAL_INPUTS: u16 = 0x6100; // one bit per subindex
const DIGITAL_OUTPUTS: u16 = 0x7100;

/// Eight digital inputs and eight outputs, of a slave without mailbox.
pub struct DigitalIo {
    objects: Dictionary,
}

impl DigitalIo {
    pub fn new() -> DigitalIo {
        let mut objects = Dictionary::default();
        let entries = |index| (1..=8).map(move |subindex| PdoEntry { index, subindex, bits: 1 });
        for subindex in 1..=8 {
            objects.add(DIGITAL_INPUTS, subindex, &[0], Access::ReadOnly, Mapped::AsInput);
            objects.add(DIGITAL_OUTPUTS, subindex, &[0], Access::ReadOnly, Mapped::AsOutput);
        }
        objects.add_pdo(0x1600, &entries(DIGITAL_OUTPUTS).collect::<Vec<_>>());
        objects.add_pdo(0x1A00, &entries(DIGITAL_INPUTS).collect::<Vec<_>>());
        objects.add_assignment(OUTPUT_ASSIGNMENT, &[0x1600]);
        objects.add_assignment(INPUT_ASSIGNMENT, &[0x1A00]);
        DigitalIo { objects }
    }

    fn outputs(&self) -> u8 {
        (1..=8).fold(0, |all, i| all | ((self.objects.get(DIGITAL_OUTPUTS, i) as u8) << (i - 1)))
    }
}

impl Device for DigitalIo {
    fn objects(&self) -> &Dictionary {
        &self.objects
    }
    fn objects_mut(&mut self) -> &mut Dictionary {
        &mut self.objects
    }
    fn has_mailbox(&self) -> bool {
        false
    }
    fn step(&mut self, _pulses_ns: Option<u32>) {}
    fn stop(&mut self) {
        for subindex in 1..=8 {
            self.objects.set(DIGITAL_OUTPUTS, subindex, 0);
        }
    }
    // the reset button is its first output
    fn demand(&self) -> Option<Demand> {
        let is_pressed = self.objects.get(DIGITAL_OUTPUTS, 1) != 0;
        let target = if is_pressed { 1.0 } else { 0.0 };
        Some(Demand { part: Part::None, is_ready: true, is_following: true, target, speed: 0.0 })
    }
    fn feel(&mut self, sensed: &Sensed) {
        for (channel, &is_set) in sensed.switches.iter().enumerate() {
            self.set_channel(channel, f64::from(u8::from(is_set)));
        }
    }
    fn channels(&self) -> &'static [&'static str] {
        &["in1", "in2", "in3", "in4", "in5", "in6", "in7", "in8"]
    }
    fn set_channel(&mut self, channel: usize, value: f64) {
        self.objects.set(DIGITAL_INPUTS, channel as u8 + 1, i64::from(value != 0.0));
    }
    fn describe(&self) -> String {
        format!(",\"outputs\":{}", self.outputs())
    }
}
