//! The master ethercrab behind commands on standard input: one a line, one line of JSON as answer.
//! pysoem_master.py has the same commands, and ethercat_test.py describes them.
//!
//! ethercrab_master INTERFACE

use std::io::{BufRead, Write};
use std::time::Duration;

use ethercrab::error::{Error, MailboxError};
use ethercrab::subdevice_group::{DcConfiguration, HasDc, Op, PreOp, SafeOp};
use ethercrab::{
    DcSync, MainDevice, MainDeviceConfig, PduStorage, SubDeviceGroup, SubDeviceRef, Timeouts,
};

use bus_master::link::Link;
use bus_master::pump::{now_ns, Pump};

const MOST_SLAVES: usize = 16;
const MOST_BYTES: usize = 1024;
const PATIENCE: Duration = Duration::from_secs(20);
const PERIOD: Duration = Duration::from_millis(1);

static FRAMES: PduStorage<16, { PduStorage::element_size(1100) }> = PduStorage::new();

type Group<S, D = ethercrab::subdevice_group::NoDc> =
    SubDeviceGroup<MOST_SLAVES, MOST_BYTES, ethercrab::DefaultLock, S, D>;

enum Stage {
    None,
    PreOp(Group<PreOp>),
    SafeOp(Group<SafeOp, HasDc>),
    Op(Group<Op, HasDc>),
}

struct Master {
    pump: Pump,
    bus: &'static MainDevice<'static>,
    stage: Stage,
}

/// Runs `$body` with `$group` in whatever state it is.
macro_rules! with_group {
    ($master:expr, $group:ident => $body:expr) => {
        match &$master.stage {
            Stage::None => Err("scan first".to_string()),
            Stage::PreOp($group) => $body,
            Stage::SafeOp($group) => $body,
            Stage::Op($group) => $body,
        }
    };
}

fn main() {
    let interface = std::env::args().nth(1).expect("expected: ethercrab_master INTERFACE");
    let link = Link::open(&interface).expect("the interface");
    let (tx, rx, frames) = FRAMES.try_split().expect("the only user");
    let second = Duration::from_secs(1);
    let timeouts = Timeouts {
        state_transition: 5 * second,
        pdu: second,
        eeprom: second,
        mailbox_echo: second,
        mailbox_response: second,
        ..Timeouts::default()
    };
    let config = MainDeviceConfig { dc_static_sync_iterations: 50, ..Default::default() };
    let bus = Box::leak(Box::new(MainDevice::new(frames, timeouts, config)));
    let mut master = Master { pump: Pump { link, tx, rx }, bus, stage: Stage::None };
    for line in std::io::stdin().lock().lines() {
        let line = line.expect("commands");
        let words: Vec<&str> = line.split_whitespace().collect();
        let answer = master.obey(&words).unwrap_or_else(|problem| {
            format!("{{\"error\":\"{}\"}}", problem.replace(['"', '\\'], "'"))
        });
        println!("{answer}");
        std::io::stdout().flush().expect("answers");
    }
}

fn number(text: &str) -> Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| format!("no number: {text}"))
}

fn bytes_of(hex: &str) -> Result<Vec<u8>, String> {
    (0..hex.len() / 2)
        .map(|i| u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).map_err(|error| error.to_string()))
        .collect()
}

fn hex_of(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(","))
}

/// An abort of a slave is an answer; everything else ends the command.
fn abort_or_error(error: Error) -> Result<String, String> {
    match error {
        Error::Mailbox(MailboxError::Aborted { code, .. }) => {
            Ok(format!("{{\"abort\":{}}}", u32::from(code)))
        }
        error => Err(format!("{error:?}")),
    }
}

impl Master {
    fn obey(&mut self, words: &[&str]) -> Result<String, String> {
        match *words {
            ["scan"] => self.scan(),
            ["read", i, index, subindex, size] => {
                let (i, size) = (number(i)? as usize, number(size)?);
                self.read(i, number(index)? as u16, number(subindex)? as u8, size)
            }
            ["write", i, index, subindex, hex] => {
                let (i, bytes) = (number(i)? as usize, bytes_of(hex)?);
                self.write(i, number(index)? as u16, number(subindex)? as u8, &bytes)
            }
            ["configure"] => self.configure(),
            ["operate"] => self.operate(),
            ["cycle", patience_ms, outputs] => self.cycle(number(patience_ms)?, outputs),
            ["states"] => self.states(),
            ["register", i, address, hex] => {
                let value = u16::from_le_bytes(
                    bytes_of(hex)?.try_into().map_err(|_| "expected two bytes".to_string())?,
                );
                self.set_register(number(i)? as usize, number(address)? as u16, value)
            }
            _ => Err(format!("unknown command {words:?}")),
        }
    }

    fn scan(&mut self) -> Result<String, String> {
        let group = self
            .pump
            .run(self.bus.init_single_group::<MOST_SLAVES, MOST_BYTES>(now_ns), PATIENCE)
            .ok_or("no end")?
            .map_err(|error| format!("{error:?}"))?;
        let found = list(group.iter(self.bus).map(|slave| {
            let id = slave.identity();
            format!(
                "{{\"name\":\"{}\",\"vendor\":{},\"product\":{},\"revision\":{},\"delay_ns\":{}}}",
                slave.name(),
                id.vendor_id,
                id.product_id,
                id.revision,
                slave.propagation_delay()
            )
        }));
        self.stage = Stage::PreOp(group);
        Ok(found)
    }

