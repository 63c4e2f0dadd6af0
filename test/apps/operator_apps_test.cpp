// pmg_send and pmg_watch, used as by their users: alone, without a network, and against a pmg_controller over UDP.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/running_program.hpp"
#include "folders.hpp"
#include "io/clock.hpp"
#include "io/private_network.hpp"
#include "io/raw_datagrams.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using io::Multicast;
using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

/// A program in the background, in the calling thread's network.
class Background {
 public:
  Background(const std::string& program, std::vector<std::string> arguments, const fs::path& output) {
    std::vector<char*> argv;
    arguments.insert(arguments.begin(), program);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      if (std::freopen(output.c_str(), "w", stdout) == nullptr ||
          std::freopen(output.c_str(), "a", stderr) == nullptr) {
        ::_exit(126);
      }
      ::execv((pmg::test::program_folder() + "/" + program).c_str(), argv.data());
      ::_exit(127);
    }
  }
  ~Background() {
    if (pid_ > 0) end(SIGKILL);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  bool running() {
    siginfo_t ended{};
    return ::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0;
  }
  int end(int signal) {
    ::kill(pid_, signal);
    return wait();
  }
  int wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

class OperatorApps : public testing::Test {
 protected:
  OperatorApps() { fs::create_directories(folder_); }
  ~OperatorApps() override { fs::remove_all(folder_); }

  test::Finished run(const std::string& command) { return test::run_in_shell(command, folder_); }
  std::unique_ptr<Background> controller(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--hal",    "sil",  "--robot",  "z1",
                                          "--policy", "none", "--gantry", "--no-realtime",
                                          "--name",   name,   "--log",    (folder_ / ("log_" + name)).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto started = std::make_unique<Background>("pmg_controller", arguments, folder_ / (name + ".txt"));
    EXPECT_EQ(run("pmg_watch --once --timeout 60 --robot " + name).exit_code, 0)
        << test::text_of(folder_ / (name + ".txt"));
    return started;
  }
  std::string mode_of(const std::string& name) {
    const test::Finished watch = run("pmg_watch --once --json --timeout 10 --robot " + name);
    return watch.exit_code == 0 ? nlohmann::json::parse(watch.out)["mode"].get<std::string>() : watch.err;
  }
  /// A host that pauses these processes for 0.2 s ends a walk; a longer pause ends in a fault, as it should.
  void stand_again(const std::string& name) {
    run("pmg_send reset --robot " + name);
    run("pmg_send stand --robot " + name);
  }
  /// Of two controllers that were just started: one gives way and says so, the other one runs and ends well.
  void expect_one_runs(Background& first, Background& second, const std::string& first_name,
                       const std::string& second_name, int attempt) {
    const auto speaks = [&](const std::string& name) {
      return test::text_of(folder_ / (name + ".txt")).find("mode: passive") != std::string::npos;
    };
    const auto decided = [&] {
      if (first.running() && second.running()) return speaks(first_name) && speaks(second_name);
      return speaks(first_name) || speaks(second_name) || (!first.running() && !second.running());
    };
    while (!decided()) ::usleep(10'000);
    const std::string shown =
        test::text_of(folder_ / (first_name + ".txt")) + test::text_of(folder_ / (second_name + ".txt"));
    ASSERT_NE(first.running(), second.running()) << "try " << attempt << ": " << shown;
    EXPECT_THAT(shown, HasSubstr("is already run by another controller")) << "try " << attempt;
    const bool first_runs = first.running();
    EXPECT_EQ((first_runs ? second : first).wait(), 2) << shown;
    EXPECT_EQ((first_runs ? first : second).end(SIGINT), 0) << shown;
  }
  /// A driver whose commands make the robot walk.
  std::unique_ptr<Background> walking_driver(const std::string& name) {
    for (int attempt = 0; attempt < 5; ++attempt) {
      auto driver = std::make_unique<Background>(
          "pmg_send", std::vector<std::string>{"walk", "--vx", "0.2", "--for", "100", "--robot", name},
          folder_ / "driver.txt");
      std::string mode;
      while (mode != "walk" && mode != "fault" && driver->running()) mode = mode_of(name);
      if (mode == "walk") return driver;
      driver->end(SIGINT);
      stand_again(name);
    }
    ADD_FAILURE() << name << " doesn't walk; " << test::text_of(folder_ / "driver.txt");
    return std::make_unique<Background>("pmg_send", std::vector<std::string>{"--help"}, folder_ / "driver.txt");
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_operator_apps_test_" + std::to_string(getpid()));
};

TEST_F(OperatorApps, HelpHasAnExampleAndTheExitCodes) {
  for (const char* app : {"pmg_send", "pmg_watch"}) {
    const test::Finished help = run(std::string(app) + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, AllOf(HasSubstr("Examples:"), HasSubstr("Exit codes: 0")));
  }
}

TEST_F(OperatorApps, BadInputIsRefused) {
  for (const auto& [command, complaint] : {
           std::pair{"pmg_send", "a command is missing"},
           std::pair{"pmg_send fly", "fly: unknown command"},
           std::pair{"pmg_send walk --vx 0.3", "--for is missing"},
           std::pair{"pmg_send walk --vx fast --for 1", "--vx"},
           std::pair{"pmg_send walk --vx nan --for 1", "'nan' isn't a finite number"},
           std::pair{"pmg_send walk --for -1", "--for"},
           std::pair{"pmg_send stop --timeout 0", "--timeout"},
           std::pair{"pmg_send stop --lcm-url udpm://10.0.0.1:7667", "expected a multicast group"},
           std::pair{"pmg_send arms --for 1", "expected --left or --right, or --hand-back"},
           std::pair{"pmg_send arms --hand-back --left 0.3 0.2 0.1 --for 1", "--hand-back alone"},
           std::pair{"pmg_send arms --left 0.3 0.2 0.1", "--for is missing"},
           std::pair{"pmg_send arms --left nan 0.2 0.1 --for 1", "'nan' isn't a number from -10 to 10"},
           std::pair{"pmg_send arms --right 1e300 0.2 0.1 --for 1", "'1e300' isn't a number from -10 to 10"},
           std::pair{"pmg_send arms --right 0.3 0.2 0.1 0.5 --for 1", "--right: 4 numbers; expected X Y Z"},
           std::pair{"pmg_watch --lcm-url file:///tmp/log", "expected udpm://GROUP:PORT"},
           std::pair{"pmg_watch --timeout never", "--timeout"},
       }) {
    const test::Finished refused = run(command);
    EXPECT_EQ(refused.exit_code, 2) << command;
    EXPECT_THAT(refused.err + refused.out, HasSubstr(complaint)) << command;
  }
}

TEST_F(OperatorApps, WithoutAMulticastRouteTheWayOutIsSaid) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kNone, [&] {
    for (const char* app : {"pmg_send stop", "pmg_watch --once"}) {
      const test::Finished failed = run(app);
      EXPECT_EQ(failed.exit_code, 2);
      EXPECT_THAT(failed.err, HasSubstr("ip route add 224.0.0.0/4 dev lo"));
      EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    }
  });
}

TEST_F(OperatorApps, WithoutAControllerThatIsSaid) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    for (const char* command :
         {"pmg_send stop --timeout 0.3", "pmg_send stand --timeout 0.3", "pmg_send lift --timeout 0.3",
          "pmg_send walk --vx 0.2 --for 1 --timeout 0.3", "pmg_watch --once --timeout 0.3"}) {
      const test::Finished unheard = run(command);
      EXPECT_EQ(unheard.exit_code, 1) << command;
      EXPECT_THAT(unheard.err,
                  HasSubstr("no controller is heard on udpm://239.255.76.67:7667?ttl=0; start pmg_controller"))
          << command;
    }
    const test::Finished asked = run("pmg_send stand --json --timeout 0.3");
    EXPECT_EQ(asked.exit_code, 1);
    EXPECT_THAT(nlohmann::json::parse(asked.out)["text"].get<std::string>(),
                HasSubstr("no controller is heard on udpm://239.255.76.67:7667?ttl=0; start pmg_controller"));
    const test::Finished named = run("pmg_send stand --robot z9 --timeout 0.3");
    EXPECT_EQ(named.exit_code, 1);
    EXPECT_THAT(named.err, AllOf(HasSubstr("no controller of this name answers"), HasSubstr("; start pmg_controller")));
  });
}

