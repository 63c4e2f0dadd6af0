#include "policy/observation_layout.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "pmg/command.hpp"

namespace pmg::policy {

namespace {

constexpr double kVelocityScale = 0.1;  // joint velocities reach 10 rad/s, all other values about 1

const char* name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kGyro:
      return "gyro";
    case Quantity::kGravityDirection:
      return "gravity_direction";
    case Quantity::kCommand:
      return "command";
    case Quantity::kUserCommand:
      return "user_command";
    case Quantity::kPhase:
      return "phase";
    case Quantity::kReferencePosition:
      return "q_ref";
    case Quantity::kReferenceVelocity:
      return "dq_ref";
    case Quantity::kJointPosition:
      return "q";
    case Quantity::kJointVelocity:
      return "dq";
    case Quantity::kLastAction:
      return "last_action";
  }
  return "";
}

}  // namespace

ObservationLayout::ObservationLayout(const model::RobotModel& robot) {
  const std::vector<std::string> axes = {"x", "y", "z"};
  const std::vector<std::string> channels(std::begin(kChannelNames), std::end(kChannelNames));
  const std::vector<std::string>& all = robot.joint_index.names();
  std::vector<int> all_joints, legs;
  for (int i = 0; i < robot.joint_index.size(); ++i) {
    all_joints.push_back(i);
    if (!robot.joints[static_cast<std::size_t>(i)].policy) continue;
    legs.push_back(i);
    action_joints_.push_back(robot.joint_index.name(i));
  }
  add(Quantity::kGyro, 1.0, 0, axes, {});
  add(Quantity::kGravityDirection, 1.0, 0, axes, {});
  add(Quantity::kCommand, 1.0, 0, channels, {});
  add(Quantity::kUserCommand, 1.0, 0, channels, {});
  add(Quantity::kPhase, 1.0, 0, {"gain_sin", "gain_cos", "gain"}, {});
  add(Quantity::kReferencePosition, 1.0, 0, all, all_joints);
  add(Quantity::kReferenceVelocity, kVelocityScale, 0, action_joints_, legs);
  add(Quantity::kJointPosition, 1.0, 0, all, all_joints);
  add(Quantity::kJointVelocity, kVelocityScale, 0, all, all_joints);
  add(Quantity::kLastAction, 1.0, 0, action_joints_, legs);
  for (const int age : kHistoryAges_ticks) {
    add(Quantity::kGyro, 1.0, age, axes, {});
    add(Quantity::kGravityDirection, 1.0, age, axes, {});
    add(Quantity::kJointPosition, 1.0, age, action_joints_, legs);
    add(Quantity::kJointVelocity, kVelocityScale, age, action_joints_, legs);
    add(Quantity::kLastAction, 1.0, age, action_joints_, legs);
  }
}

void ObservationLayout::add(Quantity quantity, double scale, int age_ticks, std::vector<std::string> elements,
                            std::vector<int> joints) {
  ObservationTerm term;
  term.quantity = quantity;
  term.name = name_of(quantity);
  term.offset = size_;
  term.size = static_cast<int>(elements.size());
  term.scale = scale;
  term.age_ticks = age_ticks;
  term.element = std::move(elements);
  term.joint = std::move(joints);
  size_ += term.size;
  terms_.push_back(std::move(term));
}

std::string ObservationLayout::to_json() const {
  nlohmann::ordered_json terms = nlohmann::ordered_json::array();
  for (const ObservationTerm& term : terms_) {
    terms.push_back({{"name", term.name},
                     {"offset", term.offset},
                     {"size", term.size},
                     {"scale", term.scale},
                     {"age_ticks", term.age_ticks},
                     {"elements", term.element}});
  }
  return nlohmann::ordered_json{{"size", size_}, {"terms", terms}}.dump();
}

}  // namespace pmg::policy
