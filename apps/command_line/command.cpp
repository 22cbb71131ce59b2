#include "apps/command_line/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "apps/command_line/output.h"
#include "hg/core/nearest_name.h"

namespace hg::apps {
namespace {

constexpr int kBadInput = 2;

// "hapticgiant new device": the words that lead to a command.
std::string full_name(const CLI::App& command) {
  const CLI::App* above = command.get_parent();
  return above == nullptr ? command.get_name() : full_name(*above) + " " + command.get_name();
}

// The name that `word` abbreviates or misspells; empty: none is near enough.
std::string meant(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t kShortest = 3;
  const auto is_part = [&](const std::string& name) {
    return word.size() >= kShortest && (name.starts_with(word) || word.starts_with(name));
  };
  const auto found = std::ranges::find_if(names, is_part);
  return found != names.end() ? *found : misspelt_name(word, names);
}

// Names of the options that the help shows, without those of retire_option().
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() || option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string unknown_option(const CLI::App& command, const std::string& word) {
  std::string name = word.substr(0, word.find('='));
  std::ranges::replace(name, '_', '-');
  const std::string near = meant(name, option_names(command));
  return fmt::format("{}: no such option of {}{}", word.substr(0, word.find('=')),
                     full_name(command), near.empty() ? "" : ", did you mean '" + near + "'?");
}

// What an option is for, behind its name; empty: nothing is known of it.
std::string help_of(const CLI::App& command, const std::string& name) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name() == name && !option->get_description().empty())
      return ": " + option->get_description();
  }
  return "";
}

// The subcommand of `app` that was missed, and which there are.
std::string missing_subcommand(const CLI::App& app, const Advices& advices) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  for (const std::string& word : app.remaining()) {
    if (word.starts_with('-')) return unknown_option(app, word);
    const bool is_top = app.get_parent() == nullptr;
    const auto ask = [&](const Advice& advice) {
      return is_top && advice ? advice(word) : std::string();
    };
    if (const std::string text = ask(advices.meanings); !text.empty()) return text;
    const std::string unknown = fmt::format("{}: no such subcommand of {}", word, full_name(app));
    if (const std::string near = meant(word, names); !near.empty())
      return fmt::format("{}, did you mean '{}'?", unknown, near);
    if (const std::string text = ask(advices.others); !text.empty()) return text;
    return fmt::format("{}; there are {}", unknown, all);
  }
  return fmt::format("{}: expected a subcommand: {}", full_name(app), all);
}

// A word that nothing of `command` takes.
std::string unexpected_word(const CLI::App& command) {
  const std::vector<std::string> words = command.remaining(true);
  const auto option = std::ranges::find_if(
      words, [](const std::string& word) { return word.starts_with('-') && word != "-"; });
  if (option != words.end()) return unknown_option(command, *option);
  std::string takes;
  for (const CLI::Option* positional : command.get_options()) {
    if (positional->get_positional()) takes += " " + positional->get_name();
  }
  return fmt::format("{}: one word too many, {} takes {}", words.empty() ? "" : words.front(),
                     full_name(command), takes.empty() ? "none" : "only" + takes);
}

// What is wrong with the command line, of which `command` is the last one named.
std::string fault_of(const CLI::App& command, const CLI::ParseError& error,
                     const Advices& advices) {
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (command.get_require_subcommand_min() > 0) return missing_subcommand(command, advices);
    constexpr std::string_view kEnd = " is required";
    const std::string text = error.what();
    const std::string name = text.substr(0, text.rfind(kEnd));
    return fmt::format("{}: {}{}", full_name(command), text, help_of(command, name));
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return unexpected_word(command);
  return error.what();
}

// The end of a help that names files of docs/, examples/, models/ or tests/.
std::string where_files_are(const std::string& help, const std::string& folder) {
  const auto is_named = [&](const char* start) { return help.find(start) != std::string::npos; };
  const bool names_one = std::ranges::any_of(
      std::array{"docs/", "examples/", "models/", "tests/reference/"}, is_named);
  if (folder.empty() || !names_one) return "";
  return fmt::format("\nFiles that this names are in {}\n", folder);
}

// An empty text (a variable of a script that is not set) is no file, key or name.
void refuse_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() > 0) {
      option->check(
          [](const std::string& text) { return text.empty() ? "must not be empty" : ""; });
    }
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

// Name of the validator that keeps the values of Option::suggest(): it is asked for them only, and
// checks nothing.
constexpr std::string_view kSuggested = "suggested";

std::vector<std::string> suggested_values(CLI::Option& option) {
  CLI::Validator* kept = nullptr;
  try {
    for (int i = 0; kept == nullptr || kept->get_name() != kSuggested; ++i)
      kept = option.get_validator(i);
  } catch (const CLI::OptionNotFound&) {
    return {};
  }
  std::string values;
  kept->active(true);
  (void)(*kept)(values);
  kept->active(false);
  return CLI::detail::split(values, '\n');
}

