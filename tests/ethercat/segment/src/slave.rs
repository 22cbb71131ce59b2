//! One slave: its controller, its states (ETG.1000.6), its mailbox and what it is good for.

use crate::clock::Clock;
use crate::device::Device;
use crate::dictionary::{INPUT_ASSIGNMENT, OUTPUT_ASSIGNMENT};
use crate::esc::{Direction, Esc};
use crate::mailbox;
use crate::registers::*;
use crate::sii::{self, Identity};

const OUTPUTS_PATIENCE_NS: u64 = 1_000_000_000; // on the way to OP

pub const INIT: u8 = 1;
pub const PRE_OP: u8 = 2;
pub const BOOT: u8 = 3;
pub const SAFE_OP: u8 = 4;
pub const OP: u8 = 8;
const ERROR: u8 = 0x10; // with a state: it is not the one asked for
const ACKNOWLEDGE: u8 = 0x10;

/// AL status codes.
mod code {
    pub const NONE: u16 = 0x0000;
    pub const INVALID_CHANGE: u16 = 0x0011;
    pub const UNKNOWN_STATE: u16 = 0x0012;
    pub const NO_BOOT: u16 = 0x0013;
    pub const MAILBOX: u16 = 0x0016;
    pub const NO_OUTPUTS: u16 = 0x0019;
    pub const WATCHDOG: u16 = 0x001B;
    pub const OUTPUTS: u16 = 0x001D;
    pub const INPUTS: u16 = 0x001E;
    pub const SYNC_PULSES: u16 = 0x0030;
}

pub struct Slave {
    /// Of this one, for those who watch; no master sees it.
    pub name: String,
    pub esc: Esc,
    pub device: Box<dyn Device>,
    has_mailbox: bool,
    last_mail: Vec<u8>,
    waiting: Vec<Vec<u8>>, // mails for the master
    op_asked_ns: Option<u64>,
    /// AL status code with which it refuses to leave INIT; 0: it does not.
    pub refusal: u16,
    /// Datagrams of process data that get no working counter from this slave.
    pub uncounted: u32,
}

impl Slave {
    pub fn new(
        name: &str,
        type_name: &str,
        identity: &Identity,
        device: Box<dyn Device>,
        clock: Option<Clock>,
        has_watchdog: bool,
    ) -> Slave {
        let has_mailbox = device.has_mailbox();
        let eeprom = sii::eeprom(identity, type_name, has_mailbox, has_watchdog, device.objects());
        let output_manager = if has_mailbox { 2 } else { 0 };
        // simple slaves read four bytes of their EEPROM at a time
        let esc = Esc::new(eeprom, has_mailbox, clock, output_manager);
        Slave {
            name: name.to_string(),
            esc,
            device,
            has_mailbox,
            last_mail: Vec::new(),
            waiting: Vec::new(),
            op_asked_ns: None,
            refusal: code::NONE,
            uncounted: 0,
        }
    }

    pub fn state(&self) -> u8 {
        self.esc.u8(AL_STATUS) & 0x0F
    }
    pub fn status(&self) -> u8 {
        self.esc.u8(AL_STATUS)
    }
    pub fn status_code(&self) -> u16 {
        self.esc.u16(AL_STATUS_CODE)
    }

    /// Links of its ports, as a master reads them.
    pub fn set_links(&mut self, is_linked_behind: bool, hops_behind: usize) {
        let was_linked = self.esc.u16(DL_STATUS) & 0x0020 != 0;
        // port 0 carries the frames, port 1 where a slave follows; 2 and 3 do not exist
        let status = if is_linked_behind { 0x5A31 } else { 0x5611 };
        self.esc.set_u16(DL_STATUS, status);
        if was_linked && !is_linked_behind {
            let count = self.esc.u8(LOST_LINKS + 1).saturating_add(1);
            self.esc.set(LOST_LINKS + 1, &[count]);
        }
        if let Some(clock) = &mut self.esc.clock {
            clock.set_hops_behind(hops_behind);
        }
    }

