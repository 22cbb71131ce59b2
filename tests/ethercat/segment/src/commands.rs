//! Commands of the one who watches: faults on purpose, values of sensors, a look at the slaves. One
//! a line, one line of answer: `ok`, JSON, or `error: ...`.

use crate::layout::parse_whole;
use crate::line::Line;
use crate::registers::TIME_DELAY;
use crate::slave::{INIT, PRE_OP, SAFE_OP};

const COMMANDS: &str =
    "after, lose, late, miscount, fall, refuse, open, close, trip, brake, set, show";

pub fn execute(line: &mut Line, command: &str, now_ns: u64) -> String {
    match run(line, command, now_ns) {
        Ok(answer) => answer,
        Err(problem) => format!("error: {problem}"),
    }
}

/// Executes what was to wait for the frame with process data that has just passed.
pub fn execute_due(line: &mut Line, now_ns: u64) -> Result<(), String> {
    for (frames, _) in &mut line.waiting {
        *frames = frames.saturating_sub(1);
    }
    while let Some(i) = line.waiting.iter().position(|(frames, _)| *frames == 0) {
        let (_, command) = line.waiting.remove(i);
        run(line, &command, now_ns)?;
    }
    Ok(())
}

fn run(line: &mut Line, command: &str, now_ns: u64) -> Result<String, String> {
    let words: Vec<&str> = command.split_whitespace().collect();
    match words[..] {
        ["after", frames, _, ..] => {
            let frames = count(frames)?;
            let command = words[2..].join(" ");
            line.waiting.push((frames, command));
        }
        ["lose", frames] => line.faults.lost = count(frames)?,
        ["lose", frames, "any"] => line.faults.lost_of_all_kinds = count(frames)?,
        ["late", frames, us] => {
            line.faults.late = count(frames)?;
            line.faults.late_us = u64::from(count(us)?);
        }
        ["miscount", name, frames] => {
            let i = find(line, name)?;
            line.slaves[i].uncounted = count(frames)?;
        }
        ["fall", name, state, code] => {
            let state = match state {
                "init" => INIT,
                "preop" => PRE_OP,
                "safeop" => SAFE_OP,
                _ => return Err(format!("expected init, preop or safeop, got '{state}'")),
            };
            let i = find(line, name)?;
            line.slaves[i].fall(state, code_of(code)?);
        }
        ["refuse", name, code] => {
            let i = find(line, name)?;
            line.slaves[i].refusal = code_of(code)?;
        }
        ["open", name] => {
            let i = find(line, name)?;
            line.connect(i + 1);
        }
        ["close"] => line.connect(line.slaves.len()),
        ["trip", name, code] => {
            let i = find(line, name)?;
            let code = code_of(code)?;
            if !line.slaves[i].device.trip(code) {
                return Err(format!("'{name}' has no faults"));
            }
            line.slaves[i].give_inputs();
        }
        ["brake", name] => {
            let i = find(line, name)?;
            if !line.slaves[i].device.close_brake() {
                return Err(format!("'{name}' has no brake"));
            }
        }
        ["set", channel, value] => set(line, channel, value)?,
        ["show"] => return Ok(show(line, now_ns)),
        _ => return Err(format!("cannot read '{command}'; commands: {COMMANDS}")),
    }
    Ok("ok".to_string())
}

fn count(text: &str) -> Result<u32, String> {
    parse_whole(text).ok_or_else(|| format!("expected a number, got '{text}'"))
}

fn code_of(text: &str) -> Result<u16, String> {
    count(text)?.try_into().map_err(|_| format!("expected a code of 16 bits, got '{text}'"))
}

fn find(line: &Line, name: &str) -> Result<usize, String> {
    line.slaves.iter().position(|slave| slave.name == name).ok_or_else(|| {
        let names: Vec<&str> = line.slaves.iter().map(|slave| slave.name.as_str()).collect();
        format!("no slave '{name}'; there are {}", names.join(", "))
    })
}

fn set(line: &mut Line, channel: &str, value: &str) -> Result<(), String> {
    let (name, channel) =
        channel.split_once('.').ok_or_else(|| format!("expected NAME.CHANNEL, got '{channel}'"))?;
    let i = find(line, name)?;
    let device = &mut line.slaves[i].device;
    let channels = device.channels();
    let number = channels.iter().position(|&known| known == channel).ok_or_else(|| {
        format!("'{name}' has no channel '{channel}'; it has {}", channels.join(", "))
    })?;
    let value: f64 = value.parse().map_err(|_| format!("expected a number, got '{value}'"))?;
    if !value.is_finite() {
        return Err("expected a finite number".to_string());
    }
    device.set_channel(number, value);
    line.slaves[i].give_inputs();
    Ok(())
}

fn show(line: &Line, now_ns: u64) -> String {
    let reference = line.slaves.iter().find_map(|slave| slave.esc.shared_time(now_ns));
    let slaves: Vec<String> = line
        .slaves
        .iter()
        .map(|slave| {
            let ahead = slave.esc.shared_time(now_ns).zip(reference);
            let clock = ahead.map_or(String::new(), |(own, first)| {
                let delay = slave.esc.u32(TIME_DELAY);
                format!(",\"ahead_ns\":{},\"delay_ns\":{delay}", own.wrapping_sub(first) as i64)
            });
            format!(
                "{{\"name\":\"{}\",\"status\":{},\"code\":{}{clock}{}}}",
                slave.name,
                slave.status(),
                slave.status_code(),
                slave.device.describe()
            )
        })
        .collect();
    format!("[{}]", slaves.join(","))
}
