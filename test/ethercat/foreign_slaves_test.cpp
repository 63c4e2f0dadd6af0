// The master against slaves that this project did not write: KickCAT's emulated slave controllers and CiA 402 motors
// (its program network_simulator) on the other end of a cable, in lockstep. A cycle goes on when its frames are back,
// however long that takes, so counts and positions decide. Only the slaves' own watchdog of 20 ms runs in real time:
// where this computer held the outputs up for so long, the test says so, and nothing was shown.
// foreign_slaves_test.sh starts this; elsewhere these tests are skipped.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../sim/robots.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "ethercat/datagrams.hpp"
#include "ethercat/ethercat_hal.hpp"
#include "ethercat/packet_wire.hpp"
#include "folders.hpp"
#include "temporary_folder.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): some libraries' headers lack it

namespace pmg::ethercat {
namespace {

using drives::Cia402Mode;
using hal::BusStatus;
using testing::HasSubstr;

constexpr int kAlias = 0x65;  // of drive.xml
constexpr double kCounts = 65536.0, kCount_rad = 2.0 * M_PI / kCounts;

/// The host's end of the cable. It awaits each answer, and notes for how long the slaves had no outputs at most.
class LockstepWire final : public Wire {
 public:
  bool send(std::span<const std::uint8_t> frame) noexcept override {
    writes_ = frame.size() > FrameWriter::kHeader &&
              frame[FrameWriter::kHeader] == static_cast<std::uint8_t>(Command::kLogicalWrite);
    const std::int64_t now_ns = clock_.now_ns();
    if (!wire_.send(frame)) return false;
    if (writes_) next_write_ns_ = now_ns;
    return true;
  }
  std::size_t receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept override {
    const std::size_t bytes = wire_.receive(frame, patient ? std::max(wait_ns, kPatience_ns) : wait_ns);
    if (bytes > 0) {
      if (last_write_ns_ > 0) longest_ns_ = std::max(longest_ns_, clock_.now_ns() - last_write_ns_);
      if (writes_) last_write_ns_ = next_write_ns_;
    }
    return bytes;
  }
  /// The longest time without outputs, as the slaves may have seen it, since it was forgotten.
  std::int64_t longest_ns() const noexcept { return longest_ns_; }
  void forget() noexcept { longest_ns_ = 0; }
  bool patient = true;

 private:
  static constexpr std::int64_t kPatience_ns = 2'000'000'000;
  io::WallClock clock_;
  PacketWire wire_{"ecat0"};
  bool writes_ = false;
  std::int64_t next_write_ns_ = 0, last_write_ns_ = 0, longest_ns_ = 0;
};

/// One datagram for all slaves, from a socket of its own. False: no answer within 10 ms.
bool broadcast(Command command, std::uint16_t address, std::array<std::uint8_t, 2> value) {
  PacketWire wire("ecat0");
  FrameWriter frame(0xEE);
  frame.add(command, std::uint32_t{address} << 16U, value);
  std::array<std::uint8_t, kMostFrame> answer{};
  if (!wire.send(frame.bytes())) return false;
  const std::size_t bytes = wire.receive(answer, 10'000'000);
  Datagram heard;
  return FrameReader(std::span(answer).first(bytes), frame.bytes()).next(heard) && heard.working_counter > 0;
}

/// KickCAT's simulator as a process of its own.
class Simulator {
 public:
  Simulator(const std::filesystem::path& program, const std::vector<std::filesystem::path>& slaves) {
    std::vector<std::string> words = {program.string(), "-i", "ecat1", "-s"};
    for (const auto& slave : slaves) words.push_back(slave.string());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
    const int failed = posix_spawn(&process_, program.c_str(), &quiet, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&quiet);
    if (failed != 0) throw std::runtime_error(program.string() + " does not start");
    for (int k = 0; !broadcast(Command::kBroadcastRead, kAlStatus, {}); ++k) {
      const bool ended = waitpid(process_, nullptr, WNOHANG) != 0;
      if (k < kTries && !ended) continue;
      if (!ended) end();
      throw std::runtime_error(program.string() + " does not answer; expected KickCAT's network_simulator");
    }
  }
  ~Simulator() { end(); }
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

