/// How bridges find a run: each run leaves the address of its live interface in a file of its own,
/// which only its user can read, because the address holds the token.
///
/// The files are in $XDG_RUNTIME_DIR/hapticgiant, or in /tmp/hapticgiant-UID without that variable;
/// the folder belongs to the user alone (mode 0700, files 0600). They are named after the process,
/// so that what a killed run has left is recognised and deleted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hg::live {

/// ws://HOST:PORT/live?token=TOKEN for the link of a page, http://HOST:PORT/#token=TOKEN.
std::string live_address(const std::string& page_link);

/// Folder of the files.
std::filesystem::path link_folder();

/// File that is there while the object is.
class LinkFile {
 public:
  /// Writes the file. When it cannot, problem() says why, and the run continues without.
  explicit LinkFile(const std::string& address,
                    const std::filesystem::path& folder = link_folder());
  ~LinkFile();
  LinkFile(const LinkFile&) = delete;
  LinkFile& operator=(const LinkFile&) = delete;

  const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path file_;
  std::string problem_;
};

/// Addresses of the runs of this user, the newest first. Throws SetupError when the folder is not
/// one of this user alone.
std::vector<std::string> running_addresses(const std::filesystem::path& folder = link_folder());

}  // namespace hg::live
