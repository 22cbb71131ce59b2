//! A file that stays failed: after the first error nothing more is written, so that what is on the
//! disk stays a clean beginning of the file.

use std::cell::Cell;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::rc::Rc;

const BUFFER_BYTES: usize = 64 * 1024;

pub struct FailFastFile {
    buffer: BufWriter<CountedFile>,
    has_failed: bool,
}

struct CountedFile {
    handle: FileHandle,
}

/// What stays reachable while a writer owns the file.
pub struct FileHandle {
    file: File,
    path: PathBuf,
    written: Rc<Cell<u64>>,
}

impl FailFastFile {
    /// Creates a file that must not exist.
    pub fn create(path: &Path) -> io::Result<(Self, FileHandle)> {
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        let handle = FileHandle { file, path: path.to_path_buf(), written: Rc::default() };
        let file = CountedFile { handle: handle.another()? };
        let buffer = BufWriter::with_capacity(BUFFER_BYTES, file);
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
        // behind a part that was cut off a hole would follow
        self.handle.check()?;
        let size = self.handle.file.write(data)?;
        self.handle.written.set(self.handle.written.get() + size as u64);
        Ok(size)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.handle.file.flush()
    }
}

impl FileHandle {
    fn another(&self) -> io::Result<Self> {
        let (path, written) = (self.path.clone(), self.written.clone());
        Ok(Self { file: self.file.try_clone()?, path, written })
    }

    /// Whether the name still stands for this file.
    pub fn is_in_place(&self) -> bool {
        let place = |facts: Metadata| (facts.dev(), facts.ino());
        let own = self.file.metadata().map(place);
        std::fs::symlink_metadata(&self.path).map(place).is_ok_and(|found| own.is_ok_and(|own| own == found))
    }

    /// Fails unless it does, and the file has as many bytes as were written.
    pub fn check(&self) -> io::Result<()> {
        if !self.is_in_place() {
            return Err(io::Error::other("the file was deleted, moved or replaced"));
        }
        let (written, found) = (self.written(), self.file.metadata()?.len());
        if found != written {
            let message = format!("the file was changed: it had {written} bytes and has {found}");
            return Err(io::Error::other(message));
        }
        Ok(())
    }

    /// Bytes handed to the operating system so far.
    pub fn written(&self) -> u64 {
        self.written.get()
    }

    /// Waits until the file is on the disk.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }
}
