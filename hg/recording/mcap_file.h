/// An open MCAP file: owns the handle of mcap_sink.h and offers C++ types.
///
/// Errors persist: after the first one no more data are written and error() gives the reason. One
/// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "hg/recording/key_values.h"
#include "hg/recording/mcap_sink/mcap_sink.h"

namespace hg::recording {

class McapFile {
 public:
  /// Creates `path`, which must not exist.
  explicit McapFile(const std::filesystem::path& path);

  /// Adds a topic whose messages are encoded as CDR. Returns its number.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            const std::string& schema_text);
  void attach(const std::string& name, const std::string& text, std::uint64_t time_ns);
  void add_metadata(const std::string& name, const KeyValues& pairs);
  void write(std::uint16_t channel, std::uint64_t sequence, std::uint64_t time_ns,
             std::span<const std::byte> message);

  /// Ends a chunk: data written before survive a crash of the program.
  void flush();
  /// Writes the index and waits for the disk. The file is then complete.
  void finish();

  std::string error() const;  ///< empty while there is no error
  bool has_failed() const;
  std::uint64_t bytes() const;  ///< bytes handed to the operating system so far
  mcap_file_state state() const;

 private:
  std::unique_ptr<mcap_sink, decltype(&mcap_sink_free)> sink_;
};

}  // namespace hg::recording
