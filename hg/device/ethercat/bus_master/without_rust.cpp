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

void bus_master_free(bus_master*) {}
