//! The memory of one slave controller as a master sees it: registers, sync managers, FMMUs, EEPROM
//! registers, watchdog of process data and clock.

use crate::clock::Clock;
use crate::registers::*;
use crate::sii::WATCHDOG_TRIGGER;

const MEMORY: usize = 0x3000; // registers and 8 KiB of RAM
const MAILBOX_FULL: u8 = 0x08; // status of a sync manager
const EEPROM_READ_8: u8 = 0x40; // status of the EEPROM: eight bytes at a time
const EEPROM_ERROR: u8 = 0x20;

/// What a datagram has caused; taken by the slave after each.
#[derive(Default)]
pub struct Events {
    pub al_control: bool,
    pub mail_came: bool,
    pub mail_gone: bool,
    pub repeat_asked: bool,
    pub outputs_came: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    Read,
    Write,
}

/// One sync manager as configured by the master.
#[derive(Clone, Copy)]
pub struct SyncManager {
    pub start: u16,
    pub length: u16,
    pub control: u8,
    pub is_enabled: bool,
}

impl SyncManager {
    pub fn is_mailbox(&self) -> bool {
        self.control & 0x03 == 0x02
    }
    pub fn direction(&self) -> Direction {
        if self.control & 0x0C == 0x04 {
            Direction::Write
        } else {
            Direction::Read
        }
    }
    fn end(&self) -> usize {
        usize::from(self.start) + usize::from(self.length)
    }
    fn touches(&self, address: u16, length: usize) -> bool {
        usize::from(address) < self.end() && usize::from(self.start) < usize::from(address) + length
    }
}

/// One FMMU: bits of the logical memory and where they lie in the slave.
struct Fmmu {
    logical_bit: u64,
    bits: u64,
    physical_bit: u64,
    reads: bool,
    writes: bool,
}

pub struct Esc {
    memory: Vec<u8>,
    pub eeprom: Vec<u8>,
    reads_eight_bytes: bool,
    pub clock: Option<Clock>,
    pub events: Events,
    opened: [bool; SYNC_MANAGER_TOTAL as usize],
    pub output_manager: usize,
    /// Its sync pulses come where a master has switched them on.
    pub has_pulses: bool,
    last_outputs_ns: u64,
    watchdog_expired: bool,
}

impl Esc {
    pub fn new(
        eeprom: Vec<u8>,
        reads_eight_bytes: bool,
        clock: Option<Clock>,
        output_manager: usize,
    ) -> Esc {
        let mut esc = Esc {
            memory: vec![0; MEMORY],
            eeprom,
            reads_eight_bytes,
            clock,
            events: Events::default(),
            opened: [false; SYNC_MANAGER_TOTAL as usize],
            output_manager,
            has_pulses: true,
            last_outputs_ns: 0,
            watchdog_expired: false,
        };
        esc.set(TYPE, &[0x11, 0x00]);
        esc.set_u16(BUILD, 2);
        esc.set(FMMU_COUNT, &[FMMU_TOTAL as u8]);
        esc.set(SYNC_MANAGER_COUNT, &[SYNC_MANAGER_TOTAL as u8]);
        esc.set(RAM_KIB, &[8]);
        esc.set(PORT_DESCRIPTOR, &[0x0F]); // two ports, MII
        esc.set_u16(FEATURES, if esc.clock.is_some() { 0x000C } else { 0 });
        let alias = [esc.eeprom[8], esc.eeprom[9]];
        esc.set(STATION_ALIAS, &alias);
        esc.set_u16(AL_STATUS, 1);
        esc.set_u16(WATCHDOG_DIVIDER, 0x09C2); // 100 us
        esc.set_u16(0x0410, 1000);
        esc.set_u16(WATCHDOG_TIME, 1000); // 100 ms
        esc.set_u16(EEPROM_CONTROL, u16::from(esc.eeprom_status()));
        esc
    }

    // --- memory as the slave's own program uses it -------------------------------------------

