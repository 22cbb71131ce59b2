//! A drive with the profile CiA 402: state machine, cyclic synchronous position, velocity and torque
//! (CSP, CSV, CST), limits, faults and a brake. Its motor moves by one period with each output.

use std::f64::consts::TAU;

use crate::device::{common_objects, Device};
use crate::dictionary::{
    Abort, Access, Dictionary, Mapped, PdoEntry, INPUT_ASSIGNMENT, OUTPUT_ASSIGNMENT,
};
use crate::motor::{Motor, Wish};
use crate::plant::{Demand, Part, Sensed};

const ERROR_CODE: u16 = 0x603F;
const CONTROL_WORD: u16 = 0x6040;
const STATUS_WORD: u16 = 0x6041;
const QUICK_STOP_OPTION: u16 = 0x605A;
const SHUTDOWN_OPTION: u16 = 0x605B;
const DISABLE_OPTION: u16 = 0x605C;
const HALT_OPTION: u16 = 0x605D;
const FAULT_OPTION: u16 = 0x605E;
const MODE: u16 = 0x6060;
const MODE_NOW: u16 = 0x6061;
const POSITION: u16 = 0x6064;
const FOLLOWING_WINDOW: u16 = 0x6065;
const FOLLOWING_TIME: u16 = 0x6066;
const VELOCITY: u16 = 0x606C;
const TARGET_TORQUE: u16 = 0x6071;
const MOST_TORQUE: u16 = 0x6072;
const RATED: u16 = 0x6076;
const TORQUE: u16 = 0x6077;
const TARGET_POSITION: u16 = 0x607A;
const POSITION_LIMITS: u16 = 0x607D;
const MOST_SPEED: u16 = 0x6080;
const TORQUE_OFFSET: u16 = 0x60B2;
const PERIOD: u16 = 0x60C2;
const LINK_POSITION: u16 = 0x60E4; // of an encoder behind the gear
const LINK_VELOCITY: u16 = 0x60E5;
const JOINT_TORQUE: u16 = 0x2077; // of a sensor behind the gear, 1e-6 Nm
const FOLLOWING_ERROR: u16 = 0x60F4;
const DIGITAL_OUTPUTS: u16 = 0x60FE;
const TARGET_VELOCITY: u16 = 0x60FF;
const MODES: u16 = 0x6502;

const CSP: i64 = 8;
const CSV: i64 = 9;
const CST: i64 = 10;

const COMMUNICATION_FAULT: u16 = 0x7500;
const OVERSPEED_FAULT: u16 = 0x8400;
const FOLLOWING_FAULT: u16 = 0x8611;

const BRAKE_PERIODS: u32 = 5; // until it is open
const STANDSTILL: f64 = 0.05; // rad/s

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    SwitchOnDisabled,
    ReadyToSwitchOn,
    SwitchedOn,
    OperationEnabled,
    QuickStopActive,
    FaultReactionActive,
    Fault,
}

impl State {
    // bits 0 to 3, 5 and 6 of the status word
    fn bits(self) -> u16 {
        match self {
            State::SwitchOnDisabled => 0x40,
            State::ReadyToSwitchOn => 0x21,
            State::SwitchedOn => 0x23,
            State::OperationEnabled => 0x27,
            State::QuickStopActive => 0x07,
            State::FaultReactionActive => 0x0F,
            State::Fault => 0x08,
        }
    }
    fn has_torque(self) -> bool {
        matches!(
            self,
            State::OperationEnabled | State::QuickStopActive | State::FaultReactionActive
        )
    }
}

pub struct Drive {
    objects: Dictionary,
    counts_per_rad: f64, // of a gantry axis per m
    rated_torque: f64,   // Nm
    part: Part,
    has_plant: bool, // which moves it instead of its motor
    motor: Motor,
    state: State,
    last_control: u16,
    target: i64,       // of the last period, in counts
    target_speed: f64, // with which it has changed, rad/s
    brake_periods: u32,
    late_periods: u32, // outside the window of the following error
}

