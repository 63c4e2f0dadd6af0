#include "report/limited_joints.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/constants.hpp"

namespace pmg::report {

namespace {

void join_neighbours(std::vector<LimitedJoint::Stretch>& stretches) {
  for (std::size_t i = 0; 2 * i + 1 < stretches.size(); ++i) {
    LimitedJoint::Stretch joined = stretches[2 * i];
    const LimitedJoint::Stretch& next = stretches[2 * i + 1];
    joined.to_s = next.to_s;
    for (std::size_t reason = 0; reason < joined.by.size(); ++reason)
      joined.by[reason] = joined.by[reason] || next.by[reason];
    stretches[i] = joined;
  }
  stretches.resize(stretches.size() / 2);
}

}  // namespace

std::string LimitedJoint::reasons() const {
  std::string text;
  for (std::size_t reason = 0; reason < ticks.size(); ++reason) {
    if (ticks[reason] == 0) continue;
    text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", kLimitNames[reason],
                        ticks[reason] == 1 ? "1 tick" : fmt::format("{} ticks", ticks[reason]));
  }
  return text;
}

void LimitedJoints::add(double t_s, const pmg_msgs::limited_t& message) {
  for (std::size_t i = 0; i < std::min(message.joint.size(), message.by.size()); ++i) {
    if (message.joint[i] < 0) continue;
    const auto joint = static_cast<std::size_t>(message.joint[i]);
    auto known = std::ranges::find(joints_, joint, &LimitedJoint::joint);
    if (known == joints_.end()) known = joints_.insert(joints_.end(), LimitedJoint{.joint = joint, .stretches = {}});
    std::array<bool, 3> by{};
    for (std::size_t reason = 0; reason < by.size(); ++reason) {
      by[reason] = (static_cast<unsigned>(message.by[i]) >> reason & 1U) != 0;
      known->ticks[reason] += by[reason];
    }
    ++known->any_ticks;
    auto& stretches = known->stretches;
    if (!stretches.empty() && stretches.back().by == by &&
        t_s - stretches.back().to_s < 0.5 * model::kControlPeriod_s) {
      stretches.back().to_s = t_s + model::kControlPeriod_s;
    } else {
      if (stretches.size() == kMostStretches) join_neighbours(stretches);
      stretches.push_back({t_s, t_s + model::kControlPeriod_s, by});
    }
    known->longest_s = std::max(known->longest_s, stretches.back().to_s - stretches.back().from_s);
  }
}

std::vector<LimitedJoint> LimitedJoints::most_first() const {
  std::vector<LimitedJoint> sorted = joints_;
  std::ranges::stable_sort(sorted, std::greater{}, &LimitedJoint::any_ticks);
  return sorted;
}

}  // namespace pmg::report
