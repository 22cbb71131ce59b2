//! The EtherCAT master ethercrab behind the C interface of `bus_master.h`.
//!
//! No panic leaves this library: a panic becomes the sticky error of its handle.

pub mod link;
pub mod pump;

use std::ffi::{c_char, CStr, CString};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::time::Duration;

use ethercrab::error::{CoeAbortCode, Error, Item, MailboxError};
use ethercrab::subdevice_group::{Op, PreOp, SafeOp};
use ethercrab::{
    AlStatusCode, Command, DefaultLock, EtherCrabWireRead, MainDevice, MainDeviceConfig,
    PduStorage, SubDeviceGroup, Timeouts,
};

use link::Link;
use pump::{now_ns, Pump};

const MOST_SLAVES: usize = 64;
const MOST_BYTES: usize = 4096; // of process data
const FRAMES: usize = 16;
const FRAME_BYTES: usize = PduStorage::element_size(1100);
const FIRST_ADDRESS: u16 = 0x1000; // that ethercrab gives to slaves
const NAME_BYTES: usize = 64;
const WATCHDOG_DIVIDER: u16 = 0x0400;
const WATCHDOG_TIME: u16 = 0x0420;
const WATCHDOG_TICK: u16 = 2498; // 100 us
const AL_CONTROL: u16 = 0x0120;
const AL_STATUS: u16 = 0x0130;
const AL_STATUS_CODE: u16 = 0x0134;
const ERROR_FLAG: u16 = 0x10;
const SYSTEM_TIME: u16 = 0x0910;
const SYNC_ACTIVATION: u16 = 0x0981;
const SYNC_START: u16 = 0x0990;
const SYNC0_PERIOD: u16 = 0x09A0;
const SYNC0_ON: u8 = 3; // cyclic operation, with pulses
const SYNC_AHEAD_NS: u64 = 100_000_000; // of the first pulse
const SECOND: Duration = Duration::from_secs(1);
const ANSWER: Duration = Duration::from_millis(500); // of one frame or one step
const PATIENCE: Duration = Duration::from_secs(60);
const NO_ANSWER: i64 = -1;

/// One slave as in `bus_master.h`.
#[allow(non_camel_case_types)]
#[repr(C)]
#[derive(Clone, Copy)]
pub struct bus_slave {
    name: [u8; NAME_BYTES],
    vendor: u32,
    product: u32,
    revision: u32,
    serial: u32,
    address: u16,
    delay_ns: u32,
    has_clock: bool,
    status: u8,
}

/// One interface with what was found behind it.
#[allow(non_camel_case_types)]
pub struct bus_master {
    open: Option<Bus>,
    slaves: Vec<bus_slave>,
    synced: Vec<bool>, // by slave: gets sync pulses
    error: CString,
}

type Group<S> = SubDeviceGroup<MOST_SLAVES, MOST_BYTES, DefaultLock, S>;

enum Stage {
    Unknown,
    PreOp(Group<PreOp>),
    SafeOp(Group<SafeOp>),
    Op(Group<Op>),
}

/// Evaluates with the group of a stage with process data, as what else in the others.
macro_rules! with_process_data {
    ($stage:expr, $group:ident => $value:expr, else $other:expr) => {
        match $stage {
            Stage::SafeOp($group) => $value,
            Stage::Op($group) => $value,
            _ => $other,
        }
    };
}

struct Bus {
    pump: Pump,
    device: &'static MainDevice<'static>,
    interface: String,
    stage: Stage,
    expected: u16,             // working counter of an exchange
    states: [u8; MOST_SLAVES], // AL states by the last exchange; 0: no answer
    time_ns: u64,              // of the clocks at the last exchange; 0: there are none
}

impl Bus {
    fn open(interface: &str) -> Result<Bus, String> {
        let link = Link::open(interface).map_err(|error| match error.raw_os_error() {
            Some(libc::EPERM) => format!(
                "{interface}: raw sockets are not permitted: run as root, or give the program the \
                 capability cap_net_raw"
            ),
            _ => format!("{interface}: {error}"),
        })?;
        // ethercrab wants both for the rest of the program, which opens one bus
        let storage = Box::leak(Box::new(PduStorage::<FRAMES, FRAME_BYTES>::new()));
        let (tx, rx, frames) = storage.try_split().map_err(|()| "frames are in use")?;
        let timeouts = Timeouts {
            state_transition: 3 * SECOND, // ETG.1020, to PRE-OP
            pdu: ANSWER,
            eeprom: ANSWER,
            mailbox_echo: ANSWER,
            mailbox_response: 2 * ANSWER,
            ..Timeouts::default()
        };
        let config = MainDeviceConfig { dc_static_sync_iterations: 1000, ..Default::default() };
        let device = Box::leak(Box::new(MainDevice::new(frames, timeouts, config)));
        Ok(Bus {
            pump: Pump { link, tx, rx },
            device,
            interface: interface.to_string(),
            stage: Stage::Unknown,
            expected: 0,
            states: [0; MOST_SLAVES],
            time_ns: 0,
        })
    }

