// A recording of a robot's buses, as pmg_bus dump writes it, through the backend.
#include "can/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../sim/robots.hpp"
#include "can/canopen_setup.hpp"
#include "can/emulated_drives.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"

namespace pmg::can {
namespace {

/// One end of a bus whose frames, both ways, are written down.
class WrittenLink final : public Link {
 public:
  WrittenLink(std::unique_ptr<Link> inner, std::string name, const std::int64_t& now_ns, std::string& recording)
      : inner_(std::move(inner)), name_(std::move(name)), now_ns_(now_ns), recording_(recording) {}
  std::size_t send(std::span<const drives::Message> frames) noexcept override {
    for (const drives::Message& frame : frames) write(frame);
    return inner_->send(frames);
  }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    const std::size_t count = inner_->receive(frames);
    for (const drives::Message& frame : frames.first(count)) write(frame);
    return count;
  }
  BusHealth health() const noexcept override { return inner_->health(); }
  const LinkCounts& counts() const noexcept override { return inner_->counts(); }

 private:
  void write(const drives::Message& frame) {
    recording_ += to_line({.stamp_ns = now_ns_, .interface = name_, .frame = frame}) + "\n";
  }
  std::unique_ptr<Link> inner_;
  std::string name_;
  const std::int64_t& now_ns_;
  std::string& recording_;
};

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

/// Some cycles of a robot whose knees turn at 0.5 rad/s. silent_from: the left knee falls silent in this cycle.
std::string recorded(const DriveSetup& setup, int cycles, int silent_from = -1) {
  std::string recording;
  std::int64_t now_ns = kStart_ns;
  std::vector<std::unique_ptr<Link>> host, far;
  for (const BusSetup& bus : setup.buses) {
    auto [here, there] = test::MemoryLink::pair();
    host.push_back(std::make_unique<WrittenLink>(std::move(here), bus.name, now_ns, recording));
    far.push_back(std::move(there));
  }
  test::EmulatedDrives drives(setup, std::move(far));
  set_up_nodes(setup, host, [&] { drives.answer(); }, {});
  recording.clear();
  const io::SimulationClock clock;
  CanHal hal(setup, z1(), clock, std::move(host));
  model::JointCommand command = standing_command(z1());
  command.kp.setZero();
  command.kd.setZero();
  model::JointCommand acting = command;
  model::RobotState truth, state;
  truth.q = z1().q_stand();
  truth.dq = truth.tau = JointVector::Zero(truth.q.size());
  const int knee = z1().joint_index.at("left_knee");
  for (int k = 0; k < cycles; ++k) {
    for (std::size_t b = 0; b < setup.buses.size(); ++b) {
      for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m) {
        if (setup.buses[b].motors[m].index == knee) drives.drive(b, m).silent = silent_from >= 0 && k >= silent_from;
      }
    }
    truth.dq[knee] = 0.5;
    truth.q[knee] += 0.001;
    drives.feel(truth);
    now_ns = kStart_ns + k * 2'000'000;
    hal.send(command);
    now_ns += 300'000;
    drives.serve();
    hal.receive(state);
    drives.tick(acting);
    drives.answer();
  }
  return recording;
}

struct Said {
  std::vector<std::pair<double, std::string>> lines;
  std::uint64_t troubles = 0, left_out = 0, missing = 0, too_many = 0, unreadable = 0;
  double knee_rad = 0.0;
};
Said replayed(const DriveSetup& setup, const std::string& recording) {
  Said said;
  Replay replay(setup, z1(), [&said](double t_s, const std::string& text) { said.lines.emplace_back(t_s, text); });
  std::istringstream stream(recording);
  feed(replay, stream, "first.log");
  said.troubles = replay.troubles();
  said.left_out = replay.left_out();
  said.unreadable = replay.hal().unreadable() + replay.hal().strangers();
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m) {
      const drives::MotorMonitor& monitor = replay.hal().motor(b, m);
      said.missing += monitor.lost();
      said.too_many += monitor.uncalled();
      const drives::MotorSetup& motor = setup.buses[b].motors[m];
      if (motor.joint == "left_knee") said.knee_rad = motor.transmission.to_joint(monitor.reading()).q_rad;
    }
  }
  return said;
}

TEST(Replay, AHealthyRecordingOfEitherProtocolHasNoTrouble) {
  for (const bool mixed : {false, true}) {
    const DriveSetup setup = mixed ? test::mixed_drives(z1()) : load_drives(z1());
    const Said said = replayed(setup, recorded(setup, 200));
    EXPECT_THAT(said.lines, testing::IsEmpty()) << mixed;
    EXPECT_EQ(said.troubles, 0u);
    EXPECT_EQ(said.missing + said.too_many, 0u) << mixed;
    EXPECT_EQ(said.unreadable, 0u) << "this computer's own commands are no messages to it";
    EXPECT_NEAR(said.knee_rad, z1().q_stand()[z1().joint_index.at("left_knee")] + 0.2, 2e-3);
  }
}