    pub fn get(&self, address: u16, length: usize) -> &[u8] {
        &self.memory[usize::from(address)..usize::from(address) + length]
    }
    pub fn set(&mut self, address: u16, bytes: &[u8]) {
        let start = usize::from(address);
        self.memory[start..start + bytes.len()].copy_from_slice(bytes);
    }
    pub fn u8(&self, address: u16) -> u8 {
        self.memory[usize::from(address)]
    }
    pub fn u16(&self, address: u16) -> u16 {
        u16::from_le_bytes([self.u8(address), self.u8(address + 1)])
    }
    pub fn u32(&self, address: u16) -> u32 {
        u32::from(self.u16(address)) | u32::from(self.u16(address + 2)) << 16
    }
    pub fn u64(&self, address: u16) -> u64 {
        u64::from(self.u32(address)) | u64::from(self.u32(address + 4)) << 32
    }
    pub fn set_u16(&mut self, address: u16, value: u16) {
        self.set(address, &value.to_le_bytes());
    }

    // --- access by datagrams -------------------------------------------------------------------

    /// Reads for a master; false: not granted, the working counter stays.
    pub fn read(&mut self, address: u16, out: &mut [u8], now_ns: u64) -> bool {
        if !self.exists(address, out.len()) {
            return false;
        }
        if address >= RAM && !self.grants(address, out.len(), Direction::Read) {
            return false;
        }
        self.refresh(address, out.len(), now_ns);
        out.copy_from_slice(self.get(address, out.len()));
        true
    }

    /// Writes for a master; false: not granted, the working counter stays.
    pub fn write(&mut self, address: u16, data: &[u8], now_ns: u64) -> bool {
        if !self.exists(address, data.len()) {
            return false;
        }
        if address >= RAM {
            // the data must be there before the program of the slave looks at them
            let granted = self.grants(address, data.len(), Direction::Write);
            if granted {
                self.set(address, data);
                if self.events.outputs_came {
                    self.last_outputs_ns = now_ns;
                    self.watchdog_expired = false;
                }
            }
            return granted;
        }
        self.write_registers(address, data, now_ns);
        true
    }

    /// Reads and writes the part of a logical datagram that the FMMUs map; (read, written).
    pub fn exchange(
        &mut self,
        logical: u32,
        data: &mut [u8],
        reads: bool,
        writes: bool,
        now_ns: u64,
    ) -> (bool, bool) {
        let sent = data.to_vec();
        let first = u64::from(logical) * 8;
        let last = first + data.len() as u64 * 8;
        let (mut has_read, mut has_written) = (false, false);
        for i in 0..FMMU_TOTAL {
            let Some(fmmu) = self.fmmu(i) else { continue };
            let from = fmmu.logical_bit.max(first);
            let to = (fmmu.logical_bit + fmmu.bits).min(last);
            if from >= to {
                continue;
            }
            let part = BitRange {
                logical: from - first,
                physical: fmmu.physical_bit + from - fmmu.logical_bit,
                bits: to - from,
            };
            if writes && fmmu.writes {
                has_written |= self.write_bits(&part, &sent, now_ns);
            }
            if reads && fmmu.reads {
                has_read |= self.read_bits(&part, data, now_ns);
            }
        }
        (has_read, has_written)
    }

    // registers of the clock are there only where there is one
    fn exists(&self, address: u16, length: usize) -> bool {
        let end = usize::from(address) + length;
        let in_clock = end > usize::from(RECEIVE_TIMES) && address < 0x0A00;
        end <= MEMORY && (self.clock.is_some() || !in_clock)
    }

    fn fmmu(&self, i: u16) -> Option<Fmmu> {
        let at = FMMUS + i * FMMU_BYTES;
        let length = u64::from(self.u16(at + 4));
        if self.u8(at + 12) & 1 == 0 || length == 0 {
            return None;
        }
        let (start_bit, stop_bit) =
            (u64::from(self.u8(at + 6) & 7), u64::from(self.u8(at + 7) & 7));
        Some(Fmmu {
            logical_bit: u64::from(self.u32(at)) * 8 + start_bit,
            bits: ((length - 1) * 8 + stop_bit + 1).saturating_sub(start_bit),
            physical_bit: u64::from(self.u16(at + 8)) * 8 + u64::from(self.u8(at + 10) & 7),
            reads: self.u8(at + 11) & 1 != 0,
            writes: self.u8(at + 11) & 2 != 0,
        })
    }

    fn read_bits(&mut self, part: &BitRange, data: &mut [u8], now_ns: u64) -> bool {
        let mut bytes = vec![0; part.bytes()];
        let granted = self.read(part.address(), &mut bytes, now_ns);
        if granted {
            copy_bits(&bytes, part.physical % 8, data, part.logical, part.bits);
        }
        granted
    }

