//! The slaves in a line, and what a frame meets on its way through them (ETG.1000.4).

use crate::slave::Slave;

const ETHERNET_BYTES: usize = 14;
const HEADER_BYTES: usize = 10; // of a datagram
const ETHERTYPE: [u8; 2] = [0x88, 0xA4];
const DATAGRAMS: u16 = 1; // kind of a frame

/// What becomes of a frame.
#[derive(PartialEq, Eq, Debug)]
pub enum Fate {
    Answered,
    /// By microseconds.
    Late(u64),
    Lost,
}

/// Faults of the next frames.
#[derive(Default)]
pub struct FrameFaults {
    pub lost: u32,
    pub lost_of_all_kinds: u32,
    pub late: u32,
    pub late_us: u64,
}

pub struct Line {
    pub slaves: Vec<Slave>,
    /// The last frame had process data.
    pub has_exchanged: bool,
    reached: usize, // slaves before the open cable
    pub faults: FrameFaults,
    /// Commands, and after how many frames with process data they come.
    pub waiting: Vec<(u32, String)>,
}

/// Commands of datagrams.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Nothing,
    ByPosition { reads: bool, writes: bool },
    ByAddress { reads: bool, writes: bool },
    ToAll { reads: bool, writes: bool },
    Logical { reads: bool, writes: bool },
    ReadOneWriteOthers { by_position: bool },
}

impl Kind {
    fn of(command: u8) -> Kind {
        // in each group of three: reads, writes, does both
        let reads = command % 3 != 2;
        let writes = command % 3 != 1;
        match command {
            1..=3 => Kind::ByPosition { reads, writes },
            4..=6 => Kind::ByAddress { reads, writes },
            7..=9 => Kind::ToAll { reads, writes },
            10..=12 => Kind::Logical { reads, writes },
            13 => Kind::ReadOneWriteOthers { by_position: true },
            14 => Kind::ReadOneWriteOthers { by_position: false },
            _ => Kind::Nothing,
        }
    }
}

/// One datagram of a frame, while it passes a slave.
struct Datagram<'a> {
    kind: Kind,
    address: [u8; 4],
    data: &'a mut [u8],
    counter: u16,
}

impl Datagram<'_> {
    fn position(&self) -> u16 {
        u16::from_le_bytes([self.address[0], self.address[1]])
    }
    fn offset(&self) -> u16 {
        u16::from_le_bytes([self.address[2], self.address[3]])
    }
    fn logical(&self) -> u32 {
        u32::from_le_bytes(self.address)
    }
    // each slave adds one to the position, so that the next one sees its own
    fn pass_on(&mut self) {
        let [low, high] = self.position().wrapping_add(1).to_le_bytes();
        self.address[0] = low;
        self.address[1] = high;
    }
    fn count(&mut self, has_read: bool, has_written: bool, writes_count: u16) {
        let steps = u16::from(has_read) + if has_written { writes_count } else { 0 };
        self.counter = self.counter.wrapping_add(steps);
    }
}

impl Line {
    pub fn new(slaves: Vec<Slave>) -> Line {
        let mut line = Line {
            reached: slaves.len(),
            slaves,
            has_exchanged: false,
            faults: FrameFaults::default(),
            waiting: Vec::new(),
        };
        line.connect(line.slaves.len());
        line
    }

    /// Connects the first slaves; between the last of them and the next the cable is open.
    pub fn connect(&mut self, count: usize) {
        self.reached = count;
        let total = self.slaves.len();
        for (i, slave) in self.slaves.iter_mut().enumerate() {
            let end = if i < count { count } else { total };
            slave.set_links(i + 1 < end, end - i - 1);
        }
    }

    /// Looks at what happens without frames.
    pub fn watch(&mut self, now_ns: u64) {
        for slave in &mut self.slaves {
            slave.watch(now_ns);
        }
    }

    /// Lets a frame pass; it is changed into its answer.
    pub fn pass(&mut self, frame: &mut [u8], now_ns: u64) -> Fate {
        if frame.len() < ETHERNET_BYTES + 2 || frame[12..14] != ETHERTYPE {
            return Fate::Lost;
        }
        let header = u16::from_le_bytes([frame[14], frame[15]]);
        if header >> 12 != DATAGRAMS {
            return Fate::Lost;
        }
        let end = (ETHERNET_BYTES + 2 + usize::from(header & 0x07FF)).min(frame.len());
        let has_process_data = self.pass_datagrams(&mut frame[ETHERNET_BYTES + 2..end], now_ns);
        self.has_exchanged = has_process_data;
        // the first slave marks frames that have come back
        if self.reached > 0 {
            frame[6] |= 0x02;
        }
        self.fate(has_process_data)
    }

