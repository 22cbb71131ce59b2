//! A simulated EtherCAT segment: answers the frames of a master on a network interface as slaves in
//! a line would, and makes faults on purpose (docs/reference/ethercat_segment.md).
//!
//! segment INTERFACE LAYOUT [HOST:PORT]
//!
//! HOST:PORT is a simulated machine (`hapticgiant simulate --fast`), which the drives then move.
//! Commands come by standard input, whose end ends the program.

mod clock;
mod commands;
mod device;
mod dictionary;
mod drive;
mod esc;
mod layout;
mod line;
#[path = "../../../../hg/device/ethercat/bus_master/src/link.rs"]
mod link;
mod mailbox;
mod motor;
mod plant;
mod registers;
mod sensors;
mod sii;
mod slave;

use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

use line::{Fate, Line};
use link::Link;
use plant::Plant;

const LOOK: Duration = Duration::from_millis(5); // at watchdogs, where no frames come

struct Segment {
    line: Line,
    link: Link,
    plant: Option<Plant>,
    started: Instant,
    late: VecDeque<(Instant, Vec<u8>)>,
    typed: Vec<u8>, // an unfinished line of standard input
}

impl Segment {
    fn now_ns(&self) -> u64 {
        self.started.elapsed().as_nanos() as u64
    }

    fn run(&mut self) -> Result<(), String> {
        loop {
            let (has_frames, has_input) = self.wait();
            self.line.watch(self.now_ns());
            if has_input && !self.obey()? {
                return Ok(());
            }
            if has_frames {
                self.answer()?;
            }
            self.send_late().map_err(|error| format!("the interface: {error}"))?;
        }
    }

    fn wait(&self) -> (bool, bool) {
        let now = Instant::now();
        let next = self.late.iter().map(|(time, _)| time.saturating_duration_since(now)).min();
        let timeout = next.unwrap_or(LOOK).min(LOOK);
        let mut files = [self.link.descriptor(), 0].map(|fd| libc::pollfd {
            fd,
            events: libc::POLLIN,
            revents: 0,
        });
        let timeout = libc::timespec { tv_sec: 0, tv_nsec: timeout.as_nanos() as i64 };
        // SAFETY: two files are given, and the time lives as long as the call
        unsafe { libc::ppoll(files.as_mut_ptr(), 2, &timeout, std::ptr::null()) };
        (files[0].revents != 0, files[1].revents != 0)
    }

    fn answer(&mut self) -> Result<(), String> {
        let wrong = |error: io::Error| format!("the interface: {error}");
        let now_ns = self.now_ns();
        while let Some(frame) = self.link.receive().map_err(wrong)? {
            let fate = self.line.pass(frame, now_ns);
            match fate {
                Fate::Lost => {}
                Fate::Late(us) => {
                    let due = Instant::now() + Duration::from_micros(us);
                    self.late.push_back((due, frame.to_vec()));
                }
                Fate::Answered => {
                    let answer = frame.to_vec();
                    self.link.send(&answer).map_err(wrong)?;
                }
            }
            if !self.line.has_exchanged {
                continue;
            }
            if let Some(plant) = &mut self.plant {
                plant.follow(&mut self.line).map_err(|error| format!("the plant: {error}"))?;
            }
            commands::execute_due(&mut self.line, now_ns)?;
        }
        Ok(())
    }

    fn send_late(&mut self) -> io::Result<()> {
        let now = Instant::now();
        while self.late.front().is_some_and(|(time, _)| *time <= now) {
            if let Some((_, frame)) = self.late.pop_front() {
                self.link.send(&frame)?;
            }
        }
        Ok(())
    }

    /// Executes what was typed; false: that was the end.
    fn obey(&mut self) -> Result<bool, String> {
        let mut bytes = [0; 4096];
        let count = io::stdin().lock().read(&mut bytes).map_err(|error| error.to_string())?;
        self.typed.extend(&bytes[..count]);
        while let Some(end) = self.typed.iter().position(|&byte| byte == b'\n') {
            let line: Vec<u8> = self.typed.drain(..=end).collect();
            let command = String::from_utf8_lossy(&line);
            let now_ns = self.now_ns();
            let answer = commands::execute(&mut self.line, command.trim(), now_ns);
            say(&answer)?;
        }
        Ok(count > 0)
    }
}

fn say(text: &str) -> Result<(), String> {
    let mut out = io::stdout().lock();
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(|error| error.to_string())
}

fn start() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (interface, file, machine) = match &arguments[..] {
        [interface, file] => (interface, file, None),
        [interface, file, machine] => (interface, file, Some(machine)),
        _ => return Err("expected: segment INTERFACE LAYOUT [HOST:PORT]".to_string()),
    };
    let text = std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
    let slaves = layout::read(&text).map_err(|problem| format!("{file}: {problem}"))?;
    let link = Link::open(interface).map_err(|error| format!("{interface}: {error}"))?;
    let mut line = Line::new(slaves);
    let plant = machine.map(|address| Plant::behind(&mut line, address)).transpose()?;
    say(&format!("{} slaves on {interface}", line.slaves.len()))?;
    let mut segment = Segment {
        line,
        link,
        plant,
        started: Instant::now(),
        late: VecDeque::new(),
        typed: Vec::new(),
    };
    segment.run()
}

fn main() {
    if let Err(problem) = start() {
        eprintln!("segment: {problem}");
        std::process::exit(2);
    }
}
