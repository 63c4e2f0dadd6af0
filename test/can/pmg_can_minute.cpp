// pmg_can_minute: the bus thread of the backend `can` at 500 Hz against emulated drives on this kernel's CAN
// interfaces, in real time. A frame may be lost only around cycles for which the host woke a thread over 2 ms late;
// those are counted apart. Its twin in lockstep is CanRobot.DISABLED_AMinuteLosesNoFrame.
#include <fmt/format.h>
#include <poll.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../apps/option_checks.hpp"
#include "../apps/program.hpp"
#include "can/can_backend.hpp"
#include "can/can_hal.hpp"
#include "can/emulated_drives.hpp"
#include "can/socket_link.hpp"
#include "hal/bus_cycle.hpp"
#include "io/clock.hpp"
#include "model/robot_model.hpp"
#include "runtime/periodic_schedule.hpp"
#include "runtime/realtime.hpp"

namespace {

using namespace pmg;

enum ExitCode { kOk = 0, kLost = 1, kNoCan = 77 };

constexpr std::int64_t kPeriod_ns = hal::BusCycle::kPeriod_ns, kLate_ns = 2'000'000;
constexpr std::size_t kAround = 5;  // an answer that a late cycle cost is given up so many cycles later at most

void sleep_until(std::int64_t time_ns) noexcept {
  const timespec until{.tv_sec = time_ns / 1'000'000'000, .tv_nsec = time_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

/// Drives without physics, in a thread of their own: joints stand in the standing posture.
class DrivesThread {
 public:
  DrivesThread(const can::DriveSetup& setup, const model::RobotModel& robot) {
    std::vector<std::unique_ptr<can::Link>> links;
    for (const can::BusSetup& bus : setup.buses) {
      links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
      polled_.push_back({.fd = links.back()->descriptor(), .events = POLLIN, .revents = 0});
    }
    drives_ = std::make_unique<test::EmulatedDrives>(setup, std::move(links));
    model::RobotState state;
    state.q = robot.q_stand();
    state.dq = state.tau = JointVector::Zero(state.q.size());
    drives_->feel(state);
    acting_.q = acting_.dq = acting_.kp = acting_.kd = acting_.tau_ff = JointVector::Zero(state.q.size());
    thread_ = std::thread([this] { run(); });
  }
  ~DrivesThread() {
    ends_ = true;
    thread_.join();
  }
  DrivesThread(const DrivesThread&) = delete;
  DrivesThread& operator=(const DrivesThread&) = delete;
  int late() const noexcept { return late_; }

 private:
  void run() {
    runtime::schedule_this_thread({.name = "pmg-drives", .priority = 60});
    const io::WallClock clock;
    std::int64_t next_ns = clock.now_ns() + kPeriod_ns;
    while (!ends_) {
      drives_->speak();
      drives_->answer();
      for (std::int64_t left_ns = 0; (left_ns = next_ns - clock.now_ns()) > 0;) {
        const timespec timeout{.tv_sec = 0, .tv_nsec = left_ns};
        ppoll(polled_.data(), polled_.size(), &timeout, nullptr);
        drives_->answer();
      }
      const std::int64_t now_ns = clock.now_ns();
      if (now_ns - next_ns > kLate_ns) ++late_;
      next_ns = std::max(next_ns, now_ns - kPeriod_ns) + kPeriod_ns;
      drives_->tick(acting_);
    }
  }

  std::vector<pollfd> polled_;
  std::unique_ptr<test::EmulatedDrives> drives_;
  model::JointCommand acting_;
  std::atomic<bool> ends_ = false;
  std::atomic<int> late_ = 0;
  std::thread thread_;
};

/// One entry a cycle.
struct Record {
  std::vector<std::int64_t> costs_ns;
  std::vector<bool> late;
  std::vector<std::uint64_t> lost;  // answers given up in it, and frames not sent
};

std::uint64_t lost(const can::CanHal& hal, const can::DriveSetup& setup) {
  std::uint64_t sum = 0;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    sum += hal.link(b).counts().not_sent;
    for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m) sum += hal.motor(b, m).lost();
  }
  return sum;
}

double quantile_us(std::vector<std::int64_t> values_ns, double share) {
  std::ranges::sort(values_ns);
  return 1e-3 *
         static_cast<double>(values_ns[static_cast<std::size_t>(share * static_cast<double>(values_ns.size() - 1))]);
}

int report(const Record& record, const can::CanHal& hal, const can::DriveSetup& setup, double cpu_share) {
  std::uint64_t sent = 0, received = 0, in_late = 0, others = 0;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    sent += hal.link(b).counts().sent;
    received += hal.link(b).counts().received;
  }
  for (std::size_t k = 0; k < record.lost.size(); ++k) {
    const std::size_t from = k < kAround ? 0 : k - kAround, to = std::min(k + 2, record.late.size());
    const bool excused = std::find(record.late.begin() + static_cast<std::ptrdiff_t>(from),
                                   record.late.begin() + static_cast<std::ptrdiff_t>(to),
                                   true) != record.late.begin() + static_cast<std::ptrdiff_t>(to);
    (excused ? in_late : others) += record.lost[k];
  }
  fmt::print(
      "{} cycles: {} frames sent, {} received\n"
      "{} cycles woken over 2 ms late; {} frames lost around them, {} elsewhere\n"
      "a cycle: p50 {:.1f} us, p99 {:.1f} us, of which up to {:.0f} us wait for answers; {:.1f} % of one CPU\n",
      record.costs_ns.size(), sent, received, std::ranges::count(record.late, true), in_late, others,
      quantile_us(record.costs_ns, 0.5), quantile_us(record.costs_ns, 0.99), 1e-3 * can::CanHal::kWait_ns,
      100.0 * cpu_share);
  return others == 0 ? kOk : kLost;
}

