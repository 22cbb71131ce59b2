#include "hg/core/open_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "hg/core/test/message_of.h"
#include "hg/core/test/temporary_folder.h"

namespace hg {
namespace {

TEST(OpenFile, ReadsWholeFilesAndNothingElse) {
  const TemporaryFolder folder;
  const std::string long_text(200'000, 'x');
  const auto file = folder.write("file", long_text);
  EXPECT_EQ(read_file(file), long_text);
  EXPECT_EQ(read_file(file, long_text.size()), long_text);
  EXPECT_EQ(message_of([&] { read_file(file, 100); }),
            file.string() + ": cannot be read: it has more than 100 bytes");
  EXPECT_EQ(message_of([&] { read_file(folder.path() / "none"); }),
            (folder.path() / "none").string() + ": cannot be read: No such file or directory");
  EXPECT_EQ(message_of([&] { read_file(folder.path()); }),
            folder.path().string() + ": cannot be read: expected a file, got a folder");
  EXPECT_EQ(message_of([] { read_file("/dev/zero"); }),
            "/dev/zero: cannot be read: expected a file, got a device");
}

TEST(OpenFile, APointerOfGitLfsIsNotTheFile) {
  const TemporaryFolder folder;
  const auto file = folder.write("arm.urdf", "version https://git-lfs.github.com/spec/v1\noid x\n");
  EXPECT_EQ(message_of([&] { read_file(file); }),
            file.string() +
                ": cannot be read: it is a pointer of Git LFS; git lfs pull fetches the "
                "file itself");
}

TEST(OpenFile, NamedPipesAreNotWaitedFor) {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path() / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message_of([&] { read_file(pipe); }),
            pipe + ": cannot be read: expected a file, got a named pipe");
  for (const bool has_reader : {false, true}) {
    const OpenFile reader(has_reader ? open(pipe.c_str(), O_RDONLY | O_NONBLOCK) : -1);
    EXPECT_EQ(message_of([&] { open_to_write(pipe, Content::kEmptied); }),
              pipe + ": cannot be written: expected a file, got a named pipe");
  }
}

TEST(OpenFile, WritesFilesAndCharacterDevices) {
  const TemporaryFolder folder;
  const auto file = folder.write("file", "before");
  open_to_write(file, Content::kKept);
  EXPECT_EQ(read_file(file), "before");
  open_to_write(file, Content::kEmptied);
  EXPECT_EQ(read_file(file), "");
  EXPECT_GE(open_to_write("/dev/null", Content::kEmptied).descriptor(), 0);
  EXPECT_EQ(message_of([&] { open_to_write(folder.path(), Content::kEmptied); }),
            folder.path().string() + ": cannot be written: Is a directory");
}

TEST(OpenFile, WhatStandardOutputIsIsWrittenBehindWhatWasPrinted) {
  const TemporaryFolder folder;
  const auto file = folder.write("file", "");
  const OpenFile saved(dup(STDOUT_FILENO));
  {
    const OpenFile redirected = open_to_write(file, Content::kKept);
    dup2(redirected.descriptor(), STDOUT_FILENO);
  }
  EXPECT_EQ(write(STDOUT_FILENO, "one ", 4), 4);
  EXPECT_EQ(write(open_to_write("/dev/stdout", Content::kEmptied).descriptor(), "two", 3), 3);
  dup2(saved.descriptor(), STDOUT_FILENO);
  EXPECT_EQ(read_file(file), "one two");
}

}  // namespace
}  // namespace hg
