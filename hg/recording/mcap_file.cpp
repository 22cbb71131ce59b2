#include "hg/recording/mcap_file.h"

namespace hg::recording {

McapFile::McapFile(const std::filesystem::path& path)
    : sink_(mcap_sink_open(path.c_str()), &mcap_sink_free) {}

std::uint16_t McapFile::add_channel(const std::string& topic, const std::string& schema_name,
                                    const std::string& schema_text) {
  return mcap_sink_add_channel(sink_.get(), topic.c_str(), schema_name.c_str(),
                               schema_text.c_str());
}

void McapFile::attach(const std::string& name, const std::string& text, std::uint64_t time_ns) {
  mcap_sink_attach(sink_.get(), name.c_str(), time_ns, text.data(), text.size());
}

void McapFile::add_metadata(const std::string& name, const KeyValues& pairs) {
  std::vector<const char*> texts;
  for (const auto& [key, value] : pairs) {
    texts.push_back(key.c_str());
    texts.push_back(value.c_str());
  }
  mcap_sink_add_metadata(sink_.get(), name.c_str(), texts.data(), pairs.size());
}

void McapFile::write(std::uint16_t channel, std::uint64_t sequence, std::uint64_t time_ns,
                     std::span<const std::byte> message) {
  mcap_sink_write(sink_.get(), channel, static_cast<std::uint32_t>(sequence), time_ns,
                  reinterpret_cast<const std::uint8_t*>(message.data()), message.size());
}

void McapFile::flush() { mcap_sink_flush(sink_.get()); }

void McapFile::finish() { mcap_sink_finish(sink_.get()); }

std::string McapFile::error() const { return mcap_sink_error(sink_.get()); }

bool McapFile::has_failed() const { return *mcap_sink_error(sink_.get()) != '\0'; }

mcap_file_state McapFile::state() const {
  return static_cast<mcap_file_state>(mcap_sink_state(sink_.get()));
}

std::uint64_t McapFile::bytes() const { return mcap_sink_bytes(sink_.get()); }

}  // namespace hg::recording
