/// The shared key: its file, its tag, and what either side makes of another one or none.
#include "hg/device/udp/key.h"
#include "hg/device/udp/codec.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "hg/core/allocation_counter.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/device/udp/test/peers.h"

namespace hg::udp {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

Key key_of(char letter) { return Key(bytes_of(std::string(32, letter))); }

std::string hex(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : bytes) {
    text += kDigits[std::to_integer<std::size_t>(byte) >> 4U];
    text += kDigits[std::to_integer<std::size_t>(byte) & 15U];
  }
  return text;
}

TEST(Key, TheTagIsTheOneOfRfc4231) {
  // test cases 1, 2 and 6: a short key, a text, a key longer than a block of SHA-256
  EXPECT_EQ(hex(Key(bytes_of(std::string(20, '\x0b'))).tag(bytes_of("Hi There"))),
            "b0344c61d8db38535ca8afceaf0bf12b");
  EXPECT_EQ(hex(Key(bytes_of("Jefe")).tag(bytes_of("what do ya want for nothing?"))),
            "5bdcc146bf60754e6a042426089575c7");
  EXPECT_EQ(hex(Key(bytes_of(std::string(131, '\xaa')))
                    .tag(bytes_of("Test Using Larger Than Block-Size Key - Hash Key First"))),
            "60e431591ee0b67f0d8a26aacbf5b77f");
}

// docs/reference/device_protocol.md shows these bytes
TEST(Key, AReadyWithATagIsTheOneOfTheDocument) {
  std::string secret;
  for (char byte = 0; byte < 32; ++byte) secret += byte;
  Datagram datagram;
  encode({.session = 0x01020305, .number = 2, .time_ns = 0}, Ready{}, datagram,
         Key(bytes_of(secret)));
  std::ifstream file("docs/reference/device_protocol.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(
      document.find(hex(datagram.view().first(32)) + "\n" + hex(datagram.view().subspan(32, 16)) +
                    "\n" + hex(datagram.view().last(4)) + "\n"),
      std::string::npos)
      << hex(datagram.view());
}

TEST(Key, ADatagramWithAnyOtherByteIsForgedOrCorrupted) {
  const Key key = key_of('k');
  Datagram datagram;
  encode({.session = 7, .number = 3}, Goodbye{.reason = "done"}, datagram, key);
  Header header;
  EXPECT_EQ(read_header(datagram.view(), header, key), DatagramCheck::kGood);
  EXPECT_EQ(read_header(datagram.view(), header, key_of('l')), DatagramCheck::kForged);
  EXPECT_EQ(read_header(datagram.view(), header), DatagramCheck::kForged);
  for (std::size_t i = 16; i + 4 < datagram.size; ++i) {  // behind what says its size
    Datagram changed = datagram;
    changed.bytes[i] ^= std::byte{1};
    EXPECT_EQ(read_header(changed.view(), header, key), DatagramCheck::kCorrupted);
    const std::uint32_t crc = checksum(changed.view().first(changed.size - 4));
    std::memcpy(changed.bytes.data() + changed.size - 4, &crc, sizeof crc);
    EXPECT_EQ(read_header(changed.view(), header, key), DatagramCheck::kForged) << "byte " << i;
  }
  encode({.session = 7, .number = 3}, Goodbye{.reason = "done"}, datagram);
  EXPECT_EQ(read_header(datagram.view(), header), DatagramCheck::kGood);
  EXPECT_EQ(read_header(datagram.view(), header, key), DatagramCheck::kForged);
}