/// How the process data of a drive are made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Mapping {
    /// All modes; the master may map other objects.
    Free,
    /// Position only, with a gap; the master must take it as it is.
    Fixed,
    /// Torque, and the sensors behind the gear.
    Joint,
}

/// What a drive is made of.
pub struct DriveOptions {
    pub counts_per_turn: f64,
    pub mapping: Mapping,
    pub rated_torque: f64, // Nm
    /// What it moves of a plant.
    pub part: Part,
}

impl Drive {
    pub fn new(name: &str, identity: [u32; 4], options: &DriveOptions) -> Drive {
        let mut objects = common_objects(0x0002_0192, name, identity);
        add_values(&mut objects);
        add_settings(&mut objects, options);
        add_mapping(&mut objects, options.mapping);
        let motor = Motor { brake_is_closed: true, ..Motor::default() };
        let mut drive = Drive {
            objects,
            counts_per_rad: match options.part {
                Part::Axis(_) => options.counts_per_turn,
                _ => options.counts_per_turn / TAU,
            },
            rated_torque: options.rated_torque,
            part: options.part,
            has_plant: false,
            motor,
            state: State::SwitchOnDisabled,
            last_control: 0,
            target: 0,
            target_speed: 0.0,
            brake_periods: 0,
            late_periods: 0,
        };
        drive.publish(false);
        drive
    }

    // --- states ----------------------------------------------------------------------------------

    fn obey(&mut self, control: u16) {
        let is_reset = control & 0x80 != 0 && self.last_control & 0x80 == 0;
        self.last_control = control;
        let next = if self.state == State::Fault {
            if is_reset {
                self.objects.set(ERROR_CODE, 0, 0);
                State::SwitchOnDisabled
            } else {
                State::Fault
            }
        } else if self.state == State::FaultReactionActive {
            self.state
        } else {
            self.commanded(control)
        };
        self.enter(next);
    }

    // the state that a command of the control word leads to, one transition at a time
    fn commanded(&self, control: u16) -> State {
        use State::*;
        let has_voltage = control & 0x02 != 0;
        let is_quick_stop = control & 0x06 == 0x02;
        let shutdown = control & 0x07 == 0x06;
        let switch_on = control & 0x07 == 0x07;
        let enable = control & 0x0F == 0x0F;
        match self.state {
            _ if !has_voltage => SwitchOnDisabled,
            OperationEnabled if is_quick_stop => QuickStopActive,
            ReadyToSwitchOn | SwitchedOn if is_quick_stop => SwitchOnDisabled,
            SwitchOnDisabled if shutdown => ReadyToSwitchOn,
            ReadyToSwitchOn if switch_on => SwitchedOn,
            SwitchedOn | OperationEnabled if shutdown => ReadyToSwitchOn,
            SwitchedOn if enable && self.has_mode() => OperationEnabled,
            OperationEnabled if switch_on && !enable => SwitchedOn,
            state => state,
        }
    }

    fn enter(&mut self, state: State) {
        if state == State::OperationEnabled && self.state != state {
            self.brake_periods = BRAKE_PERIODS;
            self.late_periods = 0;
            self.target = self.position();
        }
        self.state = state;
    }

    fn fail(&mut self, code: u16) {
        if self.state == State::Fault || self.state == State::FaultReactionActive {
            return;
        }
        self.objects.set(ERROR_CODE, 0, i64::from(code));
        self.state =
            if self.state.has_torque() { State::FaultReactionActive } else { State::Fault };
    }

    fn stand_still_ends(&mut self) {
        if self.motor.speed.abs() > STANDSTILL {
            return;
        }
        if self.state == State::FaultReactionActive {
            self.state = State::Fault;
        }
        // options 5 to 8 stay in quick stop, the others end in switch on disabled
        if self.state == State::QuickStopActive && self.objects.get(QUICK_STOP_OPTION, 0) < 5 {
            self.state = State::SwitchOnDisabled;
        }
    }

    fn has_mode(&self) -> bool {
        self.objects.get(MODE_NOW, 0) != 0
    }

