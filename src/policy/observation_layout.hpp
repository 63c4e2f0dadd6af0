// The actor's observation: names, sizes, offsets and scales of the vector. This is the only definition: the
// controller's observation.hpp reads it, and training gets it from here as JSON.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::policy {

/// The quantity of an observation term. Each element is scale * (value - origin).
enum class Quantity {
  kGyro,               ///< angular velocity in the IMU frame [rad/s]
  kGravityDirection,   ///< unit vector down, in the IMU frame
  kCommand,            ///< the policy's command (gco::MotionComposition), in the order of pmg::Channel
  kUserCommand,        ///< the user's command, admissible and rate-limited: Reference::command
  kPhase,              ///< gain * sin(2 pi phi), gain * cos(2 pi phi), gain
  kReferencePosition,  ///< q_ref - q_stand [rad]
  kReferenceVelocity,  ///< dq_ref [rad/s]
  kJointPosition,      ///< q - q_stand [rad]
  kJointVelocity,      ///< dq [rad/s]
  kLastAction,         ///< the network's previous output
};

struct ObservationTerm {
  Quantity quantity = Quantity::kGyro;
  std::string name;
  int offset = 0;  ///< first element in the vector
  int size = 0;
  double scale = 1.0;
  int age_ticks = 0;                 ///< 0: this tick; otherwise the value of that many ticks ago
  std::vector<std::string> element;  ///< one name per element: joint, channel or axis
  std::vector<int> joint;            ///< each element's index in the robot's joint order; empty for other terms
};

class ObservationLayout {
 public:
  /// Older frames of the fastest quantities; from them the actor infers velocities, delays and contacts.
  static constexpr int kHistoryAges_ticks[] = {2, 4, 6};
  static constexpr int kOldest_ticks = 6;

  explicit ObservationLayout(const model::RobotModel& robot);

  const std::vector<ObservationTerm>& terms() const { return terms_; }
  int size() const { return size_; }
  const std::vector<std::string>& action_joints() const { return action_joints_; }

  /// {"size", "terms": [{"name", "offset", "size", "scale", "age_ticks", "elements"}]}
  std::string to_json() const;

 private:
  void add(Quantity quantity, double scale, int age_ticks, std::vector<std::string> elements, std::vector<int> joints);

  std::vector<ObservationTerm> terms_;
  std::vector<std::string> action_joints_;
  int size_ = 0;
};

}  // namespace pmg::policy
