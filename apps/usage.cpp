#include "usage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "files/nearest_name.hpp"

namespace pmg::apps {

namespace {

/// The program, then each given subcommand: {pmg_send, walk}.
std::vector<const CLI::App*> given_commands(const CLI::App& app) {
  std::vector<const CLI::App*> chain{&app};
  for (auto next = app.get_subcommands(); !next.empty(); next = next.front()->get_subcommands()) {
    chain.push_back(next.front());
  }
  return chain;
}

/// "pmg_send walk"
std::string name_of(const std::vector<const CLI::App*>& chain) {
  std::vector<std::string> names;
  for (const CLI::App* app : chain) names.push_back(app->get_name());
  return fmt::format("{}", fmt::join(names, " "));
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

/// Options as typed: "--out", "-M".
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool has_option(const CLI::App& app, const std::string& name) {
  return std::ranges::count(option_names(app), name) > 0;
}

std::string unknown_option(const std::vector<const CLI::App*>& chain, const std::string& word) {
  const std::string option = word.substr(0, word.find('='));
  const CLI::App& program = *chain.front();
  for (const CLI::App* given : chain) {
    if (!has_option(*given, option)) continue;
    return given == &program ? fmt::format("{}: belongs before {}", option, chain[1]->get_name())
                             : fmt::format("{}: belongs after {}", option, given->get_name());
  }
  for (const CLI::App* other : commands_of(program)) {
    if (has_option(*other, option)) {
      return fmt::format("{}: is an option of {} {}", option, program.get_name(), other->get_name());
    }
  }
  std::vector<std::string> known;
  for (const CLI::App* given : chain) std::ranges::copy(option_names(*given), std::back_inserter(known));
  const std::string nearest = files::nearest_name(option, known);
  return nearest.empty() ? fmt::format("{}: unknown option ({} --help lists all)", option, name_of(chain))
                         : fmt::format("{}: unknown option; did you mean {}?", option, nearest);
}

/// The first word that CLI11 does not know; empty: none.
std::string unknown_word(const CLI::App& app, const std::vector<const CLI::App*>& chain) {
  std::vector<std::string> words = app.remaining(true);
  std::erase(words, "--");
  if (words.empty()) return "";
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  const std::vector<std::string> commands = names_of(commands_of(*chain.back()));
  if (!commands.empty() && !is_option(words.front())) {
    return fmt::format("{}: unknown command; {}", words.front(), files::expected_name(words.front(), commands));
  }
  const auto option = std::ranges::find_if(words, is_option);
  if (option != words.end()) return unknown_option(chain, *option);
  for (const CLI::App* given : chain) {
    if (has_option(*given, "--" + words.front()))
      return fmt::format("'{}' is one argument too many; did you mean --{}?", words.front(), words.front());
  }
  return fmt::format("'{}' is one argument too many ({} --help shows an example)", words.front(), name_of(chain));
}

std::string missing(const std::vector<const CLI::App*>& chain, const CLI::ParseError& error) {
  for (const CLI::App* app : chain) {
    for (const CLI::Option* option : app->get_options()) {
      if (option->get_required() && option->count() == 0) {
        return fmt::format("{} is missing: {} ({} --help shows an example)", option->get_name(),
                           option->get_description(), name_of(chain));
      }
    }
  }
  const std::vector<std::string> commands = names_of(commands_of(*chain.back()));
  if (commands.empty()) return error.what();
  return fmt::format("a command is missing; expected one of {} ({} --help shows an example)", fmt::join(commands, ", "),
                     name_of(chain));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  if (const std::size_t at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
  return text;
}

const CLI::Option* option_named(const std::vector<const CLI::App*>& chain, const std::string& name) {
  for (const CLI::App* app : chain) {
    for (const CLI::Option* option : app->get_options()) {
      if (option->get_name() == name) return option;
    }
  }
  return nullptr;
}

/// For CLI11's message "Could not convert: --seed = many".
std::string not_converted(const std::vector<const CLI::App*>& chain, const std::string& text) {
  const std::string start = "Could not convert: ";
  const std::size_t equals = text.find(" = ");
  if (!text.starts_with(start) || equals == std::string::npos) return text;
  const std::string name = text.substr(start.size(), equals - start.size());
  const CLI::Option* option = option_named(chain, name);
  const std::string type = option == nullptr ? "" : option->get_type_name();
  const char* expected = type.starts_with("UINT")   ? "a whole number of at least 0"
                         : type.starts_with("INT")  ? "a whole number"
                         : type.starts_with("TEXT") ? "a text"
                                                    : "a number";
  return fmt::format("{}: '{}' isn't {}", name, text.substr(equals + 3), expected);
}

/// For a missing value or too many values: CLI11's message begins with the option's name.
std::string wrong_count(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  if (text.ends_with("missing")) return name + ": its value is missing";
  if (text.find("eceived") != std::string::npos) return name + ": is given more than once; expected it once";
  return text;
}

}  // namespace

std::string misread_value(const CLI::App& app) {
  const std::vector<const CLI::App*> chain = given_commands(app);
  for (const CLI::App* given : chain) {
    for (const CLI::Option* option : given->get_options()) {
      if (option->get_expected_max() == 0) continue;  // a flag
      for (const std::string& value : option->results()) {
        const std::string name = value.substr(0, value.find('='));
        const bool of_chain = std::ranges::any_of(chain, [&](const CLI::App* one) { return has_option(*one, name); });
        if (of_chain || (value.starts_with("--") && value.size() > 2))
          return fmt::format("{}: {}: its value is missing; {} follows it", name_of(chain), option->get_name(), value);
        if (option->get_type_name().starts_with("UINT") && value.starts_with('-'))
          return fmt::format("{}: {}: '{}' isn't a whole number of at least 0", name_of(chain), option->get_name(),
                             value);
      }
    }
  }
  return "";
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  if (const std::string misread = misread_value(app); !misread.empty()) return misread;
  const std::vector<const CLI::App*> chain = given_commands(app);
  std::string text = unknown_word(app, chain);
  const std::string kind = error.get_name(), what = error.what();
  if (!text.empty()) {
  } else if (kind == "RequiredError") {
    text = missing(chain, error);
  } else if (kind == "RequiresError") {
    text = replaced(what, " requires ", " needs ");
  } else if (kind == "ExcludesError") {
    text = replaced(what, " excludes ", " can't be given together with ");
  } else if (kind == "ConversionError") {
    text = not_converted(chain, what);
  } else if (kind == "ArgumentMismatch") {
    text = wrong_count(what);
  } else {
    text = what;
  }
  return name_of(chain) + ": " + text;
}

}  // namespace pmg::apps