int measure(can::CanHal& hal, const can::DriveSetup& setup, const model::RobotModel& robot, const DrivesThread& drives,
            double seconds) {
  const auto cycles = static_cast<std::size_t>(seconds * 1e9 / kPeriod_ns);
  Record record;
  record.costs_ns.reserve(cycles);
  record.late.reserve(cycles);
  record.lost.reserve(cycles);
  model::JointCommand command;
  const int n = robot.joint_index.size();
  command.q = robot.q_stand();
  command.dq = command.tau_ff = command.kp = command.kd = JointVector::Zero(n);
  model::RobotState state;
  for (const std::string& refused : runtime::lock_memory()) std::cerr << refused << '\n';
  for (const std::string& refused : runtime::schedule_this_thread({.name = "pmg-bus", .priority = 80}))
    std::cerr << refused << '\n';
  runtime::prefault_stack();
  const io::WallClock clock;
  timespec before{}, after{};
  runtime::PeriodicSchedule schedule(clock.now_ns() + kPeriod_ns, kPeriod_ns);
  const std::int64_t start_ns = clock.now_ns();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
  std::uint64_t lost_before = lost(hal, setup);
  for (std::size_t k = 0; k < cycles && apps::interrupt_requested == 0; ++k) {
    sleep_until(schedule.planned_ns());
    const std::int64_t woke_ns = clock.now_ns();
    const int drives_late = drives.late();
    if (k == 10) {  // enabled by then
      for (int j = 0; j < n; ++j) {
        command.kp[j] = robot.joints[static_cast<std::size_t>(j)].kp_Nm_per_rad;
        command.kd[j] = robot.joints[static_cast<std::size_t>(j)].kd_Nm_s_per_rad;
      }
    }
    hal.exchange(command, state);
    const std::int64_t done_ns = clock.now_ns();
    const std::uint64_t lost_now = lost(hal, setup);
    record.costs_ns.push_back(done_ns - woke_ns);
    record.late.push_back(woke_ns - schedule.planned_ns() > kLate_ns || drives.late() != drives_late);
    record.lost.push_back(lost_now - lost_before);
    lost_before = lost_now;
    schedule.advance(woke_ns, done_ns);
  }
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
  const double cpu_s =
      static_cast<double>(after.tv_sec - before.tv_sec) + 1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec);
  return report(record, hal, setup, cpu_s / (1e-9 * static_cast<double>(clock.now_ns() - start_ns)));
}

int run(const std::string& name, double seconds) {
  const model::RobotModel robot = model::load_robot(model::find_robot(name));
  const can::DriveSetup setup = can::load_drives(robot);
  std::unique_ptr<DrivesThread> drives;
  try {
    drives = std::make_unique<DrivesThread>(setup, robot);
  } catch (const std::runtime_error& error) {
    std::cerr << "pmg_can_minute: SKIPPED, NOTHING WAS MEASURED: " << error.what() << '\n';
    return kNoCan;
  }
  hal::BackendFactory factory;
  can::register_backend(factory);
  const io::WallClock clock;
  const auto backend = factory.kind("can").make({.robot = robot,
                                                 .clock = clock,
                                                 .name = name,
                                                 .lcm_url = "memq://",
                                                 .benched_joint = "",
                                                 .keeps_truth = false,
                                                 .options = {}});
  apps::notice({SIGINT, SIGTERM}, nullptr);
  auto& hal = dynamic_cast<can::CanHal&>(backend->connect([] { return apps::interrupt_requested != 0; }));
  return measure(hal, setup, robot, *drives, seconds);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "500 bus cycles a second against emulated drives on this kernel's CAN interfaces: what is lost and what it "
      "costs.",
      "pmg_can_minute");
  std::string robot = "z1";
  double seconds = 60.0;
  app.add_option("--robot", robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_option("--for", seconds, "seconds")->check(apps::positive())->capture_default_str();
  app.footer(
      "\nExample (vcan interfaces as in docs/how-to/hal.md):\n  pmg_can_minute --for 60\n\nExit codes: 0 nothing lost "
      "but "
      "around cycles that the host woke late, 1 something lost elsewhere, 2 bad input, 77 this kernel has no CAN "
      "interfaces of robot.yaml's names.");
  return apps::run_program(app, argc, argv, [&]() -> int { return run(robot, seconds); });
}
