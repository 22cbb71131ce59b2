/// What is kept about a device between runs: the result of its last test, and where its joints
/// stood when its brakes had closed. JSON, beside the recordings.
#pragma once

#include <ctime>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/start_test/procedure.h"

namespace hg::start_test {

/// Of a test.
struct Result {
  std::string device;         ///< its name in device.yaml
  std::string address;        ///< of a remote one
  std::string version;        ///< of the program
  std::string files_sha256;   ///< of the files that describe the device
  std::time_t ended = 0;      ///< s since 1970
  bool is_simulated = false;  ///< says nothing about a machine
  bool has_passed = false;
  std::vector<Item> items;
};

/// SHA-256 of texts that follow each other, as 64 hexadecimal digits.
std::string sha256(std::span<const std::string_view> texts);

/// "FOLDER/KIND_DEVICE_WHERE.json", with characters in the names that are safe in any folder.
/// `where` is the address of a machine.
std::string file_of(std::string_view folder, std::string_view kind, std::string_view device,
                    std::string_view where);

std::string to_json(const Result& result);

/// What a run of a machine asks for.
struct Wanted {
  std::string device, address, files_sha256;
  double valid_for_s = 86400.0;
  std::time_t now = 0;
};

/// What of a kept result a run needs to know.
struct Verdict {
  std::string objection;              ///< why it does not count; empty: it does
  std::string ended;                  ///< "2026-11-23 08:00 UTC"; empty where nobody knows
  std::vector<std::string> untested;  ///< names of items that the test has left out
};

/// Of the text of a file as to_json() makes it; anything may stand there.
Verdict judge(std::string_view json, const Wanted& wanted);

/// One joint or axis of the gantry.
struct Position {
  std::string name;
  double value = 0.0;       ///< rad or m
  bool is_slide = false;    ///< m
  bool is_endless = false;  ///< whole turns do not count
};

std::string posture_to_json(const std::string& device, const std::string& address, std::time_t at,
                            const std::vector<Position>& posture);

/// Joints that stand elsewhere than they were left, or of which nothing was kept, as "m2: -0.512
/// rad, the last run has left it at 0.103 rad". Throws SetupError for a text that is no posture of
/// the machine at `address`.
struct Moved {
  std::string name, words;
};
std::vector<Moved> compare_posture(std::string_view json, const std::string& address,
                                   const std::vector<Position>& now, const StartTestConfig& config);

}  // namespace hg::start_test
