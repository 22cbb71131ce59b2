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

uint16_t bus_master_start(bus_master*, uint32_t) { return 0; }

int32_t bus_master_exchange(bus_master*, uint32_t) { return -1; }

bool bus_master_status(bus_master*, size_t, uint8_t*, uint16_t*) { return false; }

void bus_master_free(bus_master*) {}
