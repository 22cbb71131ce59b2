//! The object dictionary of a slave: values, what a master may do with them, and process data made
//! of them (CiA 301, ETG.1000.6).

use std::collections::BTreeMap;

pub const OUTPUT_ASSIGNMENT: u16 = 0x1C12;
pub const INPUT_ASSIGNMENT: u16 = 0x1C13;
const MOST_ENTRIES: usize = 8; // of a PDO
const MOST_PDOS: usize = 2; // of an assignment

/// Abort codes of SDO transfers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Abort {
    UnknownCommand = 0x0504_0001,
    ReadOnly = 0x0601_0002,
    CountNotZero = 0x0601_0003,
    NoObject = 0x0602_0000,
    NotMappable = 0x0604_0041,
    TooLong = 0x0604_0042,
    WrongLength = 0x0607_0010,
    NoSubindex = 0x0609_0011,
    OutOfRange = 0x0609_0030,
    WrongState = 0x0800_0022,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Access {
    ReadOnly,
    ReadWrite,
    /// Of the mapping: written in PRE-OP only.
    Mapping,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Mapped {
    Never,
    AsOutput,
    AsInput,
}

pub struct Object {
    bytes: Vec<u8>,
    access: Access,
    mapped: Mapped,
    range: Option<(i64, i64)>,
}

#[derive(Default)]
pub struct Dictionary {
    objects: BTreeMap<(u16, u8), Object>,
}

/// One entry of a PDO.
#[derive(Clone, Copy)]
pub struct PdoEntry {
    pub index: u16,
    pub subindex: u8,
    pub bits: u8,
}

impl PdoEntry {
    fn from_value(value: u32) -> PdoEntry {
        PdoEntry { index: (value >> 16) as u16, subindex: (value >> 8) as u8, bits: value as u8 }
    }
    fn value(&self) -> u32 {
        u32::from(self.index) << 16 | u32::from(self.subindex) << 8 | u32::from(self.bits)
    }
    // an entry of object 0 fills a gap
    fn is_gap(&self) -> bool {
        self.index == 0
    }
}

impl Dictionary {
    pub fn add(&mut self, index: u16, subindex: u8, bytes: &[u8], access: Access, mapped: Mapped) {
        let object = Object { bytes: bytes.to_vec(), access, mapped, range: None };
        self.objects.insert((index, subindex), object);
    }

    pub fn limit(&mut self, index: u16, subindex: u8, low: i64, high: i64) {
        if let Some(object) = self.objects.get_mut(&(index, subindex)) {
            object.range = Some((low, high));
        }
    }

    pub fn add_text(&mut self, index: u16, text: &str) {
        self.add(index, 0, text.as_bytes(), Access::ReadOnly, Mapped::Never);
    }

    /// Adds a PDO that a master may change.
    pub fn add_pdo(&mut self, pdo: u16, entries: &[PdoEntry]) {
        self.add_entries(pdo, entries, MOST_ENTRIES, Access::Mapping);
    }

    /// Adds a PDO that is as it is.
    pub fn add_fixed_pdo(&mut self, pdo: u16, entries: &[PdoEntry]) {
        self.add_entries(pdo, entries, entries.len(), Access::ReadOnly);
    }

    fn add_entries(&mut self, pdo: u16, entries: &[PdoEntry], places: usize, access: Access) {
        self.add(pdo, 0, &[entries.len() as u8], access, Mapped::Never);
        for i in 0..places {
            let value = entries.get(i).map_or(0, PdoEntry::value);
            self.add(pdo, i as u8 + 1, &value.to_le_bytes(), access, Mapped::Never);
        }
    }

    /// Adds the list of PDOs of a sync manager; there is place for MOST_PDOS.
    pub fn add_assignment(&mut self, assignment: u16, pdos: &[u16]) {
        self.add(assignment, 0, &[pdos.len() as u8], Access::Mapping, Mapped::Never);
        for i in 0..MOST_PDOS {
            let pdo = pdos.get(i).copied().unwrap_or(0);
            self.add(assignment, i as u8 + 1, &pdo.to_le_bytes(), Access::Mapping, Mapped::Never);
        }
    }

    // --- values ----------------------------------------------------------------------------------

    /// A value of up to eight bytes as a signed number; 0 where there is no such object.
    pub fn get(&self, index: u16, subindex: u8) -> i64 {
        self.objects.get(&(index, subindex)).map_or(0, |object| number(&object.bytes))
    }

    pub fn set(&mut self, index: u16, subindex: u8, value: i64) {
        if let Some(object) = self.objects.get_mut(&(index, subindex)) {
            let length = object.bytes.len();
            object.bytes.copy_from_slice(&value.to_le_bytes()[..length]);
        }
    }

    // --- SDO -------------------------------------------------------------------------------------

    pub fn upload(&self, index: u16, subindex: u8) -> Result<&[u8], Abort> {
        self.find(index, subindex).map(|object| object.bytes.as_slice())
    }

    pub fn download(
        &mut self,
        index: u16,
        subindex: u8,
        bytes: &[u8],
        is_pre_op: bool,
    ) -> Result<(), Abort> {
        let object = self.find(index, subindex)?;
        if object.access == Access::ReadOnly {
            return Err(Abort::ReadOnly);
        }
        if object.bytes.len() != bytes.len() {
            return Err(Abort::WrongLength);
        }
        let value = number(bytes);
        if object.range.is_some_and(|(low, high)| value < low || value > high) {
            return Err(Abort::OutOfRange);
        }
        if object.access == Access::Mapping {
            self.check_mapping(index, subindex, value, is_pre_op)?;
        }
        self.set(index, subindex, value);
        Ok(())
    }

    fn find(&self, index: u16, subindex: u8) -> Result<&Object, Abort> {
        self.objects.get(&(index, subindex)).ok_or_else(|| {
            let has_index = self.objects.range((index, 0)..=(index, u8::MAX)).next().is_some();
            if has_index {
                Abort::NoSubindex
            } else {
                Abort::NoObject
            }
        })
    }

    fn check_mapping(
        &self,
        index: u16,
        subindex: u8,
        value: i64,
        is_pre_op: bool,
    ) -> Result<(), Abort> {
        if !is_pre_op {
            return Err(Abort::WrongState);
        }
        let is_assignment = index == OUTPUT_ASSIGNMENT || index == INPUT_ASSIGNMENT;
        if subindex == 0 {
            let most = if is_assignment { MOST_PDOS } else { MOST_ENTRIES };
            return if value <= most as i64 { Ok(()) } else { Err(Abort::TooLong) };
        }
        if self.get(index, 0) != 0 {
            return Err(Abort::CountNotZero);
        }
        let value = value as u32;
        let is_output = index == OUTPUT_ASSIGNMENT || (0x1600..0x1A00).contains(&index);
        let fits = if is_assignment {
            let pdos = if is_output { 0x1600..0x1A00 } else { 0x1A00..0x1C00 };
            pdos.contains(&value) && self.objects.contains_key(&(value as u16, 0))
        } else {
            self.can_map(PdoEntry::from_value(value), is_output)
        };
        if fits {
            Ok(())
        } else {
            Err(Abort::NotMappable)
        }
    }

    fn can_map(&self, entry: PdoEntry, is_output: bool) -> bool {
        let wanted = if is_output { Mapped::AsOutput } else { Mapped::AsInput };
        entry.is_gap()
            || self.objects.get(&(entry.index, entry.subindex)).is_some_and(|object| {
                object.mapped == wanted && object.bytes.len() == usize::from(entry.bits).div_ceil(8)
            })
    }

    // --- process data ----------------------------------------------------------------------------

    pub fn pdos(&self, assignment: u16) -> Vec<u16> {
        let count = self.get(assignment, 0) as u8;
        (1..=count).map(|i| self.get(assignment, i) as u16).collect()
    }

    pub fn entries(&self, pdo: u16) -> Vec<PdoEntry> {
        let count = self.get(pdo, 0) as u8;
        (1..=count).map(|i| PdoEntry::from_value(self.get(pdo, i) as u32)).collect()
    }

    /// Bytes of the process data that are assigned.
    pub fn process_bytes(&self, assignment: u16) -> usize {
        let bits: usize = self.mapped(assignment).iter().map(|entry| usize::from(entry.bits)).sum();
        bits.div_ceil(8)
    }

    fn mapped(&self, assignment: u16) -> Vec<PdoEntry> {
        self.pdos(assignment).iter().flat_map(|&pdo| self.entries(pdo)).collect()
    }

    pub fn take_outputs(&mut self, data: &[u8]) {
        let mut bit = 0;
        for entry in self.mapped(OUTPUT_ASSIGNMENT) {
            let mut value: i64 = 0;
            for i in 0..usize::from(entry.bits) {
                value |= i64::from(data[(bit + i) / 8] >> ((bit + i) % 8) & 1) << i;
            }
            bit += usize::from(entry.bits);
            self.set(entry.index, entry.subindex, value);
        }
    }

    pub fn give_inputs(&self) -> Vec<u8> {
        let mut data = vec![0; self.process_bytes(INPUT_ASSIGNMENT)];
        let mut bit = 0;
        for entry in self.mapped(INPUT_ASSIGNMENT) {
            let value = self.get(entry.index, entry.subindex);
            for i in 0..usize::from(entry.bits) {
                data[(bit + i) / 8] |= ((value >> i & 1) as u8) << ((bit + i) % 8);
            }
            bit += usize::from(entry.bits);
        }
        data
    }
}

fn number(bytes: &[u8]) -> i64 {
    let is_negative = bytes.last().is_some_and(|&last| last & 0x80 != 0);
    let mut all = [if is_negative { 0xFF } else { 0 }; 8];
    let length = bytes.len().min(8);
    all[..length].copy_from_slice(&bytes[..length]);
    i64::from_le_bytes(all)
}