TEST_F(OperatorApps, ARealControllerStandsWalksAndStops) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto robot = controller("z1");
    EXPECT_EQ(mode_of("z1"), "passive");

    const test::Finished stand = run("pmg_send stand --json");
    EXPECT_EQ(stand.exit_code, 0) << stand.out << stand.err;
    const auto answer = nlohmann::json::parse(stand.out);
    EXPECT_EQ(answer["robots"][0]["robot"], "z1");
    EXPECT_EQ(answer["robots"][0]["acknowledged"], true);
    EXPECT_EQ(answer["robots"][0]["mode"], "stand");

    test::Finished walk;
    for (int attempt = 0; attempt < 5 && walk.exit_code != 0; ++attempt) {
      if (attempt > 0) stand_again("z1");
      walk = run("pmg_send walk --vx 0.2 --for 0.5");
    }
    EXPECT_EQ(walk.exit_code, 0) << walk.err;
    EXPECT_THAT(walk.out, HasSubstr("z1: stand (drove for 0.5 s)"));
    walk = run("pmg_send walk --vx 50 --for 0.5");
    EXPECT_THAT(walk.out + walk.err, HasSubstr("; limited: vx 50 -> ")) << "in its last words";

    const std::unique_ptr<Background> driver = walking_driver("z1");
    const test::Finished stop = run("pmg_send stop");
    EXPECT_EQ(stop.exit_code, 0) << stop.err;
    EXPECT_THAT(stop.out, MatchesRegex("z1: damping; acknowledged after [0-9]+ ms, damping known after [0-9]+ ms\n"));
    EXPECT_EQ(driver->wait(), 1) << "the driver is told that somebody stopped it";
    EXPECT_EQ(mode_of("z1"), "damping");
    EXPECT_EQ(robot->end(SIGINT), 0);
  });
}

