/// Options of commands, over a library that is compiled in command.cpp alone: its header costs
/// every file that includes it several seconds.
///
/// Command and Option are handles: cheap to copy, valid as long as the Program they come from.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace hg::apps {

/// Returns the fault of a value on the command line; empty = valid.
using OptionCheck = std::function<std::string(const std::string&)>;

/// An option, a flag or a positional argument. Each function returns the option, for chains.
class Option {
 public:
  explicit Option(CLI::Option* self) : self_(self) {}

  Option check(const OptionCheck& check) const;
  /// Only these values; the help lists them, and a shell completes them.
  Option one_of(const std::vector<std::string>& values) const;
  /// Values that a shell completes, besides others that are valid; found when it asks for them.
  Option suggest(const std::function<std::vector<std::string>()>& values) const;
  Option existing_file() const;
  /// Replaces the value by what `change` returns for it.
  Option transform(const std::function<std::string(const std::string&)>& change) const;
  Option required() const;
  Option needs(const std::string& other) const;
  Option needs(Option other) const;
  Option excludes(const std::string& other) const;
  Option excludes(Option other) const;
  /// Shows the value before parsing as the default.
  Option capture_default_str() const;
  /// Splits a value into several at this character.
  Option delimiter(char separator) const;
  /// Whether one option takes all words up to the next option.
  Option allow_extra_args(bool allowed) const;
  /// Number of values: exactly, or between two numbers.
  Option expected(int count) const;
  Option expected(int least, int most) const;
  /// Environment variable that gives the value where the option does not.
  Option envname(const std::string& name) const;
  /// How often it stands on the command line.
  std::size_t count() const;

 private:
  friend class Command;
  CLI::Option* self_;
};

/// A program or one of its subcommands.
class Command {
 public:
  explicit Command(CLI::App* self) : self_(self) {}

  Command add_subcommand(const std::string& name, const std::string& description) const;
  /// An option for std::string, bool, int, std::uint16_t, std::uint64_t, double, and vectors and
  /// optionals of them. `value` must outlive parsing.
  template <typename T>
  Option add_option(const std::string& name, T& value, const std::string& help) const;
  /// A flag; with '!' before its name it sets `value` to false.
  Option add_flag(const std::string& name, bool& value, const std::string& help) const;
  /// An option of earlier versions, which the help does not show; `instead` says what to use.
  void retire_option(const std::string& name, const std::string& instead) const;
  /// Runs when the command line names this command.
  void callback(const std::function<void()>& run) const;
  /// What the help begins with, above the usage.
  void describe(const std::string& text) const;
  void footer(const std::string& text) const;
  /// Lists these subcommands under a heading of the help.
  void group(const std::string& heading, const std::vector<std::string>& names) const;
  std::vector<std::string> subcommand_names() const;
  /// At least one subcommand, `count` of them, or between two numbers.
  void require_subcommand() const;
  void require_subcommand(int count) const;
  void require_subcommand(int least, int most) const;
  /// Takes options that it does not know from the command above.
  void fallthrough() const;
  /// All words after the command's name are remaining(), also --help.
  void take_all_words() const;
  /// Keeps words that it does not know as remaining().
  void allow_extras() const;
  std::string name() const;
  std::vector<std::string> remaining() const;
  /// Names of the options that the command line gives to it.
  std::vector<std::string> given_options() const;
  bool has_subcommand() const;
  /// What a shell can complete the last of `words` to: subcommands, options, and values that
  /// one_of() and suggest() name. `words` follow this command's name on a command line that is
  /// being typed.
  std::vector<std::string> completions(const std::vector<std::string>& words) const;

 private:
  friend class Program;
  CLI::App* self_;
};

/// Says what a word means that is no subcommand, as "FILE is a scenario: ..."; empty = unknown.
using Advice = std::function<std::string(const std::string& word)>;

/// `meanings` are asked before a command that is spelt alike is named, `others` after it.
struct Advices {
  Advice meanings = {}, others = {};
};

/// A program: parses its command line and prints what is wrong with it.
class Program {
 public:
  Program(const std::string& description, const std::string& name);
  ~Program();

  Command command() const { return Command(app_.get()); }
  /// Prints `version` for --version.
  void set_version(const std::string& version);
  void set_advices(const Advices& advices) { advices_ = advices; }
  /// The folder of docs/, examples/ and models/; a help that names one of their files ends with it.
  void set_shipped_files(const std::string& folder) { shipped_files_ = folder; }
  /// Parses the command line, during which callbacks run. Returns nothing where they have run;
  /// otherwise the exit code after help (0) or a fault on the command line (2), which are printed;
  /// without any word, that is the help with 2. Lets other exceptions of callbacks pass.
  std::optional<int> parse(int argc, char** argv);

 private:
  int explain(const CLI::ParseError& error) const;

  std::unique_ptr<CLI::App> app_;
  Advices advices_;
  std::string shipped_files_;
};

/// Inside a callback: ends parsing with "NAME: FAULT".
[[noreturn]] void refuse_option(const std::string& name, const std::string& fault);
/// Inside a callback: ends parsing because the argument `name` is missing.
[[noreturn]] void refuse_without(const std::string& name);

/// The number that a text is; empty = none.
std::optional<double> number_in(const std::string& text);

}  // namespace hg::apps
