// The one place that defines the order of joints.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace pmg::model {

/// Joint names in the robot's order (that of robot.yaml), and the way back.
class JointIndex {
 public:
  JointIndex() = default;
  explicit JointIndex(std::vector<std::string> names);  ///< throws std::invalid_argument on a repeated name

  int size() const { return static_cast<int>(names_.size()); }
  const std::vector<std::string>& names() const { return names_; }
  const std::string& name(int joint) const { return names_.at(static_cast<std::size_t>(joint)); }
  std::optional<int> find(std::string_view name) const;
  int at(std::string_view name) const;  ///< throws std::out_of_range naming the joint

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, int> by_name_;
};

}  // namespace pmg::model