TEST_F(OperatorApps, ARealControllersArmsAreLedHeldInStandAndHandedBack) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto robot = controller("z1");
    const auto arms = [&] { return nlohmann::json::parse(run("pmg_watch --once --json --timeout 10").out).at("arms"); };
    const auto send = [&](const std::string& what) {
      test::Finished sent;
      for (int attempt = 0; attempt < 5 && sent.exit_code != 0; ++attempt) {
        if (attempt > 0) stand_again("z1");
        sent = run("pmg_send arms " + what);
      }
      return sent;
    };
    EXPECT_EQ(arms().at("left").at("activity"), "reference");
    const std::vector<double> rest = arms().at("right").at("p_m");
    const test::Finished led = send("--right " + std::to_string(rest[0] + 0.1) + " " + std::to_string(rest[1]) + " " +
                                    std::to_string(rest[2] + 0.1) + " --for 2");
    EXPECT_EQ(led.exit_code, 0) << led.err;
    EXPECT_THAT(led.out, HasSubstr("right arm: at its target"));
    EXPECT_EQ(arms().at("right").at("activity"), "held");
    EXPECT_EQ(arms().at("left").at("activity"), "reference");
    EXPECT_EQ(arms().at("order"), "not_walking");
    EXPECT_THAT(run("pmg_watch --once").out, HasSubstr("the robot doesn't walk: arms are led in walk only"));

    const test::Finished far = run("pmg_send arms --right 3 0 0 --for 1");
    EXPECT_EQ(far.exit_code, 1);
    EXPECT_THAT(far.err, HasSubstr("from its target"));
    const test::Finished back = send("--hand-back --for 3");
    EXPECT_EQ(back.exit_code, 0) << back.err;
    EXPECT_EQ(arms().at("right").at("activity"), "reference");
    EXPECT_EQ(robot->end(SIGINT), 0);
  });
}

