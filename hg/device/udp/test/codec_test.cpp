#include "hg/device/udp/codec.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "hg/device/udp/test/example_messages.h"

namespace hg::udp {
namespace {

Datagram sensors_datagram() {
  std::mt19937 random(1);
  Datagram datagram;
  encode({.session = 7, .number = 3, .time_ns = 5}, example_sensors(random, 42), datagram);
  return datagram;
}

DatagramCheck verdict_of(std::span<const std::byte> bytes) {
  Header header;
  return read_header(bytes, header);
}

// after a change, the checksum is made to fit again
Datagram sealed(Datagram datagram) {
  const std::uint32_t crc = checksum(datagram.view().first(datagram.size - 4));
  std::memcpy(datagram.bytes.data() + datagram.size - 4, &crc, 4);
  return datagram;
}

template <typename T>
Datagram with(Datagram datagram, std::size_t offset, T value) {
  std::memcpy(datagram.bytes.data() + offset, &value, sizeof value);
  return sealed(datagram);
}

TEST(Printable, KeepsTextAndReplacesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("Gr\u00F6\u00DFe \u20AC \u00C0 1.5\u00B0"),
            "Gr\u00F6\u00DFe \u20AC \u00C0 1.5\u00B0");
  EXPECT_EQ(printable("\x1B[31mred\n\r\t\x07\x7F."), "?[31mred?????.");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "31m\x9B"
                      "31m"),
            "a??31m?31m");  // CSI, in UTF-8 and as one byte
  EXPECT_EQ(printable("\xC0\x9B \xE0\x80\x9B a\u202Eb"), "?? ??? a???b");
  EXPECT_EQ((Text<4>{"\n\nabc"}.printable()), "??ab");
}

TEST(Checksum, IsTheOneOfZlib) {
  const std::string text = "123456789";  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(checksum(std::as_bytes(std::span(text.data(), text.size()))), 0xCBF43926U);
}

TEST(Codec, EveryMessageComesBackBitForBit) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const SensorFrame sensors = example_sensors(random, seed);
    const CommandFrame command = example_command(random, seed);
    Datagram datagram;
    SensorFrame sensors_back;
    CommandFrame command_back;
    encode({}, sensors, datagram);
    ASSERT_EQ(verdict_of(datagram.view()), DatagramCheck::kGood);
    ASSERT_TRUE(decode(datagram.view(), sensors_back));
    EXPECT_TRUE(same_bits(sensors, sensors_back));
    EXPECT_EQ(sensors_back.q_m, sensors.q_m);
    EXPECT_EQ(sensors_back.omega_S, sensors.omega_S);
    EXPECT_EQ(sensors_back.driver_fault, sensors.driver_fault);
    encode({}, command, datagram);
    ASSERT_TRUE(decode(datagram.view(), command_back));
    EXPECT_TRUE(same_bits(command, command_back));
    EXPECT_EQ(command_back.tau_m, command.tau_m);
    EXPECT_EQ(command_back.hand_target.p_B, command.hand_target.p_B);
    EXPECT_EQ(command_back.enable, command.enable);
  }
}

TEST(Codec, NotANumberAndEmptyVectorsTravelToo) {
  std::mt19937 random(1);
  SensorFrame sensors = example_sensors(random, 1);
  sensors.theta_m.resize(0);
  sensors.q_p.resize(0);
  sensors.w_S[2] = std::numeric_limits<double>::quiet_NaN();
  Datagram datagram;
  encode({}, sensors, datagram);
  SensorFrame back;
  ASSERT_TRUE(decode(datagram.view(), back));
  EXPECT_EQ(back.theta_m.size(), 0);
  EXPECT_EQ(back.q_p.size(), 0);
  EXPECT_TRUE(std::isnan(back.w_S[2]));
}

TEST(Codec, TheHandshakeComesBack) {
  const Description description{.device = "HapticGiant",
                                .n_p = 2,
                                .n_m = 6,
                                .rate_Hz = 2000.0,
                                .interface = Interface::kTorque,
                                .is_lock_step = true};
  Datagram datagram;
  encode({}, Hello{77, description, "a client"}, datagram);
  Hello hello;
  ASSERT_TRUE(decode(datagram.view(), hello));
  EXPECT_EQ(hello.nonce, 77U);
  EXPECT_EQ(hello.expected.device.view(), "HapticGiant");
  EXPECT_EQ(hello.expected.interface, Interface::kTorque);
  EXPECT_TRUE(hello.expected.is_lock_step);
  EXPECT_EQ(hello.client.view(), "a client");
  encode({},
         Welcome{77, ConnectionRefusal::kBusy, true, description, 0.05, "a server",
                 std::string(300, 'x')},
         datagram);
  Welcome welcome;
  ASSERT_TRUE(decode(datagram.view(), welcome));
  EXPECT_EQ(welcome.refusal, ConnectionRefusal::kBusy);
  EXPECT_TRUE(welcome.is_simulated);
  EXPECT_EQ(welcome.actual.rate_Hz, 2000.0);
  EXPECT_EQ(welcome.command_timeout_s, 0.05);
  EXPECT_EQ(welcome.reason.view(), std::string(192, 'x'));  // what does not fit is cut
}