    /// Does what the last datagram has asked for.
    pub fn react(&mut self, now_ns: u64) {
        let events = std::mem::take(&mut self.esc.events);
        if events.al_control {
            self.change_state(now_ns);
        }
        if events.mail_came {
            self.answer_mail();
        }
        if events.repeat_asked {
            self.repeat_mail();
        }
        if events.mail_gone {
            self.post();
        }
        if events.outputs_came {
            self.take_outputs(now_ns);
        }
    }

    /// Looks at what happens without a command.
    pub fn watch(&mut self, now_ns: u64) {
        if self.state() == OP && self.esc.has_watchdog_expired(now_ns) {
            self.fall(SAFE_OP, code::WATCHDOG);
        }
        if self.op_asked_ns.is_some_and(|asked| now_ns > asked + OUTPUTS_PATIENCE_NS) {
            self.refuse(code::NO_OUTPUTS);
        }
    }

    // --- states ----------------------------------------------------------------------------------

    fn change_state(&mut self, now_ns: u64) {
        let control = self.esc.u8(AL_CONTROL);
        let wanted = control & 0x0F;
        let now = self.state();
        let has_error = self.status() & ERROR != 0;
        if has_error && control & ACKNOWLEDGE == 0 && wanted > now {
            return; // the error has to be acknowledged first
        }
        self.op_asked_ns = None;
        match (now, wanted) {
            (_, BOOT) => self.refuse(code::NO_BOOT),
            (INIT, PRE_OP) => {
                let problem = self.check_mailbox();
                self.try_enter(PRE_OP, problem);
            }
            (PRE_OP, SAFE_OP) => {
                let problem = self.check_process_data();
                self.try_enter(SAFE_OP, problem);
            }
            (SAFE_OP, OP) => {
                self.enter(SAFE_OP, code::NONE);
                self.op_asked_ns = Some(now_ns);
                if !self.has_outputs() {
                    self.enter_op(now_ns);
                }
            }
            (_, INIT | PRE_OP | SAFE_OP | OP) if wanted <= now => self.enter(wanted, code::NONE),
            (_, INIT | PRE_OP | SAFE_OP | OP) => self.refuse(code::INVALID_CHANGE),
            _ => self.refuse(code::UNKNOWN_STATE),
        }
    }

    fn try_enter(&mut self, state: u8, problem: u16) {
        if problem == code::NONE {
            self.enter(state, code::NONE);
        } else {
            self.refuse(problem);
        }
    }

    fn enter(&mut self, state: u8, status_code: u16) {
        let was_op = self.state() == OP;
        let error = if status_code == code::NONE { 0 } else { ERROR };
        self.esc.set_u16(AL_STATUS, u16::from(state | error));
        self.esc.set_u16(AL_STATUS_CODE, status_code);
        let (first, count) = if self.has_mailbox { (2, 2) } else { (0, 2) };
        for i in first..first + count {
            self.esc.switch_sync_manager(i, state >= SAFE_OP);
        }
        if state == INIT {
            self.waiting.clear();
        }
        if was_op && state != OP {
            self.device.stop();
        }
        self.give_inputs();
    }

    fn refuse(&mut self, status_code: u16) {
        self.op_asked_ns = None;
        self.enter(self.state(), status_code);
    }

    /// Leaves OP without a command. Its outputs are closed then, so that masters see it in the working counter.
    pub fn fall(&mut self, state: u8, status_code: u16) {
        self.op_asked_ns = None;
        self.enter(state, status_code);
        self.esc.switch_sync_manager(self.esc.output_manager, false);
    }

    fn enter_op(&mut self, now_ns: u64) {
        self.op_asked_ns = None;
        self.esc.restart_watchdog(now_ns);
        self.enter(OP, code::NONE);
    }

    fn has_outputs(&self) -> bool {
        self.device.objects().process_bytes(OUTPUT_ASSIGNMENT) > 0
    }

