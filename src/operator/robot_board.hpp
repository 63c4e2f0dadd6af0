// The robots on an LCM address: the newest message of each kind, and timing over the last seconds.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/status_order.hpp"
#include "pmg_msgs/link_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::ops {

/// Percentiles (nearest rank) over the last kKept values.
class RecentValues {
 public:
  static constexpr std::size_t kKept = 1000;  ///< ten seconds of ticks

  void add(double value);
  double percentile(double percent) const;  ///< 0 without values
  bool empty() const noexcept { return values_.empty(); }

 private:
  std::vector<double> values_;  // a ring once it is full
  std::size_t next_ = 0;
};

struct RobotNews {
  pmg_msgs::status_t status{};
  StatusOrder order{};        ///< of its STATUS
  std::int64_t heard_ns = 0;  ///< time of the newest status, by the board's clock
  std::optional<pmg_msgs::robot_info_t> info{};
  std::optional<pmg_msgs::link_t> link{};
  std::optional<pmg_msgs::reference_t> reference{};
  std::optional<pmg_msgs::robot_state_t> state{};
  std::optional<pmg_msgs::timing_t> timing{};
  RecentValues wake_us{}, tick_us{};
  int sessions =
      1;  ///< changes of the session since the first message, plus 1: restarts, or several controllers with one name
};

/// For one thread. Receives only within link.receive().
class RobotBoard {
 public:
  static constexpr std::size_t kMostRobots = 64;  ///< limit for a flood of invented names

  /// Keeps references.
  RobotBoard(io::LcmLink& link, const io::Clock& clock, seal::OperatorSeal seal = seal::OperatorSeal());
  ~RobotBoard() = default;
  RobotBoard(const RobotBoard&) = delete;
  RobotBoard& operator=(const RobotBoard&) = delete;

  const std::map<std::string, RobotNews>& robots() const noexcept { return robots_; }
  /// Seconds since the robot's last status.
  double silence_s(const RobotNews& news) const noexcept;

 private:
  void hear_status(io::Bytes message);

  const io::Clock& clock_;
  seal::OperatorSeal seal_;
  std::map<std::string, RobotNews> robots_;
};

}  // namespace pmg::ops