    // --- motion ----------------------------------------------------------------------------------

    fn position(&self) -> i64 {
        (self.motor.angle * self.counts_per_rad).round() as i64
    }

    /// Opens or closes the brake; true: it is open.
    fn move_brake(&mut self) -> bool {
        let is_forced =
            self.objects.get(DIGITAL_OUTPUTS, 2) & self.objects.get(DIGITAL_OUTPUTS, 1) & 1;
        if !self.state.has_torque() || is_forced != 0 {
            self.motor.brake_is_closed = true;
            self.brake_periods = BRAKE_PERIODS;
        } else if self.brake_periods > 0 {
            self.brake_periods -= 1;
        } else {
            self.motor.brake_is_closed = false;
        }
        !self.motor.brake_is_closed
    }

    fn wish(&mut self, is_open: bool) -> Wish {
        if !self.state.has_torque() {
            return Wish::Nothing;
        }
        if self.state != State::OperationEnabled || !is_open {
            self.target = self.position();
            return Wish::Speed(0.0);
        }
        match self.objects.get(MODE_NOW, 0) {
            CSP => {
                let from = self.target;
                let (low, high) =
                    (self.objects.get(POSITION_LIMITS, 1), self.objects.get(POSITION_LIMITS, 2));
                self.target = self.objects.get(TARGET_POSITION, 0).clamp(low, high.max(low));
                Wish::Angle {
                    from: from as f64 / self.counts_per_rad,
                    to: self.target as f64 / self.counts_per_rad,
                }
            }
            CSV => Wish::Speed(self.objects.get(TARGET_VELOCITY, 0) as f64 / self.counts_per_rad),
            _ => Wish::Torque(self.target_torque()),
        }
    }

    fn target_torque(&self) -> f64 {
        self.objects.get(TARGET_TORQUE, 0) as f64 * self.rated_torque / 1000.0
    }

    fn supervise(&mut self, is_open: bool, period: f64) {
        if self.state != State::OperationEnabled || !is_open {
            return;
        }
        let most = self.objects.get(MOST_SPEED, 0) as f64 * TAU / 60.0;
        if self.motor.speed.abs() > most {
            self.fail(OVERSPEED_FAULT);
        }
        let error = self.following_error().abs();
        let is_late = error > self.objects.get(FOLLOWING_WINDOW, 0);
        self.late_periods = if is_late { self.late_periods + 1 } else { 0 };
        let patience = self.objects.get(FOLLOWING_TIME, 0) as f64 * 1e-3;
        if is_late && f64::from(self.late_periods) * period > patience {
            self.fail(FOLLOWING_FAULT);
        }
    }

    fn following_error(&self) -> i64 {
        if self.objects.get(MODE_NOW, 0) == CSP {
            self.target - self.position()
        } else {
            0
        }
    }

    fn period(&self, pulses_ns: Option<u32>) -> f64 {
        match pulses_ns {
            Some(period_ns) => f64::from(period_ns) * 1e-9,
            None => {
                let exponent = self.objects.get(PERIOD, 2) as i32;
                self.objects.get(PERIOD, 1) as f64 * 10f64.powi(exponent)
            }
        }
    }

    fn publish(&mut self, is_open: bool) {
        let speed = (self.motor.speed * self.counts_per_rad).round() as i64;
        let torque = (self.motor.torque / self.rated_torque * 1000.0).round() as i64;
        let is_following = self.state == State::OperationEnabled && is_open;
        let is_limited = is_following
            && (self.motor.is_limited
                || self.objects.get(MODE_NOW, 0) == CSP
                    && self.target != self.objects.get(TARGET_POSITION, 0));
        let error = self.following_error();
        let is_late = self.objects.get(ERROR_CODE, 0) == i64::from(FOLLOWING_FAULT as i16);
        // voltage is there, and the fieldbus commands
        let status = self.state.bits()
            | 0x0210
            | if is_limited { 0x0800 } else { 0 }
            | if is_following { 0x1000 } else { 0 }
            | if is_late { 0x2000 } else { 0 };
        for (index, value) in [
            (STATUS_WORD, i64::from(status)),
            (POSITION, self.position()),
            (VELOCITY, speed),
            (TORQUE, torque),
            (FOLLOWING_ERROR, error),
        ] {
            self.objects.set(index, 0, value);
        }
        let is_wrong = self.objects.get(ERROR_CODE, 0) != 0;
        self.objects.set(0x1001, 0, i64::from(is_wrong));
    }
}

