// The actor's observation: its quantities with their values, and the terms of the vector. This is the only definition:
// the controller's observation.hpp reads it, and training gets it from here as JSON.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/reference.hpp"

namespace pmg::policy {

/// What older terms show of a tick.
struct Frame {
  model::RobotState state;
  Eigen::VectorXf action;  ///< the network's previous output
};

/// What the terms of a tick show.
struct Seen {
  const Frame& frame;          ///< of the term's age
  const Reference& reference;  ///< of this tick, as is observed
  const Command& observed;     ///< the policy's command (gco::MotionComposition)
};

/// An element of a quantity that isn't of joints, and its sign in the mirrored robot: reflection in the sagittal plane
/// turns y round in vectors, x and z in axial vectors such as a rate of rotation; it shifts the gait by half a cycle.
struct Element {
  std::string name;
  int mirror_sign = 1;
};

/// A quantity of the observation. Each element of a term is scale * (value - origin); the origin is the standing
/// posture for from_stand, else 0.
struct Quantity {
  enum class Of {
    kElements,      ///< those listed
    kJoints,        ///< all joints now, the policy's in older terms
    kPolicyJoints,  ///< the policy's
    kActions,       ///< the policy's, in the order of the network's output
  };

  std::string name;
  Of of = Of::kElements;
  std::vector<Element> elements = {};                     ///< of kElements
  double (*value)(const Seen& seen, int index) noexcept;  ///< index: of the robot's joint, or of the element
  bool older = false;                                     ///< older terms show it, too
  bool from_stand = false;
  double scale = 1.0;
};

/// In the order of the vector.
const std::vector<Quantity>& quantities();

struct ObservationTerm {
  const Quantity* quantity = nullptr;
  int offset = 0;                         ///< first element in the vector
  int age_ticks = 0;                      ///< 0: this tick; otherwise the value of that many ticks ago
  std::vector<std::string> element = {};  ///< one name per element: joint, channel or axis
  std::vector<int> index = {};            ///< of each element, as Quantity::value takes it
  int size() const { return static_cast<int>(element.size()); }
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
  void add(const Quantity& quantity, int age_ticks, const model::RobotModel& robot);

  std::vector<ObservationTerm> terms_;
  std::vector<std::string> action_joints_;
  int size_ = 0;
};

/// {name: {"from_stand", "mirror_sign": {element: sign}}}, for training. Quantities of joints have no signs: theirs are
/// the joints'.
std::string quantities_json();

}  // namespace pmg::policy
