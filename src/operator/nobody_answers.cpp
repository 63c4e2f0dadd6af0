#include "operator/nobody_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "io/plain_text.hpp"

namespace pmg::ops {

namespace {
constexpr const char* kWayOut = "; start pmg_controller, or give --lcm-url the address that it names";
}  // namespace

std::string nobody_answers(const OperatorSource& source) {
  std::vector<std::string> names;
  for (const auto& [name, heard] : source.heard())
    if (heard.status) names.push_back(io::plain_text(name));
  return fmt::format("no controller of this name answers on {}{}", source.url(),
                     names.empty() ? std::string(kWayOut) : fmt::format("; heard: {}", fmt::join(names, ", ")));
}

std::string nobody_heard(const std::string& url, const std::string& robot) {
  return fmt::format("no controller{} is heard on {}{}", robot.empty() ? "" : fmt::format(" named \"{}\"", robot), url,
                     kWayOut);
}

}  // namespace pmg::ops