    fn scan(&mut self) -> Result<Vec<bus_slave>, String> {
        self.expect_slaves()?;
        let device = self.device;
        let init = device.init_single_group::<MOST_SLAVES, MOST_BYTES>(now_ns);
        let group = match self.pump.run(init, PATIENCE) {
            None => return Err(self.explain("no end of the scan")),
            Some(Err(Error::Capacity(Item::SubDevice))) => {
                return Err(format!(
                    "{}: {} slaves, at most {MOST_SLAVES} are supported",
                    self.interface,
                    device.num_subdevices()
                ))
            }
            Some(Err(error)) => return Err(self.explain(&error.to_string())),
            Some(Ok(group)) => group,
        };
        let mut slaves = Vec::new();
        for slave in group.iter(device) {
            let id = slave.identity();
            let address = slave.configured_address();
            let (status, _) = self
                .status(address, PATIENCE)
                .ok_or_else(|| format!("slave {address:#06x}: no answer"))?;
            slaves.push(bus_slave {
                name: name_of(slave.name()),
                vendor: id.vendor_id,
                product: id.product_id,
                revision: id.revision,
                serial: id.serial,
                address,
                delay_ns: slave.propagation_delay(),
                has_clock: slave.dc_support().any(),
                status: (status & 0x1F) as u8,
            });
        }
        self.stage = Stage::PreOp(group);
        Ok(slaves)
    }

    /// To SAFE-OP, with sync pulses of this period (0: none) for some slaves.
    fn start(&mut self, watchdog_ms: u32, sync_ns: u32, synced: &[u16]) -> Result<(), String> {
        let Stage::PreOp(group) = std::mem::replace(&mut self.stage, Stage::Unknown) else {
            return Err(format!("{}: scan comes before start", self.interface));
        };
        let device = self.device;
        for &address in synced {
            self.set_sync(address, synced[0], sync_ns)?;
        }
        let to_safe_op = async { group.into_pre_op_pdi(device).await?.into_safe_op(device).await };
        let group = match self.pump.run(to_safe_op, PATIENCE) {
            Some(Ok(group)) => group,
            Some(Err(error)) => return Err(self.explain(&error.to_string())),
            None => return Err(self.explain("no end of the way to SAFE-OP")),
        };
        self.expected = 0;
        let mut watched = Vec::new();
        for slave in group.iter(device) {
            let (outputs, inputs) = (slave.outputs_raw().len(), slave.inputs_raw().len());
            self.expected += u16::from(inputs > 0) + if outputs > 0 { 2 } else { 0 };
            if outputs > 0 {
                watched.push(slave.configured_address());
            }
        }
        for address in watched {
            self.set_watchdog(address, watchdog_ms)?;
        }
        self.stage = Stage::SafeOp(group);
        Ok(())
    }

    /// Asks all slaves for OP, which they reach with the next exchanges.
    fn operate(&mut self) -> Result<(), String> {
        let Stage::SafeOp(group) = std::mem::replace(&mut self.stage, Stage::Unknown) else {
            return Err(format!("{}: start comes before operate", self.interface));
        };
        match self.pump.run(group.request_into_op(self.device), PATIENCE) {
            Some(Ok(group)) => self.stage = Stage::Op(group),
            Some(Err(error)) => return Err(self.explain(&error.to_string())),
            None => return Err(self.explain("no answer on the way to OP")),
        }
        Ok(())
    }

