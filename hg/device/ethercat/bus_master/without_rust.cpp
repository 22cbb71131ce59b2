/// Replacement of the Rust library when it is missing: there is no EtherCAT, and it reports so.
#include "hg/device/ethercat/bus_master/bus_master.h"

struct bus_master {};

bus_master* bus_master_open(const char*) {
  static bus_master master;
  return &master;
}

const char* bus_master_error(const bus_master*) {
  return "EtherCAT is off: this program was built without Rust";
}

size_t bus_master_scan(bus_master*) { return 0; }

bool bus_master_slave(const bus_master*, size_t, bus_slave*) { return false; }

int64_t bus_master_read_object(bus_master*, size_t, uint16_t, uint8_t, uint8_t*, size_t) {
  return -1;
}

int64_t bus_master_write_object(bus_master*, size_t, uint16_t, uint8_t, const uint8_t*, size_t) {
  return -1;
}

bool bus_master_read_register(bus_master*, size_t, uint16_t, uint8_t*, size_t) { return false; }

bool bus_master_set_watchdog(bus_master*, size_t, uint32_t) { return false; }

void bus_master_use_sync(bus_master*, size_t) {}

uint16_t bus_master_start(bus_master*, uint32_t, uint32_t) { return 0; }

bool bus_master_operate(bus_master*) { return false; }

void bus_master_explain(bus_master*) {}

bool bus_master_sizes(bus_master*, size_t, size_t*, size_t*) { return false; }

void bus_status_code_words(uint16_t, char* text, size_t) { *text = 0; }

void bus_abort_code_words(uint32_t, char* text, size_t) { *text = 0; }

void bus_master_set_outputs(bus_master*, size_t, const uint8_t*, size_t) {}

void bus_master_inputs(const bus_master*, size_t, uint8_t*, size_t) {}

int32_t bus_master_exchange(bus_master*, uint32_t) { return -1; }

uint64_t bus_master_time_ns(const bus_master*) { return 0; }

uint8_t bus_master_state(const bus_master*, size_t) { return 0; }

bool bus_master_request_state(bus_master*, size_t, uint8_t, uint32_t) { return false; }

bool bus_master_status(bus_master*, size_t, uint32_t, uint8_t*, uint16_t*) { return false; }

void bus_master_free(bus_master*) {}
