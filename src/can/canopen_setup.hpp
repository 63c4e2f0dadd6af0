// A CANopen drive before and after the bus cycle: its objects by SDO, its PDOs, the network's state.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/link.hpp"
#include "drive_protocols/canopen.hpp"
#include "drive_protocols/cia402_objects.hpp"

namespace pmg::can {

/// Called while an answer is awaited, for a millisecond or so. It sleeps; emulators answer in it.
using Wait = std::function<void()>;
Wait sleeping();

/// The objects of one node by expedited SDO transfers. Frames of others are dropped meanwhile.
class SdoClient final : public drives::ObjectDictionary {
 public:
  static constexpr int kWaits = 100;  ///< for one answer, of some 1 ms
  static constexpr int kTries = 3;    ///< a frame may be lost

  SdoClient(int node, Link& link, Wait wait) : node_(node), link_(link), wait_(std::move(wait)) {}
  std::optional<std::uint32_t> read(const drives::ObjectId& id) override;
  bool write(const drives::ObjectId& id, std::uint32_t value) override;

 private:
  /// Nullopt: no such object.
  std::optional<drives::canopen::SdoAnswer> ask(const drives::Message& request, const drives::ObjectId& id);

  int node_;
  Link& link_;
  Wait wait_;
};

/// Puts the node into pre-operational, checks it against robot.yaml, sets it up, and starts it; it stays switched off.
/// RPDO1 acts when it comes; TPDO1 and TPDO2 come with every SYNC; all other PDOs are off. Throws std::runtime_error:
/// "left_knee (can0, node 4): object 0x6076 (rated torque) is ...".
void set_up_node(const BusSetup& bus, const drives::MotorSetup& motor, Link& link, const Wait& wait);

/// The same for every CANopen drive of every bus.
void set_up_nodes(const DriveSetup& setup, const std::vector<std::unique_ptr<Link>>& links, const Wait& wait,
                  const std::function<bool()>& interrupted);

}  // namespace pmg::can
