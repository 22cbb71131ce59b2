/// What is fuzzed: functions of any bytes that abort, with a message, when something is wrong.
///
/// `make fuzz` builds each into a program with libFuzzer, address and undefined behaviour
/// sanitizers; replay_test.cpp runs them on the inputs in corpus/, with any compiler.
#pragma once

#include <cstdint>
#include <span>

namespace hg::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Problem files: refused with a place, or read, written, and read again the same.
void hqp_reader(Bytes bytes);

/// A sequence of warm solves of a ByteProblem: finite and certified, without allocation, same bits
/// when repeated.
void hqp_solver(Bytes bytes);

/// A device, twin, scenario or tool file beside the shipped ones (the first byte says which):
/// refused with SetupError, or loaded.
void config(Bytes bytes);

/// A URDF: refused with its name, or a chain whose kinematics can be computed.
void urdf(Bytes bytes);

/// A datagram, its checksum corrected where the first byte is odd: refused, or decoded, and what is
/// encoded from that is decoded to the same again.
void protocol(Bytes bytes);

/// What a page may send: refused, or within the ranges that messages.h promises.
void commands(Bytes bytes);

/// Frames of a live client, each after a byte of flags and one for its size: answered with frames
/// that are well formed, and orders within the ranges of the parameters.
void live(Bytes bytes);

/// A recording (first byte even), or the bytes of one sample or event: refused, or handed out.
void recording(Bytes bytes);

}  // namespace hg::fuzz