TEST(Replay, ARecordingThatBeginsInTheMiddleOfACycleHasNoTrouble) {
  const DriveSetup setup = load_drives(z1());
  const std::string all = recorded(setup, 50);
  std::size_t at = 0;
  for (int line = 0; line < 45; ++line) at = all.find('\n', at) + 1;  // the commands, and a part of the answers
  EXPECT_THAT(replayed(setup, all.substr(at)).lines, testing::IsEmpty());
}

TEST(Replay, AnImuThatSpeaksOnlyNowAndThenIsNoTroubleAtTheBegin) {
  const DriveSetup setup = load_drives(z1());
  std::istringstream all(recorded(setup, 50));
  std::string line, later;
  while (std::getline(all, line)) {
    const auto frame = from_line(line);
    const bool early = frame->stamp_ns - kStart_ns < 8'000'000;
    if (!early || frame->interface != "can4" || frame->frame.id < kImuQuaternion) later += line + "\n";
  }
  EXPECT_THAT(replayed(setup, later).lines, testing::IsEmpty());
}

TEST(Replay, ARecordingWithoutTheCommandsIsReadToo) {
  const DriveSetup setup = load_drives(z1());
  std::istringstream all(recorded(setup, 100));
  std::string line, answers;
  while (std::getline(all, line)) {
    if ((from_line(line)->stamp_ns - kStart_ns) % 2'000'000 != 0) answers += line + "\n";
  }
  const Said said = replayed(setup, answers);
  EXPECT_THAT(said.lines, testing::IsEmpty());
  EXPECT_NEAR(said.knee_rad, z1().q_stand()[z1().joint_index.at("left_knee")] + 0.1, 2e-3);
}

TEST(Replay, ADriveThatFellSilentIsNamedWithItsTime) {
  const DriveSetup setup = load_drives(z1());
  const Said said = replayed(setup, recorded(setup, 200, 100));
  ASSERT_EQ(said.lines.size(), 1u);
  EXPECT_EQ(said.lines[0].second, "left_knee (can0, node 4) does not answer");
  EXPECT_NEAR(said.lines[0].first, 0.2 + 0.002 * drives::MotorMonitor::kSilentCycles, 0.003);
  EXPECT_EQ(said.troubles, 1u);
}

TEST(Replay, ADriveThatNeverAnswersIsNamedToo) {
  const DriveSetup setup = load_drives(z1());
  const Said said = replayed(setup, recorded(setup, 50, 0));
  ASSERT_EQ(said.lines.size(), 1u);
  EXPECT_EQ(said.lines[0].second, "left_knee (can0, node 4) does not answer");
}

TEST(Replay, AHoleInTheRecordingIsNoSilenceOfTheDrives) {
  const DriveSetup setup = load_drives(z1());
  std::istringstream all(recorded(setup, 200));
  std::string line, without, without_answers;
  while (std::getline(all, line)) {
    const std::int64_t at_ns = from_line(line)->stamp_ns - kStart_ns;
    const bool inside = at_ns >= 200'000'000 && at_ns <= 240'000'000;
    if (!inside) without += line + "\n";
    if (!inside || at_ns % 2'000'000 == 0) without_answers += line + "\n";
  }
  const Said hole = replayed(setup, without);
  ASSERT_EQ(hole.lines.size(), 1u) << testing::PrintToString(hole.lines);
  EXPECT_EQ(hole.lines[0].second, "nothing was recorded for 0.042 s");
  EXPECT_EQ(hole.troubles, 0u);
  const Said silence = replayed(setup, without_answers);
  EXPECT_GE(silence.troubles, 1u) << "commands went out, and nobody answered";
  EXPECT_EQ(silence.lines[0].second, "left_hip_pitch (can0, node 1) does not answer");
  EXPECT_NEAR(silence.lines[0].first, 0.21, 0.003);
  EXPECT_EQ(silence.lines.back().second, "the drives answer");
}

TEST(Replay, OtherInterfacesAreLeftOutAndWhatIsNoRecordingIsRefusedWithItsLine) {
  const DriveSetup setup = load_drives(z1());
  const std::string other = "(1436509052.249713) can7 044#2A366C2B\n";
  EXPECT_EQ(replayed(setup, other + recorded(setup, 20)).left_out, 1u);
  EXPECT_THROW(replayed(setup, other), std::runtime_error) << "no frame of this robot";
  EXPECT_THROW(replayed(setup, ""), std::runtime_error);
  try {
    replayed(setup, recorded(setup, 1) + "Wed Nov 26\n");
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(),
                testing::MatchesRegex("first.log:[0-9]+: isn't a frame; expected candump's log format.*"));
  }
}

}  // namespace
}  // namespace pmg::can
