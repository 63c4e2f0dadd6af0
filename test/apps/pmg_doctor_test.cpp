// pmg_doctor as a user runs it, and what pmg_controller does with its findings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/running_program.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::size_t count_of(const std::string& what, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

class DoctorProgram : public testing::Test {
 protected:
  DoctorProgram() { fs::create_directories(folder_); }
  ~DoctorProgram() override { fs::remove_all(folder_); }

  int run(const std::string& program, const std::vector<std::string>& arguments) {
    test::RunningProgram running(program, arguments, folder_);
    const int code = running.wait();
    out_ = running.out();
    err_ = running.err();
    return code;
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_doctor_app_" + std::to_string(getpid()));
  std::string out_, err_;
};

TEST_F(DoctorProgram, AFailingLineIsExitCodeOneWithWhatToDoBelowIt) {
  EXPECT_EQ(run("pmg_doctor",
                {"--hal", "ethercat", "--interface", "none0", "--log", folder_.string(), "--lcm-url", "memq://"}),
            1);
  EXPECT_THAT(out_, HasSubstr("fail  none0 link: no such interface\n      -> plug the card in"));
  EXPECT_THAT(out_, HasSubstr("ok    policy: pmg fits robot and clips"));
  EXPECT_EQ(err_, "");
}

TEST_F(DoctorProgram, ItsJsonHasEveryLineAndItsExitCodeFollowsTheCount) {
  const int code = run("pmg_doctor", {"--hal", "sil", "--json", "--log", folder_.string(), "--lcm-url", "memq://"});
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(code, json["fail"].get<int>() > 0 ? 1 : 0) << "what the computer of a test has isn't known";
  std::vector<std::string> checks;
  for (const auto& finding : json["findings"]) {
    checks.push_back(finding["check"]);
    EXPECT_EQ(finding.contains("remedy"), finding["verdict"] != "ok") << finding;
  }
  for (const char* check :
       {"robot.yaml and URDF", "clips", "policy", "bundle", "kernel", "real-time priority", "locked memory",
        "real-time throttling", "isolated CPUs", "CPU frequency", "interrupts of other devices", "disk space",
        "disk speed", "clock source", "clock set", "clock jumps", "multicast route", "keys"}) {
    EXPECT_THAT(checks, testing::Contains(check));
  }
  EXPECT_EQ(checks.size(), 18u);
}

TEST_F(DoctorProgram, BadUsageIsOneLineAndExitCodeTwo) {
  EXPECT_EQ(run("pmg_doctor", {"--robot", "zz1"}), 2);
  EXPECT_EQ(err_, "pmg_doctor: robot 'zz1' is neither known nor a folder; did you mean z1?\n");
  EXPECT_EQ(run("pmg_doctor", {"--hal", "ethercat"}), 2);
  EXPECT_THAT(err_, StartsWith("pmg_doctor: --hal ethercat: --interface is missing"));
  EXPECT_EQ(run("pmg_doctor", {"--hal", "sil", "--ask-drives"}), 2);
  EXPECT_EQ(err_, "pmg_doctor: --ask-drives: needs --hal can\n");
  EXPECT_EQ(run("pmg_doctor", {"--hal", "canopen"}), 2);
}

TEST_F(DoctorProgram, AControllerOfMotorsRefusesWhatFailsUnlessTold) {
  if (fs::exists("/sys/class/net/can0")) GTEST_SKIP() << "this computer has the CAN interface that must be missing";
  // Another test may run a controller beside this one, and of one name only one runs.
  const std::vector<std::string> arguments = {
      "--hal",    "can",           "--lcm-url", "memq://",
      "--no-log", "--no-realtime", "--name",    "doctored_" + std::to_string(getpid())};
  EXPECT_EQ(run("pmg_controller", arguments), 2);
  EXPECT_THAT(err_, HasSubstr("error doctor: can4: no such interface"));
  EXPECT_THAT(err_, HasSubstr("\npmg_controller: can0: no such interface; plug the adapter in"));
  // Five buses are missing; what else fails (a clock that was set meanwhile) is the computer's.
  const std::size_t failing = count_of("error doctor: ", err_);
  EXPECT_GE(failing, 5u);
  const std::string others = "(" + std::to_string(failing - 1) + " more: pmg_doctor)\n";
  EXPECT_THAT(err_, HasSubstr(others));
  EXPECT_THAT(err_, Not(HasSubstr("doctor: kernel"))) << "without real time its lines don't concern it";
  std::vector<std::string> told = arguments;
  told.emplace_back("--despite-doctor");
  EXPECT_EQ(run("pmg_controller", told), 2);
  EXPECT_THAT(err_, HasSubstr("--despite-doctor: the motors are driven all the same"));
  EXPECT_THAT(err_, HasSubstr("\npmg_controller: can0: ")) << "it went on to the bus itself";
  EXPECT_THAT(err_, Not(HasSubstr("more: pmg_doctor)")));
}

TEST_F(DoctorProgram, ASimulatedRobotNeedsNoDoctor) {
  EXPECT_EQ(run("pmg_controller", {"--hal", "sil", "--lcm-url", "memq://", "--no-log", "--no-realtime", "--duration",
                                   "0.1", "--name", "healthy_" + std::to_string(getpid())}),
            0);
  EXPECT_THAT(err_, Not(HasSubstr("doctor")));
}

}  // namespace
}  // namespace pmg