TEST(Key, AFileThatIsNoGoodKeyIsRefused) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, std::size_t size, mode_t mode) {
    const std::string file = folder.write(name, std::string(size, 'k')).string();
    chmod(file.c_str(), mode);
    return file;
  };
  const auto refusal = [](const std::string& file) {
    return message_of([&] { Key::from_file(file); });
  };
  std::string file = write("good", 32, 0600);
  EXPECT_EQ(Key::from_file(file).tag(bytes_of("x")), key_of('k').tag(bytes_of("x")));
  EXPECT_EQ(Key::from_file(write("read-only", 32, 0400)).tag(bytes_of("x")),
            key_of('k').tag(bytes_of("x")));
  EXPECT_TRUE(Key::from_file(write("long", 4096, 0600)).is_set());
  for (const mode_t mode : {0640U, 0604U, 0620U, 0602U, 0644U}) {
    chmod(file.c_str(), mode);
    EXPECT_NE(refusal(file).find("the key must be its owner's only, got mode 0"), std::string::npos)
        << refusal(file);
  }
  file = write("short", 31, 0600);
  EXPECT_EQ(refusal(file), file + ": a key has 32 to 4096 bytes, got 31");
  file = write("empty", 0, 0600);
  EXPECT_EQ(refusal(file), file + ": a key has 32 to 4096 bytes, got 0");
  file = write("longer", 4097, 0600);
  EXPECT_EQ(refusal(file), file + ": a key has 32 to 4096 bytes, got more than 4096");
  EXPECT_EQ(refusal("/no/such"), "/no/such: cannot be read: No such file or directory");
  EXPECT_EQ(refusal(folder.path()),
            folder.path().string() + ": cannot be read: expected a file, got a folder");
  file = folder.write("zeros", std::string(32, '\0')).string();
  chmod(file.c_str(), 0600);
  EXPECT_EQ(refusal(file),
            file + ": a key of zeros is not accepted: head -c 32 /dev/urandom makes one");
  file = write("stranger's", 32, 0600);
  if (chown(file.c_str(), 12345, 12345) == 0) {
    EXPECT_EQ(refusal(file),
              file + ": the key must be a file of yours or of root, got one of user 12345");
  }
}

TEST(Key, WithTheSameKeyASessionIsASessionAndTheLoopAllocatesNothing) {
  Serving serving(true, kLong, 0, key_of('k'));
  RemoteDevice there(serving.address(), client(true, key_of('k')));
  SensorFrame sensors;
  there.read(sensors);
  CommandFrame command = answer(sensors);
  const AllocationCounter allocations;
  for (int i = 0; i < 200; ++i) {
    there.write(command);
    there.read(sensors);
    command.sequence = sensors.sequence;
  }
  EXPECT_EQ(allocations.count(), 0U);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kNone);
  EXPECT_EQ(sensors.sequence, 200U);
}

TEST(Key, AnotherKeyOrNoneIsRefusedAndBothSidesSayWhy) {
  const auto refusal = [](const Key& of_server, const Key& of_client) {
    Serving serving(true, kLong, 0, of_server);
    const std::string message =
        message_of([&] { RemoteDevice there(serving.address(), client(true, of_client)); });
    serving.stop();
    EXPECT_TRUE(serving.reports.empty());
    return message.substr(message.find(": ") + 2);
  };
  const std::string other =
      "the device refuses: its key is another one, or none was given (--key-file)";
  EXPECT_EQ(refusal(key_of('k'), key_of('l')), other);
  EXPECT_EQ(refusal(key_of('k'), {}), other);
  EXPECT_EQ(refusal({}, key_of('k')),
            "the device refuses: it has no key (--key-file), and none may be given");

  Script server;  // with no key and no manners
  std::thread thread([&] {
    Header header;
    Hello hello;
    do {
      server.await_any(header);
    } while (header.type != static_cast<std::uint16_t>(MessageType::kHello));
    (void)decode(server.datagram.view(), hello);
    server.send(Welcome{.nonce = hello.nonce, .actual = description(true)},
                {.session = 7, .number = 1});
  });
  const std::string message =
      message_of([&] { RemoteDevice there(server.address(), client(true, key_of('k'))); });
  thread.join();
  EXPECT_NE(message.find("the device's answer is not of the key that was given (--key-file)"),
            std::string::npos)
      << message;
}

TEST(Key, CommandsWithoutItAndThoseOfAnOldSessionAreNothing) {
  Serving serving(false, kLong, 100, key_of('k'));
  Voice voice(serving.address(), 1, key_of('k'));
  voice.hello(false);
  const std::uint32_t old = voice.session;
  voice.send(Ready{});
  voice.await<SensorFrame>();
  voice.send(Goodbye{});
  serving.await_sessions(1);

  voice.hello(false);
  voice.send(Ready{}, {.session = voice.session, .number = 100});
  const std::uint64_t first = voice.await<SensorFrame>().sequence;
  voice.send(command_for(first), {.session = old, .number = 101});  // as it was recorded
  voice.send_without_tag(command_for(first), {.session = voice.session, .number = 102});
  voice.send(Goodbye{}, {.session = voice.session, .number = 103});
  serving.await_sessions(2);
  EXPECT_EQ(serving.reports[1].link.wrong_session, 1U);
  EXPECT_EQ(serving.reports[1].link.forged, 1U);
  EXPECT_FALSE(serving.was_enabled);
}

}  // namespace
}  // namespace hg::udp