    fn write_bits(&mut self, part: &BitRange, data: &[u8], now_ns: u64) -> bool {
        if usize::from(part.address()) + part.bytes() > MEMORY {
            return false;
        }
        let mut bytes = self.get(part.address(), part.bytes()).to_vec();
        copy_bits(data, part.logical, &mut bytes, part.physical % 8, part.bits);
        self.write(part.address(), &bytes, now_ns)
    }

    // --- registers -----------------------------------------------------------------------------

    fn write_registers(&mut self, address: u16, data: &[u8], now_ns: u64) {
        let covers = |at: u16| address <= at && usize::from(at) < usize::from(address) + data.len();
        for (i, &byte) in data.iter().enumerate() {
            let at = address + i as u16;
            if (SYNC_MANAGERS..SYNC_MANAGERS + 0x20).contains(&at) {
                self.write_sync_manager_byte(at, byte);
            } else if WRITABLE.iter().any(|&(first, last)| first <= at && at <= last) {
                self.memory[usize::from(at)] = byte;
            } else if (RX_ERRORS..LOST_LINKS + 4).contains(&at)
                || (WATCHDOG_COUNTER..WATCHDOG_COUNTER + 2).contains(&at)
            {
                self.memory[usize::from(at)] = 0; // counters are cleared by any value
            }
        }
        if covers(AL_CONTROL) {
            self.events.al_control = true;
        }
        if covers(EEPROM_CONTROL + 1) {
            self.execute_eeprom_command();
        }
        if covers(RECEIVE_TIMES) {
            self.latch_receive_times(now_ns);
        }
        if covers(SYSTEM_TIME) && covers(SYSTEM_TIME + 3) {
            let at = usize::from(SYSTEM_TIME - address);
            let time = u32::from_le_bytes(data[at..at + 4].try_into().expect("four bytes"));
            self.follow_time(time, now_ns);
        }
        if covers(SPEED_COUNTER) {
            if let Some(clock) = &mut self.clock {
                clock.forget_difference();
            }
        }
    }

    fn write_sync_manager_byte(&mut self, at: u16, byte: u8) {
        let index = usize::from((at - SYNC_MANAGERS) / SYNC_MANAGER_BYTES);
        let field = (at - SYNC_MANAGERS) % SYNC_MANAGER_BYTES;
        if field == 5 || field == 7 {
            return; // status and the slave's own control
        }
        let before = self.u8(at);
        self.memory[usize::from(at)] = byte;
        if field != 6 {
            return;
        }
        if before & 1 == 0 && byte & 1 != 0 {
            self.set(at - 1, &[0]);
            self.opened[index] = false;
        }
        if (before ^ byte) & 2 != 0 {
            self.events.repeat_asked = true;
        }
    }

    // values that change by themselves, just before they are read
    fn refresh(&mut self, address: u16, length: usize, now_ns: u64) {
        let reads = |at: u16, size: usize| {
            usize::from(address) < usize::from(at) + size
                && usize::from(at) < usize::from(address) + length
        };
        if reads(WATCHDOG_STATUS, 2) {
            let is_running = !self.watchdog_expired;
            self.set_u16(WATCHDOG_STATUS, u16::from(is_running));
        }
        if self.clock.is_some() && reads(SYSTEM_TIME, 8) {
            let time = self.system_time(now_ns);
            self.set(SYSTEM_TIME, &time.to_le_bytes());
        }
        if self.clock.is_some()
            && self.has_pulses
            && (reads(SYNC_STATUS, 1) || reads(SYNC_START, 8))
        {
            self.refresh_pulses(now_ns);
        }
        if let Some(clock) = &self.clock {
            if reads(TIME_DIFFERENCE, 4) {
                let difference = clock.difference_register();
                self.set(TIME_DIFFERENCE, &difference.to_le_bytes());
            }
        }
    }

    // whether the first pulse is still to come, and the time of the next one
    fn refresh_pulses(&mut self, now_ns: u64) {
        let (start, period) = (self.u64(SYNC_START), u64::from(self.u32(SYNC0_CYCLE)));
        if self.u8(SYNC_ACTIVATION) & 3 != 3 || period == 0 {
            return;
        }
        let time = self.system_time(now_ns);
        self.set(SYNC_STATUS, &[u8::from(time < start)]);
        if time >= start {
            let next = start + ((time - start) / period + 1) * period;
            self.set(SYNC_START, &next.to_le_bytes());
        }
    }