TEST_F(OperatorApps, AnInjectedFailureOfTheSimulatedRobotIsReportedBesideThePromise) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const fs::path file = folder_ / "failures.yaml";
    std::ofstream(file) << "failures:\n  - {kind: hot, at_s: 3.0, for_s: 100.0, joint: left_knee, value: 95.0}\n";
    test::Finished damping;
    std::string shown, mode;
    // A host that pauses the controller for longer than it can bear ends it in a fault of timing: then once more.
    for (int attempt = 0; attempt < 5; ++attempt) {
      const auto robot = controller("z1", {"--inject", file.string()});
      damping = run("pmg_send damping");
      const io::WallClock clock;
      const std::int64_t end_ns = clock.now_ns() + 60'000'000'000;
      while (mode = mode_of("z1"), mode != "fault" && clock.now_ns() < end_ns) {
      }
      EXPECT_EQ(robot->end(SIGINT), 0);
      shown = test::text_of(folder_ / "z1.txt");
      if (shown.find("FAULT") == shown.find("FAULT, damping: temperature")) break;
    }
    EXPECT_EQ(damping.exit_code, 0);
    EXPECT_EQ(mode, "fault");
    EXPECT_THAT(shown, AllOf(HasSubstr("injected: hot at 3 s: temperature; "), HasSubstr("(promised 501 to 505)")));
  });
}

TEST_F(OperatorApps, FailuresAreInjectedIntoSimulatedDrivesOnly) {
  const test::Finished refused = run("pmg_controller --hal can --inject failures.yaml --lcm-url memq:// --no-log");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--inject spoils simulated drives; expected --hal sil"));
}

TEST_F(OperatorApps, AnInterruptedWalkIsBroughtToRest) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto robot = controller("z1");
    const std::unique_ptr<Background> driver = walking_driver("z1");
    EXPECT_EQ(driver->end(SIGINT), 130);
    EXPECT_EQ(mode_of("z1"), "stand") << "brought to rest, not dropped; " << test::text_of(folder_ / "driver.txt");
  });
}

TEST_F(OperatorApps, TwoControllersNeedTwoNamesAndOneStopReachesBoth) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto first = controller("first");
    const test::Finished refused =
        run("pmg_controller --hal sil --gantry --no-realtime --name first --log " + (folder_ / "x").string());
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("\"first\" is already run by another controller"), HasSubstr("--name")));

    const auto second = controller("second");
    const test::Finished unclear = run("pmg_send stand");
    EXPECT_EQ(unclear.exit_code, 2);
    EXPECT_THAT(unclear.err, HasSubstr("several robots are heard (first, second)"));
    EXPECT_EQ(run("pmg_send stand --robot first").exit_code, 0);
    EXPECT_EQ(run("pmg_send stand --robot second").exit_code, 0);
    const test::Finished stop = run("pmg_send stop");
    EXPECT_EQ(stop.exit_code, 0) << stop.err;
    EXPECT_THAT(stop.out, AllOf(HasSubstr("first: damping"), HasSubstr("second: damping")));
  });
}

constexpr const char* kNetwork = "udpm://239.255.76.67:7667?ttl=1";

