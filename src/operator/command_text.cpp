#include "operator/command_text.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace pmg::ops {

double share_apart(double a, double b) { return std::abs(a - b) / std::max({std::abs(a), std::abs(b), 0.1}); }

bool alike(double a, double b) { return share_apart(a, b) <= 0.01; }

nlohmann::ordered_json command_json(std::span<const double, kChannels> u) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < kChannels; ++i) json[kChannelNames[i]] = u[i];
  return json;
}

}  // namespace pmg::ops
