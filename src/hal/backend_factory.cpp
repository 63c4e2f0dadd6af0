#include "hal/backend_factory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "files/nearest_name.hpp"

namespace pmg::hal {

namespace {

std::vector<std::string> names_of(const std::vector<BackendKind>& kinds) {
  std::vector<std::string> names;
  for (const BackendKind& kind : kinds) names.push_back(kind.name);
  return names;
}

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& words) {
  if (words.size() < 2) return fmt::format("{}", fmt::join(words, ""));
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

}  // namespace

void BackendFactory::add(BackendKind kind) {
  const std::vector<std::string> known = names();
  if (std::ranges::find(known, kind.name) != known.end()) throw std::logic_error("two backends named " + kind.name);
  kinds_.push_back(std::move(kind));
}

void BackendFactory::lacks(const std::string& name, const std::string& what) { lacking_.emplace_back(name, what); }

std::vector<std::string> BackendFactory::names() const {
  std::vector<std::string> names = names_of(kinds_);
  for (const auto& [name, what] : lacking_) names.push_back(name);
  return names;
}

std::string BackendFactory::help() const {
  std::vector<std::string> missing, summaries;
  for (const auto& [name, what] : lacking_) missing.push_back(name);
  for (const BackendKind& kind : kinds_) summaries.push_back(kind.name + ", " + kind.summary);
  std::string text = "the drives: ";
  if (kinds_.empty()) text += "this build has no backend";
  if (kinds_.size() == 1) text += summaries.front() + ", is the one backend of this build";
  if (kinds_.size() > 1) text += fmt::format("{}", fmt::join(summaries, "; "));
  if (!missing.empty())
    text += fmt::format("; {} {} not in it", enumerated(missing), missing.size() > 1 ? "are" : "is");
  return text;
}

const BackendKind& BackendFactory::kind(const std::string& name) const {
  const auto found = std::ranges::find(kinds_, name, &BackendKind::name);
  if (found != kinds_.end()) return *found;
  const auto lacking = std::ranges::find(lacking_, name, &std::pair<std::string, std::string>::first);
  const std::string what = lacking == lacking_.end() ? "such backend" : lacking->second;
  const std::vector<std::string> here = names_of(kinds_);
  const std::string expected = here.empty()       ? "it has no other backend either"
                               : here.size() == 1 ? fmt::format("expected {}, the one that it has", here.front())
                                                  : files::expected_name(name, here);
  throw std::invalid_argument(fmt::format("--hal {}: this build has no {}; {}", name, what, expected));
}

}  // namespace pmg::hal