CLI::App* subcommand_named(CLI::App* command, const std::string& name) {
  const std::vector<CLI::App*> all = command->get_subcommands({});
  const auto found =
      std::ranges::find(all, name, [](const CLI::App* one) { return one->get_name(); });
  return found == all.end() ? nullptr : *found;
}

// Where the typing of a command line has arrived.
struct Typed {
  CLI::App* command = nullptr;
  CLI::Option* awaiting = nullptr;  // the option of which a value follows
  std::size_t positionals = 0;      // given so far
};

Typed read_typed(CLI::App* command, const std::vector<std::string>& words) {
  Typed typed{.command = command};
  for (const std::string& word : words) {
    if (word == "=") continue;  // shells split --law=gauss
    if (word.starts_with("--")) {
      CLI::Option* option = typed.command->get_option_no_throw(word.substr(0, word.find('=')));
      const bool takes_next = option != nullptr && option->get_items_expected_max() > 0 &&
                              word.find('=') == std::string::npos;
      typed.awaiting = takes_next ? option : nullptr;
    } else if (typed.awaiting != nullptr) {
      typed.awaiting = nullptr;
    } else if (CLI::App* below = subcommand_named(typed.command, word); below != nullptr) {
      typed = {.command = below};
    } else {
      ++typed.positionals;
    }
  }
  return typed;
}

std::vector<std::string> offered(const Typed& typed, bool is_option) {
  if (typed.awaiting != nullptr) return suggested_values(*typed.awaiting);
  std::vector<std::string> found;
  std::size_t positional = 0;
  for (CLI::Option* option : typed.command->get_options()) {
    if (option->get_positional()) {
      if (positional++ == typed.positionals && !is_option) found = suggested_values(*option);
    } else if (is_option && !option->get_group().empty()) {  // without retired ones
      for (const std::string& name : option->get_lnames()) found.push_back("--" + name);
    }
  }
  if (is_option) return found;
  for (const CLI::App* below : typed.command->get_subcommands({}))
    found.push_back(below->get_name());
  return found;
}

}  // namespace

Option Option::check(const OptionCheck& check) const { return Option(self_->check(check)); }

Option Option::one_of(const std::vector<std::string>& values) const {
  CLI::Validator member = CLI::IsMember(values);
  member.operation([values](const std::string& text) -> std::string {
    if (std::ranges::find(values, text) != values.end()) return "";
    const std::string near = meant(text, values);
    return fmt::format("expected one of {}, got '{}'{}", fmt::join(values, ", "), text,
                       near.empty() ? "" : ", did you mean '" + near + "'?");
  });
  return Option(self_->check(member)).suggest([values] { return values; });
}

Option Option::suggest(const std::function<std::vector<std::string>()>& values) const {
  CLI::Validator kept;
  kept.operation([values](std::string& text) {
    text = fmt::format("{}", fmt::join(values(), "\n"));
    return std::string();
  });
  kept.name(std::string(kSuggested)).active(false);
  return Option(self_->transform(kept));
}

Option Option::existing_file() const { return Option(self_->check(CLI::ExistingFile)); }

Option Option::transform(const std::function<std::string(const std::string&)>& change) const {
  return Option(self_->transform([change](const std::string& text) { return change(text); }));
}

Option Option::required() const { return Option(self_->required()); }
Option Option::needs(const std::string& other) const { return Option(self_->needs(other)); }
Option Option::needs(Option other) const { return Option(self_->needs(other.self_)); }
Option Option::excludes(const std::string& other) const { return Option(self_->excludes(other)); }
Option Option::excludes(Option other) const { return Option(self_->excludes(other.self_)); }
Option Option::capture_default_str() const { return Option(self_->capture_default_str()); }
Option Option::delimiter(char separator) const { return Option(self_->delimiter(separator)); }
Option Option::allow_extra_args(bool allowed) const {
  return Option(self_->allow_extra_args(allowed));
}
Option Option::expected(int count) const { return Option(self_->expected(count)); }
Option Option::expected(int least, int most) const { return Option(self_->expected(least, most)); }
Option Option::envname(const std::string& name) const { return Option(self_->envname(name)); }
std::size_t Option::count() const { return self_->count(); }

Command Command::add_subcommand(const std::string& name, const std::string& description) const {
  return Command(self_->add_subcommand(name, description));
}

template <typename T>
Option Command::add_option(const std::string& name, T& value, const std::string& help) const {
  return Option(self_->add_option(name, value, help));
}

