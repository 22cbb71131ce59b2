//! What a slave is good for: its objects, what happens in a period, and values set by hand.

use crate::dictionary::{Abort, Access, Dictionary, Mapped};
use crate::plant::{Demand, Sensed};

pub trait Device {
    fn objects(&self) -> &Dictionary;
    fn objects_mut(&mut self) -> &mut Dictionary;
    fn has_mailbox(&self) -> bool {
        true
    }
    /// A period with new outputs; with sync pulses, their period in ns.
    fn step(&mut self, pulses_ns: Option<u32>);
    /// Outputs are no longer valid: the slave has left OP.
    fn stop(&mut self) {}
    /// What it wants of the plant.
    fn demand(&self) -> Option<Demand> {
        None
    }
    /// What it senses of the plant.
    fn feel(&mut self, _sensed: &Sensed) {}
    /// Writes an object on behalf of the master.
    fn download(
        &mut self,
        index: u16,
        subindex: u8,
        bytes: &[u8],
        is_pre_op: bool,
    ) -> Result<(), Abort> {
        self.objects_mut().download(index, subindex, bytes, is_pre_op)
    }
    /// Names of the values that can be set by hand.
    fn channels(&self) -> &'static [&'static str];
    /// Sets the value of a channel (index in `channels()`), in SI units.
    fn set_channel(&mut self, channel: usize, value: f64);
    /// A fault on purpose; false: this kind of slave has none.
    fn trip(&mut self, _code: u16) -> bool {
        false
    }
    /// Closes the brake of a drive for good; false: it has none.
    fn close_brake(&mut self) -> bool {
        false
    }
    /// What it does, as members of a JSON object, with a comma in front of each.
    fn describe(&self) -> String;
}

/// Objects that every slave with a mailbox has.
pub fn common_objects(device_type: u32, name: &str, identity: [u32; 4]) -> Dictionary {
    let mut objects = Dictionary::default();
    objects.add(0x1000, 0, &device_type.to_le_bytes(), Access::ReadOnly, Mapped::Never);
    objects.add(0x1001, 0, &[0], Access::ReadOnly, Mapped::Never);
    objects.add_text(0x1008, name);
    objects.add_text(0x100A, "segment 1.0");
    objects.add(0x1018, 0, &[4], Access::ReadOnly, Mapped::Never);
    for (i, value) in identity.into_iter().enumerate() {
        let subindex = i as u8 + 1;
        objects.add(0x1018, subindex, &value.to_le_bytes(), Access::ReadOnly, Mapped::Never);
    }
    objects.add(0x1C00, 0, &[4], Access::ReadOnly, Mapped::Never);
    for kind in 1..=4 {
        objects.add(0x1C00, kind, &[kind], Access::ReadOnly, Mapped::Never);
    }
    objects
}