    // --- clock ---------------------------------------------------------------------------------

    /// System time of this slave in ns, when a frame that left the master at `now_ns` passes it.
    pub fn system_time(&self, now_ns: u64) -> u64 {
        let local = self.clock.as_ref().map_or(0, |clock| clock.local_ns(now_ns));
        local.wrapping_add(self.u64(TIME_OFFSET))
    }

    /// System time of this slave at an instant that is the same for all.
    pub fn shared_time(&self, now_ns: u64) -> Option<u64> {
        let clock = self.clock.as_ref()?;
        Some(clock.at(now_ns).wrapping_add(self.u64(TIME_OFFSET)))
    }

    fn latch_receive_times(&mut self, now_ns: u64) {
        let Some(clock) = &self.clock else { return };
        let (out, back) = clock.receive_times(now_ns);
        self.set(RECEIVE_TIMES, &(out as u32).to_le_bytes());
        self.set(RECEIVE_TIMES + 4, &(back.unwrap_or(0) as u32).to_le_bytes());
        self.set(UNIT_RECEIVE_TIME, &out.to_le_bytes());
    }

    fn follow_time(&mut self, received: u32, now_ns: u64) {
        let own = self.system_time(now_ns) as u32;
        let delay = self.u32(TIME_DELAY);
        let difference = own.wrapping_sub(received.wrapping_add(delay)) as i32;
        if let Some(clock) = &mut self.clock {
            clock.follow(difference);
        }
    }

    // --- EEPROM --------------------------------------------------------------------------------

    fn eeprom_status(&self) -> u8 {
        if self.reads_eight_bytes {
            EEPROM_READ_8
        } else {
            0
        }
    }

    fn execute_eeprom_command(&mut self) {
        let is_write_enabled = self.u8(EEPROM_CONTROL) & 1 != 0;
        let command = self.u8(EEPROM_CONTROL + 1) & 7;
        let start = (self.u32(EEPROM_ADDRESS) as usize).saturating_mul(2);
        let mut errors = 0;
        match command {
            1 => {
                let length = if self.reads_eight_bytes { 8 } else { 4 };
                // behind its end an EEPROM reads as erased
                let bytes: Vec<u8> =
                    (start..start + length).map(|i| *self.eeprom.get(i).unwrap_or(&0xFF)).collect();
                self.set(EEPROM_DATA, &bytes);
            }
            2 if is_write_enabled && start + 2 <= self.eeprom.len() => {
                let word = [self.u8(EEPROM_DATA), self.u8(EEPROM_DATA + 1)];
                self.eeprom[start..start + 2].copy_from_slice(&word);
            }
            2 => errors = EEPROM_ERROR | if is_write_enabled { 0 } else { 0x40 },
            0 | 4 => {}
            _ => errors = EEPROM_ERROR,
        }
        let status = self.eeprom_status();
        self.set(EEPROM_CONTROL, &[status, errors]);
    }

    // --- sync managers -------------------------------------------------------------------------

    pub fn sync_manager(&self, i: usize) -> SyncManager {
        let at = SYNC_MANAGERS + i as u16 * SYNC_MANAGER_BYTES;
        SyncManager {
            start: self.u16(at),
            length: self.u16(at + 2),
            control: self.u8(at + 4),
            is_enabled: self.u8(at + 6) & 1 != 0 && self.u8(at + 7) & 1 == 0,
        }
    }

    /// The slave's own switch: a sync manager that is off grants nothing.
    pub fn switch_sync_manager(&mut self, i: usize, is_on: bool) {
        self.set(SYNC_MANAGERS + i as u16 * SYNC_MANAGER_BYTES + 7, &[u8::from(!is_on)]);
    }

    pub fn is_mailbox_full(&self, i: usize) -> bool {
        self.u8(Self::status_of(i)) & MAILBOX_FULL != 0
    }

    pub fn set_mailbox_full(&mut self, i: usize, is_full: bool) {
        let status = self.u8(Self::status_of(i)) & !MAILBOX_FULL;
        self.set(Self::status_of(i), &[status | if is_full { MAILBOX_FULL } else { 0 }]);
    }

