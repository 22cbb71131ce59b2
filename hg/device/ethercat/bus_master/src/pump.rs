//! Runs ethercrab without threads: polls its futures, sends their frames and receives the answers.

use std::future::Future;
use std::pin::pin;
use std::sync::atomic::{AtomicU64, Ordering};
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

use ethercrab::{PduRx, PduTx};

use crate::link::Link;

const LOOK: Duration = Duration::from_millis(1); // at timers, where no frames come

/// When the earliest timer of a pending future ends, in microseconds of `clock_us()`.
static NEXT_TIMER_US: AtomicU64 = AtomicU64::new(u64::MAX);

struct Clock;

impl embassy_time_driver::Driver for Clock {
    fn now(&self) -> u64 {
        clock_us()
    }
    // futures are polled again at that time; no waker is needed
    fn schedule_wake(&self, at: u64, _waker: &Waker) {
        NEXT_TIMER_US.fetch_min(at, Ordering::Relaxed);
    }
}

embassy_time_driver::time_driver_impl!(static CLOCK: Clock = Clock);

fn clock_us() -> u64 {
    now_ns() / 1000
}

/// Monotonic time in ns.
pub fn now_ns() -> u64 {
    // SAFETY: the call fills the time that it is given
    unsafe {
        let mut time: libc::timespec = std::mem::zeroed();
        libc::clock_gettime(libc::CLOCK_MONOTONIC, &mut time);
        time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
    }
}

pub struct Pump {
    pub link: Link,
    pub tx: PduTx<'static>,
    pub rx: PduRx<'static>,
}

impl Pump {
    /// Runs a future to its end; None: it did not come within the time, and is dropped.
    pub fn run<F: Future>(&mut self, future: F, patience: Duration) -> Option<F::Output> {
        let mut future = pin!(future);
        let mut context = Context::from_waker(Waker::noop());
        let deadline = Instant::now() + patience;
        loop {
            NEXT_TIMER_US.store(u64::MAX, Ordering::Relaxed);
            if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
                return Some(output);
            }
            if Instant::now() > deadline {
                return None;
            }
            self.send();
            self.wait();
            self.receive();
        }
    }

    fn send(&mut self) {
        while let Some(frame) = self.tx.next_sendable_frame() {
            // what cannot be sent is as good as lost
            let _ = frame.send_blocking(|bytes| {
                let _ = self.link.send(bytes);
                Ok(bytes.len())
            });
        }
    }

    fn wait(&self) {
        let timer_us = NEXT_TIMER_US.load(Ordering::Relaxed);
        let timer = Duration::from_micros(timer_us.saturating_sub(clock_us()));
        let timeout = libc::timespec { tv_sec: 0, tv_nsec: timer.min(LOOK).as_nanos() as i64 };
        let mut file =
            libc::pollfd { fd: self.link.descriptor(), events: libc::POLLIN, revents: 0 };
        // SAFETY: one file is given, and the time lives as long as the call
        unsafe { libc::ppoll(&mut file, 1, &timeout, std::ptr::null()) };
    }

    fn receive(&mut self) {
        while let Ok(Some(frame)) = self.link.receive() {
            // a frame that is no longer waited for is an error that ends nothing
            let _ = self.rx.receive_frame(frame);
        }
    }
}
