//! The EtherCAT master ethercrab behind the C interface of `bus_master.h`.
//!
//! No panic leaves this library: a panic becomes the sticky error of its handle.

pub mod link;
pub mod pump;

use std::ffi::{c_char, CStr, CString};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::time::Duration;

use ethercrab::error::{Error, Item};
use ethercrab::subdevice_group::{Op, PreOp};
use ethercrab::{
    AlStatusCode, Command, DefaultLock, MainDevice, MainDeviceConfig, PduStorage, SubDeviceGroup,
    Timeouts,
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
const AL_STATUS: u16 = 0x0130;
const AL_STATUS_CODE: u16 = 0x0134;
const ERROR_FLAG: u16 = 0x10;
const SECOND: Duration = Duration::from_secs(1);
const ANSWER: Duration = Duration::from_millis(500); // of one frame or one step
const TO_OP: Duration = Duration::from_secs(10); // ETG.1020
const PATIENCE: Duration = Duration::from_secs(60);

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
    error: CString,
}

type Group<S> = SubDeviceGroup<MOST_SLAVES, MOST_BYTES, DefaultLock, S>;

enum Stage {
    Unknown,
    PreOp(Group<PreOp>),
    Op(Group<Op>),
}

struct Bus {
    pump: Pump,
    device: &'static MainDevice<'static>,
    interface: String,
    stage: Stage,
    expected: u16, // working counter of an exchange
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
        })
    }

    fn scan(&mut self) -> Result<Vec<bus_slave>, String> {
        self.expect_someone()?;
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
            let (status, _) = self.status(slave.configured_address())?;
            slaves.push(bus_slave {
                name: name_of(slave.name()),
                vendor: id.vendor_id,
                product: id.product_id,
                revision: id.revision,
                serial: id.serial,
                address: slave.configured_address(),
                delay_ns: slave.propagation_delay(),
                has_clock: slave.dc_support().any(),
                status: (status & 0x1F) as u8,
            });
        }
        self.stage = Stage::PreOp(group);
        Ok(slaves)
    }

    fn start(&mut self, watchdog_ms: u32) -> Result<(), String> {
        let Stage::PreOp(group) = std::mem::replace(&mut self.stage, Stage::Unknown) else {
            return Err(format!("{}: scan comes before start", self.interface));
        };
        let device = self.device;
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
        let to_op = async {
            let group = group.request_into_op(device).await?;
            while !group.tx_rx_sync_system_time(device).await?.all_op() {}
            Ok::<_, Error>(group)
        };
        match self.pump.run(to_op, TO_OP) {
            Some(Ok(group)) => self.stage = Stage::Op(group),
            Some(Err(error)) => return Err(self.explain(&error.to_string())),
            None => return Err(self.explain("no end of the way to OP")),
        }
        Ok(())
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

    /// Working counter of one exchange of process data; None: no answer in time.
    fn exchange(&mut self, patience: Duration) -> Option<u16> {
        let Stage::Op(group) = &self.stage else { return None };
        match self.pump.run(group.tx_rx_sync_system_time(self.device), patience) {
            Some(Ok(response)) => Some(response.working_counter),
            _ => None,
        }
    }

    fn expect_someone(&mut self) -> Result<(), String> {
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

    /// AL status and its code of one slave.
    fn status(&mut self, address: u16) -> Result<(u16, u16), String> {
        let device = self.device;
        let ask = async {
            let status = Command::fprd(address, AL_STATUS).receive::<u16>(device).await?;
            let code = Command::fprd(address, AL_STATUS_CODE).receive::<u16>(device).await?;
            Ok::<_, Error>((status, code))
        };
        match self.pump.run(ask, PATIENCE) {
            Some(Ok(found)) => Ok(found),
            Some(Err(error)) => Err(format!("slave {address:#06x}: {error}")),
            None => Err(format!("slave {address:#06x}: no answer")),
        }
    }

    /// Which slaves report an error, where there are some; else what ethercrab says.
    fn explain(&mut self, words: &str) -> String {
        let count = self.device.num_subdevices() as u16;
        let mut named = Vec::new();
        for i in 0..count {
            let address = FIRST_ADDRESS + i;
            match self.status(address) {
                Ok((status, code)) if status & ERROR_FLAG != 0 => named.push(format!(
                    "slave {} of {count} ({address:#06x}) stays in {}: AL status code {code:#06x}, \
                     {}",
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

fn name_of(text: &str) -> [u8; NAME_BYTES] {
    let mut name = [0; NAME_BYTES];
    let length = text.len().min(NAME_BYTES - 1);
    name[..length].copy_from_slice(&text.as_bytes()[..length]);
    name
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
    let mut master =
        Box::new(bus_master { open: None, slaves: Vec::new(), error: CString::default() });
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
        Ok(slaves) => master.slaves = slaves,
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
/// `master` comes from `bus_master_open`.
#[no_mangle]
pub unsafe extern "C" fn bus_master_start(master: *mut bus_master, watchdog_ms: u32) -> u16 {
    let master = &mut *master;
    let Some(bus) = &mut master.open else { return 0 };
    match guarded(|| bus.start(watchdog_ms)) {
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
pub unsafe extern "C" fn bus_master_exchange(master: *mut bus_master, patience_us: u32) -> i32 {
    let Some(bus) = &mut (*master).open else { return -1 };
    let patience = Duration::from_micros(u64::from(patience_us));
    let counter = catch_unwind(AssertUnwindSafe(|| bus.exchange(patience)));
    counter.ok().flatten().map_or(-1, i32::from)
}

/// # Safety
/// `master` comes from `bus_master_open`; `status` and `code` point to numbers.
#[no_mangle]
pub unsafe extern "C" fn bus_master_status(
    master: *mut bus_master,
    index: usize,
    status: *mut u8,
    code: *mut u16,
) -> bool {
    let master = &mut *master;
    let (Some(bus), Some(slave)) = (&mut master.open, master.slaves.get(index)) else {
        return false;
    };
    match guarded(|| bus.status(slave.address)) {
        Ok((found, found_code)) => {
            *status = (found & 0x1F) as u8;
            *code = found_code;
            true
        }
        Err(_) => false,
    }
}

/// # Safety
/// `master` comes from `bus_master_open` and is not used again.
#[no_mangle]
pub unsafe extern "C" fn bus_master_free(master: *mut bus_master) {
    drop(Box::from_raw(master));
}
