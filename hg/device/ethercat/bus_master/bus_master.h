/// C interface of the EtherCAT master ethercrab.
///
/// One handle serves one interface and one thread; a program opens one. The first error persists:
/// bus_master_error() gives it. Strings are UTF-8, zero-terminated. Without a Rust toolchain,
/// without_rust.cpp is used instead.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bus_master bus_master;

/// One slave as it was found.
typedef struct {
  char name[64];      ///< of its type, from its EEPROM
  uint32_t vendor;    ///< identity, from its EEPROM
  uint32_t product;   ///< of this vendor
  uint32_t revision;  ///< of this product
  uint32_t serial;    ///< 0: the vendor gives none
  uint16_t address;   ///< that the scan has given to it
  uint32_t delay_ns;  ///< time that a frame takes from the first clock to it
  bool has_clock;     ///< distributed clock
  uint8_t status;     ///< AL status: state and, 0x10, error flag
} bus_slave;

/// Opens a network interface for frames. Never returns null: check bus_master_error().
bus_master* bus_master_open(const char* interface_name);

/// Text of the first error; empty while there is none. Valid until the next call with this handle.
const char* bus_master_error(const bus_master* master);

/// Takes all slaves to INIT and then to PRE-OP, and reads what they are. Returns their number, 0
/// after an error. Drives of a bus in operation lose their commands by this.
size_t bus_master_scan(bus_master* master);

/// One of the slaves of the last scan, in the order of the cable. False: there is none.
bool bus_master_slave(const bus_master* master, size_t index, bus_slave* slave);

/// Takes all slaves of the last scan to OP, with outputs of zero: drives stay off. Those with
/// outputs get a watchdog, which is read back. Returns the working counter that an exchange has
/// when all slaves take part; 0 after an error.
uint16_t bus_master_start(bus_master* master, uint32_t watchdog_ms);

/// Exchanges process data once, and keeps the clocks together. Returns the working counter; -1: no
/// answer within this time.
int32_t bus_master_exchange(bus_master* master, uint32_t patience_us);

/// Reads AL status and AL status code of a slave of the last scan. False: it does not answer.
bool bus_master_status(bus_master* master, size_t index, uint8_t* status, uint16_t* code);

/// Closes the interface.
void bus_master_free(bus_master* master);

#ifdef __cplusplus
}
#endif
