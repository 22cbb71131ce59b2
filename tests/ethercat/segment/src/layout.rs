//! The file that says which slaves stand in the line: one per line, `KIND NAME [KEY=VALUE ...]`.

use crate::clock::Clock;
use crate::device::Device;
use crate::drive::{Drive, DriveOptions, Mapping};
use crate::plant::{self, Part};
use crate::sensors::{DigitalIo, Sensor};
use crate::sii::Identity;
use crate::slave::Slave;

const KINDS: [&str; 4] = ["drive", "imu", "force", "io"];
// what they are called in their EEPROMs: a name belongs to a type, not to one slave
const TYPES: [&str; 4] = ["CiA 402 drive", "inertial unit", "force sensor", "digital I/O"];
const VENDOR: u32 = 0x00FF_FF00; // not given to anyone
const COUNTS_PER_TURN: f64 = 1_048_576.0;
const RATED_TORQUE: f64 = 1.0; // Nm

const KEYS: &str = "vendor, product, revision, serial, drift, watchdog, pulses";
const DRIVE_KEYS: &str = "turn, rated, mapping, joint, axis";

/// What a line of the file says.
struct Entry<'a> {
    kind: usize,
    name: &'a str,
    identity: Identity,
    drift_ppm: f64,
    has_watchdog: bool, // of its outputs
    has_pulses: bool,
    drive: DriveOptions,
}

/// The slaves of a file's text, or what is wrong with it and where.
pub fn read(text: &str) -> Result<Vec<Slave>, String> {
    let mut slaves: Vec<Slave> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let entry =
            parse(line, slaves.len()).map_err(|problem| format!("line {}: {problem}", i + 1))?;
        if slaves.iter().any(|slave| slave.name == entry.name) {
            return Err(format!("line {}: there is a slave '{}' already", i + 1, entry.name));
        }
        let slave = make(&entry, slaves.len());
        slaves.push(slave);
    }
    if slaves.is_empty() {
        return Err("no slaves: expected lines such as 'drive axis_1'".to_string());
    }
    Ok(slaves)
}

fn parse(line: &str, position: usize) -> Result<Entry<'_>, String> {
    let mut words = line.split_whitespace();
    let kind_name = words.next().unwrap_or_default();
    let kind = KINDS
        .iter()
        .position(|&kind| kind == kind_name)
        .ok_or_else(|| format!("unknown kind '{kind_name}', expected {}", KINDS.join(", ")))?;
    let name = words.next().filter(|name| !name.contains('='));
    let mut entry = Entry {
        kind,
        name: name.ok_or("expected a name behind the kind")?,
        identity: Identity {
            vendor: VENDOR,
            product: kind as u32 + 1,
            revision: 1,
            serial: position as u32 + 1,
        },
        drift_ppm: 0.0,
        has_watchdog: true,
        has_pulses: true,
        drive: DriveOptions {
            counts_per_turn: COUNTS_PER_TURN,
            mapping: Mapping::Free,
            rated_torque: RATED_TORQUE,
            part: Part::None,
        },
    };
    for word in words {
        let (key, value) =
            word.split_once('=').ok_or_else(|| format!("expected KEY=VALUE, got '{word}'"))?;
        set(&mut entry, key, value)?;
    }
    Ok(entry)
}

fn set(entry: &mut Entry, key: &str, value: &str) -> Result<(), String> {
    match key {
        "vendor" => entry.identity.vendor = whole(key, value)?,
        "product" => entry.identity.product = whole(key, value)?,
        "revision" => entry.identity.revision = whole(key, value)?,
        "serial" => entry.identity.serial = whole(key, value)?,
        "drift" => entry.drift_ppm = number(key, value, -1000.0, 1000.0)?,
        "watchdog" => entry.has_watchdog = is_on(key, value)?,
        "pulses" => entry.has_pulses = is_on(key, value)?,
        _ if entry.kind == 0 => return set_drive(&mut entry.drive, key, value),
        _ => return Err(format!("unknown key '{key}', expected {KEYS}")),
    }
    Ok(())
}

fn set_drive(drive: &mut DriveOptions, key: &str, value: &str) -> Result<(), String> {
    match key {
        "turn" => drive.counts_per_turn = number(key, value, 100.0, 268_435_456.0)?,
        "rated" => drive.rated_torque = number(key, value, 0.001, 10_000.0)?,
        "joint" => drive.part = Part::Joint(place(key, value, plant::MOST_JOINTS)?),
        "axis" => drive.part = Part::Axis(place(key, value, plant::MOST_AXES)?),
        "mapping" => {
            drive.mapping = match value {
                "free" => Mapping::Free,
                "fixed" => Mapping::Fixed,
                "joint" => Mapping::Joint,
                _ => return Err(format!("mapping: expected free, fixed or joint, got '{value}'")),
            }
        }
        _ => return Err(format!("unknown key '{key}', expected {KEYS}, {DRIVE_KEYS}")),
    }
    Ok(())
}

fn is_on(key: &str, value: &str) -> Result<bool, String> {
    match value {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(format!("{key}: expected on or off, got '{value}'")),
    }
}

// counted from 1 in the file
fn place(key: &str, value: &str, most: usize) -> Result<usize, String> {
    match value.parse() {
        Ok(place) if (1..=most).contains(&place) => Ok(place - 1),
        _ => Err(format!("{key}: expected 1 to {most}, got '{value}'")),
    }
}

fn whole(key: &str, value: &str) -> Result<u32, String> {
    parse_whole(value).ok_or_else(|| format!("{key}: expected a number of 32 bits, got '{value}'"))
}

/// A whole number, also as 0x...
pub fn parse_whole(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

fn number(key: &str, value: &str, low: f64, high: f64) -> Result<f64, String> {
    value
        .parse()
        .ok()
        .filter(|number| (low..=high).contains(number))
        .ok_or_else(|| format!("{key}: expected a number from {low} to {high}, got '{value}'"))
}

fn make(entry: &Entry, position: usize) -> Slave {
    let id = &entry.identity;
    let numbers = [id.vendor, id.product, id.revision, id.serial];
    let name = TYPES[entry.kind];
    let device: Box<dyn Device> = match KINDS[entry.kind] {
        "drive" => Box::new(Drive::new(name, numbers, &entry.drive)),
        "imu" => Box::new(Sensor::inertial(name, numbers)),
        "force" => Box::new(Sensor::force(name, numbers)),
        _ => Box::new(DigitalIo::new()),
    };
    // a plain slave has no clock
    let clock = device.has_mailbox().then(|| Clock::new(position, entry.drift_ppm));
    let mut slave = Slave::new(entry.name, name, id, device, clock, entry.has_watchdog);
    slave.esc.has_pulses = entry.has_pulses;
    slave
}
