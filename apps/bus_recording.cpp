#include "bus_recording.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "can/candump.hpp"
#include "can/replay.hpp"
#include "can/socket_link.hpp"
#include "files/bounded_file.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"
#include "program.hpp"

namespace pmg::apps {

int dump_buses(const std::string& robot_name, double for_s) {
  constexpr std::int64_t kLate_ns = 20'000'000;  // a frame is read so long after it came at most
  const can::DriveSetup setup = can::load_drives(model::load_robot(model::find_robot(robot_name)));
  std::vector<std::unique_ptr<can::SocketLink>> links;
  for (const can::BusSetup& bus : setup.buses)
    links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto end = now() + std::chrono::duration<double>(for_s > 0.0 ? for_s : 1e9);
  can::FrameOrder order;
  can::RecordedFrame frame;
  const auto write = [&](std::int64_t before_ns) {
    while (order.take(before_ns, frame)) std::cout << can::to_line(frame) << '\n';
    if (!std::cout) throw std::runtime_error("the recording can't be written");
    std::cout << std::flush;  // whoever reads along sees each frame at once
  };
  while (interrupt_requested == 0 && now() < end) {
    for (const auto& link : links) {
      while (link->record(frame)) order.put(frame);
    }
    write(std::chrono::system_clock::now().time_since_epoch().count() - kLate_ns);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  write(std::numeric_limits<std::int64_t>::max());
  return 0;
}

int replay_recording(const std::string& robot_name, const std::string& recording) {
  const model::RobotModel robot = model::load_robot(model::find_robot(robot_name));
  const can::DriveSetup setup = can::load_drives(robot);
  constexpr std::uint64_t kLargest_bytes = std::uint64_t{1} << 32;  // a day of five full buses
  files::expect_bounded_file(recording, kLargest_bytes, "a recording of `pmg_bus dump`");
  std::ifstream file(recording);
  can::Replay replay(setup, robot, [](double t_s, const std::string& text) {
    std::cout << fmt::format("{:10.4f} s  {}\n", t_s, text);
  });
  can::feed(replay, file, recording);
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m) {
      const drives::MotorSetup& motor = setup.buses[b].motors[m];
      const drives::MotorMonitor& monitor = replay.hal().motor(b, m);
      std::cout << fmt::format("{:22} {:6} {:4}  ", motor.joint, setup.buses[b].name, motor.node)
                << (monitor.answered()
                        ? fmt::format("{:8.2f} deg at the end, {} answers missing, {} too many, {} not believed\n",
                                      motor.transmission.to_joint(monitor.reading()).q_rad / kRadPerDegree,
                                      monitor.lost(), monitor.uncalled(), monitor.refused())
                        : std::string("-\n"));
    }
  }
  std::cout << fmt::format("{} frames in {} cycles, {} of other interfaces, remote frames or errors left out\n",
                           replay.frames(), replay.cycles(), replay.left_out());
  return replay.troubles() == 0 ? 0 : 1;
}

}  // namespace pmg::apps