 private:
  static constexpr int kTries = 3000;  // of 10 ms each
  void end() const {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  pid_t process_ = 0;
};

/// Z1's left knee, and its ankle where there is a second drive, are KickCAT's.
class ForeignSlaves : public testing::Test {
 protected:
  void SetUp() override {
    const char* kickcat = std::getenv("PMG_KICKCAT");
    if (kickcat == nullptr || if_nametoindex("ecat1") == 0)
      GTEST_SKIP() << "needs test/ethercat/foreign_slaves_test.sh";
    kickcat_ = kickcat;
  }
  void TearDown() override {
    if (!HasFailure() || !wire_ || wire_->longest_ns() < std::int64_t{1000} * Master::kWatchdog_us) return;
    fmt::print("held up: the slaves had no outputs for {:.1f} ms\n", 1e-6 * static_cast<double>(wire_->longest_ns()));
  }
  std::filesystem::path program() const { return kickcat_ / "build/simulation/network_simulator"; }
  /// The drive of test/ethercat/foreign with this alias, and with the first `old` of its description as `changed`.
  std::filesystem::path drive(int alias, const std::string& old = {}, const std::string& changed = {}) const {
    const std::filesystem::path from = std::filesystem::path(pmg::test::project_folder()) / "test/ethercat/foreign";
    const std::string name = fmt::format("drive{}", alias);
    std::ifstream source(from / "drive.xml");
    std::string xml{std::istreambuf_iterator<char>(source), {}};
    const std::string key = "<ConfigData>080E02EE409C0000";
    xml.replace(xml.find(key) + key.size(), 2, fmt::format("{:02X}", alias));
    if (!old.empty()) xml.replace(xml.find(old), old.size(), changed);
    std::ofstream(folder_.file(name + ".xml")) << xml;
    std::ifstream form(from / "drive.json");
    std::string json{std::istreambuf_iterator<char>(form), {}};
    json.replace(json.find("drive.xml"), 9, name + ".xml");
    std::ofstream(folder_.file(name + ".json")) << json;
    return folder_.file(name + ".json");
  }
  void begin(const std::vector<std::filesystem::path>& slaves) {
    simulator_.reset();
    simulator_.emplace(program(), slaves);
  }
  void expect(Cia402Mode mode, int count = 1) {
    setup_ = can::load_drives(z1());
    setup_.buses.resize(1);
    can::BusSetup& bus = setup_.buses[0];
    bus.motors.erase(bus.motors.begin(), bus.motors.begin() + 3);
    bus.motors.erase(bus.motors.begin() + count, bus.motors.end());
    bus.on_can = false;
    cable_.buses = {{.first_slave = 1, .first_alias = kAlias}};
    int node = 0;
    for (drives::MotorSetup& motor : bus.motors) {
      motor.node = ++node;
      const model::Joint& joint = z1().joints[static_cast<std::size_t>(motor.index)];
      motor.drive = drives::cia402_drive({.mode = mode,
                                          .counts_per_turn = kCounts,
                                          .velocity_unit_rad_s = kCount_rad,  // KickCAT's motor: counts a second
                                          .rated_torque_Nm = 40.0,
                                          .largest_torque_Nm = 120.0,
                                          .kp_Nm_per_rad = joint.kp_Nm_per_rad,
                                          .kd_Nm_s_per_rad = joint.kd_Nm_s_per_rad,
                                          .vendor_id = 0x1234,
                                          .product_code = 0x0402});
    }
    knee_ = bus.motors[0].index;
    holding_ = limp_ = standing_command(z1());
    limp_.kp.setZero();
    limp_.kd.setZero();
  }
  /// robot.yaml says something else of a motor's drive.
  template <typename Edit>
  void change(std::size_t motor, Edit edit) {
    drives::DriveKind& drive = setup_.buses[0].motors[motor].drive;
    drives::Cia402Settings settings = *drives::as_cia402(drive);
    edit(settings);
    drive = drives::cia402_drive(settings);
  }
  void connect() {
    hal_.reset();
    if (!wire_) wire_.emplace();
    wire_->patient = true;
    hal_.emplace(
        cable_, setup_, z1(), clock_, *wire_, [] {}, std::function<bool()>());
    wire_->forget();
  }
  std::string refusal() {
    try {
      connect();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "connected";
  }
  BusStatus cycle(const model::JointCommand& command) { return hal_->exchange(command, state_); }
  /// Enabled, at the place where it was. False: not within a hundred cycles.
  bool switch_on() {
    for (int k = 0; k < 100; ++k) {
      if (cycle(limp_) != BusStatus::kOk) continue;
      start_rad_ = holding_.q[knee_] = state_.q[knee_];
      if (k < 10) continue;
      return true;
    }
    return false;
  }
  /// Over this many cycles to start + by; then it stays there for as many.
  void move(double by_rad, int cycles) {
    for (int k = 1; k <= 2 * cycles; ++k) {
      holding_.q[knee_] = start_rad_ + by_rad * std::min(k, cycles) / cycles;
      ASSERT_EQ(cycle(holding_), BusStatus::kOk) << k << ": " << hal_->take_news();
      ASSERT_EQ(hal_->can().motor(0, 0).age_cycles(), 0) << k;
    }
  }

  std::filesystem::path kickcat_;
  test::TemporaryFolder folder_;
  std::optional<Simulator> simulator_;
  EthercatSetup cable_{.interface = "ecat0", .buses = {}, .imu = {}};
  can::DriveSetup setup_;
  io::WallClock clock_;
  std::optional<LockstepWire> wire_;
  std::optional<EthercatHal> hal_;
  model::RobotState state_;
  model::JointCommand holding_, limp_;
  int knee_ = 0;
  double start_rad_ = 0.0;
};

TEST_F(ForeignSlaves, InPositionModeADriveComesToOperationalAndStandsAtEachTarget) {
  begin({drive(kAlias)});
  expect(Cia402Mode::kPosition);
  connect();
  EXPECT_TRUE(hal_->cable().good);
  ASSERT_TRUE(switch_on()) << hal_->take_news();
  EXPECT_NEAR(start_rad_, 3130 * kCount_rad, 1e-9) << "0x6064 of drive.xml";
  for (const double by_rad : {0.05, -0.05}) {
    move(by_rad, 100);
    EXPECT_NEAR(state_.q[knee_], start_rad_ + by_rad, 1.51 * kCount_rad)
        << "half a count of the target, one of the reading: KickCAT cuts it off";
  }
  EXPECT_EQ(hal_->misses(), 0u);
}

TEST_F(ForeignSlaves, InTorqueModeOurLoopMovesTheirInertia) {
  begin({drive(kAlias)});
  expect(Cia402Mode::kTorque);
  connect();
  ASSERT_TRUE(switch_on()) << hal_->take_news();
  holding_.kp[knee_] = 200.0;  // an inertia of 0.1 kg m^2: 45 rad/s, damping 1
  holding_.kd[knee_] = 9.0;
  move(0.05, 150);
  EXPECT_NEAR(state_.q[knee_], start_rad_ + 0.05, 0.5 * 0.04 / 200.0 + kCount_rad) << "half a step of torque, a count";
  EXPECT_NEAR(state_.tau[knee_], 0.0, 0.04) << "a motor without load holds nothing";
  EXPECT_EQ(hal_->misses(), 0u);
}

TEST_F(ForeignSlaves, WhatIsNotAsInRobotYamlIsRefusedInOneLine) {
  begin({drive(kAlias + 1), drive(kAlias)});
  expect(Cia402Mode::kPosition, 2);
  EXPECT_EQ(refusal(), "ecat0: slave 1 (Foreign drive) has alias 0x66; expected 0x65 as in robot.yaml");
  expect(Cia402Mode::kPosition, 1);
  EXPECT_EQ(refusal(), "ecat0: 2 slaves answer; expected 1 as in robot.yaml");
  begin({drive(kAlias), drive(kAlias + 1)});
  expect(Cia402Mode::kPosition, 2);
  change(1, [](drives::Cia402Settings& settings) { settings.rated_torque_Nm = 41.0; });
  EXPECT_THAT(refusal(), HasSubstr("ecat0: slave 2, left_ankle_pitch (can0, node 2) object 0x6076 (rated torque) is 40 "
                                   "Nm; expected rated_torque_Nm 41 as in robot.yaml"));
  change(1, [](drives::Cia402Settings& settings) { settings.rated_torque_Nm = 40.0; });
  EXPECT_EQ(refusal(), "connected") << "after one that was refused";
}

TEST_F(ForeignSlaves, TheirSdoAbortsAreReadAsTheStandardMeansThem) {
  begin({drive(kAlias, "<Index>#x6072</Index>", "<Index>#x6073</Index>")});
  expect(Cia402Mode::kPosition);
  EXPECT_EQ(refusal(),
            "ecat0: slave 1, left_knee (can0, node 1) has no object 0x6072 (largest torque); expected a drive that has "
            "it");
  begin({drive(kAlias)});
  change(0, [](drives::Cia402Settings& settings) { settings.temperature_index = 0x2030; });
  EXPECT_THAT(refusal(), HasSubstr("has no object 0x2030 (temperature)"));
  change(0, [](drives::Cia402Settings& settings) { settings.temperature_index = 0; });
  const std::string most = "<Info><DefaultValue>1000</DefaultValue></Info><Flags><Access>";
  begin({drive(kAlias, most + "rw", most + "ro")});
  EXPECT_THAT(refusal(), HasSubstr("refuses object 0x6072 with SDO abort 0x06010002")) << "read-only";
}

TEST_F(ForeignSlaves, SilenceTakesItOutOfOperationalAndALimpRobotGetsItBack) {
  begin({drive(kAlias)});
  expect(Cia402Mode::kPosition);
  connect();
  ASSERT_TRUE(switch_on()) << hal_->take_news();
  std::this_thread::sleep_for(std::chrono::microseconds(2 * Master::kWatchdog_us));  // the silence, at least
  int bad = 0;
  for (int k = 0; k < 10 && bad < 2; ++k) {
    const BusStatus status = cycle(holding_);
    if (hal_->cable().al_status == kOperational && bad == 0) continue;  // KickCAT looks at its watchdog after a frame
    EXPECT_EQ(status, ++bad == 1 ? BusStatus::kStale : BusStatus::kLost) << "in the second cycle in which it says so";
  }
  ASSERT_EQ(bad, 2);
  wire_->forget();  // this silence
  EXPECT_EQ(hal_->cable().al_status, 0x14) << "safe-operational with error";
  EXPECT_THAT(hal_->take_news(), HasSubstr("states 0x14"));
  for (int k = 0; k < 120; ++k) cycle(holding_);
  EXPECT_EQ(hal_->cable().al_status, 0x14) << "never while the robot is stiff";
  for (int k = 0; k < 2 * EthercatHal::kRecoverCycles; ++k) cycle(limp_);
  ASSERT_EQ(hal_->cable().al_status, kOperational) << hal_->take_news();
  ASSERT_TRUE(switch_on()) << hal_->take_news();
  move(0.02, 50);
}

TEST_F(ForeignSlaves, AStateThatSomebodyElseTakesFromItIsLostInItsSecondCycle) {
  begin({drive(kAlias)});
  for (const std::uint8_t state : {std::uint8_t{4}, std::uint8_t{2}, std::uint8_t{1}}) {
    expect(Cia402Mode::kPosition);
    connect();
    ASSERT_TRUE(switch_on()) << hal_->take_news();
    bool written = false;
    for (int k = 0; k < 100 && !written; ++k) written = broadcast(Command::kBroadcastWrite, kAlControl, {state, 0});
    ASSERT_TRUE(written);
    EXPECT_EQ(cycle(holding_), BusStatus::kStale) << int{state};
    EXPECT_EQ(cycle(holding_), BusStatus::kLost) << int{state};
    EXPECT_EQ(hal_->cable().al_status, state);
    for (int k = 0; k < 2 * EthercatHal::kRecoverCycles; ++k) cycle(limp_);
    // Safe-operational keeps its set-up. Below it the set-up is lost, and the program must be started again.
    EXPECT_EQ(hal_->cable().al_status == kOperational, state == 4) << int{state};
  }
}

TEST_F(ForeignSlaves, OneThatIsKilledIsLostInItsSecondCycleAndNeedsANewStart) {
  begin({drive(kAlias)});
  expect(Cia402Mode::kPosition);
  connect();
  ASSERT_TRUE(switch_on()) << hal_->take_news();
  simulator_.reset();
  wire_->patient = false;
  EXPECT_EQ(cycle(holding_), BusStatus::kStale);
  EXPECT_EQ(cycle(holding_), BusStatus::kLost);
  EXPECT_THAT(hal_->take_news(), HasSubstr("0 slaves answer"));
  begin({drive(kAlias)});
  wire_->patient = true;
  for (int k = 0; k < 3 * EthercatHal::kRecoverCycles; ++k) ASSERT_NE(cycle(limp_), BusStatus::kOk);
  EXPECT_EQ(hal_->cable().slaves, 1);
  EXPECT_NE(hal_->cable().al_status & 0x0FU, kOperational);
  connect();
  ASSERT_TRUE(switch_on()) << hal_->take_news();
}

/// KickCAT's own slaves: two of its examples, and a maker's drive (Ingenia EVS-NET-01) by its description. None is what
/// robot.yaml describes, and each is asked as far as it goes: the first two have no profile of a drive, the third has
/// no encoder object.
TEST_F(ForeignSlaves, KickcatsOwnSlavesAreFoundAndRefusedInOneLine) {
  expect(Cia402Mode::kPosition);
  cable_.buses[0].first_alias = 0;
  const std::vector<std::pair<const char*, const char*>> slaves = {
      {"freedom-k64f.json", "object 0x1000 (device type) is profile 0; expected profile 402"},
      {"xmc4800.json", "object 0x1000 (device type) is profile 0; expected profile 402"},
      {"ecat402-drive.json", "has no object 0x608F:1 (encoder counts); expected a drive that has it"}};
  change(0, [](drives::Cia402Settings& settings) { settings.rated_torque_Nm = 1.0; });
  for (const auto& [name, said] : slaves) {
    begin({kickcat_ / "simulation/slave_configs" / name});
    change(0, [](drives::Cia402Settings& settings) { settings.vendor_id = 0x1234; });
    EXPECT_THAT(refusal(), testing::MatchesRegex("ecat0: slave 1 \\(.*\\) has vendor 0x.*; expected 0x1234 as in "
                                                 "robot.yaml"))
        << name;
    change(0, [](drives::Cia402Settings& settings) { settings.vendor_id = settings.product_code = 0; });
    EXPECT_THAT(refusal(), HasSubstr(said)) << name;
  }
}

}  // namespace
}  // namespace pmg::ethercat
