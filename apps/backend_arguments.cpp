#include "backend_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>

#include "option_checks.hpp"

namespace pmg::apps {

void BackendArguments::declare(CLI::App& app) {
  app.add_option("--hal", hal_, factory_.help())->required()->check(one_of(factory_.names()));
  for (const hal::BackendKind& kind : factory_.kinds()) {
    for (const hal::BackendOption& option : kind.options) declare(app, kind, option);
  }
}

void BackendArguments::declare(CLI::App& app, const hal::BackendKind& kind, const hal::BackendOption& option) {
  const std::string help = kind.name + ": " + option.help;
  const auto same = std::ranges::find(declared_, option.name, &Declared::name);
  if (same != declared_.end()) {
    if (same->value.index() != option.value.index()) throw std::logic_error("two types of --" + option.name);
    same->kinds.push_back(kind.name);
    same->help += "; " + help;
    same->option->description(same->help);
    return;
  }
  Declared& declared = declared_.emplace_back(Declared{option.name, option.value, nullptr, {kind.name}, help});
  const std::string flag = "--" + option.name;
  declared.option = std::visit(
      [&](auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, bool>) {
          return app.add_flag(flag, value, help);
        } else {
          CLI::Option* added = app.add_option(flag, value, help);
          return value == Value{} && std::is_same_v<Value, std::string> ? added : added->capture_default_str();
        }
      },
      declared.value);
}

hal::OptionValues BackendArguments::values() const {
  hal::OptionValues values;
  for (const hal::BackendOption& option : kind().options) values[option.name] = option.value;
  for (const Declared& declared : declared_) {
    if (declared.option->count() == 0) continue;
    if (!values.contains(declared.name)) {
      throw std::invalid_argument(fmt::format("--{}: is an option of --hal {}; expected none with --hal {}",
                                              declared.name, fmt::join(declared.kinds, " and --hal "), hal_));
    }
    values[declared.name] = declared.value;
  }
  return values;
}

void add_to(nlohmann::ordered_json& json, const hal::OptionValues& values) {
  for (const auto& [name, any] : values) {
    const auto* text = std::get_if<std::string>(&any);
    if (text != nullptr && text->empty()) continue;
    std::visit([&json, &key = name](const auto& value) { json[key] = value; }, any);
  }
}

}  // namespace pmg::apps
