#include "runtime/source_rates.hpp"

#include <algorithm>

namespace pmg::runtime {

namespace {

/// A steady rate, and how many messages may come at once after a delay on their way.
struct Allowance {
  std::int64_t period_ns;
  std::int64_t burst;
};

/// By MessageKind. Commands: five programs of 50 Hz. Requests are repeated every 50 ms; eight operators at
/// 40 Hz, with stops beside, stay below the 800 a second that the control cycle takes from its inbox.
/// Arms: a headset's 120 Hz; eight such operators stay below the 1,200 a second that it takes of them.
constexpr std::array<Allowance, 4> kAllowances = {{{4'000'000, 8}, {25'000'000, 4}, {25'000'000, 4}, {8'000'000, 4}}};

}  // namespace

bool SourceRates::admit(const control::Source& source, MessageKind kind, std::int64_t now_ns) noexcept {
  Place* place = place_of(source, now_ns);
  if (place == nullptr) {
    if (kind != MessageKind::kStop) return false;
    place = &others_;
  }
  return admit(*place, kind, now_ns);
}

bool SourceRates::admit(Place& place, MessageKind kind, std::int64_t now_ns) noexcept {
  place.heard_ns = now_ns;
  const auto index = static_cast<std::size_t>(kind);
  const auto [period_ns, burst] = kAllowances[index];
  std::int64_t& next_ns = place.next_ns[index];
  if (next_ns > now_ns + (burst - 1) * period_ns) return false;
  next_ns = std::max(next_ns, now_ns) + period_ns;
  return true;
}

SourceRates::Place* SourceRates::place_of(const control::Source& source, std::int64_t now_ns) noexcept {
  const auto of_operator = [&](const Place& place) {
    return place.source.name[0] != '\0' && place.source.operator_name() == source.operator_name();
  };
  if (const auto found = std::ranges::find_if(places_, of_operator); found != places_.end()) return &*found;
  const auto vacant = [&](const Place& place) {
    return place.source.name[0] == '\0' || now_ns - place.heard_ns > kSilent_ns;
  };
  const auto found = std::ranges::find_if(places_, vacant);
  if (found == places_.end()) return nullptr;
  *found = Place{.source = source, .heard_ns = now_ns, .next_ns = {}};
  return &*found;
}

}  // namespace pmg::runtime
