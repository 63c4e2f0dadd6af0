#include "command_stream.hpp"

#include <array>
#include <cmath>

namespace pmg::training {

namespace {
// A velocity below this share of its range becomes zero: operators do not command a crawl.
constexpr double kSmallestShare = 0.08;
// Of the draws this share has velocities of up to kSlowest of their ranges, as of somebody who works at a table.
constexpr double kSlowShare = 0.2, kSlowest = 0.4;
constexpr double kJumpingShare = 0.04;  // of the draws; with ten jumps each, 5 % of the time
constexpr std::array kChannelShown = {0.7, 0.5, 0.55, 0.45, 0.45, 0.45};
static_assert(kChannelShown.size() == kChannels);
}  // namespace

const Command& CommandStream::step(double dt_s) {
  left_s_ -= dt_s;
  if (left_s_ <= 0.0) draw();
  return command_;
}

double CommandStream::value(std::size_t channel) {
  const double stretch = slow_ && channel < kVelocityChannels ? kSlowest : kRangeStretch;
  const double drawn = stretch * uniform(limits_.lower[channel], limits_.upper[channel]);
  const double range = drawn < 0.0 ? -limits_.lower[channel] : limits_.upper[channel];
  return channel < kVelocityChannels && std::abs(drawn) < kSmallestShare * range ? 0.0 : drawn;
}

/// Every velocity at one of its ends or none; in half of the episodes every posture, too.
void CommandStream::jump() {
  left_s_ = 0.5;
  command_ = Command{};
  for (std::size_t c = 0; c < (postures_jump_ ? kChannels : kVelocityChannels); ++c) {
    const double end = uniform(0.0, 3.0);
    command_.u[c] = end < 1.0 ? limits_.lower[c] : end < 2.0 ? limits_.upper[c] : 0.0;
  }
}

void CommandStream::draw() {
  if (jumps_left_ == 0 && uniform(0.0, 1.0) < kJumpingShare) {
    jumps_left_ = 10;
    postures_jump_ = uniform(0.0, 1.0) < 0.5;
  }
  if (jumps_left_ > 0) {
    --jumps_left_;
    jump();
    return;
  }
  left_s_ = uniform(0.0, 1.0) < 0.15 ? uniform(0.4, 1.5) : uniform(2.0, 7.0);
  slow_ = uniform(0.0, 1.0) < kSlowShare;
  command_ = Command{};
  const double kind = uniform(0.0, 1.0);
  if (kind < 0.06) return;  // stand upright
  if (kind < 0.16) {        // a posture on the spot
    for (std::size_t c = kVelocityChannels; c < kChannels; ++c) {
      if (uniform(0.0, 1.0) < 0.6) command_.u[c] = value(c);
    }
    return;
  }
  if (kind < 0.40) {  // one velocity alone
    const auto c = static_cast<std::size_t>(uniform(0.0, static_cast<double>(kVelocityChannels)));
    command_.u[c] = value(c);
    return;
  }
  if (kind < 0.55) {  // a velocity and one channel more
    const auto c = static_cast<std::size_t>(uniform(0.0, static_cast<double>(kVelocityChannels)));
    const auto other = (c + static_cast<std::size_t>(uniform(1.0, static_cast<double>(kChannels)))) % kChannels;
    command_.u[c] = value(c);
    command_.u[other] = value(other);
    return;
  }
  for (std::size_t c = 0; c < kChannels; ++c) {
    if (uniform(0.0, 1.0) < kChannelShown[c]) command_.u[c] = value(c);
  }
}

}  // namespace pmg::training