template Option Command::add_option(const std::string&, std::string&, const std::string&) const;
template Option Command::add_option(const std::string&, std::filesystem::path&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, int&, const std::string&) const;
template Option Command::add_option(const std::string&, unsigned int&, const std::string&) const;
template Option Command::add_option(const std::string&, double&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint16_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<int>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<double>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint64_t>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<std::string>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<double>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<int>&,
                                    const std::string&) const;

Option Command::add_flag(const std::string& name, bool& value, const std::string& help) const {
  return Option(self_->add_flag(name, value, help));
}

void Command::retire_option(const std::string& name, const std::string& instead) const {
  self_
      ->add_option_function<std::string>(
          name,
          [=](const std::string&) { refuse_option(name, "is no option any more: " + instead); })
      ->expected(0, 1)
      ->group("");
}

void Command::callback(const std::function<void()>& run) const { self_->callback(run); }
void Command::describe(const std::string& text) const { self_->description(text); }
void Command::footer(const std::string& text) const { self_->footer(text); }

void Command::group(const std::string& heading, const std::vector<std::string>& names) const {
  for (const std::string& name : names) self_->get_subcommand(name)->group(heading);
}

std::vector<std::string> Command::subcommand_names() const {
  std::vector<std::string> names;
  for (const CLI::App* command : self_->get_subcommands({})) names.push_back(command->get_name());
  return names;
}

void Command::require_subcommand() const { self_->require_subcommand(); }
void Command::require_subcommand(int count) const { self_->require_subcommand(count); }
void Command::require_subcommand(int least, int most) const {
  self_->require_subcommand(least, most);
}
void Command::fallthrough() const { self_->fallthrough(); }

void Command::take_all_words() const {
  self_->set_help_flag();
  self_->prefix_command();
}

void Command::allow_extras() const { self_->allow_extras(); }
std::string Command::name() const { return self_->get_name(); }
std::vector<std::string> Command::remaining() const { return self_->remaining(); }
std::vector<std::string> Command::given_options() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : std::as_const(*self_).get_options()) {
    if (option->count() > 0) names.push_back(option->get_name());
  }
  return names;
}

bool Command::has_subcommand() const { return !self_->get_subcommands().empty(); }

std::vector<std::string> Command::completions(const std::vector<std::string>& words) const {
  if (words.empty()) return {};
  std::string last = words.back() == "=" ? "" : words.back();
  std::vector<std::string> before(words.begin(), words.end() - 1);
  std::string kept;  // of --law=ga, where a shell does not split it
  if (const std::size_t end = last.find('='); last.starts_with("--") && end != std::string::npos) {
    before.push_back(last.substr(0, end));
    kept = last.substr(0, end + 1);
    last.erase(0, end + 1);
  }
  const Typed typed = read_typed(self_, before);
  std::vector<std::string> found = offered(typed, last.starts_with('-'));
  std::erase_if(found, [&](const std::string& text) { return !text.starts_with(last); });
  for (std::string& text : found) text.insert(0, kept);
  return found;
}

Program::Program(const std::string& description, const std::string& name)
    : app_(std::make_unique<CLI::App>(description, name)) {}

Program::~Program() = default;

void Program::set_version(const std::string& version) {
  app_->set_version_flag("--version", version);
}

std::optional<int> Program::parse(int argc, char** argv) {
  refuse_empty_values(*app_);
  try {
    app_->parse(argc, argv);
    return {};
  } catch (const CLI::ParseError& error) {
    return explain(error);
  }
}

int Program::explain(const CLI::ParseError& error) const {
  const CLI::App* last = app_.get();
  while (!last->get_subcommands().empty()) last = last->get_subcommands().back();
  const bool needs_word = last->get_require_subcommand_min() > 0;
  const std::vector<std::string> words = last->remaining();
  const bool has_unknown = needs_word && std::ranges::any_of(words, [](const std::string& word) {
                             return !word.starts_with('-');
                           });
  if (error.get_exit_code() == 0 && !has_unknown) {  // help or version
    std::ostringstream out, errors;
    app_->exit(error, out, errors);
    print_out(out.str() + where_files_are(out.str(), shipped_files_));
    return 0;
  }
  if (needs_word && last->get_parent() == nullptr && words.empty()) {
    print_out(last->help() + where_files_are(last->help(), shipped_files_));
    return kBadInput;
  }
  const std::string fault =
      has_unknown ? missing_subcommand(*last, advices_) : fault_of(*last, error, advices_);
  print_error("{}\nMore: {} --help\n", fault, full_name(*last));
  return kBadInput;
}

void refuse_option(const std::string& name, const std::string& fault) {
  throw CLI::ValidationError(name, fault);
}

void refuse_without(const std::string& name) { throw CLI::RequiredError(name); }

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  if (!CLI::detail::lexical_cast(text, value)) return {};
  return value;
}

}  // namespace hg::apps
