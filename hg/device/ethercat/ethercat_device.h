/// A machine on an EtherCAT bus as a device.
///
/// Set-up (constructor, close()) may block for a bounded time and throw; read() and write() follow
/// the contract of Device, but read() keeps the period: the device is the clock. Each read() is one
/// exchange of process data, which carries the last command. Between set-up and the first read(),
/// and in a pause with drives off, slaves rest in SAFE-OP, which needs no frames; the read() after
/// it takes them to OP and may take some seconds. Drives are switched on, with closed brakes, from
/// the first read() on, and enabled while commands have drives on. When they are switched off,
/// torques stay until the brakes are closed. What the machine stops itself for becomes a fault,
/// with the slave that it comes from in farewell(). Without answers frames continue, and
/// command all drives to stop.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hg/device/connected_device.h"
#include "hg/device/ethercat/bus.h"
#include "hg/device/ethercat/drive_state.h"
#include "hg/device/ethercat/machine.h"
#include "hg/device/ethercat/pace.h"
#include "hg/device/ethercat/process_data.h"
#include "hg/signals/frames.h"

namespace hg::ethercat {

/// Set-up data of a machine.
struct EthercatConfig {
  std::string interface_name;
  Machine machine;
  int n_p = 0;  ///< gantry axes of the device
  int n_m = 0;  ///< joints of its manipulator
  double rate_Hz = 1000.0;
  bool is_fast = false;  ///< as fast as it can, for a machine that moves with frames
};

class EthercatDevice final : public device::ConnectedDevice {
 public:
  /// Compares all slaves with the machine, sets them up, and takes them to OP with drives off.
  /// Throws SetupError with one sentence for each difference.
  explicit EthercatDevice(const EthercatConfig& config);
  /// The same on this bus, instead of one on the network interface.
  EthercatDevice(const EthercatConfig& config, std::unique_ptr<Bus> bus);
  ~EthercatDevice() override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;

  /// Stops drives that are on, switches all off, and takes the slaves back to PRE-OP, within 2 s.
  void close(FaultCode reason) noexcept override;
  std::string farewell() const override;
  LinkCounts counts() const noexcept override { return counts_; }
  std::int64_t late_ns() const noexcept override { return late_ns_; }

 private:
  /// Why the machine has stopped.
  enum class Cause : std::uint8_t {
    kNone,
    kIncomplete,
    kLeftOp,
    kDrive,
    kDisabled,
    kNotEnabled,
    kNotFollowing,
    kOutOfStep,
    kSensor,
    kNoSamples,
    kSilent,
    kNotFinite,
  };

  /// What is watched of one slave.
  struct Watch {
    bool has_followed = false;  ///< of a drive: since it was enabled
    std::uint32_t ignored = 0;  ///< samples in a row in which a drive did not follow any more
    bool was_well = false;      ///< since the machine recovers
  };

  bool is_drive(std::size_t slave) const noexcept {
    return config_.machine.slaves[slave].mode != DriveMode::kNone;
  }
  void start();
  void check_pulses();
  bool has_pulses() const noexcept;
  bool is_silent() const noexcept;
  bool come_into_step() noexcept;
  void await_drives();
  void rest() noexcept;
  bool has_paused() const noexcept;
  void wake() noexcept;
  void call_to_op() noexcept;
  void wait_for_turn() noexcept;
  std::int64_t patience_ns() const noexcept { return std::int64_t{1000} * patience_us_; }
  int exchange() noexcept;
  void take_in() noexcept;
  void take_lost() noexcept;
  void keep_stopping() noexcept;
  void repeat(SensorFrame& sensors) noexcept;
  void suspect(Cause cause, std::size_t slave) noexcept;
  void look_at_step() noexcept;
  void look_at_counter(int counter) noexcept;
  void look_at_states() noexcept;
  void look_at_drives() noexcept;
  void look_at_drive(std::size_t slave, bool is_enabled) noexcept;
  void look_at_sensors() noexcept;
  void look_at_bus_errors(int counter) noexcept;
  void look_at_recovery(int counter) noexcept;
  bool is_well(std::size_t slave) const noexcept;
  void fail_again(std::size_t slave) noexcept;
  void stop(Cause cause, std::size_t slave, FaultCode fault) noexcept;
  void fall_silent() noexcept;
  void blame(Cause cause, std::size_t slave) noexcept;
  void recover() noexcept;
  bool may_move() const noexcept;
  void put_out() noexcept;
  bool all_follow() const noexcept;
  bool any_has_power() const noexcept;
  std::uint16_t control_word_for(std::size_t slave, bool enables) const noexcept;
  bool is_finite(const CommandFrame& command) const noexcept;
  std::string drive_words() const;

  EthercatConfig config_;
  std::unique_ptr<Bus> bus_;
  std::vector<BusSlave> found_;
  std::vector<Station> stations_;
  std::vector<Watch> watches_;
  std::uint32_t enabling_ = 0;  ///< exchanges since drives were enabled
  int expected_ = 0;            ///< working counter of an exchange in which all take part
  std::uint32_t patience_us_ = 0;
  std::int64_t period_ns_ = 0;
  Pace pace_;
  SensorFrame frame_;     ///< of the last exchange
  CommandFrame command_;  ///< for the next exchange
  bool has_command_ = false;
  CommandFrame held_;               ///< last one with drives on, without its velocities
  std::uint32_t holding_ = 0;       ///< exchanges for which it is still held
  std::uint32_t hold_cycles_ = 0;   ///< exchanges until brakes are closed
  bool has_brake_outputs_ = false;  ///< brakes are closed by us, not by the drives
  std::uint64_t sequence_ = 0;
  std::uint32_t lost_in_a_row_ = 0, incomplete_in_a_row_ = 0;
  bool is_in_use_ = false;         ///< the first read() has come: drives are switched on
  std::int64_t exchanged_ns_ = 0;  ///< time of the last exchange
  std::int64_t late_ns_ = 0;       ///< of this computer in that exchange
  bool was_reset_ = false;         ///< reset button in the last command
  int recovery_ = 0;               ///< exchanges that are left to recover; 0: does not recover
  bool is_stopping_ = false;       ///< drives are commanded to stop, whatever they do
  bool is_closed_ = false;
  // why the bus has errors in this sample
  Cause suspect_ = Cause::kNone;
  std::size_t suspected_ = 0;
  // what has stopped the machine; kept for farewell() until it recovers
  Cause cause_ = Cause::kNone;
  std::size_t culprit_ = 0;
  SlaveStatus culprit_status_;
  std::uint16_t culprit_word_ = 0;  ///< status word of a drive
  std::uint8_t culprit_mode_ = 0;
  int culprit_counter_ = 0;
  FaultCode fault_ = FaultCode::kNone;
  LinkCounts counts_;
};

}  // namespace hg::ethercat
