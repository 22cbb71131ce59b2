/// What a machine (a remote device that is no simulation) is asked before a run, and what is kept
/// about it: the result of its start test and the posture in which it was left.
#pragma once

#include <string>
#include <vector>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/device.h"
#include "hg/remote/remote_device.h"
#include "hg/start_test/memory.h"

namespace hg::apps {

/// Of the files that describe the device.
std::string sha256_of(const config::Device& device);

/// The file of the start test of the machine at `address` in the folder of the recordings; an empty
/// one stands for all simulations, whose results count for no machine and replace none.
std::string start_test_file(const std::string& folder, const config::Device& device,
                            const std::string& address);

/// Whether brakes and stop inputs were tested, in words for people. Throws SetupError where they
/// were not and `arguments` do not say that it goes without.
std::string check_start_test(const RunArguments& arguments, const config::Device& device);

/// Compares where the machine stands with where the last run has left it, in a short session with
/// closed brakes, which it ends. What there is to say; throws SetupError where joints stand
/// elsewhere that `arguments` do not confirm.
std::string check_posture(const RunArguments& arguments, const config::Device& device,
                          remote::RemoteDevice& remote);

/// Keeps where the machine stands at the end of its session, after a second with closed brakes.
/// Where one of them slips meanwhile, or `fault` says that one did, its start test counts no more.
/// What there is to say, one line each; nothing when all is well.
std::vector<std::string> leave_machine(const RunArguments& arguments, const config::Device& device,
                                       remote::RemoteDevice& remote, FaultCode fault);

}  // namespace hg::apps
