#include "hg/core/whole_file.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "hg/core/open_file.h"
#include "hg/core/test/message_of.h"
#include "hg/core/test/temporary_folder.h"

namespace hg {
namespace {

using Names = std::set<std::string>;

TEST(WholeFile, ReplacesAFileAndLeavesNothingBesideIt) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file.json", "{old").string();
  check_writable(file, kJson);
  EXPECT_EQ(read_file(file), "{old");
  const std::string text(100'000, 'x');
  write_whole_file(file, text);
  EXPECT_EQ(read_file(file), text);
  EXPECT_EQ(folder.names(), Names{"file.json"});
}

TEST(WholeFile, AFileOfAnotherKindIsNotReplaced) {
  const TemporaryFolder folder;
  const std::string file = folder.write("door.yaml", "twin: x").string();
  EXPECT_EQ(message_of([&] { check_writable(file, kJson); }),
            file +
                ": exists already and is no file of the kind that would be written there; it is "
                "not replaced");
  EXPECT_EQ(message_of([&] { check_writable("", kJson); }), "no error");
}

TEST(WholeFile, ALinkInPlaceOfThePartialFileLeadsNowhere) {
  const TemporaryFolder folder;
  const std::string victim = folder.write("victim", "kept").string();
  const std::string file = (folder.path() / "file.json").string();
  std::filesystem::create_symlink(victim, file + ".partial");
  check_writable(file, kJson);
  std::filesystem::create_symlink(victim, file + ".partial");
  write_whole_file(file, "{}");
  EXPECT_EQ(read_file(victim), "kept");
  EXPECT_EQ(read_file(file), "{}");
  EXPECT_EQ(folder.names(), (Names{"file.json", "victim"}));
}

TEST(WholeFile, AnErrorHasItsReason) {
  EXPECT_EQ(message_of([] { write_whole_file("/dev/full", "{}"); }),
            "/dev/full: could not be written: No space left on device");
}

TEST(WholeFile, AFolderIsMadeUnlessAFileIsThere) {
  const TemporaryFolder folder;
  make_folder((folder.path() / "a" / "b").string());
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
  const std::string file = folder.write("file", "text").string();
  EXPECT_NE(message_of([&] { make_folder(file); }), "no error");
}

}  // namespace
}  // namespace hg