/// Two controllers of the default name and network, started at the same moment; how many run.
TEST_F(OperatorApps, OfTwoControllersStartedTogetherExactlyOneRuns) {
  const char* tries = std::getenv("PMG_CLAIM_TRIES");  // 50 for the campaign
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    for (int k = 0; k < (tries != nullptr ? std::atoi(tries) : 2); ++k) {
      const auto start = [&](const std::string& number) {
        const std::string log = (folder_ / ("log" + number)).string();
        return std::make_unique<Background>(
            "pmg_controller",
            std::vector<std::string>{"--hal", "sil", "--policy", "none", "--gantry", "--no-realtime", "--log", log},
            folder_ / (number + ".txt"));
      };
      const auto first = start("1"), second = start("2");
      expect_one_runs(*first, *second, "1", "2", k);
    }
  });
}

/// The same on two computers, whose locks know nothing of each other: claims over the wire decide, signed by the one
/// key that both have.
TEST_F(OperatorApps, OfTwoControllersOnTwoComputersExactlyOneRuns) {
  const char* tries = std::getenv("PMG_CLAIM_TRIES");
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const io::SecondComputer other;
    if (!other.wired()) {
      GTEST_SKIP() << "NOT TESTED: the kernel makes no virtual wire (ip link add ... type veth)";
    }
    const std::string keys = (folder_ / "keys").string();
    EXPECT_EQ(run("pmg_key new anna --keys " + keys + " --out " + (folder_ / "anna.key").string()).exit_code, 0);
    for (int k = 0; k < (tries != nullptr ? std::atoi(tries) : 2); ++k) {
      const auto start = [&](const std::string& number) {
        const std::string log = (folder_ / ("log" + number)).string();
        return std::make_unique<Background>(
            "pmg_controller",
            std::vector<std::string>{"--hal", "sil", "--policy", "none", "--gantry", "--no-realtime", "--lcm-url",
                                     kNetwork, "--keys", keys, "--log", log},
            folder_ / (number + ".txt"));
      };
      std::unique_ptr<Background> there;
      other.inside([&] { there = start("there"); });
      const auto here = start("here");
      expect_one_runs(*here, *there, "here", "there", k);
    }
  });
}

TEST_F(OperatorApps, OnANetworkNobodyDrivesWhoHasNoKey) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const std::string keys = (folder_ / "controller").string(), anna = (folder_ / "anna").string(),
                      bert = (folder_ / "bert").string(), url = std::string(" --lcm-url '") + kNetwork + "'";
    const std::string start = "pmg_controller --hal sil --policy none --gantry --no-realtime --duration 0.1 --log " +
                              (folder_ / "x").string() + url;
    ::setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1);
    const test::Finished refused = run(start);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("pmg_key new"), HasSubstr("--insecure-without-keys")));
    const test::Finished insecure = run(start + " --insecure-without-keys");
    EXPECT_EQ(insecure.exit_code, 0) << insecure.err;
    EXPECT_THAT(insecure.err, HasSubstr("INSECURE: without keys everybody"));

    for (const std::string& folder : {anna, bert}) {
      fs::create_directories(folder);
      std::string make_key = "pmg_key new --keys ";
      make_key.append(keys).append(" ").append(fs::path(folder).filename()).append(" --out ").append(folder);
      const test::Finished made = run(make_key.append("/z1.key"));
      EXPECT_EQ(made.exit_code, 0) << made.err;
    }
    EXPECT_EQ(run("pmg_key list --keys " + keys).out, "anna\nbert\n");
    Background robot("pmg_controller",
                     {"--hal", "sil", "--policy", "none", "--gantry", "--no-realtime", "--lcm-url", kNetwork, "--keys",
                      keys, "--log", (folder_ / "log").string()},
                     folder_ / "z1.txt");
    EXPECT_EQ(run("pmg_watch --once --timeout 60 --robot z1 --keys " + anna + url).exit_code, 0)
        << test::text_of(folder_ / "z1.txt");

    const test::Finished stranger = run("pmg_send stand --timeout 1" + url);
    EXPECT_EQ(stranger.exit_code, 1);
    EXPECT_THAT(stranger.err, HasSubstr("it takes only operators with a key"));
    const test::Finished stand = run("pmg_send stand --keys " + anna + url);
    EXPECT_EQ(stand.exit_code, 0) << stand.err;
    const test::Finished stop = run("pmg_send stop" + url);
    EXPECT_EQ(stop.exit_code, 0) << "a stop needs no key: " << stop.err;
    EXPECT_THAT(stop.out, MatchesRegex("z1: damping; acknowledged after [0-9]+ ms, damping known after [0-9]+ ms\n"));

    EXPECT_EQ(run("pmg_key revoke --keys " + keys + " anna").exit_code, 0);
    EXPECT_EQ(run("pmg_key revoke --keys " + keys + " anna").exit_code, 1);
    const std::string stand_by_anna = "pmg_send stand --timeout 4 --keys " + anna + url;
    int revoked = 0;
    for (int k = 0; k < 100 && revoked == 0; ++k) {  // the controller looks once a second
      EXPECT_EQ(run("pmg_send stop" + url).exit_code, 0);
      revoked = run(stand_by_anna).exit_code;
    }
    EXPECT_EQ(revoked, 1);
    EXPECT_EQ(run("pmg_send stand --keys " + bert + url).exit_code, 0);
    EXPECT_EQ(robot.end(SIGINT), 0);
    ::unsetenv("XDG_CONFIG_HOME");
  });
}

