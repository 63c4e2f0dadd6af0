// pmg_emulated_drives: a simulated robot behind CAN sockets, in real time, for pmg_controller --hal can and pmg_bus.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <iostream>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../apps/program.hpp"
#include "can/hoisted_robot.hpp"
#include "can/socket_link.hpp"
#include "io/clock.hpp"

namespace {

using namespace pmg;

constexpr std::int64_t kPeriod_ns = test::HoistedRobot::kPeriod_ns;

struct Fault {
  const char* word;
  void (*begin)(test::DriveEmulator& drive);
};

/// What a drive can be told to have.
constexpr std::array<Fault, 8> kFaults = {{
    {"silent", [](test::DriveEmulator& drive) { drive.silent = true; }},
    {"twice", [](test::DriveEmulator& drive) { drive.twice = true; }},
    {"stuck", [](test::DriveEmulator& drive) { drive.stuck_q = drive.shown_rad(); }},
    {"turn", [](test::DriveEmulator& drive) { drive.turn_rad += 2.0 * std::numbers::pi; }},
    {"hot", [](test::DriveEmulator& drive) { drive.temperature_degC = 120.0; }},
    {"over-current", [](test::DriveEmulator& drive) { drive.fault = drives::DriveFault::kOverCurrent; }},
    {"encoder", [](test::DriveEmulator& drive) { drive.fault = drives::DriveFault::kEncoder; }},
    {"well",
     [](test::DriveEmulator& drive) {
       drive.silent = drive.twice = false;
       drive.stuck_q.reset();
       drive.turn_rad = 0.0;
       drive.temperature_degC = test::DriveEmulator::kCool_degC;
       drive.fault = drives::DriveFault::kNone;
     }},
}};

/// Lines of a named pipe: "left_knee silent", "imu silent", "imu well".
class FaultPipe {
 public:
  /// Makes it where it isn't there. Throws std::runtime_error.
  FaultPipe(const std::string& path, const can::DriveSetup& setup, test::EmulatedDrives& drives)
      : setup_(setup), drives_(drives) {
    if (path.empty()) return;
    mkfifo(path.c_str(), 0600);
    // Open for writing, too: a pipe whose last writer went would be at its end for ever.
    descriptor_ = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);  // NOLINT(cppcoreguidelines-pro-type-vararg)
    struct stat found {};
    if (descriptor_ < 0 || fstat(descriptor_, &found) != 0 || !S_ISFIFO(found.st_mode))
      throw std::runtime_error(path + ": can't be read; expected a named pipe, or a place for one");
  }
  ~FaultPipe() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  FaultPipe(const FaultPipe&) = delete;
  FaultPipe& operator=(const FaultPipe&) = delete;

  void read_lines() {
    std::array<char, 256> bytes{};
    while (descriptor_ >= 0) {
      const ssize_t got = read(descriptor_, bytes.data(), bytes.size());
      if (got <= 0) return;
      text_.append(bytes.data(), static_cast<std::size_t>(got));
      for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
        std::cout << answer(text_.substr(0, end)) << '\n' << std::flush;
        text_.erase(0, end + 1);
      }
    }
  }

 private:
  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string who, what, more;
    words >> who >> what >> more;
    if (who == "imu" && more.empty() && (what == "silent" || what == "well")) {
      drives_.imu_silent = what == "silent";
      return "imu: " + what;
    }
    for (std::size_t b = 0; b < setup_.buses.size(); ++b) {
      for (std::size_t m = 0; m < setup_.buses[b].motors.size(); ++m) {
        if (setup_.buses[b].motors[m].joint != who) continue;
        const auto fault = std::ranges::find_if(kFaults, [&](const Fault& one) { return one.word == what; });
        if (fault == kFaults.end() || !more.empty()) {
          std::string known;
          for (const Fault& one : kFaults) known += (known.empty() ? "" : ", ") + std::string(one.word);
          return fmt::format("'{}': expected one word after {}: {}", line, who, known);
        }
        fault->begin(drives_.drive(b, m));
        return fmt::format("{}: {}", who, what);
      }
    }
    return fmt::format("'{}': expected a joint, or imu, and what it has", line);
  }

  const can::DriveSetup& setup_;
  test::EmulatedDrives& drives_;
  int descriptor_ = -1;
  std::string text_;
};

int run(const std::string& name, bool gantry, int patience, const std::string& faults_from) {
  const model::RobotModel robot = model::load_robot(model::find_robot(name));
  const can::DriveSetup setup = can::load_drives(robot);
  std::vector<std::unique_ptr<can::Link>> links;
  std::vector<pollfd> polled;
  for (const can::BusSetup& bus : setup.buses) {
    links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
    polled.push_back({.fd = links.back()->descriptor(), .events = POLLIN, .revents = 0});
  }
  test::EmulatedDrives drives(setup, std::move(links));
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m) drives.drive(b, m).patience = patience;
  }
  test::HoistedRobot hoisted(robot, drives, gantry);
  FaultPipe pipe(faults_from, setup, drives);

  apps::notice({SIGINT, SIGTERM}, nullptr);
  const io::WallClock clock;
  std::int64_t next_ns = clock.now_ns();
  std::cout << "drives of " << robot.name << " answer\n" << std::flush;
  while (apps::interrupt_requested == 0) {
    hoisted.speak();
    drives.answer();  // also where the next tick is due already
    for (std::int64_t left_ns = 0; (left_ns = next_ns - clock.now_ns()) > 0;) {
      const timespec timeout{.tv_sec = 0, .tv_nsec = left_ns};
      if (ppoll(polled.data(), polled.size(), &timeout, nullptr) > 0) drives.answer();
    }
    next_ns = std::max(next_ns + kPeriod_ns, clock.now_ns() - 5 * kPeriod_ns);  // less than a watchdog
    hoisted.step();
    pipe.read_lines();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A simulated robot's drives and IMU on this computer's CAN interfaces, in real time.",
               "pmg_emulated_drives");
  std::string robot = "z1", faults_from;
  bool gantry = false;
  int patience = 1;
  app.add_option("--robot", robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_flag("--gantry", gantry, "the robot stays in its gantry");
  app.add_option("--patience", patience, "the drives' watchdogs take so many times their time (for a loaded computer)")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option(
      "--faults", faults_from,
      "named pipe for faults on demand, a line each: a joint (or imu), then silent, twice, stuck, turn, hot, "
      "over-current, encoder or well (imu: silent or well)");
  return apps::run_program(app, argc, argv, [&]() -> int { return run(robot, gantry, patience, faults_from); });
}
