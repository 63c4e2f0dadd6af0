// What controllers say of their robots' arms (ARMS_STATE): the newest of each.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::ops {

struct HeardArms {
  pmg_msgs::arms_state_t state{};
  std::int64_t heard_ns = 0;  ///< by the board's clock
};

/// For one thread. Receives only within link.receive().
class ArmsBoard {
 public:
  static constexpr std::size_t kMostRobots = 64;  ///< limit for a flood of invented names
  /// A controller sends ten a second: after so long without one, what it said counts no longer.
  static constexpr std::int64_t kSilent_ns = 1'000'000'000;

  /// Keeps references.
  ArmsBoard(io::LcmLink& link, const io::Clock& clock, seal::OperatorSeal seal = seal::OperatorSeal());
  ~ArmsBoard() = default;
  ArmsBoard(const ArmsBoard&) = delete;
  ArmsBoard& operator=(const ArmsBoard&) = delete;

  /// Of the last second; null: the robot has no arms that can be led, or it is silent.
  const HeardArms* of(const std::string& robot) const;

 private:
  void hear(io::Bytes message);

  const io::Clock& clock_;
  seal::OperatorSeal seal_;
  std::map<std::string, HeardArms> robots_;
};

}  // namespace pmg::ops
