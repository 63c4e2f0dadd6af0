// One stretch of leading arms: each palm to a pose, or back to the gait, while something else drives the robot.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "arms_operator/arms_board.hpp"
#include "operator/arms_source.hpp"

namespace pmg::ops {

/// What is asked of one palm.
struct PalmGoal {
  std::int8_t wish = pmg_msgs::arms_t::HOLD;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> R{};  ///< nothing: as the palm is turned when the stretch begins
};

class ArmsLead {
 public:
  /// A controller whose robot has arms is heard of within that time.
  static constexpr std::int64_t kHear_ns = 1'000'000'000;

  /// Keeps references.
  ArmsLead(const io::Clock& clock, const ArmsBoard& board, std::string robot, const PerFoot<PalmGoal>& goals);

  /// Call after each link.receive() while the robot is driven in walk, at least every 20 ms.
  void step();
  /// What RobotDriver sends of it (Device::palms); null: the arms' poses aren't known yet.
  const PerFoot<PalmWish>* wishes() const noexcept { return wishes_ ? &*wishes_ : nullptr; }

  /// What is wrong with it; empty: nothing yet.
  const std::string& trouble() const noexcept { return trouble_; }
  /// Each palm that was asked for something is there, as of the newest news.
  bool reached() const;
  std::string text() const;  ///< "left: at its target; right: ..."; of the arms that were asked for something

 private:
  bool take_goals();

  const io::Clock& clock_;
  const ArmsBoard& board_;
  std::string robot_;
  PerFoot<PalmGoal> goals_;
  std::optional<PerFoot<PalmWish>> wishes_;
  std::optional<std::int64_t> begin_ns_;
  std::string trouble_;
};

}  // namespace pmg::ops
