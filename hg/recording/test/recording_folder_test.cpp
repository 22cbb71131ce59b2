#include "hg/recording/recording_folder.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"
#include "hg/core/test/message_of.h"
#include "hg/core/test/temporary_folder.h"

namespace hg::recording {
namespace {

using Names = std::vector<std::string>;

const std::chrono::system_clock::time_point kStart{std::chrono::seconds(1'800'000'000)};

TEST(RecordingFolder, NamesFilesByUtcTime) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  setenv("TZ", "ABC-3", 1);  // three hours east
  tzset();
  const auto path = folder.new_path("door", kStart);
  unsetenv("TZ");
  tzset();
  EXPECT_EQ(path, temporary.path() / "door_20270115_080000.partial.mcap");
}

TEST(RecordingFolder, NumbersFilesOfOneSecond) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  temporary.write("door_20270115_080000.mcap", 1);
  temporary.write("door_20270115_080000_2.partial.mcap", 1);
  EXPECT_EQ(folder.new_path("door", kStart),
            temporary.path() / "door_20270115_080000_3.partial.mcap");
}

TEST(RecordingFolder, RefusesANameThatLeavesTheFolder) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  const std::string message = message_of([&] { (void)folder.new_path("../door", kStart); });
  EXPECT_NE(message.find("got \"../door\""), std::string::npos) << message;
  EXPECT_THROW((void)folder.new_path("", kStart), SetupError);
}

TEST(RecordingFolder, ReportsWhichFolderCannotBeMade) {
  const TemporaryFolder temporary;
  temporary.write("file", 1);
  const std::string path = (temporary.path() / "file" / "recordings").string();
  const std::string message = message_of([&] { RecordingFolder folder{path}; });
  EXPECT_NE(message.find(path), std::string::npos) << message;
  EXPECT_NE(message.find("Not a directory"), std::string::npos) << message;
}

TEST(RecordingFolder, CompletesAFileAndLinksIt) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  temporary.write("door_20270115_080000.partial.mcap", 1);
  std::filesystem::create_symlink("older.mcap", temporary.path() / "latest.mcap");
  std::string why;
  const auto path = folder.complete(temporary.path() / "door_20270115_080000.partial.mcap", why);
  EXPECT_EQ(why, "");
  EXPECT_EQ(path, temporary.path() / "door_20270115_080000.mcap");
  EXPECT_EQ(temporary.names(), (std::set<std::string>{"door_20270115_080000.mcap", "latest.mcap"}));
  EXPECT_EQ(std::filesystem::read_symlink(temporary.path() / "latest.mcap"),
            "door_20270115_080000.mcap");
}

TEST(RecordingFolder, LeavesAloneWhatHasTheNameOfARecordingOrOfTheLink) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  const auto partial = temporary.write("door_20270115_080000.partial.mcap", "ours");
  const auto mine = temporary.write("latest.mcap", "mine");
  EXPECT_EQ(folder.link_latest(partial),
            mine.string() + " is no link of this program and stays as it is");
  EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(mine)));
  EXPECT_EQ(std::filesystem::file_size(mine), 4U);
  std::filesystem::remove(mine);
  temporary.write("latest.new", "mine");
  EXPECT_NE(folder.link_latest(partial), "");
  EXPECT_EQ(std::filesystem::file_size(temporary.path() / "latest.new"), 4U);

  const auto taken = temporary.path() / "door_20270115_080000.mcap";
  for (const bool is_folder : {true, false}) {
    if (is_folder) std::filesystem::create_directory(taken);
    if (!is_folder) temporary.write("door_20270115_080000.mcap", "another");
    std::string why;
    EXPECT_EQ(folder.complete(partial, why), partial);
    EXPECT_EQ(why, taken.string() + ": File exists");
    EXPECT_EQ(std::filesystem::file_size(partial), 4U);
    std::filesystem::remove(taken);
  }
}

TEST(RecordingFolder, DeletesTheOldestUntilTheBudgetHolds) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  // neither the order of names nor of writing is the order of age
  temporary.write("b_20270101_000000.mcap", 100);
  temporary.write("a_20270103_000000.mcap", 100);
  temporary.write("d_20270101_000000_2.partial.mcap", 100);
  temporary.age("d_20270101_000000_2.partial.mcap", std::chrono::hours(1));
  temporary.write("c_20270101_000000_10.mcap", 100);
  temporary.write("z_20261231_235959.mcap", 100);
  EXPECT_EQ(folder.make_room(temporary.path() / "e_20270104_000000.partial.mcap", 50.0, 550.0),
            Names{});
  EXPECT_EQ(folder.make_room(temporary.path() / "e_20270104_000000.partial.mcap", 51.0, 550.0),
            Names{"z_20261231_235959.mcap"});
  EXPECT_EQ(folder.make_room(temporary.path() / "e_20270104_000000.partial.mcap", 50.0, 200.0),
            (Names{"b_20270101_000000.mcap", "d_20270101_000000_2.partial.mcap",
                   "c_20270101_000000_10.mcap"}));
  EXPECT_EQ(temporary.names(), std::set<std::string>{"a_20270103_000000.mcap"});
}

TEST(RecordingFolder, LeavesAloneWhatAnotherRunIsWriting) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  temporary.write("a_20270101_000000.partial.mcap", 100);
  EXPECT_EQ(folder.make_room(temporary.path() / "b_20270101_000001.partial.mcap", 50.0, 1.0),
            Names{});
  temporary.age("a_20270101_000000.partial.mcap", std::chrono::minutes(2));
  EXPECT_EQ(folder.make_room(temporary.path() / "b_20270101_000001.partial.mcap", 50.0, 1.0),
            Names{"a_20270101_000000.partial.mcap"});
}

TEST(RecordingFolder, NeverDeletesTheCurrentFile) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  temporary.write("door_20270101_000000.partial.mcap", 100);
  EXPECT_EQ(folder.make_room(temporary.path() / "door_20270101_000000.partial.mcap", 100.0, 1.0),
            Names{});
}

TEST(RecordingFolder, NeitherCountsNorDeletesFilesWithOtherNames) {
  const TemporaryFolder temporary;
  const RecordingFolder folder(temporary.path());
  temporary.write("keep.mcap", 1000);
  temporary.write("door_20270101_000000.mcap.bak", 1000);
  temporary.write("door_20270101_000000.mcap", 100);
  std::filesystem::create_symlink("keep.mcap", temporary.path() / "link_20260101_000000.mcap");
  EXPECT_EQ(folder.make_room("", 0.0, 100.0), Names{});
  EXPECT_EQ(folder.make_room("", 0.0, 99.0), Names{"door_20270101_000000.mcap"});
  EXPECT_EQ(temporary.names().size(), 3u);
}

}  // namespace
}  // namespace hg::recording
