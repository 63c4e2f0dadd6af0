// Game controllers on the network.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gamepad/pad_command.hpp"
#include "operator/driving_station.hpp"

namespace pmg::gamepad {

/// The state that the pads show with light and rumble; a later one hides an earlier one.
enum class Sign { kRest, kDriving, kLimited, kLinkLost, kFault };

/// For one thread.
class GamepadStation : public ops::DrivingStation {
 public:
  /// As KeyboardStation.
  GamepadStation(io::LcmLink& link, Mapping mapping, std::string robot, std::int64_t session, const io::Clock& clock,
                 const seal::OperatorSeal& seal = seal::OperatorSeal());

  /// Every connected pad's state; a pad without the stop button drives nothing. Call before each step().
  void take(std::span<const PadReport> pads);
  void press_stop() { stop(); }
  Sign sign() const;
  /// What each pad does, or why it does nothing.
  std::vector<std::string> pad_lines(std::span<const PadReport> pads, std::span<const UselessPad> useless) const;

 private:
  ops::RobotDriver& make_driver(const std::string& robot) override;

  std::string state(const PadReport& pad) const;

  PadCommand pads_;
  std::vector<PadReport> usable_;
  std::optional<ops::RobotDriver> robot_driver_;
};

}  // namespace pmg::gamepad
