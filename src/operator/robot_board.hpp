// The robots on an LCM address: the newest message of each kind, and timing over the last seconds.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/heard_hoist.hpp"
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

/// What tells how far a robot leans (ROBOT_INFO's options).
struct UprightRule {
  std::array<double, 3> up_I{};  ///< "up" of the IMU's link, in the IMU's frame
  double most_tilt_rad = 0.0;    ///< a robot that leans farther has a fault and doesn't stand up
};

struct RobotNews {
  pmg_msgs::status_t status{};
  StatusOrder order{};        ///< of its STATUS
  std::int64_t boot = 0;      ///< of the start that sent it
  std::int64_t heard_ns = 0;  ///< time of the newest status, by the board's clock
  std::optional<pmg_msgs::robot_info_t> info{};
  std::optional<UprightRule> upright{};  ///< nothing: the controller doesn't tell it
  std::optional<pmg_msgs::link_t> link{};
  std::optional<pmg_msgs::reference_t> reference{};
  std::optional<pmg_msgs::robot_state_t> state{};
  std::optional<pmg_msgs::timing_t> timing{};
  HeardHoist hoist{};
  RecentValues wake_us{}, tick_us{};
  int sessions =
      1;  ///< changes of the session since the first message, plus 1: restarts, or several controllers with one name
};

/// Of the IMU's link from upright [rad], by the newest STATE. Nothing: not known.
std::optional<double> tilt_rad(const RobotNews& news);

/// The reference in force. Null: none is, as the robot neither stands nor walks; a controller sends its last one on.
const pmg_msgs::reference_t* reference_in_force(const RobotNews& news) noexcept;

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
