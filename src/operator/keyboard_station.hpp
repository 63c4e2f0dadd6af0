// A keyboard on the network.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "operator/driving_station.hpp"
#include "operator/keyboard_driver.hpp"

namespace pmg::ops {

/// For one thread.
class KeyboardStation : public DrivingStation {
 public:
  /// robot: the controller's name; empty: the only controller on the address. session: as in OperatorSource.
  /// seal: without keys unless given.
  KeyboardStation(io::LcmLink& link, std::string robot, KeyReport report, std::int64_t session, const io::Clock& clock,
                  const seal::OperatorSeal& seal = seal::OperatorSeal());

  /// Key names are those of key_named(); other names have no effect. Before a robot is known, "escape" stops every
  /// robot on the address.
  void press(std::string_view key, bool shift);
  void repeat(std::string_view key, bool shift);
  void release(std::string_view key);
  void release_all();
  void listen();

 private:
  RobotDriver& make_driver(const std::string& robot) override;

  KeyReport report_;
  std::optional<KeyboardDriver> keyboard_;
};

}  // namespace pmg::ops
