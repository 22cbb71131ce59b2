//! The official MCAP writer and reader behind the C interface of `mcap_sink.h`.
//!
//! No panic leaves this library: a panic becomes the sticky error of its handle.

mod file;
mod read;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ffi::{c_char, c_void, CStr, CString, OsStr};
use std::os::unix::ffi::OsStrExt;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::path::Path;

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, WriteOptions, Writer};

use file::{FailFastFile, FileHandle};
use read::{read, Item};

/// Uncompressed size after which a chunk ends, whether it is flushed or not.
const CHUNK_BYTES: u64 = 2 * 1024 * 1024;
/// The fastest level of zstd that is not a trade against size on these messages (docs/reference/recording.md).
const ZSTD_LEVEL: u32 = 1;

type Failure = Box<dyn std::error::Error>;

/// One file. The chunk under way is kept in memory, so that the file always ends with a whole one.
#[allow(non_camel_case_types)]
pub struct mcap_sink {
    open: Option<OpenFile>,
    error: CString,
}

struct OpenFile {
    writer: Writer<NoSeek<FailFastFile>>,
    handle: FileHandle,
}

impl mcap_sink {
    fn open(path: &Path) -> Result<OpenFile, Failure> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library("hapticgiant")
            .chunk_size(Some(CHUNK_BYTES))
            .compression_level(ZSTD_LEVEL)
            .compression_threads(0)
            .disable_seeking(true);
        let (file, handle) = FailFastFile::create(path)?;
        Ok(OpenFile { writer: options.create(NoSeek::new(file))?, handle })
    }

    fn fail(&mut self, message: String) {
        self.error = CString::new(message.replace('\0', " ")).unwrap_or_default();
    }

    /// Runs `action` unless an earlier one failed; keeps the first error.
    fn run<T>(&mut self, action: impl FnOnce(&mut OpenFile) -> Result<T, Failure>) -> Option<T> {
        if !self.error.is_empty() {
            return None;
        }
        let file = self.open.as_mut()?;
        match catch_unwind(AssertUnwindSafe(|| action(file))) {
            Ok(Ok(value)) => return Some(value),
            Ok(Err(failure)) => self.fail(root_cause(&*failure)),
            Err(_) => self.fail("the MCAP library panicked".to_string()),
        }
        None
    }
}

/// The library says that a write failed; what is wrong with the disk stands below that.
fn root_cause(failure: &(dyn std::error::Error + 'static)) -> String {
    let mut cause = failure;
    while let Some(below) = cause.source() {
        cause = below;
    }
    cause.to_string()
}

unsafe fn text<'a>(pointer: *const c_char) -> Cow<'a, str> {
    CStr::from_ptr(pointer).to_string_lossy()
}

/// Names of files are bytes, not always UTF-8.
unsafe fn path_of<'a>(pointer: *const c_char) -> &'a Path {
    Path::new(OsStr::from_bytes(CStr::from_ptr(pointer).to_bytes()))
}

unsafe fn bytes<'a>(data: *const u8, size: usize) -> &'a [u8] {
    if size == 0 {
        &[]
    } else {
        std::slice::from_raw_parts(data, size)
    }
}

#[no_mangle]
pub extern "C" fn mcap_sink_available() -> bool {
    true
}

/// # Safety
/// `path` is a zero-terminated string.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_open(path: *const c_char) -> *mut mcap_sink {
    let path = path_of(path);
    let mut sink = Box::new(mcap_sink { open: None, error: CString::default() });
    match catch_unwind(|| mcap_sink::open(path).map_err(|failure| root_cause(&*failure))) {
        Ok(Ok(file)) => sink.open = Some(file),
        Ok(Err(message)) => sink.fail(message),
        Err(_) => sink.fail("the MCAP library panicked".to_string()),
    }
    Box::into_raw(sink)
}

/// # Safety
/// `sink` comes from `mcap_sink_open`.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_error(sink: *const mcap_sink) -> *const c_char {
    (*sink).error.as_ptr()
}

/// # Safety
/// `sink` comes from `mcap_sink_open`; the others are zero-terminated strings.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_add_channel(
    sink: *mut mcap_sink,
    topic: *const c_char,
    schema_name: *const c_char,
    schema_text: *const c_char,
) -> u16 {
    let (topic, name, schema) = (text(topic), text(schema_name), text(schema_text));
    let channel = (*sink).run(|file| {
        let schema_id = file.writer.add_schema(&name, "ros2msg", schema.as_bytes())?;
        Ok(file.writer.add_channel(schema_id, &topic, "cdr", &BTreeMap::new())?)
    });
    channel.unwrap_or(0)
}

