#include "live_page/page_message.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace pmg::live_page {

namespace {

using Parsed = nlohmann::json;

constexpr std::array<std::pair<const char*, ops::Request>, 5> kRequests = {{{"stand", ops::Request::kStand},
                                                                            {"reset", ops::Request::kReset},
                                                                            {"limp", ops::Request::kLimp},
                                                                            {"lift", ops::Request::kLift},
                                                                            {"set_down", ops::Request::kSetDown}}};
constexpr double kLongest_ms = 1e12;                         // thirty years
constexpr std::int64_t kMostNumber = std::int64_t{1} << 53;  // a script's largest whole number

std::optional<double> number_in(const Parsed& json, const char* key, double most) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  if (!std::isfinite(value) || std::abs(value) > most) return std::nullopt;
  return value;
}

std::optional<std::int64_t> count_in(const Parsed& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number_unsigned()) return std::nullopt;
  const auto value = found->get<std::uint64_t>();
  if (value > static_cast<std::uint64_t>(kMostNumber)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

std::optional<HandNews> hand_in(const Parsed& json) {
  const auto number = count_in(json, "n"), presses = count_in(json, "press");
  const auto t_ms = number_in(json, "t", kLongest_ms);
  const auto forwards = number_in(json, "forwards", 1.0), turn = number_in(json, "turn", 1.0),
             left = number_in(json, "left", 1.0);
  const auto held = json.find("held");
  const bool whole = number && presses && t_ms && forwards && turn && left && held != json.end() && held->is_boolean();
  if (!whole || json.size() != 7) return std::nullopt;
  return HandNews{.number = *number,
                  .stamp_ns = static_cast<std::int64_t>(*t_ms * 1e6),
                  .held = held->get<bool>(),
                  .presses = *presses,
                  .forwards = *forwards,
                  .turn = *turn,
                  .left = *left};
}

}  // namespace

std::optional<PageMessage> read_message(std::string_view text) {
  const Parsed json = Parsed::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  const auto request = json.find("request");
  if (request == json.end()) {
    const auto hand = hand_in(json);
    return hand ? std::optional(PageMessage{.hand = hand, .request = {}}) : std::nullopt;
  }
  if (json.size() != 1 || !request->is_string()) return std::nullopt;
  for (const auto& [name, meaning] : kRequests)
    if (*request == name) return PageMessage{.hand = {}, .request = meaning};
  return std::nullopt;
}

}  // namespace pmg::live_page