    /// Sync pulses in step with the clock of the slave `first`.
    fn set_sync(&mut self, address: u16, first: u16, period_ns: u32) -> Result<(), String> {
        let device = self.device;
        let set = async {
            let now = Command::fprd(first, SYSTEM_TIME).receive::<u64>(device).await?;
            let period = u64::from(period_ns);
            let start = (now + SYNC_AHEAD_NS) / period * period;
            Command::fpwr(address, SYNC_ACTIVATION).send(device, 0u8).await?;
            Command::fpwr(address, SYNC_START).send(device, start).await?;
            Command::fpwr(address, SYNC0_PERIOD).send(device, period_ns).await?;
            Command::fpwr(address, SYNC_ACTIVATION).send(device, SYNC0_ON).await?;
            Command::fprd(address, SYNC0_PERIOD).receive::<u32>(device).await
        };
        match self.pump.run(set, PATIENCE) {
            Some(Ok(found)) if found == period_ns => Ok(()),
            Some(Err(error)) => Err(format!("slave {address:#06x}: sync pulses: {error}")),
            _ => Err(format!("slave {address:#06x}: its sync pulses cannot be set")),
        }
    }

    /// Sets the watchdog of process data and reads it back.
    fn set_watchdog(&mut self, address: u16, watchdog_ms: u32) -> Result<(), String> {
        let ticks = u16::try_from(watchdog_ms * 10)
            .map_err(|_| format!("watchdog: at most 6553 ms, got {watchdog_ms}"))?;
        let device = self.device;
        let set = async {
            for (register, value) in [(WATCHDOG_DIVIDER, WATCHDOG_TICK), (WATCHDOG_TIME, ticks)] {
                Command::fpwr(address, register).send(device, value).await?;
                if Command::fprd(address, register).receive::<u16>(device).await? != value {
                    return Ok(false);
                }
            }
            Ok::<_, Error>(true)
        };
        match self.pump.run(set, PATIENCE) {
            Some(Ok(true)) => Ok(()),
            Some(Err(error)) => Err(format!("slave {address:#06x}: watchdog: {error}")),
            _ => Err(format!("slave {address:#06x}: its watchdog cannot be set")),
        }
    }

    /// Reads an object of a slave in PRE-OP; an abort code, or NO_ANSWER.
    fn read_object(
        &mut self,
        slave: usize,
        (index, subindex): (u16, u8),
        data: &mut [u8],
    ) -> Result<(), i64> {
        let Stage::PreOp(group) = &self.stage else { return Err(NO_ANSWER) };
        let slave = group.iter(self.device).nth(slave).ok_or(NO_ANSWER)?;
        let read = async {
            match data.len() {
                1 => data.copy_from_slice(&[slave.sdo_read::<u8>(index, subindex).await?]),
                2 => data.copy_from_slice(&slave.sdo_read::<[u8; 2]>(index, subindex).await?),
                4 => data.copy_from_slice(&slave.sdo_read::<[u8; 4]>(index, subindex).await?),
                _ => return Err(Error::Internal),
            }
            Ok(())
        };
        self.pump.run(read, PATIENCE).ok_or(NO_ANSWER)?.map_err(abort_code)
    }

    /// Writes an object of a slave in PRE-OP; an abort code, or NO_ANSWER.
    fn write_object(
        &mut self,
        slave: usize,
        (index, subindex): (u16, u8),
        data: &[u8],
    ) -> Result<(), i64> {
        let Stage::PreOp(group) = &self.stage else { return Err(NO_ANSWER) };
        let slave = group.iter(self.device).nth(slave).ok_or(NO_ANSWER)?;
        let write = async {
            match *data {
                [a] => slave.sdo_write(index, subindex, a).await,
                [a, b] => slave.sdo_write(index, subindex, [a, b]).await,
                [a, b, c, d] => slave.sdo_write(index, subindex, [a, b, c, d]).await,
                _ => Err(Error::Internal),
            }
        };
        self.pump.run(write, PATIENCE).ok_or(NO_ANSWER)?.map_err(abort_code)
    }

    /// Reads a register of a slave's controller; false: no answer.
    fn read_register(&mut self, address: u16, register: u16, data: &mut [u8]) -> bool {
        let device = self.device;
        let ask = Command::fprd(address, register);
        let read = async {
            match data.len() {
                1 => data.copy_from_slice(&[ask.receive::<u8>(device).await?]),
                2 => data.copy_from_slice(&ask.receive::<[u8; 2]>(device).await?),
                4 => data.copy_from_slice(&ask.receive::<[u8; 4]>(device).await?),
                _ => return Err(Error::Internal),
            }
            Ok(())
        };
        matches!(self.pump.run(read, PATIENCE), Some(Ok(())))
    }

