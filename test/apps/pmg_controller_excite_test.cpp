// pmg_controller --excite in the robot's own threads: an operator makes the simulated robot stand, it plays, and its
// logs say what was hidden in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/running_program.hpp"
#include "io/private_network.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using io::Multicast;
using test::RunningProgram;
using testing::HasSubstr;

class ControllerExcites : public testing::Test {
 protected:
  ControllerExcites() {
    fs::create_directories(folder_);
    // Three times the friction of this joint.
    std::ofstream(at("motor.yaml")) << "joints:\n  left_elbow:\n    friction: {coulomb_Nm: 0.6, "
                                       "viscous_Nm_s_per_rad: 0.1}\n";
  }
  ~ControllerExcites() override { fs::remove_all(folder_); }

  fs::path at(const std::string& name) const { return folder_ / name; }

  int run(const std::string& program, std::vector<std::string> arguments) {
    RunningProgram running(program, std::move(arguments), folder_);
    const int code = running.wait();
    said_ = running.out() + running.err();
    return code;
  }

  /// Runs the controller; `operate` acts as the operator once it stands. Returns the exit code.
  template <typename Operator>
  int excite(const std::string& name, const std::vector<std::string>& options, Operator&& operate) {
    std::vector<std::string> arguments = {"--hal",
                                          "sil",
                                          "--robot",
                                          "z1",
                                          "--no-realtime",
                                          "--excite",
                                          name,
                                          "--motor",
                                          at("motor.yaml").string(),
                                          "--log",
                                          at(name).string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    RunningProgram controller("pmg_controller", arguments, folder_);
    EXPECT_EQ(run("pmg_watch", {"--once", "--timeout", "60", "--robot", "z1"}), 0) << controller.err();
    EXPECT_EQ(run("pmg_send", {"stand", "--robot", "z1"}), 0) << said_;
    operate(controller);
    const int code = controller.wait();
    said_ = controller.err();
    return code;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("pmg_controller_excite_" + std::to_string(getpid()));
  std::string said_;
};

TEST_F(ControllerExcites, TheLogsHeaderSaysWhatThisBackendIs) {
  ASSERT_EQ(run("pmg_controller", {"--hal", "sil", "--robot", "z1", "--gantry", "--excite", "hanging", "--motor",
                                   at("motor.yaml").string(), "--print-config"}),
            0)
      << said_;
  const nlohmann::json config = nlohmann::json::parse(said_);
  EXPECT_EQ(config.at("excite").at("name"), "hanging");
  EXPECT_EQ(config.at("drive_sampling_s"), 0.002);
  EXPECT_EQ(config.at("command_delay_s"), 0.0);
  EXPECT_THAT(config.at("set_on_simulator").dump(), HasSubstr("left_elbow: friction.coulomb_Nm = 0.6 Nm"));
}

TEST_F(ControllerExcites, TheOperatorsStopEndsItAtOnce) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const int code = excite("hanging", {"--gantry"}, [&](RunningProgram& controller) {
      EXPECT_TRUE(
          controller.until([&] { return controller.err().find("excitation plays") != std::string::npos; }, 60.0))
          << controller.err();
      EXPECT_EQ(run("pmg_send", {"stop", "--robot", "z1"}), 0) << said_;
    });
    EXPECT_EQ(code, 1) << said_;
    EXPECT_THAT(said_, HasSubstr("given up"));
    EXPECT_THAT(said_, HasSubstr("mode: damping"));
    EXPECT_EQ(run("pmg_log", {"replay", at("hanging").string()}), 0) << said_;
    EXPECT_THAT(said_, HasSubstr("bit for bit"));
  });
}

TEST_F(ControllerExcites, OneThingAtATimeAndNoPolicy) {
  EXPECT_EQ(run("pmg_controller", {"--hal", "sil", "--robot", "z1", "--excite", "sideways"}), 2);
  EXPECT_THAT(said_, HasSubstr("hanging"));
  EXPECT_EQ(run("pmg_controller", {"--hal", "sil", "--robot", "z1", "--excite", "hanging", "--policy", "pmg"}), 2);
  EXPECT_THAT(said_, HasSubstr("--policy none"));
}

}  // namespace
}  // namespace pmg
