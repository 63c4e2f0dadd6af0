#include "vr/vr_news.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace pmg::vr {

namespace {

constexpr double kFarthest_m = 20.0, kLongest_ms = 1e12, kLength = 0.01;
constexpr std::int64_t kMostCount = std::int64_t{1} << 53;  // a script's largest whole number
constexpr double kSteep = 0.2;                              // of the horizontal part of what is looked along

/// Reads members, and remembers whether each was there and as it must be.
class Reader {
 public:
  explicit Reader(const nlohmann::json& json) : json_(json) {}

  std::int64_t count(const char* key) {
    const nlohmann::json* value = member(key);
    if (value == nullptr || !value->is_number_unsigned()) return fail<std::int64_t>();
    const auto number = value->get<std::uint64_t>();
    return number > static_cast<std::uint64_t>(kMostCount) ? fail<std::int64_t>() : static_cast<std::int64_t>(number);
  }
  bool flag(const char* key) {
    const nlohmann::json* value = member(key);
    return value != nullptr && value->is_boolean() ? value->get<bool>() : fail<bool>();
  }
  double number(const char* key, double most) {
    const nlohmann::json* value = member(key);
    return value == nullptr ? fail<double>() : number_of(*value, most);
  }
  std::optional<Pose> pose(const char* key) {
    const nlohmann::json* value = member(key);
    if (value != nullptr && value->is_null()) return std::nullopt;
    if (value == nullptr || !value->is_array() || value->size() != 7) return fail<std::optional<Pose>>();
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < v.size(); ++i) v.at(i) = number_of((*value)[i], i < 3 ? kFarthest_m : 1.1);
    Pose pose{.p_m = {-v[2], -v[0], v[1]}, .R = Eigen::Quaterniond(v[6], -v[5], -v[3], v[4])};
    if (!(std::abs(pose.R.norm() - 1.0) <= kLength)) return fail<std::optional<Pose>>();
    pose.R.normalize();
    return pose;
  }
  HandNews hand(const char* key) {
    const nlohmann::json* value = member(key);
    if (value == nullptr || !value->is_object()) return fail<HandNews>();
    Reader reader(*value);
    HandNews hand{.pose = reader.pose("pose"),
                  .leads = reader.flag("leads"),
                  .lead_presses = reader.count("presses"),
                  .hand_backs = reader.count("backs")};
    whole_ = whole_ && reader.whole();
    return hand;
  }
  /// Everything that was asked for was there, and nothing else was.
  bool whole() const { return whole_ && asked_ == json_.size(); }

 private:
  template <typename T>
  T fail() {
    whole_ = false;
    return {};
  }
  const nlohmann::json* member(const char* key) {
    const auto found = json_.find(key);
    if (found == json_.end()) return nullptr;
    ++asked_;
    return &*found;
  }
  double number_of(const nlohmann::json& value, double most) {
    if (!value.is_number()) return fail<double>();
    const double number = value.get<double>();
    return std::abs(number) <= most ? number : fail<double>();  // NaN isn't
  }

  const nlohmann::json& json_;
  std::size_t asked_ = 0;
  bool whole_ = true;
};

}  // namespace

std::optional<double> yaw_of(const Eigen::Quaterniond& R) noexcept {
  const Eigen::Vector3d along = R * Eigen::Vector3d::UnitX();
  if (along.head<2>().norm() < kSteep) return std::nullopt;
  return std::atan2(along.y(), along.x());
}

std::optional<VrNews> read_news(std::string_view text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("vr")) return std::nullopt;
  Reader reader(json);
  VrNews news;
  news.number = reader.count("vr");
  news.stamp_ns = static_cast<std::int64_t>(reader.number("t", kLongest_ms) * 1e6);
  news.shown = reader.flag("shown");
  news.head = reader.pose("head");
  news.hands[kLeft] = reader.hand("left");
  news.hands[kRight] = reader.hand("right");
  news.held = reader.flag("held");
  news.presses = reader.count("presses");
  news.recentres = reader.count("recentres");
  news.spans_shown = reader.count("spans");
  news.uprights = reader.count("uprights");
  if (!reader.whole()) return std::nullopt;
  return news;
}

}  // namespace pmg::vr