    fn check_mailbox(&self) -> u16 {
        if self.refusal != code::NONE {
            return self.refusal;
        }
        if !self.has_mailbox {
            return code::NONE;
        }
        let is_right =
            [Direction::Write, Direction::Read].iter().enumerate().all(|(i, &direction)| {
                let manager = self.esc.sync_manager(i);
                manager.is_enabled
                    && manager.is_mailbox()
                    && manager.direction() == direction
                    && manager.start == sii::WITH_MAILBOX[i].start
                    && manager.length == sii::WITH_MAILBOX[i].bytes
            });
        if is_right {
            code::NONE
        } else {
            code::MAILBOX
        }
    }

    fn check_process_data(&mut self) -> u16 {
        let first = self.esc.output_manager;
        for i in first..first + 2 {
            self.esc.switch_sync_manager(i, true);
        }
        let is_right = |i: usize, assignment: u16, direction: Direction| {
            let wanted = self.device.objects().process_bytes(assignment);
            let manager = self.esc.sync_manager(i);
            if wanted == 0 {
                return !manager.is_enabled || manager.length == 0;
            }
            manager.is_enabled
                && !manager.is_mailbox()
                && manager.direction() == direction
                && usize::from(manager.length) == wanted
                && manager.start == sii::areas(self.has_mailbox)[i].start
        };
        let pulses = self.esc.u8(SYNC_ACTIVATION) & 3;
        if !is_right(first, OUTPUT_ASSIGNMENT, Direction::Write) {
            code::OUTPUTS
        } else if !is_right(first + 1, INPUT_ASSIGNMENT, Direction::Read) {
            code::INPUTS
        } else if self.esc.clock.is_some() && pulses == 3 && self.esc.u32(SYNC0_CYCLE) == 0 {
            code::SYNC_PULSES
        } else {
            code::NONE
        }
    }

    // --- process data ----------------------------------------------------------------------------

    fn take_outputs(&mut self, now_ns: u64) {
        if self.op_asked_ns.is_some() {
            self.enter_op(now_ns);
        }
        if self.state() != OP {
            return;
        }
        let manager = self.esc.sync_manager(self.esc.output_manager);
        let bytes = self.esc.get(manager.start, usize::from(manager.length)).to_vec();
        self.device.objects_mut().take_outputs(&bytes);
        let has_pulses = self.esc.u8(SYNC_ACTIVATION) & 3 == 3;
        self.device.step(has_pulses.then(|| self.esc.u32(SYNC0_CYCLE)));
        self.give_inputs();
    }

    /// Puts the device's values where the master reads inputs.
    pub fn give_inputs(&mut self) {
        let manager = self.esc.sync_manager(self.esc.output_manager + 1);
        let inputs = self.device.objects().give_inputs();
        if self.state() >= SAFE_OP && inputs.len() == usize::from(manager.length) {
            self.esc.set(manager.start, &inputs);
        }
    }

    /// Whether a master gets the inputs of a slave that needs no outputs for its next sample.
    pub fn sample_inputs(&mut self) {
        if !self.has_outputs() && self.state() >= SAFE_OP {
            self.device.step(None);
            self.give_inputs();
        }
    }

    // --- mailbox ---------------------------------------------------------------------------------

    fn answer_mail(&mut self) {
        if !self.has_mailbox || self.state() < PRE_OP {
            return;
        }
        let [to, ..] = &sii::WITH_MAILBOX;
        let mail = self.esc.get(to.start, usize::from(to.bytes)).to_vec();
        self.esc.set_mailbox_full(0, false);
        let is_pre_op = self.state() == PRE_OP;
        self.waiting.push(mailbox::answer(&mail, self.device.as_mut(), is_pre_op));
        self.post();
    }

    fn post(&mut self) {
        if self.esc.is_mailbox_full(1) || self.waiting.is_empty() {
            return;
        }
        self.last_mail = self.waiting.remove(0);
        self.deliver();
    }

    fn repeat_mail(&mut self) {
        if !self.last_mail.is_empty() {
            self.deliver();
        }
        self.esc.acknowledge_repeat(1);
    }

    fn deliver(&mut self) {
        let from = &sii::WITH_MAILBOX[1];
        let mut bytes = self.last_mail.clone();
        bytes.resize(usize::from(from.bytes), 0);
        self.esc.set(from.start, &bytes);
        self.esc.set_mailbox_full(1, true);
    }
}
