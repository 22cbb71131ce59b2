/// Replacement of the Rust library when it is missing: recording is off and reports so.
#include "hg/recording/mcap_sink/mcap_sink.h"

#include <cstdio>

struct mcap_sink {};

bool mcap_sink_available() { return false; }

mcap_sink* mcap_sink_open(const char*) {
  static mcap_sink sink;
  return &sink;
}

const char* mcap_sink_error(const mcap_sink*) {
  return "recording is off: this program was built without Rust";
}

uint16_t mcap_sink_add_channel(mcap_sink*, const char*, const char*, const char*) { return 0; }

bool mcap_sink_write(mcap_sink*, uint16_t, uint32_t, uint64_t, const uint8_t*, size_t) {
  return false;
}

bool mcap_sink_attach(mcap_sink*, const char*, uint64_t, const char*, size_t) { return false; }

bool mcap_sink_add_metadata(mcap_sink*, const char*, const char* const*, size_t) { return false; }

bool mcap_sink_flush(mcap_sink*) { return false; }

int mcap_sink_state(const mcap_sink*) { return mcap_file_whole; }

uint64_t mcap_sink_bytes(const mcap_sink*) { return 0; }

bool mcap_sink_finish(mcap_sink*) { return false; }

void mcap_sink_free(mcap_sink*) {}

bool mcap_sink_read(const char*, void*, mcap_take_item, char* error, size_t error_size) {
  std::snprintf(error, error_size, "%s", mcap_sink_error(nullptr));
  return false;
}
