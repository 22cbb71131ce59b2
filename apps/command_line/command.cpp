#include "apps/command_line/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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

// The subcommand of `app` that was missed, and which there are.
std::string missing_subcommand(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  for (const std::string& word : app.remaining()) {
    if (word.starts_with('-')) continue;
    return fmt::format("{}: no such subcommand of {}, did you mean '{}'?", word, app.get_name(),
                       nearest_name(word, names));
  }
  return fmt::format("{}: expected a subcommand: {}", app.get_name(), fmt::join(names, ", "));
}

int explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().back();
  if (dynamic_cast<const CLI::RequiredError*>(&error) == nullptr ||
      last->get_require_subcommand_min() == 0) {
    std::ostringstream out, errors;
    const int code = app.exit(error, out, errors);
    print_out(out.str());
    print_error(errors.str());
    return code == 0 ? 0 : kBadInput;
  }
  print_error("{}\nRun with --help for more information.\n", missing_subcommand(*last));
  return kBadInput;
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

// The values of Option::suggest(), kept as the name of a validator that checks nothing.
constexpr std::string_view kSuggested = "suggested\n";

std::vector<std::string> suggested_values(CLI::Option& option) {
  std::string values;
  try {
    for (int i = 0; !values.starts_with(kSuggested); ++i)
      values = option.get_validator(i)->get_name();
  } catch (const CLI::OptionNotFound&) {
    return {};
  }
  return CLI::detail::split(values.substr(kSuggested.size()), '\n');
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
  return Option(self_->check(CLI::IsMember(values))).suggest(values);
}

Option Option::suggest(const std::vector<std::string>& values) const {
  CLI::Validator kept;
  kept.name(fmt::format("{}{}", kSuggested, fmt::join(values, "\n"))).active(false);
  return Option(self_->check(kept));
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
void Command::footer(const std::string& text) const { self_->footer(text); }
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
    return explain(*app_, error);
  }
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
