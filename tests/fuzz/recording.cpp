#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>

#include "hg/core/error.h"
#include "hg/messages/cdr_reader.h"
#include "hg/recording/recording_reader.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

struct Counter final : recording::RecordingListener {
  void configuration(const recording::NamedText&) override {}
  void event(const recording::Event&) override {}
  void sample(const Sample& sample) override {
    if (sample.record.limit_count < 0 || sample.record.limit_count > kMaxLimits) std::abort();
  }
};

// in a file that needs no disk
void read_file(Bytes bytes) {
  static const int file = memfd_create("recording", 0);
  static const std::string name = "/proc/self/fd/" + std::to_string(file);
  if (ftruncate(file, 0) != 0) std::abort();
  if (pwrite(file, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    std::abort();
  }
  try {
    Counter counter;
    recording::read_recording(name, counter);
  } catch (const SetupError&) {
  }
}

}  // namespace

void recording(Bytes bytes) {
  if (bytes.empty()) return;
  const Bytes rest = bytes.subspan(1);
  if (bytes[0] % 2 == 0) return read_file(rest);
  const std::span message(reinterpret_cast<const std::byte*>(rest.data()), rest.size());
  static const auto sample = std::make_unique<Sample>();
  if (messages::CdrReader(message).decode(*sample) &&
      (sample->record.limit_count < 0 || sample->record.limit_count > kMaxLimits)) {
    std::abort();
  }
  recording::Event event;
  static_cast<void>(messages::CdrReader(message).decode(event));
}

}  // namespace hg::fuzz
