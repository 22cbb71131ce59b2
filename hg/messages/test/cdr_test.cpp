#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "hg/core/allocation_counter.h"
#include "hg/messages/cdr_reader.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/ros_messages.h"
#include "hg/messages/test/random_message.h"
#include "hg/signals/state.h"

namespace hg::messages {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes(std::initializer_list<int> values) {
  Bytes result;
  for (const int value : values) result.push_back(static_cast<std::byte>(value));
  return result;
}

template <typename Message>
Bytes encoded(const Message& message) {
  CdrWriter writer;
  const auto span = writer.encode(message);
  return {span.begin(), span.end()};
}

Sample random_sample(std::uint64_t seed) {
  Sample sample;
  RandomFiller filler(seed);
  fields(filler, sample);
  return sample;
}

TEST(CdrWriter, AlignsNumbersToTheirSizeBehindTheHeader) {
  // an empty frame id moves the next number to offset 13, aligned 16; empty sequences are a length
  JointState state;
  state.header.stamp = {1, 2};
  state.name = {"ab"};
  state.position = {1.0};
  EXPECT_EQ(encoded(state), bytes({0, 1, 0, 0,                 // CDR, little endian
                                   1, 0, 0, 0, 2, 0, 0,    0,  // stamp
                                   1, 0, 0, 0, 0, 0, 0,    0,  // frame id "", padding
                                   1, 0, 0, 0, 3, 0, 0,    0,    'a', 'b', 0,  // one name
                                   0, 1, 0, 0, 0,                 // padding, one position
                                   0, 0, 0, 0, 0, 0, 0xf0, 0x3f,  // 1.0, already at 32
                                   0, 0, 0, 0, 0, 0, 0,    0}));  // no velocity, no effort
}

TEST(CdrWriter, WritesMatricesRowByRow) {
  Pose pose;
  pose.R << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const Bytes message = encoded(pose);
  ASSERT_EQ(message.size(), 4 + 12 * sizeof(double));
  for (std::size_t i = 0; i < 9; ++i) {
    double value = 0.0;
    std::memcpy(&value, message.data() + 4 + (3 + i) * sizeof(double), sizeof(double));
    EXPECT_EQ(value, static_cast<double>(i + 1));
  }
}

TEST(CdrWriter, WritesOnlyTheLimitsInUse) {
  Sample sample;
  const std::size_t none = encoded(sample).size();
  sample.record.limit_count = 3;
  EXPECT_EQ(encoded(sample).size(), none + 3 * 56);
}

TEST(CdrWriter, DoesNotAllocateForSamples) {
  const Sample sample = random_sample(1);
  CdrWriter writer;
  const AllocationCounter counter;
  writer.encode(sample);
  EXPECT_EQ(counter.count(), 0u);
}

TEST(Cdr, DecodingGivesEveryBitOfASample) {
  rc::check("decode after encode is the identity", [](std::uint64_t seed) {
    const Bytes message = encoded(random_sample(seed));
    Sample decoded;
    RC_ASSERT(CdrReader(message).decode(decoded));
    RC_ASSERT(encoded(decoded) == message);
  });
}

TEST(Cdr, KeepsNotANumberAndItsPayload) {
  Sample sample;
  sample.sensors.q_m = VectorM::Constant(2, std::bit_cast<double>(0x7ff4'0000'dead'beef));
  Sample decoded;
  ASSERT_TRUE(CdrReader(encoded(sample)).decode(decoded));
  ASSERT_EQ(decoded.sensors.q_m.size(), 2);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(decoded.sensors.q_m[1]), 0x7ff4'0000'dead'beef);
}

TEST(CdrReader, RefusesAMessageThatEndsTooEarly) {
  const Bytes message = encoded(random_sample(2));
  for (std::size_t size = 0; size < message.size(); ++size) {
    Sample sample;
    ASSERT_FALSE(CdrReader({message.data(), size}).decode(sample)) << size << " bytes";
  }
}

TEST(CdrReader, RefusesAVectorLongerThanItsCapacity) {
  Bytes message = encoded(Sample{});
  const std::size_t length_of_q_m = 4 + 8 + 8;  // behind sequence and time
  message[length_of_q_m] = std::byte{kMaxManipulator + 1};
  message.resize(message.size() + 1000);
  Sample sample;
  EXPECT_FALSE(CdrReader(message).decode(sample));
}

TEST(CdrReader, RefusesBigEndian) {
  Bytes message = encoded(Sample{});
  message[1] = std::byte{0};
  Sample sample;
  EXPECT_FALSE(CdrReader(message).decode(sample));
}

}  // namespace
}  // namespace hg::messages
