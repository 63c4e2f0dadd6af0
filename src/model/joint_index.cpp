#include "model/joint_index.hpp"

#include <stdexcept>

namespace pmg::model {

JointIndex::JointIndex(std::vector<std::string> names) : names_(std::move(names)) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!by_name_.emplace(names_[i], static_cast<int>(i)).second) {
      throw std::invalid_argument("joint " + names_[i] + " is named twice");
    }
  }
}

std::optional<int> JointIndex::find(std::string_view name) const {
  const auto found = by_name_.find(std::string(name));
  if (found == by_name_.end()) return std::nullopt;
  return found->second;
}

int JointIndex::at(std::string_view name) const {
  const std::optional<int> joint = find(name);
  if (!joint) throw std::out_of_range("the robot has no joint " + std::string(name));
  return *joint;
}

}  // namespace pmg::model
