//! The machine that the drives move and the sensors feel: a simulator behind our device protocol
//! (docs/reference/device_protocol.md), in lock-step. One frame of process data is one period.
//!
//! It stands where its scenario begins until the first drive is made ready to switch on, and goes
//! back there when the last one is switched off.

use std::io;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

use crate::line::Line;

pub const MOST_JOINTS: usize = 7;
pub const MOST_AXES: usize = 2;
const SWITCHES: usize = 6;

const MAGIC: u32 = 0x5044_4748;
const VERSION: u16 = 2;
const HELLO: u16 = 1;
const WELCOME: u16 = 2;
const READY: u16 = 3;
const SENSORS: u16 = 4;
const COMMAND: u16 = 5;
const GOODBYE: u16 = 6;
const HEADER_BYTES: usize = 32;
const DESCRIPTION_BYTES: usize = 88;
const BY_POSITION: u32 = 1; // interface of the plant: its joints follow positions
const AGAIN: Duration = Duration::from_millis(20); // a datagram without an answer is sent again
const PATIENCE: Duration = Duration::from_secs(10);

/// What a slave moves of the plant.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Part {
    None,
    Axis(usize),
    Joint(usize),
}

/// What a slave wants of the plant.
pub struct Demand {
    pub part: Part,
    pub is_ready: bool,     // to switch on, or further
    pub is_following: bool, // enabled, and its brake is open
    pub target: f64,        // Nm, m/s or rad, as the plant takes it; of digital outputs: reset
    pub speed: f64,         // rad/s of a target in rad
}

/// What there is to sense of it, in SI units.
pub struct Sensed {
    sequence: u64,
    pub q_m: [f64; MOST_JOINTS],
    pub dq_m: [f64; MOST_JOINTS],
    pub theta_m: [f64; MOST_JOINTS],
    pub tau_m: [f64; MOST_JOINTS],
    pub q_p: [f64; MOST_AXES],
    pub wrench: [f64; 6],
    pub motion: [f64; 6], // accelerometer, gyroscope
    /// Emergency stop is free, operator enables, override key, field is clear, inputs agree,
    /// dead-man is held.
    pub switches: [bool; SWITCHES],
}

pub struct Plant {
    socket: UdpSocket,
    description: [u8; DESCRIPTION_BYTES],
    nonce: u32, // of the last hello; its welcome repeats it
    session: Option<Session>,
}

struct Session {
    id: u32,
    number: u64,
    sensed: Option<Sensed>, // by the last frame
}

impl Plant {
    /// A plant at HOST:PORT that the slaves sense from now on.
    pub fn behind(line: &mut Line, address: &str) -> Result<Plant, String> {
        let open = || -> io::Result<UdpSocket> {
            let socket = UdpSocket::bind("0.0.0.0:0")?;
            socket.connect(address)?;
            socket.set_read_timeout(Some(AGAIN))?;
            Ok(socket)
        };
        let socket = open().map_err(|error| format!("{address}: {error}"))?;
        let mut plant =
            Plant { socket, description: [0; DESCRIPTION_BYTES], nonce: 0, session: None };
        plant.begin().map_err(|error| format!("{address}: {error}"))?;
        plant.report(line);
        plant.end();
        Ok(plant)
    }

    /// Moves by a period after a frame with process data, if a drive is ready.
    pub fn follow(&mut self, line: &mut Line) -> io::Result<()> {
        let demands: Vec<Demand> =
            line.slaves.iter().filter_map(|slave| slave.device.demand()).collect();
        let drives = || demands.iter().filter(|demand| demand.part != Part::None);
        if !drives().any(|drive| drive.is_ready) {
            self.end();
            return Ok(());
        }
        if self.session.is_none() {
            self.begin()?;
        }
        let is_enabled = drives().all(|drive| drive.is_following);
        let command = self.command(&demands, is_enabled);
        self.ask(COMMAND, &command, SENSORS)?;
        self.report(line);
        Ok(())
    }

    fn report(&self, line: &mut Line) {
        let Some(session) = &self.session else { return };
        let Some(sensed) = &session.sensed else { return };
        for slave in &mut line.slaves {
            slave.device.feel(sensed);
            slave.give_inputs();
        }
    }

    fn begin(&mut self) -> io::Result<()> {
        self.session = Some(Session { id: 0, number: 0, sensed: None });
        let mut welcome = self.introduce()?;
        if u32_at(&welcome, 40) != 0 {
            // the refusal says what the device is
            self.description.copy_from_slice(&welcome[48..48 + DESCRIPTION_BYTES]);
            welcome = self.introduce()?;
        }
        if u32_at(&welcome, 40) != 0 {
            let reason =
                String::from_utf8_lossy(&welcome[208..400]).trim_end_matches('\0').to_string();
            return Err(io::Error::other(reason));
        }
        if let Some(session) = &mut self.session {
            session.id = u32_at(&welcome, 12);
            session.number = 0;
        }
        self.ask(READY, &[], SENSORS).map(|_| ())
    }

    fn introduce(&mut self) -> io::Result<Vec<u8>> {
        self.nonce += 1;
        let mut hello = u64::from(self.nonce).to_le_bytes().to_vec();
        hello.extend(self.description);
        hello.extend(b"segment");
        hello.resize(8 + DESCRIPTION_BYTES + 64, 0);
        self.ask(HELLO, &hello, WELCOME)
    }