TEST_F(OperatorApps, BadKeysAreRefusedInOneLine) {
  fs::create_directories(folder_ / "keys");
  std::ofstream(folder_ / "keys" / "z1.key") << "not a key\n";
  ::chmod((folder_ / "keys" / "z1.key").c_str(), 0600);
  const std::string keys = " --keys " + (folder_ / "keys").string(), missing = " --keys " + (folder_ / "none").string();
  for (const auto& [command, complaint] : {
           std::pair{"pmg_key", std::string("a command is missing")},
           std::pair{"pmg_key new ../anna", std::string("expected 1 to 15 letters")},
           std::pair{"pmg_key new", std::string("NAME")},
       }) {
    const test::Finished refused =
        run(std::string(command) + (command == std::string("pmg_key new ../anna") ? " --out x" : ""));
    EXPECT_EQ(refused.exit_code, 2) << command;
    EXPECT_THAT(refused.err + refused.out, HasSubstr(complaint)) << command;
  }
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    for (const std::string& command :
         {"pmg_send stand" + keys, "pmg_watch --once" + keys, "pmg_send stand" + missing}) {
      const test::Finished refused = run(command);
      EXPECT_EQ(refused.exit_code, 2) << command;
      EXPECT_THAT(refused.err, HasSubstr(".key")) << command;
      EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    }
  });
}

TEST_F(OperatorApps, AStopGoesOutWhateverTheKeysAre) {
  fs::create_directories(folder_ / "keys");
  std::ofstream(folder_ / "keys" / "z1.key") << "not a key\n";
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto robot = controller("z1");
    EXPECT_EQ(run("pmg_send stand").exit_code, 0);
    const test::Finished stop = run("pmg_send stop --keys " + (folder_ / "keys").string());
    EXPECT_EQ(stop.exit_code, 0) << stop.err;
    EXPECT_THAT(stop.out, testing::StartsWith("z1: damping; acknowledged after "));
    EXPECT_THAT(stop.err, AllOf(HasSubstr("z1.key"), HasSubstr("the stop goes out without a key")));
    EXPECT_EQ(mode_of("z1"), "damping");
  });
}

