// Posture offsets q_s (paper III-A.2, eq. 10): the joint offsets of the pitch, roll and height commands.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

#include "pmg/clip.hpp"
#include "pmg/command.hpp"
#include "pmg/types.hpp"

namespace pmg {

inline constexpr std::size_t kPostureChannels = kChannels - kVelocityChannels;

/// One channel's offset from the standing posture, piecewise linear in its command and exactly 0 at command 0.
class PostureCurve {
 public:
  PostureCurve() = default;

  /// Copies the rows; allocates. A clip without a row at command 0 gets one with offset 0, because interpolation
  /// between its neighbours need not give q_stand. An empty clip gives no offset.
  PostureCurve(const StaticClip& clip, const JointVector& q_stand) : command_(clip.command) {
    if (command_.empty()) return;
    const auto zero = std::lower_bound(command_.begin(), command_.end(), 0.0);
    const auto zero_row = std::distance(command_.begin(), zero);
    const bool add_row = zero == command_.end() || *zero != 0.0;
    if (add_row) command_.insert(zero, 0.0);
    offset_.setZero(q_stand.size(), static_cast<Eigen::Index>(command_.size()));
    for (std::size_t row = 0; row < clip.q.size(); ++row) {
      const auto from = static_cast<std::ptrdiff_t>(row);
      if (!add_row && from == zero_row) continue;
      offset_.col(from + (add_row && from >= zero_row ? 1 : 0)) = clip.q[row] - q_stand;
    }
  }

  double lower() const noexcept { return command_.empty() ? 0.0 : command_.front(); }
  double upper() const noexcept { return command_.empty() ? 0.0 : command_.back(); }

  /// Adds the offset [rad] to q_s, at the command clamped to the clip's range.
  void add(double command, JointVector& q_s) const noexcept {
    if (command == 0.0 || command_.size() < 2) return;
    const double inside = std::clamp(command, command_.front(), command_.back());
    const auto after = std::upper_bound(command_.begin() + 1, command_.end() - 1, inside);
    const auto row = std::distance(command_.begin(), after);
    const double t = (inside - *(after - 1)) / (*after - *(after - 1));
    q_s.noalias() += (1.0 - t) * offset_.col(row - 1) + t * offset_.col(row);
  }

 private:
  std::vector<double> command_;  ///< strictly increasing
  Eigen::MatrixXd offset_;       ///< joints x commands [rad]
};

/// The three channels together.
class Posture {
 public:
  Posture() = default;
  Posture(const std::array<StaticClip, kPostureChannels>& clips, const JointVector& q_stand) {
    for (std::size_t i = 0; i < kPostureChannels; ++i) curve_[i] = PostureCurve(clips[i], q_stand);
  }

  /// (command, scale) => (q_s): the sum of the channels' offsets at scale * command [rad].
  void offset(const Command& command, double scale, JointVector& q_s) const noexcept {
    q_s.setZero();
    for (std::size_t i = 0; i < kPostureChannels; ++i) curve_[i].add(scale * command.u[kVelocityChannels + i], q_s);
  }

  const PostureCurve& curve(std::size_t posture_channel) const noexcept { return curve_[posture_channel]; }

 private:
  std::array<PostureCurve, kPostureChannels> curve_;
};

}  // namespace pmg
