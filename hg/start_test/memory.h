/// Data kept about a device between runs: the result of its last test, and its joint positions
/// after its brakes had closed. JSON, beside the recordings.
#pragma once

#include <ctime>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/start_test/procedure.h"

namespace hg::start_test {

/// Result of a start test.
struct StartTestResult {
  std::string device;        ///< name in device.yaml
  std::string address;       ///< address of a remote device
  std::string version;       ///< version of the program
  std::string files_sha256;  ///< hash of the files that describe the device
  std::time_t ended = 0;     ///< s since 1970
  /// What was bad about the computer and let pass, in words; empty: nothing
  std::string computer = {};
  bool is_simulated = false;  ///< simulated: no evidence about a machine
  bool has_passed = false;
  std::vector<Item> items;
};

/// SHA-256 of concatenated texts, as 64 hexadecimal digits.
std::string sha256(std::span<const std::string_view> texts);

/// File name "FOLDER/KIND_DEVICE_WHERE.json", with characters that are safe in any folder. `where`
/// is the address of a machine.
std::string file_of(std::string_view folder, std::string_view kind, std::string_view device,
                    std::string_view where);

std::string to_json(const StartTestResult& result);

/// Requirements of a run of a machine.
struct Requirements {
  std::string device, address, files_sha256;
  double valid_for_s = 86400.0;
  std::time_t now = 0;
};

/// Evaluation of a kept result for a run.
struct Validity {
  std::string objection;              ///< why the result does not count; empty: it does
  std::string ended;                  ///< "2026-11-23 08:00 UTC"; empty if unknown
  std::vector<std::string> untested;  ///< names of items left out by the test
};

/// Checks the text of a file made by to_json(); any content is allowed.
Validity check_validity(std::string_view json, const Requirements& required);

/// Position of a joint or gantry axis.
struct Position {
  std::string name;
  double value = 0.0;       ///< rad or m
  bool is_slide = false;    ///< prismatic: value in m
  bool is_endless = false;  ///< whole turns do not count
};

std::string posture_to_json(const std::string& device, const std::string& address, std::time_t at,
                            const std::vector<Position>& posture);

/// Joint that has moved since the last run, or of which no position was kept, as "m2: -0.512 rad,
/// the last run has left it at 0.103 rad". compare_posture() throws SetupError for a text that is
/// no posture of the machine at `address`.
struct Moved {
  std::string name, words;
};
std::vector<Moved> compare_posture(std::string_view json, const std::string& address,
                                   const std::vector<Position>& now, const StartTestConfig& config);

}  // namespace hg::start_test
