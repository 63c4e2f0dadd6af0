#include "arms/near_pairs.hpp"

#include <algorithm>

namespace pmg::arms {

namespace {

constexpr double kRounding_m = 1e-9;

}  // namespace

NearPairs::NearPairs(const ArmChain& chain, const ArmVector& largest_step_rad, std::size_t others,
                     const ClearanceOptions& options)
    : options_(options), others_(others), left_out_(chain.bodies().size() * others, false) {
  for (std::size_t body = 0; body < chain.bodies().size(); ++body) {
    double travel_m = 0.0;
    for (Eigen::Index i = 0; i < chain.bodies()[body].moved_by; ++i)
      travel_m += largest_step_rad[i] * chain.reach_m(body, i);
    travel_m_.push_back(travel_m);
  }
  pairs_.resize(left_out_.size());
}

void NearPairs::collect(const ArmChain& chain, const std::vector<Shape>& others,
                        const std::vector<Ball>& balls) noexcept {
  count_ = 0;
  for (std::size_t body = 0; body < chain.bodies().size(); ++body) {
    const Capsule& mine = chain.capsules()[body];
    const Ball ball = ball_around(mine);
    const double near_m = options_.slow_m + travel_m_[body];
    for (std::size_t other = 0; other < others_; ++other) {
      if (left_out_[body * others_ + other]) continue;
      const double apart_m = near_m + ball.radius_m + balls[other].radius_m;
      if ((ball.center - balls[other].center).squaredNorm() > apart_m * apart_m) continue;
      const double distance_m = clearance(mine, others[other]).distance_m;
      if (distance_m > near_m) continue;
      NearPair& pair = pairs_[count_++];
      pair.body = body;
      pair.other = &others[other];
      pair.allowed_m = std::min(options_.stop_m, distance_m) - kRounding_m;
    }
  }
}

bool NearPairs::look(const ArmChain& chain) noexcept {
  bool allowed = true;
  for (std::size_t i = 0; i < count_; ++i) {
    NearPair& pair = pairs_[i];
    const Clearance found = clearance(chain.capsules()[pair.body], *pair.other);
    pair.distance_m = found.distance_m;
    pair.slope_m_per_rad.setZero(chain.size());
    for (Eigen::Index joint = 0; joint < chain.bodies()[pair.body].moved_by; ++joint)
      pair.slope_m_per_rad[joint] = found.normal.dot(chain.lever(joint, found.point));
    allowed = allowed && found.distance_m >= pair.allowed_m;
  }
  return allowed;
}

}  // namespace pmg::arms
