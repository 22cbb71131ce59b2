/// C interface of the official MCAP writer and reader (crate `mcap`).
///
/// One handle writes one file and serves one thread. The first error persists: every later call
/// returns false and has no effect, mcap_sink_error() gives the reason. Strings are UTF-8,
/// zero-terminated, and only read during the call. Without a Rust toolchain, without_rust.cpp is
/// used instead.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mcap_sink mcap_sink;

/// Whether recording is available; false when the program was built without Rust: then
/// mcap_sink_open() always fails.
bool mcap_sink_available(void);

/// Creates `path`, which must not exist, and writes the header. Never returns null: check
/// mcap_sink_error().
mcap_sink* mcap_sink_open(const char* path);

/// Text of the first error; empty while there is none. Valid until the next call with this handle.
const char* mcap_sink_error(const mcap_sink* sink);

/// Adds a topic with CDR messages and a ros2msg schema. Returns its number, 0 after an error.
uint16_t mcap_sink_add_channel(mcap_sink* sink, const char* topic, const char* schema_name,
                               const char* schema_text);

/// Adds a message; log time and publish time are both `time_ns` (since 1970, UTC).
bool mcap_sink_write(mcap_sink* sink, uint16_t channel, uint32_t sequence, uint64_t time_ns,
                     const uint8_t* data, size_t size);

/// Embeds a text file.
bool mcap_sink_attach(mcap_sink* sink, const char* name, uint64_t time_ns, const char* text,
                      size_t size);

/// Adds a metadata record of `count` pairs: key 0, value 0, key 1, value 1, ...
bool mcap_sink_add_metadata(mcap_sink* sink, const char* name, const char* const* pairs,
                            size_t count);

/// Ends the chunk and hands everything to the operating system: data written before survive a crash
/// of this program. A file that was deleted, moved, replaced or truncated by others is an error
/// here and in all other functions that write.
bool mcap_sink_flush(mcap_sink* sink);

/// Bytes handed to the operating system so far.
uint64_t mcap_sink_bytes(const mcap_sink* sink);

typedef enum {
  mcap_file_whole = 0,    ///< the file has all data written, or was never opened
  mcap_file_changed = 1,  ///< truncated or written to by others
  mcap_file_gone = 2      ///< its name is missing, or is that of another file
} mcap_file_state;

/// State of the file, a mcap_file_state.
int mcap_sink_state(const mcap_sink* sink);

/// Writes the index and waits until the file is on the disk.
bool mcap_sink_finish(mcap_sink* sink);

/// Closes the file and frees the handle.
void mcap_sink_free(mcap_sink* sink);

typedef enum {
  mcap_channel = 0,
  mcap_message = 1,
  mcap_attachment = 2,
  mcap_end = 3,
  mcap_damage = 4,
  mcap_lost = 5,
  mcap_metadata = 6,
  mcap_type = 7
} mcap_item_kind;

/// Receives one item of a file: a topic with the text of its schema, a message with its topic and
/// log time, an attachment with its name, the end of a file that was completed, a part that cannot
/// be read with its name, a message of that part with its topic and log time, or a metadata record
/// with its name and its keys and values, each with a terminating zero. Before a topic comes the
/// type of its messages, for example "sensor_msgs/msg/JointState". Valid during the call; `name`
/// has no terminating zero.
typedef void (*mcap_take_item)(void* context, int kind, const char* name, size_t name_size,
                               uint64_t time_ns, const uint8_t* data, size_t size);

/// Passes all intact items of a file to `take`, in order; a file cut off by a crash ends there.
/// `take` must not throw. False: `error` (zero-terminated) gives the reason.
bool mcap_sink_read(const char* path, void* context, mcap_take_item take, char* error,
                    size_t error_size);

#ifdef __cplusplus
}
#endif
