#include "descriptions.h"

#include <ros/console.h>

#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <utility>

namespace hapticgiant {
namespace {

const std::regex kMesh(R"rx((<mesh\s[^>]*filename\s*=\s*)(["'])([^"']+)\2)rx");

// An URDF whose meshes are on their way.
struct Pending {
  std::string urdf;
  std::filesystem::path folder;
  std::size_t missing = 0;
  std::map<std::string, std::string> files;  // by their name in the URDF
  std::function<void(const std::string&)> done;
};

std::string write_mesh(const std::filesystem::path& folder, const std::string& name,
                       const std::string& content) {
  const std::string extension = std::filesystem::path(name).extension().string();
  std::filesystem::create_directories(folder);
  const std::filesystem::path file =
      std::filesystem::absolute(folder) /
      (std::to_string(std::hash<std::string>()(content)) + extension);
  std::ofstream(file, std::ios::binary) << content;
  return "file://" + file.string();
}

std::string with_files(const std::string& urdf, const std::map<std::string, std::string>& files) {
  std::string out;
  auto last = urdf.cbegin();
  for (std::sregex_iterator it(urdf.begin(), urdf.end(), kMesh), end; it != end; ++it) {
    const auto file = files.find((*it)[3]);
    if (file == files.end()) continue;
    out.append(last, (*it)[3].first).append(file->second);
    last = (*it)[3].second;
  }
  return out.append(last, urdf.cend());
}

}  // namespace

void fetch_meshes(LiveClient& client, const std::string& urdf, const std::filesystem::path& folder,
                  std::function<void(const std::string& urdf)> done) {
  std::set<std::string> names;
  for (std::sregex_iterator it(urdf.begin(), urdf.end(), kMesh), end; it != end; ++it) {
    names.insert((*it)[3]);
  }
  if (names.empty()) return done(urdf);
  const auto pending =
      std::make_shared<Pending>(Pending{urdf, folder, names.size(), {}, std::move(done)});
  for (const std::string& name : names) {
    client.fetch(name, [pending, name](const Answer& answer) {
      if (answer.is_ok) {
        pending->files[name] = write_mesh(pending->folder, name, answer.bytes);
      } else {
        ROS_WARN("mesh %s: %s", name.c_str(), answer.error.c_str());
      }
      if (--pending->missing == 0) pending->done(with_files(pending->urdf, pending->files));
    });
  }
}

}  // namespace hapticgiant