    /// Answers the master's request to repeat the last mail.
    pub fn acknowledge_repeat(&mut self, i: usize) {
        let at = SYNC_MANAGERS + i as u16 * SYNC_MANAGER_BYTES;
        let control = self.u8(at + 7) & !2 | self.u8(at + 6) & 2;
        self.set(at + 7, &[control]);
    }

    fn status_of(i: usize) -> u16 {
        SYNC_MANAGERS + i as u16 * SYNC_MANAGER_BYTES + 5
    }

    // An area is opened at its first byte and closed at its last; a mailbox must be full to be read
    // and empty to be written.
    fn grants(&mut self, address: u16, length: usize, direction: Direction) -> bool {
        for i in 0..usize::from(SYNC_MANAGER_TOTAL) {
            let manager = self.sync_manager(i);
            if manager.length == 0 || !manager.touches(address, length) {
                continue;
            }
            if !manager.is_enabled {
                // an area that the slave itself has closed; one that was not configured is plain RAM
                if self.u8(SYNC_MANAGERS + i as u16 * SYNC_MANAGER_BYTES + 6) & 1 != 0 {
                    return false;
                }
                continue;
            }
            let is_full = self.is_mailbox_full(i);
            if manager.direction() != direction
                || manager.is_mailbox() && is_full != (direction == Direction::Read)
            {
                return false;
            }
            self.opened[i] |= address <= manager.start;
            if !self.opened[i] {
                return false;
            }
            if usize::from(address) + length >= manager.end() {
                self.opened[i] = false;
                self.close(i, &manager, direction);
            }
        }
        true
    }

    fn close(&mut self, i: usize, manager: &SyncManager, direction: Direction) {
        if manager.is_mailbox() {
            self.set_mailbox_full(i, direction == Direction::Write);
            match direction {
                Direction::Write => self.events.mail_came = true,
                Direction::Read => self.events.mail_gone = true,
            }
        } else if i == self.output_manager && direction == Direction::Write {
            self.events.outputs_came = true;
        }
    }

    // --- watchdog of process data --------------------------------------------------------------

    pub fn restart_watchdog(&mut self, now_ns: u64) {
        self.last_outputs_ns = now_ns;
        self.watchdog_expired = false;
    }

    /// Whether outputs have stayed away for longer than the master allowed; true once.
    pub fn has_watchdog_expired(&mut self, now_ns: u64) -> bool {
        let manager = self.sync_manager(self.output_manager);
        let tick_ns = (u64::from(self.u16(WATCHDOG_DIVIDER)) + 2) * 40;
        let limit_ns = u64::from(self.u16(WATCHDOG_TIME)) * tick_ns;
        let is_watched =
            manager.is_enabled && manager.length > 0 && manager.control & WATCHDOG_TRIGGER != 0;
        if !is_watched || limit_ns == 0 || self.watchdog_expired {
            return false;
        }
        self.watchdog_expired = now_ns.saturating_sub(self.last_outputs_ns) > limit_ns;
        if self.watchdog_expired {
            let count = self.u8(WATCHDOG_COUNTER).saturating_add(1);
            self.set(WATCHDOG_COUNTER, &[count]);
        }
        self.watchdog_expired
    }
}

/// Bits of a datagram and of the slave's memory that belong together.
struct BitRange {
    logical: u64,
    physical: u64,
    bits: u64,
}

impl BitRange {
    fn address(&self) -> u16 {
        (self.physical / 8) as u16
    }
    fn bytes(&self) -> usize {
        (((self.physical + self.bits).div_ceil(8)) - self.physical / 8) as usize
    }
}

fn copy_bits(from: &[u8], from_bit: u64, to: &mut [u8], to_bit: u64, bits: u64) {
    if (from_bit | to_bit | bits) % 8 == 0 {
        let (source, target, count) =
            ((from_bit / 8) as usize, (to_bit / 8) as usize, (bits / 8) as usize);
        to[target..target + count].copy_from_slice(&from[source..source + count]);
        return;
    }
    for i in 0..bits {
        let (source, target) = (from_bit + i, to_bit + i);
        let bit = from[(source / 8) as usize] >> (source % 8) & 1;
        let byte = &mut to[(target / 8) as usize];
        *byte = *byte & !(1 << (target % 8)) | bit << (target % 8);
    }
}
