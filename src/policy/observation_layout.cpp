#include "policy/observation_layout.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "pmg/command.hpp"

namespace pmg::policy {

namespace {

constexpr double kVelocityScale = 0.1;  // joint velocities reach 10 rad/s, all other values about 1

std::vector<Element> channels() {
  constexpr std::array kSigns = {1, -1, -1, 1, -1, 1};
  static_assert(kSigns.size() == kChannels);
  std::vector<Element> found;
  for (std::size_t c = 0; c < kChannels; ++c) found.push_back({kChannelNames[c], kSigns[c]});
  return found;
}

double of_phase(const Seen& seen, int index) noexcept {
  const double angle = 2.0 * std::numbers::pi * seen.reference.phase, gain = seen.reference.gain;
  return index == 0 ? gain * std::sin(angle) : index == 1 ? gain * std::cos(angle) : gain;
}

}  // namespace

const std::vector<Quantity>& quantities() {
  using enum Quantity::Of;
  static const std::vector<Quantity> all = {
      {.name = "gyro",  // angular velocity in the IMU frame [rad/s]
       .elements = {{"x", -1}, {"y", 1}, {"z", -1}},
       .value = [](const Seen& seen, int i) noexcept { return seen.frame.state.gyro_rad_s[i]; },
       .older = true},
      {.name = "gravity_direction",  // unit vector down, in the IMU frame
       .elements = {{"x", 1}, {"y", -1}, {"z", 1}},
       .value =
           [](const Seen& seen, int i) noexcept {
             return (seen.frame.state.orientation_WI.conjugate() * Eigen::Vector3d(0.0, 0.0, -1.0))[i];
           },
       .older = true},
      {.name = "command",
       .elements = channels(),
       .value = [](const Seen& seen, int i) noexcept { return seen.observed.u[static_cast<std::size_t>(i)]; }},
      {.name = "user_command",  // admissible and rate-limited
       .elements = channels(),
       .value = [](const Seen& seen, int i) noexcept { return seen.reference.command.u[static_cast<std::size_t>(i)]; }},
      {.name = "phase",  // gain * sin(2 pi phi), gain * cos(2 pi phi), gain
       .elements = {{"gain_sin", -1}, {"gain_cos", -1}, {"gain", 1}},
       .value = of_phase},
      {.name = "q_ref",  // [rad]
       .of = kJoints,
       .value = [](const Seen& seen, int joint) noexcept { return seen.reference.q[joint]; },
       .from_stand = true},
      {.name = "dq_ref",  // [rad/s]
       .of = kPolicyJoints,
       .value = [](const Seen& seen, int joint) noexcept { return seen.reference.dq[joint]; },
       .scale = kVelocityScale},
      {.name = "q",  // [rad]
       .of = kJoints,
       .value = [](const Seen& seen, int joint) noexcept { return seen.frame.state.q[joint]; },
       .older = true,
       .from_stand = true},
      {.name = "dq",  // [rad/s]
       .of = kJoints,
       .value = [](const Seen& seen, int joint) noexcept { return seen.frame.state.dq[joint]; },
       .older = true,
       .scale = kVelocityScale},
      {.name = "last_action",  // the network's previous output
       .of = kActions,
       .value = [](const Seen& seen, int i) noexcept { return static_cast<double>(seen.frame.action[i]); },
       .older = true},
  };
  return all;
}

ObservationLayout::ObservationLayout(const model::RobotModel& robot) {
  for (const model::Joint& joint : robot.joints) {
    if (joint.policy) action_joints_.push_back(joint.name);
  }
  for (const Quantity& quantity : quantities()) add(quantity, 0, robot);
  for (const int age : kHistoryAges_ticks) {
    for (const Quantity& quantity : quantities()) {
      if (quantity.older) add(quantity, age, robot);
    }
  }
}

void ObservationLayout::add(const Quantity& quantity, int age_ticks, const model::RobotModel& robot) {
  ObservationTerm term{.quantity = &quantity, .offset = size_, .age_ticks = age_ticks};
  if (quantity.of == Quantity::Of::kElements) {
    for (const Element& element : quantity.elements) term.element.push_back(element.name);
  } else {
    term.element = quantity.of == Quantity::Of::kJoints && age_ticks == 0 ? robot.joint_index.names() : action_joints_;
  }
  const bool of_joints = quantity.of == Quantity::Of::kJoints || quantity.of == Quantity::Of::kPolicyJoints;
  for (int i = 0; i < term.size(); ++i)
    term.index.push_back(of_joints ? robot.joint_index.at(term.element[static_cast<std::size_t>(i)]) : i);
  size_ += term.size();
  terms_.push_back(std::move(term));
}

std::string ObservationLayout::to_json() const {
  nlohmann::ordered_json terms = nlohmann::ordered_json::array();
  for (const ObservationTerm& term : terms_) {
    terms.push_back({{"name", term.quantity->name},
                     {"offset", term.offset},
                     {"size", term.size()},
                     {"scale", term.quantity->scale},
                     {"age_ticks", term.age_ticks},
                     {"elements", term.element}});
  }
  return nlohmann::ordered_json{{"size", size_}, {"terms", terms}}.dump();
}

std::string quantities_json() {
  nlohmann::ordered_json found;
  for (const Quantity& quantity : quantities()) {
    nlohmann::ordered_json signs = nlohmann::ordered_json::object();
    for (const Element& element : quantity.elements) signs[element.name] = element.mirror_sign;
    found[quantity.name] = {{"from_stand", quantity.from_stand}, {"mirror_sign", signs}};
  }
  return found.dump();
}

}  // namespace pmg::policy