    /// Asks a slave for another state; its answer is in the next exchanges.
    fn request_state(&mut self, address: u16, state: u16, patience: Duration) -> bool {
        let request = Command::fpwr(address, AL_CONTROL).send(self.device, state);
        matches!(self.pump.run(request, patience), Some(Ok(())))
    }

    /// Working counter of one exchange of process data; None: no answer in time.
    fn exchange(&mut self, patience: Duration) -> Option<u16> {
        let device = self.device;
        let response = with_process_data!(&self.stage, group => {
            self.pump.run(group.tx_rx_sync_system_time(device), patience)
        }, else None)?;
        let response = response.ok()?;
        for (known, found) in self.states.iter_mut().zip(&response.subdevice_states) {
            *known = u8::from(*found);
        }
        self.time_ns = response.extra.unwrap_or(0);
        Some(response.working_counter)
    }

    fn expect_slaves(&mut self) -> Result<(), String> {
        let ask = Command::brd(0x0000).ignore_wkc().receive::<u8>(self.device);
        match self.pump.run(ask, PATIENCE) {
            Some(Ok(_)) => Ok(()),
            _ => Err(format!(
                "{}: no slave answers: is the interface up, the cable in the first slave, and its \
                 supply on?",
                self.interface
            )),
        }
    }

    /// AL status and its code of one slave; None: no answer in time.
    fn status(&mut self, address: u16, patience: Duration) -> Option<(u16, u16)> {
        let device = self.device;
        let ask = async {
            let status = Command::fprd(address, AL_STATUS).receive::<u16>(device).await?;
            let code = Command::fprd(address, AL_STATUS_CODE).receive::<u16>(device).await?;
            Ok::<_, Error>((status, code))
        };
        self.pump.run(ask, patience)?.ok()
    }

    /// Which slaves report an error, where there are some; else what ethercrab says.
    fn explain(&mut self, words: &str) -> String {
        let count = self.device.num_subdevices() as u16;
        let mut named = Vec::new();
        for i in 0..count {
            let address = FIRST_ADDRESS + i;
            match self.status(address, PATIENCE) {
                Some((status, code)) if status & ERROR_FLAG != 0 => named.push(format!(
                    "slave {} of {count} ({address:#06x}) stays in {}: AL status code {}",
                    i + 1,
                    state_name(status),
                    AlStatusCode::from(code)
                )),
                _ => {}
            }
        }
        if named.is_empty() {
            format!("{}: {words}", self.interface)
        } else {
            named.join("; ")
        }
    }
}

fn state_name(status: u16) -> &'static str {
    match status & 0x0F {
        1 => "INIT",
        2 => "PRE-OP",
        3 => "BOOT",
        4 => "SAFE-OP",
        8 => "OP",
        _ => "an unknown state",
    }
}

fn abort_code(error: Error) -> i64 {
    match error {
        Error::Mailbox(MailboxError::Aborted { code, .. }) => i64::from(u32::from(code)),
        _ => NO_ANSWER,
    }
}

fn name_of(text: &str) -> [u8; NAME_BYTES] {
    let mut name = [0; NAME_BYTES];
    put_text(text, &mut name);
    name
}

/// As much of a text as there is room for, zero-terminated.
fn put_text(text: &str, room: &mut [u8]) {
    let length = text.len().min(room.len().saturating_sub(1));
    room[..length].copy_from_slice(&text.as_bytes()[..length]);
    if let Some(end) = room.get_mut(length) {
        *end = 0;
    }
}

impl bus_master {
    fn fail(&mut self, message: String) {
        self.error = CString::new(message.replace('\0', " ")).unwrap_or_default();
    }
}

fn guarded<T>(action: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(action))
        .unwrap_or_else(|_| Err("the EtherCAT library panicked".to_string()))
}

