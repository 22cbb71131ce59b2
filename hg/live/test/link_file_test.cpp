#include "hg/live/link_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/scratch_folder.h"

namespace hg::live {
namespace {

namespace fs = std::filesystem;

TEST(LinkFile, TheAddressIsThatOfThePage) {
  EXPECT_EQ(live_address("http://127.0.0.1:8080/#token=ab"), "ws://127.0.0.1:8080/live?token=ab");
  EXPECT_EQ(live_address("http://[::1]:8080/#token=ab"), "ws://[::1]:8080/live?token=ab");
}

TEST(LinkFile, IsThereAsLongAsTheRun) {
  const ScratchFolder scratch;
  const fs::path folder = fs::path(scratch.path()) / "links";
  EXPECT_TRUE(running_addresses(folder).empty());
  {
    const LinkFile link("ws://here", folder);
    EXPECT_EQ(link.problem(), "");
    EXPECT_EQ(running_addresses(folder), std::vector<std::string>{"ws://here"});
    for (const fs::path& file : fs::directory_iterator(folder)) {
      struct stat status = {};
      ASSERT_EQ(::stat(file.c_str(), &status), 0);
      EXPECT_EQ(status.st_mode & 0777u, 0600u) << file;
    }
  }
  EXPECT_TRUE(running_addresses(folder).empty());
}

TEST(LinkFile, OfARunThatWasKilledIsDeleted) {
  const ScratchFolder scratch;
  const fs::path folder = fs::path(scratch.path()) / "links";
  const LinkFile link("ws://here", folder);
  const fs::path left = folder / "4194305.live";  // beyond the largest number of a process
  std::ofstream(left) << "ws://gone\n";
  EXPECT_EQ(running_addresses(folder), std::vector<std::string>{"ws://here"});
  EXPECT_FALSE(fs::exists(left));
}

TEST(LinkFile, AFolderThatOthersCanEnterIsRefused) {
  const ScratchFolder scratch;
  const fs::path folder = fs::path(scratch.path()) / "links";
  fs::create_directory(folder);
  fs::permissions(folder, fs::perms(0755));
  EXPECT_NE(LinkFile("ws://here", folder).problem(), "");
  EXPECT_THROW((void)running_addresses(folder), SetupError);
}

}  // namespace
}  // namespace hg::live
