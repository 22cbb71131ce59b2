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

/// Reads an object of 1, 2 or 4 bytes of a slave that the last scan has left in PRE-OP. 0: done;
/// more: the slave refuses, with this abort code; -1: no answer, or of another size.
int64_t bus_master_read_object(bus_master* master, size_t index, uint16_t object, uint8_t subindex,
                               uint8_t* data, size_t size);

/// Writes one, likewise.
int64_t bus_master_write_object(bus_master* master, size_t index, uint16_t object, uint8_t subindex,
                                const uint8_t* data, size_t size);

/// Reads a register of 1, 2 or 4 bytes of the controller of a slave of the last scan, in any state.
/// False: no answer.
bool bus_master_read_register(bus_master* master, size_t index, uint16_t address, uint8_t* data,
                              size_t size);

/// Sets the watchdog of process data of a slave, 1 to 6553 ms, and reads it back. False: it is
/// another one.
bool bus_master_set_watchdog(bus_master* master, size_t index, uint32_t watchdog_ms);

/// This slave gets sync pulses from the next start on. The first slave that does so is the clock.
void bus_master_use_sync(bus_master* master, size_t index);

/// Takes all slaves of the last scan to SAFE-OP, with outputs of zero: drives stay off. Those with
/// outputs get a watchdog, which is read back; those that use them get sync pulses with this
/// period. Returns the working counter that an exchange has when all slaves take part; 0 after an
/// error.
uint16_t bus_master_start(bus_master* master, uint32_t watchdog_ms, uint32_t sync_ns);

/// Asks all of them for OP, which they reach with the next exchanges. False after an error.
bool bus_master_operate(bus_master* master);

/// Makes the slaves that do not reach OP, and why, the error.
void bus_master_explain(bus_master* master);

/// Bytes of process data of a slave, after the start. False: there is none.
bool bus_master_sizes(bus_master* master, size_t index, size_t* outputs, size_t* inputs);

/// An AL status code or the abort code of an object with its meaning, for example "0x001b: Sync
/// Manager Watchdog".
void bus_status_code_words(uint16_t code, char* text, size_t size);
void bus_abort_code_words(uint32_t code, char* text, size_t size);

// The functions below neither allocate nor wait for a lock, and no panic leaves them.

/// Outputs of a slave from the next exchange on; of another size they are ignored.
void bus_master_set_outputs(bus_master* master, size_t index, const uint8_t* data, size_t size);

/// Inputs of a slave by the last exchange that it took part in; `data` stays as it is where their
/// size is another one.
void bus_master_inputs(const bus_master* master, size_t index, uint8_t* data, size_t size);

/// Exchanges process data once, and keeps the clocks together. Returns the working counter; -1: no
/// answer within this time.
int32_t bus_master_exchange(bus_master* master, uint32_t patience_us);

/// Time of the first clock, to which all others are held, when the last exchange passed it; 0:
/// there is no clock. Sync pulses come at its whole periods.
uint64_t bus_master_time_ns(const bus_master* master);

/// AL state of a slave by the last exchange with an answer; 0: this slave did not answer.
uint8_t bus_master_state(const bus_master* master, size_t index);

/// Asks a slave for a state (with 0x10: acknowledges its error). False: no answer in time. What
/// becomes of it is in the next exchanges.
bool bus_master_request_state(bus_master* master, size_t index, uint8_t state,
                              uint32_t patience_us);

/// Reads AL status and AL status code of a slave of the last scan. False: no answer in time.
bool bus_master_status(bus_master* master, size_t index, uint32_t patience_us, uint8_t* status,
                       uint16_t* code);

/// Closes the interface.
void bus_master_free(bus_master* master);

#ifdef __cplusplus
}
#endif