impl Device for Drive {
    fn objects(&self) -> &Dictionary {
        &self.objects
    }
    fn objects_mut(&mut self) -> &mut Dictionary {
        &mut self.objects
    }
    fn step(&mut self, pulses_ns: Option<u32>) {
        let period = self.period(pulses_ns);
        let mode = self.objects.get(MODE, 0);
        if [CSP, CSV, CST].contains(&mode) && mode != self.objects.get(MODE_NOW, 0) {
            self.objects.set(MODE_NOW, 0, mode);
            self.target = self.position();
        }
        self.obey(self.objects.get(CONTROL_WORD, 0) as u16);
        let is_open = self.move_brake();
        let wish = self.wish(is_open);
        self.target_speed = match wish {
            Wish::Angle { from, to } => (to - from) / period,
            _ => 0.0,
        };
        if !self.has_plant {
            let most = self.objects.get(MOST_TORQUE, 0) as f64 / 1000.0 * self.rated_torque;
            let offset = self.objects.get(TORQUE_OFFSET, 0) as f64 / 1000.0 * self.rated_torque;
            self.motor.step(wish, offset, most, period);
        }
        self.stand_still_ends();
        self.supervise(is_open, period);
        self.publish(is_open);
    }
    // it is not commanded any more
    fn stop(&mut self) {
        if self.state.has_torque() {
            self.objects.set(ERROR_CODE, 0, i64::from(COMMUNICATION_FAULT));
            self.state = State::Fault;
        }
        self.motor.brake_is_closed = true;
        self.motor.speed = 0.0;
        self.motor.torque = 0.0;
        self.objects.set(CONTROL_WORD, 0, 0);
        self.publish(false);
    }
    fn download(
        &mut self,
        index: u16,
        subindex: u8,
        bytes: &[u8],
        is_pre_op: bool,
    ) -> Result<(), Abort> {
        if index == MODE && !matches!(bytes, [0 | 8 | 9 | 10]) {
            return Err(Abort::OutOfRange);
        }
        self.objects.download(index, subindex, bytes, is_pre_op)
    }
    fn demand(&self) -> Option<Demand> {
        if self.part == Part::None {
            return None;
        }
        let is_following = self.state == State::OperationEnabled && !self.motor.brake_is_closed;
        let is_ready = !matches!(self.state, State::SwitchOnDisabled);
        let demand =
            |target, speed| Demand { part: self.part, is_ready, is_following, target, speed };
        Some(match self.objects.get(MODE_NOW, 0) {
            CSP => demand(self.target as f64 / self.counts_per_rad, self.target_speed),
            _ if !is_following => demand(0.0, 0.0),
            CSV => demand(self.objects.get(TARGET_VELOCITY, 0) as f64 / self.counts_per_rad, 0.0),
            _ => demand(self.target_torque(), 0.0),
        })
    }
    fn feel(&mut self, sensed: &Sensed) {
        let counts = |value: f64, scale: f64| (value * scale).round() as i64;
        match self.part {
            Part::Joint(i) => {
                self.motor.angle = sensed.theta_m[i];
                self.motor.speed = sensed.dq_m[i];
                self.motor.torque = sensed.tau_m[i];
                let scale = self.counts_per_rad;
                self.objects.set(LINK_POSITION, 1, counts(sensed.q_m[i], scale));
                self.objects.set(LINK_VELOCITY, 1, counts(sensed.dq_m[i], scale));
                self.objects.set(JOINT_TORQUE, 0, counts(sensed.tau_m[i], 1e6));
            }
            Part::Axis(i) => self.motor.angle = sensed.q_p[i],
            Part::None => return,
        }
        self.has_plant = true;
        let is_open = !self.motor.brake_is_closed;
        self.publish(is_open);
    }
    fn channels(&self) -> &'static [&'static str] {
        &["load"]
    }
    fn set_channel(&mut self, _channel: usize, value: f64) {
        self.motor.load = value;
    }
    fn trip(&mut self, code: u16) -> bool {
        self.fail(code);
        self.publish(false);
        true
    }
    fn close_brake(&mut self) -> bool {
        self.objects.set(DIGITAL_OUTPUTS, 1, 1);
        self.objects.set(DIGITAL_OUTPUTS, 2, 1);
        true
    }
    fn describe(&self) -> String {
        format!(
            ",\"drive\":\"{:?}\",\"error\":{},\"mode\":{},\"position\":{},\"torque_Nm\":{:.6},\
             \"brake_is_closed\":{}",
            self.state,
            self.objects.get(ERROR_CODE, 0) as u16,
            self.objects.get(MODE_NOW, 0),
            self.position(),
            self.motor.torque,
            self.motor.brake_is_closed
        )
    }
}