    fn read(&mut self, i: usize, index: u16, subindex: u8, size: u32) -> Result<String, String> {
        with_group!(self, group => {
            let slave = group.iter(self.bus).nth(i).ok_or("no such slave")?;
            let read = async {
                Ok::<_, Error>(match size {
                    1 => slave.sdo_read::<u8>(index, subindex).await?.to_le_bytes().to_vec(),
                    2 => slave.sdo_read::<u16>(index, subindex).await?.to_le_bytes().to_vec(),
                    4 => slave.sdo_read::<u32>(index, subindex).await?.to_le_bytes().to_vec(),
                    _ => slave.sdo_read::<[u8; 13]>(index, subindex).await?.to_vec(),
                })
            };
            match self.pump.run(read, PATIENCE).ok_or("no end")? {
                Ok(bytes) => Ok(format!("\"{}\"", hex_of(&bytes))),
                Err(error) => abort_or_error(error),
            }
        })
    }

    fn write(&mut self, i: usize, index: u16, subindex: u8, data: &[u8]) -> Result<String, String> {
        with_group!(self, group => {
            let slave = group.iter(self.bus).nth(i).ok_or("no such slave")?;
            let write = async {
                match *data {
                    [a] => slave.sdo_write(index, subindex, a).await,
                    [a, b] => slave.sdo_write(index, subindex, [a, b]).await,
                    [a, b, c, d] => slave.sdo_write(index, subindex, [a, b, c, d]).await,
                    _ => Err(Error::Internal),
                }
            };
            match self.pump.run(write, PATIENCE).ok_or("no end")? {
                Ok(()) => Ok("{}".to_string()),
                Err(error) => abort_or_error(error),
            }
        })
    }

    fn configure(&mut self) -> Result<String, String> {
        let Stage::PreOp(mut group) = std::mem::replace(&mut self.stage, Stage::None) else {
            return Err("scan first".to_string());
        };
        for mut slave in group.iter_mut(self.bus) {
            if slave.dc_support().any() {
                slave.set_dc_sync(DcSync::Sync0);
            }
        }
        let times = DcConfiguration {
            start_delay: Duration::from_millis(10),
            sync0_period: PERIOD,
            sync0_shift: Duration::ZERO,
        };
        let bus = self.bus;
        let configure = async {
            let group = group.into_pre_op_pdi(bus).await?;
            group.configure_dc_sync(bus, times).await?.into_safe_op(bus).await
        };
        let group = self
            .pump
            .run(configure, PATIENCE)
            .ok_or("no end")?
            .map_err(|error| format!("{error:?}"))?;
        let sizes =
            list(group.iter(bus).map(|slave| {
                format!("[{},{}]", slave.outputs_raw().len(), slave.inputs_raw().len())
            }));
        self.stage = Stage::SafeOp(group);
        Ok(sizes)
    }

    fn operate(&mut self) -> Result<String, String> {
        let Stage::SafeOp(group) = std::mem::replace(&mut self.stage, Stage::None) else {
            return Err("configure first".to_string());
        };
        let bus = self.bus;
        let operate = async {
            let group = group.request_into_op(bus).await?;
            while !group.tx_rx_dc(bus).await?.all_op() {}
            Ok::<_, Error>(group)
        };
        let group = self
            .pump
            .run(operate, PATIENCE)
            .ok_or("no end")?
            .map_err(|error| format!("{error:?}"))?;
        self.stage = Stage::Op(group);
        Ok("{}".to_string())
    }

    fn cycle(&mut self, patience_ms: u32, outputs: &str) -> Result<String, String> {
        let Stage::Op(group) = &self.stage else {
            return Err("operate first".to_string());
        };
        for (slave, hex) in group.iter(self.bus).zip(outputs.split(',')) {
            let bytes = bytes_of(hex.trim_matches('-'))?;
            slave.outputs_raw_mut().copy_from_slice(&bytes);
        }
        let patience = Duration::from_millis(u64::from(patience_ms));
        match self.pump.run(group.tx_rx_dc(self.bus), patience) {
            None => Ok("{\"counter\":null}".to_string()),
            Some(Err(error)) => Err(format!("{error:?}")),
            Some(Ok(response)) => {
                let inputs = list(
                    group
                        .iter(self.bus)
                        .map(|slave| format!("\"{}\"", hex_of(&slave.inputs_raw()))),
                );
                let counter = response.working_counter;
                Ok(format!("{{\"counter\":{counter},\"inputs\":{inputs}}}"))
            }
        }
    }

    /// AL status and code of each slave; null: no answer.
    fn states(&mut self) -> Result<String, String> {
        with_group!(self, group => {
            let mut states = Vec::new();
            for slave in group.iter(self.bus) {
                let read = status_of(&slave);
                states.push(match self.pump.run(read, PATIENCE).ok_or("no end")? {
                    Ok((status, code)) => format!("[{},{code}]", status & 0x1F),
                    Err(Error::WorkingCounter { .. }) => "null".to_string(),
                    Err(error) => return Err(format!("{error:?}")),
                });
            }
            Ok(list(states.into_iter()))
        })
    }

    fn set_register(&mut self, i: usize, address: u16, value: u16) -> Result<String, String> {
        with_group!(self, group => {
            let slave = group.iter(self.bus).nth(i).ok_or("no such slave")?;
            self.pump
                .run(slave.register_write(address, value), PATIENCE)
                .ok_or("no end")?
                .map(|_| "{}".to_string())
                .map_err(|error| format!("{error:?}"))
        })
    }
}

async fn status_of<S>(slave: &SubDeviceRef<'_, S>) -> Result<(u16, u16), Error> {
    let status = slave.register_read::<u16>(0x0130u16).await?;
    let code = slave.register_read::<u16>(0x0134u16).await?;
    Ok((status, code))
}
