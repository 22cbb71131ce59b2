//! A file that stays failed: after the first error nothing more is written, so that what is on the
//! disk stays a clean beginning of the file.

use std::cell::Cell;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::rc::Rc;

const BUFFER_BYTES: usize = 64 * 1024;

pub struct FailFastFile {
    buffer: BufWriter<CountedFile>,
    has_failed: bool,
}

struct CountedFile {
    file: File,
    written: Rc<Cell<u64>>,
}

/// What stays reachable while a writer owns the file.
pub struct FileHandle {
    file: File,
    written: Rc<Cell<u64>>,
}

impl FailFastFile {
    /// Creates a file that must not exist.
    pub fn create(path: &Path) -> io::Result<(Self, FileHandle)> {
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        let written = Rc::new(Cell::new(0));
        let handle = FileHandle { file: file.try_clone()?, written: written.clone() };
        let buffer = BufWriter::with_capacity(BUFFER_BYTES, CountedFile { file, written });
        Ok((Self { buffer, has_failed: false }, handle))
    }

    fn guarded<T>(
        &mut self,
        action: impl FnOnce(&mut BufWriter<CountedFile>) -> io::Result<T>,
    ) -> io::Result<T> {
        if self.has_failed {
            return Err(io::Error::other("an earlier write failed"));
        }
        let result = action(&mut self.buffer);
        self.has_failed = result.is_err();
        result
    }
}

impl Write for FailFastFile {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        self.guarded(|buffer| buffer.write(data))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.guarded(|buffer| buffer.flush())
    }
}

impl Write for CountedFile {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        let size = self.file.write(data)?;
        self.written.set(self.written.get() + size as u64);
        Ok(size)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl FileHandle {
    /// Bytes handed to the operating system so far.
    pub fn written(&self) -> u64 {
        self.written.get()
    }

    /// Waits until the file is on the disk.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }
}