    fn end(&mut self) {
        if self.session.is_none() {
            return;
        }
        let mut goodbye = vec![1, 0, 0, 0, 0, 0, 0, 0];
        goodbye.resize(72, 0);
        let _ = self.send(GOODBYE, &goodbye);
        self.session = None;
    }

    fn send(&mut self, kind: u16, body: &[u8]) -> io::Result<()> {
        let Some(session) = &mut self.session else { return Ok(()) };
        session.number += 1;
        let length = HEADER_BYTES + body.len() + 4;
        let mut bytes = MAGIC.to_le_bytes().to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend((length as u32).to_le_bytes());
        bytes.extend(session.id.to_le_bytes());
        bytes.extend(session.number.to_le_bytes());
        bytes.extend(0u64.to_le_bytes());
        bytes.extend(body);
        bytes.extend(crc32(&bytes).to_le_bytes());
        self.socket.send(&bytes).map(|_| ())
    }

    /// Sends a message, again and again, until the next of the other kind is there.
    fn ask(&mut self, kind: u16, body: &[u8], wanted: u16) -> io::Result<Vec<u8>> {
        let begin = Instant::now();
        let mut bytes = [0; 1400];
        while begin.elapsed() < PATIENCE {
            self.send(kind, body)?;
            while let Ok(length) = self.socket.recv(&mut bytes) {
                if self.take(&bytes[..length], wanted) {
                    return Ok(bytes[..length].to_vec());
                }
            }
        }
        Err(io::Error::new(io::ErrorKind::TimedOut, "the plant does not answer"))
    }

    /// Whether this is the message that was waited for.
    fn take(&mut self, bytes: &[u8], wanted: u16) -> bool {
        let Some(session) = &mut self.session else { return false };
        if bytes.len() < HEADER_BYTES || bytes[6..8] != wanted.to_le_bytes() {
            return false;
        }
        if wanted == WELCOME {
            return u32_at(bytes, 32) == self.nonce;
        }
        let sensed = sensors(bytes);
        let is_new = session.sensed.as_ref().is_none_or(|last| sensed.sequence > last.sequence);
        if u32_at(bytes, 12) != session.id || !is_new {
            return false;
        }
        session.sensed = Some(sensed);
        true
    }

    fn command(&self, demands: &[Demand], is_enabled: bool) -> Vec<u8> {
        let sensed = self.session.as_ref().and_then(|session| session.sensed.as_ref());
        let sequence = sensed.map_or(0, |sensed| sensed.sequence);
        let (axes, joints) = (u32_at(&self.description, 64), u32_at(&self.description, 68));
        let mut joint_targets = [0.0; MOST_JOINTS];
        let mut speeds = [0.0; MOST_JOINTS];
        let mut dq_p = [0.0; MOST_AXES];
        let mut is_reset = false;
        for demand in demands {
            match demand.part {
                Part::Joint(i) => {
                    joint_targets[i] = demand.target;
                    speeds[i] = demand.speed;
                }
                Part::Axis(i) => dq_p[i] = demand.target,
                Part::None => is_reset |= demand.target != 0.0,
            }
        }
        let mut bytes = sequence.to_le_bytes().to_vec();
        bytes.extend(u32::from(is_enabled).to_le_bytes());
        bytes.resize(52, 0); // no target of a hand, no emergency stop
        for flag in [true, false, false, is_reset] {
            bytes.extend(u32::from(flag).to_le_bytes());
        }
        bytes.extend([0; 4]);
        let nothing = [0.0; MOST_JOINTS];
        if u32_at(&self.description, 80) == BY_POSITION {
            put(&mut bytes, joints, &joint_targets);
            put(&mut bytes, joints, &speeds);
            put(&mut bytes, joints, &nothing);
            put(&mut bytes, 0, &nothing);
        } else {
            for values in [nothing, nothing, nothing, joint_targets] {
                put(&mut bytes, joints, &values);
            }
        }
        put(&mut bytes, axes, &dq_p);
        bytes
    }
}

fn put(bytes: &mut Vec<u8>, count: u32, values: &[f64]) {
    bytes.extend(count.to_le_bytes());
    bytes.extend([0; 4]);
    for (i, value) in values.iter().enumerate() {
        bytes.extend(if i < count as usize { *value } else { 0.0 }.to_le_bytes());
    }
}

fn sensors(bytes: &[u8]) -> Sensed {
    let flag = |at| u32_at(bytes, at) != 0;
    let has_motor_encoders = u32_at(bytes, 216) != 0;
    Sensed {
        sequence: u64::from(u32_at(bytes, 36)) << 32 | u64::from(u32_at(bytes, 32)),
        q_m: numbers(bytes, 96),
        dq_m: numbers(bytes, 160),
        theta_m: numbers(bytes, if has_motor_encoders { 224 } else { 96 }),
        tau_m: numbers(bytes, 288),
        q_p: numbers(bytes, 352),
        wrench: numbers(bytes, 368),
        motion: numbers(bytes, 416),
        switches: [!flag(60), flag(64), flag(68), flag(72), !flag(76), flag(56)],
    }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    let mut value = [0; 4];
    value.copy_from_slice(&bytes[at..at + 4]);
    u32::from_le_bytes(value)
}

fn numbers<const N: usize>(bytes: &[u8], at: usize) -> [f64; N] {
    std::array::from_fn(|i| {
        let mut value = [0; 8];
        value.copy_from_slice(&bytes[at + 8 * i..at + 8 * i + 8]);
        f64::from_le_bytes(value)
    })
}

// as zlib has it
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = !0u32;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 != 0 { 0xEDB8_8320 } else { 0 };
        }
    }
    !crc
}
