// All threads of pmg_controller and of pmg_sil --realtime together, for ThreadSanitizer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <string>

#include "io/lcm_link.hpp"
#include "io/log_reader.hpp"
#include "io/private_network.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "recording/recorder.hpp"
#include "runtime/comms.hpp"
#include "runtime/threaded_controller.hpp"
#include "seal/operator_seal.hpp"
#include "sil/realtime_run.hpp"

namespace pmg::runtime {
namespace {

using test::ThreadedRobot;

class Composition : public testing::Test {
 protected:
  ~Composition() override { std::filesystem::remove_all(folder_); }
  std::map<std::string, int> events(const std::filesystem::path& file) {
    std::map<std::string, int> counts;
    io::LogReader reader(file);
    while (reader.next()) ++counts[reader.channel()];
    return counts;
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("pmg_composition_test_" + std::to_string(getpid()));
};

/// An operator on the controller's own network (memq receives its own messages). It works in the comms thread, between
/// comms' steps.
struct NetworkOperator {
  explicit NetworkOperator(io::LcmLink& network) : link(network) {
    drive.version = pmg_msgs::command_t::VERSION;
    request.version = pmg_msgs::mode_t::VERSION;
    drive.robot = request.robot = "z1";
    drive.source = request.source = "test";
    drive.session = request.session = 1;
    drive.lease_s = 0.5;
    drive.vx_m_s = 0.3;
    link.subscribe("STATUS", [this](io::Bytes bytes) {
      const auto heard = seal::decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
      controller = operators.believe("STATUS", heard.value().message_bytes, heard->seal, 0);
      controller->heard_ns = heard->message.stamp_ns;
    });
  }
  void speak() {
    drive.stamp_ns = request.stamp_ns = clock.now_ns();
    if (drive.stamp_ns < next_ns) return;
    next_ns = drive.stamp_ns + 20'000'000;
    ++drive.sequence;
    ++request.sequence;
    request.mode = wanted;
    const seal::Peer* peer = controller ? &*controller : nullptr;
    link.send("COMMAND", operators.seal("COMMAND", drive, peer));
    link.send("MODE", operators.seal("MODE", request, peer));
  }
  io::WallClock clock;
  io::LcmLink& link;
  std::int64_t next_ns = 0;
  std::atomic<std::int8_t> wanted{pmg_msgs::mode_t::PASSIVE};
  pmg_msgs::command_t drive{};
  pmg_msgs::mode_t request{};
  seal::OperatorSeal operators;
  std::optional<seal::Peer> controller;
};

TEST_F(Composition, OperatorsOverTheNetworkDriveARobotWhoseEveryTickIsLogged) {
  ThreadedRobot run(test::z1());
  const recording::RunInfo info{.robot = "z1", .session = 7, .realtime = run.controller.refused().empty()};
  io::LcmLink link("memq://");
  Comms comms(link, run.controller.inbox(), run.controller.outbox(), test::z1(), info, 100.0, run.clock);
  NetworkOperator human(link);
  recording::Recorder recorder(run.controller.outbox(), test::z1(), info, run.clock, {.directory = folder_},
                               [](const auto&) {});
  recorder.after_record = [&](const control::TickRecord& record) {
    const hal::TruthSample* truth = run.robot.take_truth(record.state.bus_sample);
    if (truth != nullptr) recorder.write_truth(record.now_ns, truth->truth, truth->hoisted);
  };
  run.controller.start(
      [&] {
        human.speak();
        comms.step(5);
      },
      [&] { recorder.drain(); });
  human.wanted = pmg_msgs::mode_t::WALK;
  ASSERT_TRUE(run.sees(control::Mode::kWalk));
  run.bus.lost = true;
  ASSERT_TRUE(run.sees(control::Mode::kFault));
  EXPECT_TRUE(run.controller.stop());
  recorder.close();
  EXPECT_EQ(run.controller.failure(), "");
  EXPECT_EQ(recorder.written(), run.controller.control_statistics().cycles());
  EXPECT_EQ(recorder.lost(), 0);
  const std::map<std::string, int> logged = events(recorder.file());
  EXPECT_EQ(logged.at("FAULT"), 1);
  EXPECT_EQ(logged.at("STATUS"), recorder.written());
  EXPECT_EQ(recorder.flight().written(), 1) << "the flight recorder's file";
}

/// pmg_controller's order: a thread of its own answers for the name until comms takes its first step.
TEST_F(Composition, ANameIsAnsweredForByAThreadOfItsOwnUntilCommsSteps) {
  PMG_IN_PRIVATE_NETWORK(io::Multicast::kOnLoopback, [] {
    ThreadedRobot run(test::z1());
    const recording::RunInfo info{.robot = "z1", .session = 7}, later_info{.robot = "z1", .session = 8};
    io::LcmLink link(io::kDefaultLcmUrl), later_link(io::kDefaultLcmUrl), listener(io::kDefaultLcmUrl);
    Comms comms(link, run.controller.inbox(), run.controller.outbox(), test::z1(), info, 100.0, run.clock);
    hal::StopLine stop_line;
    control::OperatorInbox inbox(stop_line);
    control::ControllerOutbox outbox;
    const auto expect_taken = [&](const char* when) {
      Comms later(later_link, inbox, outbox, test::z1(), later_info, 100.0, run.clock);
      EXPECT_THROW(later.listen_for_others(60.0), std::runtime_error) << when;
    };
    int status = 0;
    listener.subscribe("STATUS", [&](io::Bytes) { ++status; });
    std::optional<HeldClaim> claim(comms.hold_name());
    expect_taken("before comms steps");
    run.controller.start(
        [&] {
          claim.reset();
          comms.step(5);
        },
        [] {});
    EXPECT_TRUE(test::eventually([&] {
      listener.receive(10);
      return status >= 10;
    }));
    expect_taken("comms answers now");
    EXPECT_TRUE(run.controller.stop());
    EXPECT_EQ(link.publish_errors(), 0);
  });
}

TEST_F(Composition, AScenarioIsPlayedByTheWallClockAndMeasured) {
  std::filesystem::create_directories(folder_);
  ThreadedRobot run(test::z1());
  sil::Scenario scenario{.name = "walk", .steps = {}};
  scenario.steps.push_back(
      {.start_s = 0.0, .duration_s = 0.8, .text = "stand", .mode = control::Mode::kStand, .command = {}});
  scenario.steps.push_back(
      {.start_s = 0.8, .duration_s = 0.7, .text = "walk", .mode = control::Mode::kWalk, .command = {}});
  scenario.steps.back().command[kVx] = 0.4;
  io::LogWriter writer(folder_ / "log.lcm");
  const recording::RunInfo info{.robot = "z1"};
  recording::TickLog log(writer, test::z1(), info, 100.0);
  sil::RealtimeRun play(test::z1(), run.robot, run.controller, scenario, &log, false);
  std::atomic<int> observed{0};
  play.after_tick = [&](const sil::RunProgress&) { ++observed; };
  const sil::RunOutcome outcome = play.run();
  writer.flush();
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_NEAR(outcome.duration_s, 0.01 * observed, 1e-9);
  EXPECT_NEAR(outcome.hoisted_s, outcome.duration_s, 1e-6);
  EXPECT_EQ(events(folder_ / "log.lcm").at("GROUND_TRUTH"), run.controller.control_statistics().cycles());
}

TEST_F(Composition, AnInterruptedScenarioKeepsWhatWasDone) {
  ThreadedRobot run(test::z1());
  sil::Scenario scenario{.name = "long", .steps = {}};
  scenario.steps.push_back(
      {.start_s = 0.0, .duration_s = 600.0, .text = "stand", .mode = control::Mode::kStand, .command = {}});
  sil::RealtimeRun play(test::z1(), run.robot, run.controller, scenario, nullptr, false);
  std::atomic<int> observed{0};
  play.after_tick = [&](const sil::RunProgress&) { ++observed; };
  play.interrupted = [&] { return observed > 10; };
  const sil::RunOutcome outcome = play.run();
  EXPECT_TRUE(outcome.interrupted);
  EXPECT_GT(outcome.duration_s, 0.1);
  EXPECT_EQ(run.bus.last_kp_sum, 0.0);
}

}  // namespace
}  // namespace pmg::runtime