/// Everything on LCM's default group, as somebody records it who means to play it back.
class Eavesdropper {
 public:
  Eavesdropper() {
    const int yes = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    const int buffer = 1 << 22;
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &buffer, sizeof(buffer));
    const sockaddr_in group = io::default_group();
    const sockaddr any = io::any_address(group);
    EXPECT_EQ(::bind(socket_, &any, sizeof(any)), 0);
    ip_mreq membership{};
    membership.imr_multiaddr = group.sin_addr;
    EXPECT_EQ(::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)), 0);
  }
  ~Eavesdropper() { ::close(socket_); }
  Eavesdropper(const Eavesdropper&) = delete;
  Eavesdropper& operator=(const Eavesdropper&) = delete;

  /// The operators' datagrams of these channels that came since the last call.
  std::vector<std::string> recorded() {
    std::vector<std::string> all;
    std::vector<char> buffer(65536);
    for (ssize_t size = 0; (size = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT)) > 0;) {
      const std::string datagram(buffer.data(), static_cast<std::size_t>(size));
      const std::string channel = datagram.size() > 8 ? std::string(datagram.c_str() + 8) : "";
      if (channel == "COMMAND" || channel == "MODE") all.push_back(datagram);
    }
    return all;
  }

 private:
  int socket_ = ::socket(AF_INET, SOCK_DGRAM, 0);
};

TEST_F(OperatorApps, ARecordedSessionMovesNoRobot) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    Eavesdropper eavesdropper;
    std::vector<std::string> recorded;
    const auto play = [&] {
      for (const std::string& datagram : recorded) {
        io::send_datagrams({datagram});
        ::usleep(4000);  // slower than the rate limit
      }
    };
    {
      const auto robot = controller("z1");
      EXPECT_EQ(run("pmg_send stand").exit_code, 0);
      recorded = eavesdropper.recorded();
      ASSERT_GE(recorded.size(), 1u);
      EXPECT_EQ(run("pmg_send damping").exit_code, 0);
      for (int k = 0; k < 9; ++k) EXPECT_EQ(run("pmg_send stop").exit_code, 0);  // nine other names
      play();
      EXPECT_EQ(mode_of("z1"), "damping") << "after nine other names";
      EXPECT_EQ(robot->end(SIGINT), 0);
    }
    const auto robot = controller("z1");
    play();
    EXPECT_EQ(mode_of("z1"), "passive") << "after a restart of the controller";
  });
}

/// A fragment in LCM's wire format (io/lcm_assembler.hpp).
std::string fragment(std::uint32_t size, std::uint32_t offset, std::uint8_t index, const std::string& rest) {
  std::string bytes = "LC03";
  for (const std::uint32_t number : {std::uint32_t{1}, size, offset}) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(number >> shift & 0xff));
  }
  bytes += std::string{'\0', static_cast<char>(index), '\0', '\3'};
  return bytes + rest;
}

TEST_F(OperatorApps, NoDatagramEndsAProgram) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const auto robot = controller("z1");
    Background watch("pmg_watch", {"--json"}, folder_ / "watch.txt");
    Background stop("pmg_send", {"stop", "--robot", "nobody", "--timeout", "100"}, folder_ / "stop.txt");
    const auto lines = [&] {
      const std::string shown = test::text_of(folder_ / "watch.txt");
      return std::count(shown.begin(), shown.end(), '\n');
    };
    while (lines() < 2 && watch.running()) {
    }
    // An offset that wraps in 32 bits; names whose zero byte is outside the datagram, behind what an earlier one left.
    io::send_datagrams({fragment(1000, 0, 0, std::string("STATUS") + '\0' + "begin"),
                        fragment(1000, 0xFFFFFF00, 1, std::string(300, 'x'))});
    io::send_datagrams(std::vector<std::string>(20, "LC02    " + std::string(52, 'A') + '\0' + "rest"));
    io::send_datagrams({fragment(100, 41, 0, std::string(10, 'A')), "LC02    " + std::string(20, 'A')});
    const auto before = lines();
    while (lines() < before + 2 && watch.running()) {
    }
    EXPECT_TRUE(watch.running());
    EXPECT_TRUE(stop.running());
    EXPECT_TRUE(robot->running());
    EXPECT_EQ(robot->end(SIGINT), 0);
    EXPECT_EQ(watch.end(SIGINT), 0);
    EXPECT_EQ(stop.end(SIGINT), 130);
  });
}

}  // namespace
}  // namespace pmg
