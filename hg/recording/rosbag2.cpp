#include "hg/recording/rosbag2.h"

#include <fmt/format.h>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <system_error>

#include "hg/core/error.h"
#include "hg/core/visible.h"
#include "hg/core/whole_file.h"
#include "hg/recording/mcap_file.h"

namespace hg::recording {
namespace {

namespace fs = std::filesystem;

void check_interruption(const Rosbag2Plan& plan) {
  if (plan.is_interrupted != nullptr && plan.is_interrupted()) {
    throw SetupError("export: interrupted, nothing is written");
  }
}

// Counts the messages within a part of a run, and writes them into a file of their own if one is
// given.
class Copy final : public MessageListener {
 public:
  /// `copy`: file to be written; empty = none
  Copy(const Rosbag2Plan& plan, const fs::path& copy) : plan_(plan) {
    if (!copy.empty()) file_ = std::make_unique<McapFile>(copy);
  }

  void configuration(const NamedText& text) override {
    if (file_) file_->attach(text.name, text.text, start_ns_);
  }
  void metadata(const std::string& name, const KeyValues& pairs) override {
    for (const auto& [key, value] : pairs) {
      if (name == "run" && key == "start_ns") {
        std::from_chars(value.data(), value.data() + value.size(), start_ns_);
      }
    }
    if (file_) file_->add_metadata(name, pairs);
  }
  void topic(const Topic& topic) override {
    const std::uint16_t number =
        file_ ? file_->add_channel(topic.name, topic.type, topic.schema) : std::uint16_t{0};
    topics_[topic.name] = {.type = topic.type, .number = number};
  }
  void message(std::string_view topic, std::uint64_t time_ns,
               std::span<const std::byte> bytes) override {
    check_interruption(plan_);
    const double time_s =
        1e-9 * static_cast<double>(static_cast<std::int64_t>(time_ns - start_ns_));
    const auto place = topics_.find(topic);
    if (place == topics_.end() || !(time_s >= plan_.from_s && time_s < plan_.to_s)) return;
    if (file_) {
      file_->write(place->second.number, place->second.count, time_ns, bytes);
      if (file_->has_failed()) throw SetupError(plan_.folder.string() + ": " + file_->error());
    }
    ++place->second.count;
    first_ns_ = count_ == 0 ? time_ns : std::min(first_ns_, time_ns);
    last_ns_ = std::max(last_ns_, time_ns);
    ++count_;
  }

  void finish() {
    if (!file_) return;
    file_->finish();
    if (file_->has_failed()) throw SetupError(plan_.folder.string() + ": " + file_->error());
  }

  std::uint64_t count() const noexcept { return count_; }
  std::size_t topics() const noexcept { return topics_.size(); }

  // metadata.yaml of version 5, that of ROS 2 Humble, which later versions read
  std::string metadata_text(const std::string& file) const {
    const std::uint64_t duration = last_ns_ - first_ns_;
    std::string text = fmt::format(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
        "  duration:\n    nanoseconds: {0}\n  starting_time:\n    nanoseconds_since_epoch: {1}\n"
        "  message_count: {2}\n  topics_with_message_count:\n",
        duration, first_ns_, count_);
    for (const auto& [name, topic] : topics_) {
      text += fmt::format(
          "    - topic_metadata:\n        name: {}\n        type: {}\n"
          "        serialization_format: cdr\n        offered_qos_profiles: \"\"\n"
          "      message_count: {}\n",
          name, topic.type, topic.count);
    }
    text += fmt::format(
        "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - {0}\n"
        "  files:\n    - path: {0}\n      starting_time:\n        nanoseconds_since_epoch: {1}\n"
        "      duration:\n        nanoseconds: {2}\n      message_count: {3}\n",
        file, first_ns_, duration, count_);
    return text;
  }

 private:
  struct Counted {
    std::string type;
    std::uint16_t number = 0;  ///< in the file
    std::uint64_t count = 0;
  };

  const Rosbag2Plan& plan_;
  std::unique_ptr<McapFile> file_;
  std::map<std::string, Counted, std::less<>> topics_;
  std::uint64_t start_ns_ = 0, first_ns_ = 0, last_ns_ = 0, count_ = 0;
};

// in double quotes, for YAML
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

// A new folder beside the one that it becomes; removed unless it is kept.
struct Draft {
  fs::path folder;
  bool is_kept = false;

  explicit Draft(const fs::path& final_folder) {
    if (final_folder.has_parent_path()) make_folder(final_folder.parent_path().string());
    std::string name = final_folder.string() + ".partial.XXXXXX";
    if (mkdtemp(name.data()) == nullptr) {
      throw SetupError(final_folder.string() + ": cannot be written: " + std::strerror(errno));
    }
    folder = name;
    const mode_t mask = umask(0);
    umask(mask);
    (void)chmod(name.c_str(), 0777 & ~mask);  // what it would have without mkdtemp
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() {
    std::error_code ignored;
    if (!is_kept) fs::remove_all(folder, ignored);
  }
};

void link_or_copy(const fs::path& from, const fs::path& to, bool& is_link) {
  std::error_code error;
  fs::create_hard_link(fs::canonical(from), to, error);
  is_link = !error;
  if (is_link) return;
  if (!fs::copy_file(from, to, error) || error) {
    std::error_code ignored;  // the library calls a full disk an input/output error
    const bool is_full =
        error == std::errc::io_error &&
        fs::space(to.parent_path(), ignored).available < fs::file_size(from, ignored);
    if (is_full) error = std::make_error_code(std::errc::no_space_on_device);
    throw SetupError(to.string() + ": could not be written: " + error.message());
  }
}

}  // namespace

Rosbag2Result write_rosbag2(const fs::path& recording, const Rosbag2Plan& plan) {
  if (std::error_code error; fs::exists(fs::symlink_status(plan.folder, error))) {
    throw SetupError(plan.folder.string() + ": exists already, expected the name of a new folder");
  }
  const std::string folder_name = plan.folder.filename().string();
  if (visible(folder_name) != folder_name ||
      folder_name.find_first_of("\n\t") != std::string::npos) {
    throw SetupError(plan.folder.string() +
                     ": expected a name in UTF-8 without control characters, for metadata.yaml");
  }
  const bool is_part = std::isfinite(plan.from_s) || std::isfinite(plan.to_s);
  Copy survey(plan, {});
  const ReadResult read = read_messages(recording, survey);
  if (survey.count() == 0) throw SetupError(recording.string() + ": has no message in that time");

  Draft draft(plan.folder);
  Rosbag2Result result{.messages = survey.count(),
                       .topics = survey.topics(),
                       .is_complete = read.is_complete,
                       .losses = read.losses};
  const std::string name = folder_name + "_0.mcap";
  if (read.is_whole() && !is_part) {
    link_or_copy(recording, draft.folder / name, result.is_link);
  } else {
    Copy copy(plan, draft.folder / name);
    (void)read_messages(recording, copy);
    copy.finish();
  }
  write_whole_file((draft.folder / "metadata.yaml").string(), survey.metadata_text(quoted(name)));
  check_interruption(plan);
  std::error_code error;
  fs::rename(draft.folder, plan.folder, error);
  if (error) throw SetupError(plan.folder.string() + ": could not be written: " + error.message());
  draft.is_kept = true;
  return result;
}

}  // namespace hg::recording