    fn fate(&mut self, has_process_data: bool) -> Fate {
        if self.faults.lost_of_all_kinds > 0 {
            self.faults.lost_of_all_kinds -= 1;
            return Fate::Lost;
        }
        if has_process_data && self.faults.lost > 0 {
            self.faults.lost -= 1;
            return Fate::Lost;
        }
        if has_process_data && self.faults.late > 0 {
            self.faults.late -= 1;
            return Fate::Late(self.faults.late_us);
        }
        Fate::Answered
    }

    /// Whether there was a logical datagram.
    fn pass_datagrams(&mut self, mut rest: &mut [u8], now_ns: u64) -> bool {
        let mut has_process_data = false;
        while rest.len() >= HEADER_BYTES + 2 {
            let length = usize::from(u16::from_le_bytes([rest[6], rest[7]]) & 0x07FF);
            let has_more = rest[7] & 0x80 != 0;
            if rest.len() < HEADER_BYTES + length + 2 {
                break;
            }
            let (this, next) = rest.split_at_mut(HEADER_BYTES + length + 2);
            let (header, body) = this.split_at_mut(HEADER_BYTES);
            let (data, counter) = body.split_at_mut(length);
            let mut datagram = Datagram {
                kind: Kind::of(header[0]),
                address: [header[2], header[3], header[4], header[5]],
                data,
                counter: u16::from_le_bytes([counter[0], counter[1]]),
            };
            has_process_data |= matches!(datagram.kind, Kind::Logical { .. });
            for slave in &mut self.slaves[..self.reached] {
                slave.watch(now_ns);
                serve(slave, &mut datagram, now_ns);
                slave.react(now_ns);
            }
            header[2..6].copy_from_slice(&datagram.address);
            counter.copy_from_slice(&datagram.counter.to_le_bytes());
            if !has_more {
                break;
            }
            rest = next;
        }
        has_process_data
    }
}

fn serve(slave: &mut Slave, datagram: &mut Datagram, now_ns: u64) {
    match datagram.kind {
        Kind::Nothing => {}
        Kind::ByPosition { reads, writes } => {
            if datagram.position() == 0 {
                access(slave, datagram, reads, writes, now_ns);
            }
            datagram.pass_on();
        }
        Kind::ByAddress { reads, writes } => {
            if datagram.position() == station(slave) {
                access(slave, datagram, reads, writes, now_ns);
            }
        }
        Kind::ToAll { reads, writes } => {
            access(slave, datagram, reads, writes, now_ns);
            datagram.pass_on();
        }
        Kind::Logical { reads, writes } => exchange(slave, datagram, reads, writes, now_ns),
        Kind::ReadOneWriteOthers { by_position } => {
            let own = if by_position { 0 } else { station(slave) };
            let reads = datagram.position() == own;
            access(slave, datagram, reads, !reads, now_ns);
            if by_position {
                datagram.pass_on();
            }
        }
    }
}

fn station(slave: &Slave) -> u16 {
    slave.esc.u16(crate::registers::STATION_ADDRESS)
}

// Reading counts 1, writing 1, and 2 where a datagram does both. What all slaves hold is combined
// bit by bit.
fn access(slave: &mut Slave, datagram: &mut Datagram, reads: bool, writes: bool, now_ns: u64) {
    let offset = datagram.offset();
    let mut found = vec![0; datagram.data.len()];
    let has_read = reads && slave.esc.read(offset, &mut found, now_ns);
    let has_written = writes && slave.esc.write(offset, datagram.data, now_ns);
    if has_read && matches!(datagram.kind, Kind::ToAll { .. }) {
        datagram.data.iter_mut().zip(found).for_each(|(all, own)| *all |= own);
    } else if has_read {
        datagram.data.copy_from_slice(&found);
    }
    datagram.count(has_read, has_written, if reads { 2 } else { 1 });
}

fn exchange(slave: &mut Slave, datagram: &mut Datagram, reads: bool, writes: bool, now_ns: u64) {
    let logical = datagram.logical();
    let (has_read, has_written) = slave.esc.exchange(logical, datagram.data, reads, writes, now_ns);
    if has_read {
        slave.sample_inputs();
    }
    if (has_read || has_written) && slave.uncounted > 0 {
        slave.uncounted -= 1;
        return;
    }
    datagram.count(has_read, has_written, if reads { 2 } else { 1 });
}
