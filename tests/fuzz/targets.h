/// What is fuzzed: functions of any bytes that abort, with a message, when something is wrong.
///
/// `make fuzz` builds each into a program with libFuzzer, address and undefined behaviour
/// sanitizers; replay_test.cpp runs them on the inputs in corpus/, with any compiler.
#pragma once

#include <cstdint>
#include <span>

namespace hg::hqp {

/// Problem files: refused with a place, or read, written, and read again the same.
void fuzz_reader(std::span<const std::uint8_t> bytes);

/// A sequence of warm solves of a ByteProblem: finite and certified, without allocation, same bits
/// when repeated.
void fuzz_solver(std::span<const std::uint8_t> bytes);

}  // namespace hg::hqp