/// # Safety
/// `sink` comes from `mcap_sink_open`; `data` points to `size` bytes.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_write(
    sink: *mut mcap_sink,
    channel: u16,
    sequence: u32,
    time_ns: u64,
    data: *const u8,
    size: usize,
) -> bool {
    let data = bytes(data, size);
    let header =
        MessageHeader { channel_id: channel, sequence, log_time: time_ns, publish_time: time_ns };
    (*sink).run(|file| Ok(file.writer.write_to_known_channel(&header, data)?)).is_some()
}

/// # Safety
/// `sink` comes from `mcap_sink_open`; `name` is a zero-terminated string; `data` points to `size`
/// bytes.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_attach(
    sink: *mut mcap_sink,
    name: *const c_char,
    time_ns: u64,
    data: *const u8,
    size: usize,
) -> bool {
    let attachment = Attachment {
        log_time: time_ns,
        create_time: time_ns,
        name: text(name).into_owned(),
        media_type: "text/plain".to_string(),
        data: Cow::Borrowed(bytes(data, size)),
    };
    (*sink).run(|file| Ok(file.writer.attach(&attachment)?)).is_some()
}

/// # Safety
/// `sink` comes from `mcap_sink_open`; `name` is a zero-terminated string; `pairs` points to
/// `2 * count` of them.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_add_metadata(
    sink: *mut mcap_sink,
    name: *const c_char,
    pairs: *const *const c_char,
    count: usize,
) -> bool {
    let pair = |i: usize| {
        let key = text(*pairs.add(2 * i)).into_owned();
        let value = text(*pairs.add(2 * i + 1)).into_owned();
        (key, value)
    };
    let metadata =
        Metadata { name: text(name).into_owned(), metadata: (0..count).map(pair).collect() };
    (*sink).run(|file| Ok(file.writer.write_metadata(&metadata)?)).is_some()
}

/// # Safety
/// `sink` comes from `mcap_sink_open`.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_flush(sink: *mut mcap_sink) -> bool {
    let flushed = (*sink).run(|file| {
        file.writer.flush()?;
        Ok(file.handle.check()?)
    });
    flushed.is_some()
}

/// # Safety
/// `sink` comes from `mcap_sink_open`.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_bytes(sink: *const mcap_sink) -> u64 {
    let file = (*sink).open.as_ref();
    file.map_or(0, |file| file.handle.written())
}

/// # Safety
/// `sink` comes from `mcap_sink_open`.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_state(sink: *const mcap_sink) -> i32 {
    match (*sink).open.as_ref() {
        Some(file) if !file.handle.is_in_place() => 2,
        Some(file) if file.handle.check().is_err() => 1,
        _ => 0,
    }
}

/// # Safety
/// `sink` comes from `mcap_sink_open`.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_finish(sink: *mut mcap_sink) -> bool {
    let finished = (*sink).run(|file| {
        file.writer.finish()?;
        file.handle.sync()?;
        Ok(file.handle.check()?)
    });
    finished.is_some()
}

/// # Safety
/// `sink` comes from `mcap_sink_open` and is not used afterwards.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_free(sink: *mut mcap_sink) {
    let sink = Box::from_raw(sink);
    let _ = catch_unwind(AssertUnwindSafe(|| drop(sink)));
}

/// Kind of an item, its topic or name, its time, and its bytes.
type TakeItem = unsafe extern "C" fn(*mut c_void, i32, *const u8, usize, u64, *const u8, usize);

/// # Safety
/// `path` is a zero-terminated string; `take` may be called with `context`; `error` points to
/// `error_size` > 0 bytes.
#[no_mangle]
pub unsafe extern "C" fn mcap_sink_read(
    path: *const c_char,
    context: *mut c_void,
    take: TakeItem,
    error: *mut c_char,
    error_size: usize,
) -> bool {
    let path = path_of(path);
    let hand_over = |item: Item| {
        let (kind, name, time_ns, data): (_, _, _, &[u8]) = match item {
            Item::Channel { topic, schema } => (0, topic, 0, schema),
            Item::Message { topic, time_ns, data } => (1, topic, time_ns, data),
            Item::Attachment { name, data } => (2, name, 0, data),
            Item::End => (3, "", 0, &[]),
            Item::Damage { part } => (4, part, 0, &[]),
            Item::Lost { topic, time_ns } => (5, topic, time_ns, &[]),
            Item::Metadata { name, pairs } => (6, name, 0, pairs),
            Item::Type { topic, name } => (7, topic, 0, name.as_bytes()),
        };
        take(context, kind, name.as_ptr(), name.len(), time_ns, data.as_ptr(), data.len());
    };
    let result = catch_unwind(AssertUnwindSafe(|| {
        read(path, hand_over).map_err(|failure| root_cause(&*failure))
    }));
    let message = match result {
        Ok(Ok(())) => return true,
        Ok(Err(message)) => message,
        Err(_) => "the MCAP library panicked".to_string(),
    };
    let size = message.len().min(error_size - 1);
    std::ptr::copy_nonoverlapping(message.as_ptr(), error.cast(), size);
    *error.add(size) = 0;
    false
}
