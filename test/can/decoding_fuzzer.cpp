// libFuzzer's entry: any bytes as frames from every bus of Z1, with drives of each dialect of the MIT protocol or with
// drives of both protocols, and as a line of a recording. Nothing may crash, and no motor may be commanded beyond its
// limits.
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "can/can_hal.hpp"
#include "can/candump.hpp"
#include "can/limit_check.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "drive_protocols/damiao.hpp"
#include "drive_protocols/mini_cheetah.hpp"
#include "drive_protocols/robstride.hpp"
#include "folders.hpp"

namespace {

using namespace pmg;
using test::check_limits;
using test::require;

struct Robot {
  Robot()
      : model(model::load_robot(pmg::test::project_folder() + "/config/robots/z1")),
        setups({can::load_drives(model), test::mixed_drives(model), speaking<drives::DamiaoDrive>(model),
                speaking<drives::MiniCheetahDrive>(model), speaking<drives::RobstrideDrive>(model)}) {
    command.q = model.q_upper();
    const Eigen::Index n = command.q.size();
    command.dq = JointVector::Constant(n, 1e3);
    command.kp = JointVector::Constant(n, 1e6);
    command.kd = JointVector::Constant(n, 1e6);
    command.tau_ff = JointVector::Constant(n, -1e6);
  }
  template <typename Drive>
  static can::DriveSetup speaking(const model::RobotModel& model) {
    can::DriveSetup setup = can::load_drives(model);
    for (can::BusSetup& bus : setup.buses) {
      for (drives::MotorSetup& motor : bus.motors)
        motor.drive = std::make_shared<Drive>(drives::as_mit(motor.drive)->ranges());
    }
    return setup;
  }
  model::RobotModel model;
  std::array<can::DriveSetup, 5> setups;
  model::JointCommand command;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Robot robot;
  can::from_line(std::string_view(reinterpret_cast<const char*>(data), size));

  const can::DriveSetup& setup = robot.setups[size > 0 ? data[size - 1] % robot.setups.size() : 0];
  std::vector<std::unique_ptr<can::Link>> links, far;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    auto [here, there] = test::MemoryLink::pair();
    links.push_back(std::move(here));
    far.push_back(std::move(there));
  }
  const io::SimulationClock clock;
  can::CanHal hal(setup, robot.model, clock, std::move(links));
  model::RobotState state;
  model::JointCommand limp = robot.command;  // so that drives are switched on now and then
  limp.kp.setZero();
  limp.kd.setZero();
  limp.tau_ff.setZero();
  // Records of 12 bytes: bus, flags and length, identifier (2), data (8). A set high bit of the bus ends the cycle, the
  // next bit makes it limp.
  for (std::size_t at = 0; at + 12 <= size; at += 12) {
    drives::Message frame;
    frame.extended = (data[at + 1] & 0x80U) != 0;
    frame.fd = (data[at + 1] & 0x40U) != 0;
    frame.length = data[at + 1] & 0x3FU;
    frame.id = static_cast<std::uint32_t>(data[at + 2] << 8U | data[at + 3]);
    std::memcpy(frame.data.data(), data + at + 4, 8);
    drives::canopen::sdo_answer(frame);
    far[data[at] % far.size()]->send(std::span(&frame, 1));
    if ((data[at] & 0x80U) == 0) continue;
    hal.send((data[at] & 0x40U) != 0 ? limp : robot.command);
    if (hal.receive(state) == hal::BusStatus::kOk)
      require(state.q.allFinite() && state.dq.allFinite() && state.tau.allFinite());
    for (std::size_t b = 0; b < far.size(); ++b) {
      std::array<drives::Message, 64> sent;
      const std::size_t count = far[b]->receive(sent);
      for (std::size_t i = 0; i < count; ++i) check_limits(sent[i], setup.buses[b]);
    }
  }
  return 0;
}
