#include "hg/core/open_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hg/core/input_fault.h"

namespace hg {
namespace {

constexpr mode_t kNewFile = 0666;  // less the umask

[[noreturn]] void refuse(const std::filesystem::path& file, const char* what,
                         const std::string& why) {
  throw InputError(
      InputFault{.file = file.string(), .what = "cannot be " + std::string(what) + ": " + why});
}

// standard output or error, whichever `facts` belong to; -1: neither
int standard_output(const struct stat& facts) noexcept {
  for (const int standard : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat own {};
    if (fstat(standard, &own) == 0 && own.st_dev == facts.st_dev && own.st_ino == facts.st_ino) {
      return standard;
    }
  }
  return -1;
}

}  // namespace

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

int OpenFile::release() noexcept { return std::exchange(descriptor_, -1); }

const char* kind_of_file(unsigned mode) noexcept {
  switch (mode & S_IFMT) {
    case S_IFREG:
      return "a file";
    case S_IFDIR:
      return "a folder";
    case S_IFIFO:
      return "a named pipe";
    case S_IFSOCK:
      return "a socket";
    case S_IFCHR:
    case S_IFBLK:
      return "a device";
    default:
      return "no file";
  }
}

OpenFile open_to_read(const std::filesystem::path& file) {
  // O_NONBLOCK: do not wait for a named pipe; no effect on regular files
  OpenFile opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  struct stat facts {};
  if (opened.descriptor() < 0 || fstat(opened.descriptor(), &facts) != 0) {
    refuse(file, "read", std::strerror(errno));
  }
  if (!S_ISREG(facts.st_mode)) {
    refuse(file, "read", std::string("expected a file, got ") + kind_of_file(facts.st_mode));
  }
  return opened;
}

std::string read_file(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  const OpenFile opened = open_to_read(file);
  std::string content;
  std::string bytes(1 << 16, '\0');
  while (true) {
    const ssize_t count = read(opened.descriptor(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(file, "read", std::strerror(errno));
    if (count == 0) {
      if (content.starts_with("version https://git-lfs.github.com/spec/")) {
        refuse(file, "read", "it is a pointer of Git LFS; git lfs pull fetches the file itself");
      }
      return content;
    }
    content.append(bytes.data(), count);
    if (content.size() > most_bytes) {
      refuse(file, "read", "it has more than " + std::to_string(most_bytes) + " bytes");
    }
  }
}

OpenFile open_to_write(const std::filesystem::path& file, Content content) {
  // without O_TRUNC: a refused file stays unchanged
  OpenFile opened(
      open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOCTTY | O_NONBLOCK, kNewFile));
  const int error = errno;
  struct stat facts {};
  if (opened.descriptor() < 0) {
    const bool is_there = stat(file.c_str(), &facts) == 0;
    const bool has_kind = is_there && (S_ISFIFO(facts.st_mode) || S_ISSOCK(facts.st_mode));
    refuse(file, "written",
           has_kind ? std::string("expected a file, got ") + kind_of_file(facts.st_mode)
                    : std::strerror(error));
  }
  if (fstat(opened.descriptor(), &facts) != 0) refuse(file, "written", std::strerror(errno));
  if (S_ISCHR(facts.st_mode)) return opened;
  // shares the file offset: appends to the printed output
  const int standard = standard_output(facts);
  if (standard >= 0) return OpenFile(fcntl(standard, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  if (!S_ISREG(facts.st_mode)) {
    refuse(file, "written", std::string("expected a file, got ") + kind_of_file(facts.st_mode));
  }
  if (content == Content::kEmptied && ftruncate(opened.descriptor(), 0) != 0) {
    refuse(file, "written", std::strerror(errno));
  }
  return opened;
}

}  // namespace hg
