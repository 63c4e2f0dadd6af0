#include "arms/obstacles.hpp"

#include <algorithm>

#include "model/link_chain.hpp"

namespace pmg::arms {

Obstacles::Obstacles(const model::RobotModel& robot, const std::vector<LinkShape>& shapes,
                     const std::vector<std::string>& arm_links) {
  std::vector<std::string> carried;        // link of each carrier
  for (const LinkShape& shape : shapes) {  // shapes of one link stand together
    if (std::ranges::find(arm_links, shape.link) != arm_links.end()) continue;
    if (carried.empty() || carried.back() != shape.link) {
      carried.push_back(shape.link);
      carriers_.push_back({.chain = shape.link == robot.torso_link
                                        ? model::ChainKinematics(KDL::Chain(), {})
                                        : model::chain_between(robot, robot.torso_link, shape.link),
                           .first = shapes_.size()});
    }
    ++carriers_.back().count;
    shapes_.push_back(shape.shape);
  }
  placed_ = shapes_;
  balls_.resize(shapes_.size());
  compute(robot.q_stand());
}

void Obstacles::compute(const JointVector& q) noexcept {
  for (Carrier& carrier : carriers_) {
    carrier.chain.compute(q);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = carrier.chain.R();
    T.translation() = carrier.chain.p();
    for (std::size_t i = carrier.first; i < carrier.first + carrier.count; ++i) {
      placed_[i] = moved(shapes_[i], T);
      balls_[i] = ball_around(placed_[i]);
    }
  }
}

}  // namespace pmg::arms
