// The command inverse: a correction of the user's command, so that the cycle mean of the optimised command u' equals
// the user's command.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "pmg/command.hpp"

namespace pmg {

/// Clips are blended in joint space. So a mixture walks a little faster, slower, lower or more sideways than the sum of
/// its commands (docs/explanation/method.md has figures). The ground-aware optimisation gives the difference.
/// This table holds the correction that cancels it, on a grid of commands: multilinear inside the grid, constant
/// outside. Empty: no correction.
class CommandInverse {
 public:
  /// The channels on which the correction depends, and which it corrects. Pitch and roll hardly affect it and are right
  /// without it.
  static constexpr std::array<Channel, 4> kAxes = {kVx, kVy, kOmega, kHeight};
  using Node = std::array<double, kAxes.size()>;  ///< one value per axis: m/s, m/s, rad/s, m

  CommandInverse() = default;

  /// axis: strictly increasing commands of each channel of kAxes, at least one. correction: one per node, the last axis
  /// varies fastest. Allocates.
  CommandInverse(std::array<std::vector<double>, kAxes.size()> axis, std::vector<Node> correction)
      : axis_(std::move(axis)), correction_(std::move(correction)) {}

  bool empty() const noexcept { return correction_.empty(); }
  const std::array<std::vector<double>, kAxes.size()>& axis() const noexcept { return axis_; }
  const std::vector<Node>& correction() const noexcept { return correction_; }

  /// (user) => (command for the clips) = user + sum over the cell's nodes of weight * correction. Returns user
  /// unchanged if a channel of kAxes isn't finite. No heap, no exception.
  Command apply(const Command& user) const noexcept {
    if (empty()) return user;
    std::array<Cell, kAxes.size()> cell;
    for (std::size_t a = 0; a < kAxes.size(); ++a) {
      const double value = user.u[kAxes[a]];
      if (!std::isfinite(value)) return user;
      cell[a] = find(axis_[a], value);
    }
    Command wanted = user;
    for (std::size_t corner = 0; corner < (std::size_t{1} << kAxes.size()); ++corner) {
      double weight = 1.0;
      std::size_t index = 0;
      for (std::size_t a = 0; a < kAxes.size(); ++a) {
        const bool above = ((corner >> a) & 1U) != 0;
        weight *= above ? cell[a].share : 1.0 - cell[a].share;
        index = index * axis_[a].size() + (above ? cell[a].above : cell[a].below);
      }
      if (weight == 0.0) continue;
      for (std::size_t a = 0; a < kAxes.size(); ++a) wanted.u[kAxes[a]] += weight * correction_[index][a];
    }
    return wanted;
  }

 private:
  /// The two grid nodes around a value.
  struct Cell {
    std::size_t below = 0, above = 0;
    double share = 0.0;  ///< weight of the node above
  };

  static Cell find(const std::vector<double>& nodes, double value) noexcept {
    const auto after = std::upper_bound(nodes.begin(), nodes.end(), value);
    if (after == nodes.begin()) return {};
    const auto below = static_cast<std::size_t>(after - nodes.begin()) - 1;
    if (after == nodes.end()) return {below, below, 0.0};
    return {below, below + 1, (value - nodes[below]) / (nodes[below + 1] - nodes[below])};
  }

  std::array<std::vector<double>, kAxes.size()> axis_;
  std::vector<Node> correction_;
};

}  // namespace pmg