TEST(ReadHeader, EveryFlippedBitIsSeen) {
  const Datagram whole = sensors_datagram();
  for (std::size_t bit = 0; bit < 8 * whole.size; ++bit) {
    Datagram flipped = whole;
    flipped.bytes[bit / 8] ^= std::byte{1} << bit % 8;
    ASSERT_NE(verdict_of(flipped.view()), DatagramCheck::kGood) << "bit " << bit;
  }
}

TEST(ReadHeader, EveryShorterOrLongerDatagramIsTruncated) {
  const Datagram whole = sensors_datagram();
  for (std::size_t size = 0; size < whole.size; ++size) {
    ASSERT_EQ(verdict_of(whole.view().first(size)), DatagramCheck::kTruncated) << size;
  }
  Datagram longer = whole;
  longer.size += 8;
  EXPECT_EQ(verdict_of(longer.view()), DatagramCheck::kTruncated);
}

TEST(ReadHeader, ReportsWhatIsWrong) {
  const Datagram whole = sensors_datagram();
  Header header;
  EXPECT_EQ(read_header(whole.view(), header), DatagramCheck::kGood);
  EXPECT_EQ(header.session, 7U);
  EXPECT_EQ(header.number, 3U);
  EXPECT_EQ(header.time_ns, 5U);
  EXPECT_EQ(verdict_of(with(whole, 0, std::uint8_t{0x49}).view()), DatagramCheck::kForeign);
  EXPECT_EQ(verdict_of(with(whole, 4, std::uint16_t{kVersion + 1}).view()),
            DatagramCheck::kWrongVersion);
  EXPECT_EQ(verdict_of(with(whole, 6, std::uint16_t{99}).view()), DatagramCheck::kForeign);
  EXPECT_EQ(verdict_of(with(whole, 6, std::uint16_t{5}).view()), DatagramCheck::kTruncated);
  Datagram corrupted = whole;
  corrupted.bytes[100] ^= std::byte{4};
  EXPECT_EQ(verdict_of(corrupted.view()), DatagramCheck::kCorrupted);
}

TEST(Decode, RefusesImpossibleCountsTruthValuesAndRoomInUse) {
  const Datagram whole = sensors_datagram();
  constexpr std::size_t kFields = 32;
  SensorFrame sensors;
  EXPECT_TRUE(decode(whole.view(), sensors));
  EXPECT_FALSE(decode(with(whole, kFields + 24, std::uint32_t{2}).view(), sensors));  // dead_man
  EXPECT_FALSE(decode(with(whole, kFields + 40, std::uint32_t{2}).view(), sensors));  // field
  EXPECT_FALSE(decode(with(whole, kFields + 48, std::uint32_t{70000}).view(), sensors));  // fault
  EXPECT_FALSE(decode(with(whole, kFields + 60, std::uint32_t{1}).view(), sensors));      // zero
  EXPECT_FALSE(decode(with(whole, kFields + 56, std::uint32_t{8}).view(), sensors));      // count
  EXPECT_FALSE(decode(with(whole, kFields + 64 + 6 * 8, 1.0).view(), sensors));  // seventh of six
}

TEST(Decode, RandomBytesDoNoHarm) {
  std::mt19937 random(20);
  std::array<std::byte, kLargestDatagram> bytes;
  for (int i = 0; i < 20000; ++i) {
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    const std::size_t size = random() % bytes.size();
    ASSERT_NE(verdict_of({bytes.data(), size}), DatagramCheck::kGood);
    // as if header and checksum had been right
    SensorFrame sensors;
    CommandFrame command;
    Hello hello;
    ASSERT_FALSE(decode(bytes, sensors) && sensors.q_m.size() > kMaxManipulator);
    ASSERT_FALSE(decode(bytes, command) && command.q_m.size() > kMaxManipulator);
    ASSERT_FALSE(decode(bytes, hello) && hello.client.view().size() > 64);
  }
}

}  // namespace
}  // namespace hg::udp
