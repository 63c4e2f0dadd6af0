#include "operator/robot_board.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "operator/words.hpp"

namespace pmg::ops {

namespace {

std::optional<UprightRule> upright_rule(const pmg_msgs::robot_info_t& info) {
  const auto options = nlohmann::json::parse(info.options, nullptr, false);
  const nlohmann::json::json_pointer up("/imu/up"), most("/faults/tilt_rad");
  if (!options.is_object() || !options.contains(up) || !options.contains(most)) return std::nullopt;
  if (!options[up].is_array() || options[up].size() != 3 || !options[most].is_number()) return std::nullopt;
  UprightRule rule{.most_tilt_rad = options[most].get<double>()};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!options[up][i].is_number()) return std::nullopt;
    rule.up_I.at(i) = options[up][i].get<double>();
  }
  return rule;
}

}  // namespace

std::optional<double> tilt_rad(const RobotNews& news) {
  if (!news.upright || !news.state) return std::nullopt;
  const double(&q)[4] = news.state->orientation_WI;
  const Eigen::Quaterniond R_WI(q[0], q[1], q[2], q[3]);
  const Eigen::Vector3d up_I = Eigen::Map<const Eigen::Vector3d>(news.upright->up_I.data());
  if (!(std::abs(R_WI.norm() - 1.0) < 0.1) || !(std::abs(up_I.norm() - 1.0) < 0.01)) return std::nullopt;
  return std::acos(std::clamp((R_WI.normalized() * up_I).z(), -1.0, 1.0));
}

const pmg_msgs::reference_t* reference_in_force(const RobotNews& news) noexcept {
  return news.reference && is_upright(news.status.mode) ? &*news.reference : nullptr;
}

void RecentValues::add(double value) {
  if (values_.size() < kKept) {
    values_.push_back(value);
    return;
  }
  values_[next_] = value;
  next_ = (next_ + 1) % kKept;
}

double RecentValues::percentile(double percent) const {
  if (values_.empty()) return 0.0;
  std::vector<double> sorted = values_;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(percent / 100.0 * static_cast<double>(sorted.size()))) - 1;
  const auto nth = sorted.begin() + std::max<std::ptrdiff_t>(rank, 0);
  std::ranges::nth_element(sorted, nth);
  return *nth;
}

RobotBoard::RobotBoard(io::LcmLink& link, const io::Clock& clock, seal::OperatorSeal seal)
    : clock_(clock), seal_(std::move(seal)) {
  link.subscribe("STATUS", [this](io::Bytes bytes) { hear_status(bytes); });
  link.subscribe("ROBOT_INFO", [this](io::Bytes bytes) {
    const auto info = io::decode_message<pmg_msgs::robot_info_t>(bytes);
    if (!info || !robots_.contains(info->robot)) return;
    RobotNews& news = robots_[info->robot];
    if (!news.info || news.info->options != info->options) news.upright = upright_rule(*info);
    news.info = info;
  });
  link.subscribe("LINK", [this](io::Bytes bytes) {
    const auto counts = io::decode_message<pmg_msgs::link_t>(bytes);
    if (counts && robots_.contains(counts->robot)) robots_[counts->robot].link = counts;
  });
  link.subscribe("REFERENCE", [this](io::Bytes bytes) {
    const auto reference = io::decode_message<pmg_msgs::reference_t>(bytes);
    if (reference && robots_.contains(reference->robot)) robots_[reference->robot].reference = reference;
  });
  link.subscribe("TIMING", [this](io::Bytes bytes) {
    const auto timing = io::decode_message<pmg_msgs::timing_t>(bytes);
    if (!timing || !robots_.contains(timing->robot)) return;
    RobotNews& news = robots_[timing->robot];
    news.timing = timing;
    news.wake_us.add(static_cast<double>(timing->wake_ns) * 1e-3);
    news.tick_us.add(static_cast<double>(timing->tick_ns) * 1e-3);
  });
  link.subscribe("HOIST_STATE", [this](io::Bytes bytes) {
    const auto hoist = seal::decode_sealed<pmg_msgs::hoist_state_t, pmg_msgs::proof_t>(bytes);
    const auto known = hoist ? robots_.find(hoist->message.robot) : robots_.end();
    if (known != robots_.end()) known->second.hoist.hear(*hoist, known->second.boot, seal_, clock_.now_ns());
  });
  link.subscribe("STATE", [this](io::Bytes bytes) {
    const auto state = io::decode_message<pmg_msgs::robot_state_t>(bytes);
    if (state && robots_.contains(state->robot)) robots_[state->robot].state = state;
  });
}

double RobotBoard::silence_s(const RobotNews& news) const noexcept {
  return static_cast<double>(clock_.now_ns() - news.heard_ns) * 1e-9;
}

void RobotBoard::hear_status(io::Bytes bytes) {
  const auto heard = seal::decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
  if (!heard) return;
  const pmg_msgs::status_t& status = heard->message;
  const std::int64_t now_ns = clock_.now_ns(), boot = boot_of(heard->seal);
  const auto known = robots_.find(status.robot);
  if (known == robots_.end() ? robots_.size() >= kMostRobots
                             : !known->second.order.news(boot, status.stamp_ns, now_ns)) {
    return;
  }
  if (!seal_.believe("STATUS", heard->message_bytes, heard->seal, now_ns)) return;
  RobotNews& news = robots_[status.robot];
  if (news.heard_ns != 0 && news.status.session != status.session) ++news.sessions;
  news.order.take(boot, status.stamp_ns, now_ns);
  if (news.boot != boot) news.hoist = {};  // an earlier start's
  news.boot = boot;
  news.status = status;
  news.heard_ns = now_ns;
}

}  // namespace pmg::ops