fn add_values(objects: &mut Dictionary) {
    use Access::{ReadOnly, ReadWrite};
    use Mapped::{AsInput, AsOutput};
    for (index, bytes, access, mapped) in [
        (ERROR_CODE, 2, ReadOnly, AsInput),
        (CONTROL_WORD, 2, ReadWrite, AsOutput),
        (STATUS_WORD, 2, ReadOnly, AsInput),
        (MODE, 1, ReadWrite, AsOutput),
        (MODE_NOW, 1, ReadOnly, AsInput),
        (POSITION, 4, ReadOnly, AsInput),
        (VELOCITY, 4, ReadOnly, AsInput),
        (TARGET_TORQUE, 2, ReadWrite, AsOutput),
        (TORQUE, 2, ReadOnly, AsInput),
        (TARGET_POSITION, 4, ReadWrite, AsOutput),
        (TORQUE_OFFSET, 2, ReadWrite, AsOutput),
        (FOLLOWING_ERROR, 4, ReadOnly, AsInput),
        (TARGET_VELOCITY, 4, ReadWrite, AsOutput),
    ] {
        objects.add(index, 0, &[0; 4][..bytes], access, mapped);
    }
    for (index, subindex) in [(LINK_POSITION, 1), (LINK_VELOCITY, 1), (JOINT_TORQUE, 0)] {
        objects.add(index, subindex, &[0; 4], ReadOnly, AsInput);
    }
}

