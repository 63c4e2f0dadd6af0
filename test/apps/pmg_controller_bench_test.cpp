// pmg_controller --bench in the robot's own threads: an operator makes it stand; it plays, records, damps and ends. The
// number of complete runs depends on the host: a pause makes a hole, and a run with a hole is not recorded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "apps/running_program.hpp"
#include "bench/bench.hpp"
#include "bench/excitation.hpp"
#include "io/private_network.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using io::Multicast;
using test::RunningProgram;
using testing::HasSubstr;

constexpr int kRuns = 4;
constexpr std::size_t kSamples = 60;  // 0.6 s: on a host that pauses once a second most are complete

bench::Excitation steps(int runs, std::size_t samples) {
  bench::Excitation excitation;
  excitation.trajectories = {{"steps", {}}};
  for (std::size_t k = 0; k < samples; ++k) {
    excitation.trajectories[0].q_cmd_rad.push_back(k / (kSamples / 2) % 2 == 0 ? 0.0 : 0.1);
  }
  for (int run = 0; run < runs; ++run) {
    excitation.rows.push_back({"run" + std::to_string(run) + ".csv", "steps", run, {20.0, 1.0}});
  }
  return excitation;
}

class ControllerBench : public testing::Test {
 protected:
  ControllerBench() { fs::create_directories(folder_); }
  ~ControllerBench() override { fs::remove_all(folder_); }

  fs::path at(const std::string& name) const { return folder_ / name; }

  int run(const std::string& program, std::vector<std::string> arguments) {
    RunningProgram running(program, std::move(arguments), folder_);
    const int code = running.wait();
    said_ = running.out() + running.err();
    return code;
  }

  /// Runs the controller; `operate` acts as the operator from the first STATUS on. Returns the exit code.
  template <typename Operator>
  int bench(const std::string& name, const bench::Excitation& excitation, Operator&& operate) {
    if (!fs::exists(at("excitation"))) bench::write_excitation(at("excitation"), excitation, "steps");
    RunningProgram controller(
        "pmg_controller",
        {"--hal", "sil", "--robot", "z1", "--no-realtime", "--bench", "head_pitch", "--excitation",
         at("excitation").string(), "--bench-out", at(name).string(), "--log", at("log_" + name).string()},
        folder_);
    EXPECT_EQ(run("pmg_watch", {"--once", "--timeout", "60", "--robot", "z1"}), 0) << controller.err();
    EXPECT_EQ(run("pmg_send", {"stand", "--robot", "z1"}), 0) << said_;
    operate(controller);
    const int code = controller.wait();
    said_ = controller.err();
    return code;
  }
  std::ptrdiff_t recorded(const std::string& name) const {
    const fs::path runs = at(name) / "runs";
    return fs::is_directory(runs) ? std::distance(fs::directory_iterator(runs), fs::directory_iterator()) : 0;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("pmg_controller_bench_" + std::to_string(getpid()));
  std::string said_;
};

TEST_F(ControllerBench, RecordsEndsByItselfAndItsLogReplays) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    std::string name;
    int code = -1;
    for (int attempt = 0; attempt < 5 && (name.empty() || recorded(name) == 0); ++attempt) {
      name = "bench" + std::to_string(attempt);
      code = bench(name, steps(kRuns, kSamples), [](RunningProgram&) {});
    }
    const std::ptrdiff_t runs = recorded(name);
    ASSERT_GT(runs, 0) << said_;
    EXPECT_EQ(code, runs == kRuns ? 0 : 1) << said_;
    EXPECT_THAT(said_, HasSubstr(std::to_string(runs) + " of " + std::to_string(kRuns) + " runs of head_pitch"));
    const bench::Bench recording = bench::read_bench(at(name));
    EXPECT_EQ(recording.joint, "head_pitch");
    ASSERT_EQ(recording.read_runs(bench::RowFilter(""), {}).size(), static_cast<std::size_t>(runs));
    for (const bench::BenchRun& run : recording.read_runs(bench::RowFilter(""), {})) {
      EXPECT_EQ(run.recording.t_s.size(), static_cast<std::size_t>(kSamples));
    }
    EXPECT_EQ(run("pmg_log", {"replay", at("log_" + name).string()}), 0) << said_;
    EXPECT_THAT(said_, HasSubstr("bit for bit"));
  });
}

TEST_F(ControllerBench, AStopEndsItWithNothingHalfRecorded) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto ticks = [&] {
      constexpr std::uintmax_t kTick_bytes = 4000;
      std::error_code none;
      const std::uintmax_t size = fs::file_size(at("log_stopped") / "log-0000.lcm", none);
      return none ? 0 : size / kTick_bytes;
    };
    // One run of a minute, which begins within the first 400 ticks.
    const int code = bench("stopped", steps(1, 6000), [&](RunningProgram& controller) {
      const std::uintmax_t standing = ticks();
      EXPECT_TRUE(controller.until([&] { return ticks() > standing + 400; })) << controller.err();
      EXPECT_EQ(run("pmg_send", {"stop"}), 0) << said_;
    });
    EXPECT_EQ(code, 1) << said_;
    EXPECT_THAT(said_, HasSubstr("0 of 1 runs of head_pitch recorded; the robot left Stand"));
    EXPECT_FALSE(fs::exists(at("stopped")));
  });
}

}  // namespace
}  // namespace pmg