/// # Safety
/// `interface` is a zero-terminated string.
#[no_mangle]
pub unsafe extern "C" fn bus_master_open(interface: *const c_char) -> *mut bus_master {
    let interface = CStr::from_ptr(interface).to_string_lossy();
    let mut master = Box::new(bus_master {
        open: None,
        slaves: Vec::new(),
        synced: Vec::new(),
        error: CString::default(),
    });
    match guarded(|| Bus::open(&interface)) {
        Ok(bus) => master.open = Some(bus),
        Err(message) => master.fail(message),
    }
    Box::into_raw(master)
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_error(master: *const bus_master) -> *const c_char {
    (*master).error.as_ptr()
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_scan(master: *mut bus_master) -> usize {
    let master = &mut *master;
    let Some(bus) = &mut master.open else { return 0 };
    match guarded(|| bus.scan()) {
        Ok(slaves) => {
            master.synced = vec![false; slaves.len()];
            master.slaves = slaves;
        }
        Err(message) => {
            master.slaves.clear();
            master.fail(message);
        }
    }
    master.slaves.len()
}

/// # Safety
/// `master` comes from `bus_master_open`; `slave` points to a `bus_slave`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_slave(
    master: *const bus_master,
    index: usize,
    slave: *mut bus_slave,
) -> bool {
    let found = (&(*master).slaves).get(index);
    if let Some(found) = found {
        *slave = *found;
    }
    found.is_some()
}

/// # Safety
/// `master` comes from `bus_master_open`; `data` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_master_read_object(
    master: *mut bus_master,
    index: usize,
    object: u16,
    subindex: u8,
    data: *mut u8,
    size: usize,
) -> i64 {
    let Some(bus) = &mut (*master).open else { return NO_ANSWER };
    let data = std::slice::from_raw_parts_mut(data, size);
    let done = catch_unwind(AssertUnwindSafe(|| bus.read_object(index, (object, subindex), data)));
    done.unwrap_or(Err(NO_ANSWER)).err().unwrap_or(0)
}

/// # Safety
/// `master` comes from `bus_master_open`; `data` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_master_write_object(
    master: *mut bus_master,
    index: usize,
    object: u16,
    subindex: u8,
    data: *const u8,
    size: usize,
) -> i64 {
    let Some(bus) = &mut (*master).open else { return NO_ANSWER };
    let data = std::slice::from_raw_parts(data, size);
    let done = catch_unwind(AssertUnwindSafe(|| bus.write_object(index, (object, subindex), data)));
    done.unwrap_or(Err(NO_ANSWER)).err().unwrap_or(0)
}