fn add_settings(objects: &mut Dictionary, options: &DriveOptions) {
    use Access::{ReadOnly, ReadWrite};
    let window = (options.counts_per_turn / 4.0) as u32;
    let far = i32::MAX;
    let rated = (options.rated_torque * 1000.0) as u32; // mNm
    let modes = 1u32 << 7 | 1 << 8 | 1 << 9;
    let settings: [(u16, u8, Vec<u8>, Access); 18] = [
        (QUICK_STOP_OPTION, 0, 2i16.to_le_bytes().into(), ReadWrite),
        (SHUTDOWN_OPTION, 0, 0i16.to_le_bytes().into(), ReadWrite),
        (DISABLE_OPTION, 0, 0i16.to_le_bytes().into(), ReadWrite),
        (HALT_OPTION, 0, 1i16.to_le_bytes().into(), ReadWrite),
        (FAULT_OPTION, 0, 2i16.to_le_bytes().into(), ReadWrite),
        (FOLLOWING_WINDOW, 0, window.to_le_bytes().into(), ReadWrite),
        (FOLLOWING_TIME, 0, 10u16.to_le_bytes().into(), ReadWrite), // ms
        (MOST_TORQUE, 0, 3000u16.to_le_bytes().into(), ReadWrite),  // per mille
        (RATED, 0, rated.to_le_bytes().into(), ReadOnly),
        (POSITION_LIMITS, 0, vec![2], ReadOnly),
        (POSITION_LIMITS, 1, (-far).to_le_bytes().into(), ReadWrite),
        (POSITION_LIMITS, 2, far.to_le_bytes().into(), ReadWrite),
        (MOST_SPEED, 0, 3000u32.to_le_bytes().into(), ReadWrite), // rev/min
        (PERIOD, 0, vec![2], ReadOnly),
        (PERIOD, 1, vec![1], ReadWrite),
        (PERIOD, 2, (-3i8).to_le_bytes().into(), ReadWrite),
        (DIGITAL_OUTPUTS, 0, vec![2], ReadOnly),
        (MODES, 0, modes.to_le_bytes().into(), ReadOnly),
    ];
    for (index, subindex, bytes, access) in settings {
        objects.add(index, subindex, &bytes, access, Mapped::Never);
    }
    // bit 0 closes the brake where the mask allows it
    objects.add(DIGITAL_OUTPUTS, 1, &[0; 4], ReadWrite, Mapped::AsOutput);
    objects.add(DIGITAL_OUTPUTS, 2, &[0; 4], ReadWrite, Mapped::Never);
    objects.limit(QUICK_STOP_OPTION, 0, 0, 8);
    objects.limit(MOST_TORQUE, 0, 0, 3000);
    objects.limit(MOST_SPEED, 0, 0, 6000);
    objects.limit(PERIOD, 1, 1, 127);
    objects.limit(PERIOD, 2, -6, -2);
}

fn add_mapping(objects: &mut Dictionary, mapping: Mapping) {
    let entry = |(index, bits)| PdoEntry { index, subindex: 0, bits };
    let with = |entries: &[(u16, u8)]| entries.iter().map(|&e| entry(e)).collect::<Vec<_>>();
    let outputs = with(&[
        (CONTROL_WORD, 16),
        (TARGET_POSITION, 32),
        (TARGET_VELOCITY, 32),
        (TARGET_TORQUE, 16),
        (MODE, 8),
        (0, 8),
    ]);
    let inputs = with(&[
        (STATUS_WORD, 16),
        (POSITION, 32),
        (VELOCITY, 32),
        (TORQUE, 16),
        (MODE_NOW, 8),
        (0, 8),
    ]);
    let few_outputs =
        with(&[(MODE, 8), (0, 8), (CONTROL_WORD, 16), (TARGET_POSITION, 32), (TORQUE_OFFSET, 16)]);
    let few_inputs =
        with(&[(MODE_NOW, 8), (0, 8), (STATUS_WORD, 16), (ERROR_CODE, 16), (POSITION, 32)]);
    match mapping {
        Mapping::Free => {
            objects.add_pdo(0x1600, &outputs);
            objects.add_pdo(0x1601, &few_outputs);
            objects.add_pdo(0x1A00, &inputs);
            objects.add_pdo(0x1A01, &few_inputs);
        }
        Mapping::Joint => {
            let outputs = with(&[(CONTROL_WORD, 16), (TARGET_TORQUE, 16), (MODE, 8), (0, 8)]);
            let mut inputs =
                with(&[(STATUS_WORD, 16), (ERROR_CODE, 16), (MODE_NOW, 8), (0, 8), (POSITION, 32)]);
            for (index, subindex) in [(LINK_POSITION, 1), (LINK_VELOCITY, 1), (JOINT_TORQUE, 0)] {
                inputs.push(PdoEntry { index, subindex, bits: 32 });
            }
            objects.add_fixed_pdo(0x1600, &outputs);
            objects.add_fixed_pdo(0x1A00, &inputs);
        }
        Mapping::Fixed => {
            objects.add_fixed_pdo(0x1600, &few_outputs);
            objects.add_fixed_pdo(0x1A00, &few_inputs);
        }
    }
    objects.add_assignment(OUTPUT_ASSIGNMENT, &[0x1600]);
    objects.add_assignment(INPUT_ASSIGNMENT, &[0x1A00]);
}