/// # Safety
/// `master` comes from `bus_master_open`; `data` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_master_read_register(
    master: *mut bus_master,
    index: usize,
    register: u16,
    data: *mut u8,
    size: usize,
) -> bool {
    let master = &mut *master;
    let (Some(bus), Some(slave)) = (&mut master.open, master.slaves.get(index)) else {
        return false;
    };
    let data = std::slice::from_raw_parts_mut(data, size);
    catch_unwind(AssertUnwindSafe(|| bus.read_register(slave.address, register, data)))
        .unwrap_or(false)
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_set_watchdog(
    master: *mut bus_master,
    index: usize,
    watchdog_ms: u32,
) -> bool {
    let master = &mut *master;
    let (Some(bus), Some(slave)) = (&mut master.open, master.slaves.get(index)) else {
        return false;
    };
    guarded(|| bus.set_watchdog(slave.address, watchdog_ms)).is_ok()
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_use_sync(master: *mut bus_master, index: usize) {
    if let Some(is_synced) = (&mut (*master).synced).get_mut(index) {
        *is_synced = true;
    }
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_start(
    master: *mut bus_master,
    watchdog_ms: u32,
    sync_ns: u32,
) -> u16 {
    let master = &mut *master;
    let Some(bus) = &mut master.open else { return 0 };
    let synced: Vec<u16> = master
        .slaves
        .iter()
        .zip(&master.synced)
        .filter(|(_, &is_synced)| is_synced)
        .map(|(slave, _)| slave.address)
        .collect();
    match guarded(|| bus.start(watchdog_ms, sync_ns, &synced)) {
        Ok(()) => bus.expected,
        Err(message) => {
            master.fail(message);
            0
        }
    }
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_operate(master: *mut bus_master) -> bool {
    let master = &mut *master;
    let Some(bus) = &mut master.open else { return false };
    match guarded(|| bus.operate()) {
        Ok(()) => true,
        Err(message) => {
            master.fail(message);
            false
        }
    }
}

/// # Safety
/// `master` comes from `bus_master_open`; `outputs` and `inputs` point to numbers.
#[no_mangle]
pub unsafe extern "C" fn bus_master_sizes(
    master: *mut bus_master,
    index: usize,
    outputs: *mut usize,
    inputs: *mut usize,
) -> bool {
    let Some(bus) = &(*master).open else { return false };
    with_process_data!(&bus.stage, group => {
        let Ok(slave) = group.subdevice(bus.device, index) else { return false };
        *outputs = slave.outputs_raw().len();
        *inputs = slave.inputs_raw().len();
        true
    }, else false)
}

/// # Safety
/// `master` comes from `bus_master_open`; `data` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_master_set_outputs(
    master: *mut bus_master,
    index: usize,
    data: *const u8,
    size: usize,
) {
    let Some(bus) = &(*master).open else { return };
    with_process_data!(&bus.stage, group => {
        let Ok(slave) = group.subdevice(bus.device, index) else { return };
        let mut outputs = slave.outputs_raw_mut();
        if outputs.len() == size {
            outputs.copy_from_slice(std::slice::from_raw_parts(data, size));
        }
    }, else {})
}

/// # Safety
/// `master` comes from `bus_master_open`; `data` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_master_inputs(
    master: *const bus_master,
    index: usize,
    data: *mut u8,
    size: usize,
) {
    let Some(bus) = &(*master).open else { return };
    with_process_data!(&bus.stage, group => {
        let Ok(slave) = group.subdevice(bus.device, index) else { return };
        let inputs = slave.inputs_raw();
        if inputs.len() == size {
            std::slice::from_raw_parts_mut(data, size).copy_from_slice(&inputs);
        }
    }, else {})
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_exchange(master: *mut bus_master, patience_us: u32) -> i32 {
    let Some(bus) = &mut (*master).open else { return -1 };
    let patience = Duration::from_micros(u64::from(patience_us));
    let counter = catch_unwind(AssertUnwindSafe(|| bus.exchange(patience)));
    counter.ok().flatten().map_or(-1, i32::from)
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_time_ns(master: *const bus_master) -> u64 {
    (&(*master).open).as_ref().map_or(0, |bus| bus.time_ns)
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_explain(master: *mut bus_master) {
    let master = &mut *master;
    let Some(bus) = &mut master.open else { return };
    match guarded(|| Ok(bus.explain("no end of the way to OP"))) {
        Ok(message) | Err(message) => master.fail(message),
    }
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_state(master: *const bus_master, index: usize) -> u8 {
    let Some(bus) = &(*master).open else { return 0 };
    bus.states.get(index).copied().unwrap_or(0)
}

/// # Safety
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_request_state(
    master: *mut bus_master,
    index: usize,
    state: u8,
    patience_us: u32,
) -> bool {
    let master = &mut *master;
    let (Some(bus), Some(slave)) = (&mut master.open, master.slaves.get(index)) else {
        return false;
    };
    let patience = Duration::from_micros(u64::from(patience_us));
    catch_unwind(AssertUnwindSafe(|| bus.request_state(slave.address, u16::from(state), patience)))
        .unwrap_or(false)
}

/// # Safety
/// `master` comes from `bus_master_open`; `status` and `code` point to numbers.
#[no_mangle]
pub unsafe extern "C" fn bus_master_status(
    master: *mut bus_master,
    index: usize,
    patience_us: u32,
    status: *mut u8,
    code: *mut u16,
) -> bool {
    let master = &mut *master;
    let (Some(bus), Some(slave)) = (&mut master.open, master.slaves.get(index)) else {
        return false;
    };
    let patience = Duration::from_micros(u64::from(patience_us));
    let found = catch_unwind(AssertUnwindSafe(|| bus.status(slave.address, patience)));
    let Some((found, found_code)) = found.ok().flatten() else { return false };
    *status = (found & 0x1F) as u8;
    *code = found_code;
    true
}

/// # Safety
/// `text` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_status_code_words(code: u16, text: *mut u8, size: usize) {
    put_text(&AlStatusCode::from(code).to_string(), std::slice::from_raw_parts_mut(text, size));
}

/// # Safety
/// `text` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn bus_abort_code_words(code: u32, text: *mut u8, size: usize) {
    let words = match CoeAbortCode::unpack_from_slice(&code.to_le_bytes()) {
        Ok(known) => known.to_string(),
        Err(_) => format!("{code:#010x}"),
    };
    put_text(&words, std::slice::from_raw_parts_mut(text, size));
}

/// # Safety
/// `master` comes from `bus_master_open` and is not used again.
#[no_mangle]
pub unsafe extern "C" fn bus_master_free(master: *mut bus_master) {
    drop(Box::from_raw(master));
}
