// Names and texts that another program chose, through every program that shows them: none acts on a terminal, begins a
// line of its own or becomes a formula.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "apps/pseudo_terminal.hpp"
#include "apps/running_program.hpp"
#include "io/lcm_link.hpp"
#include "io/private_network.hpp"
#include "logs/log_surgery.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/link_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "pmg_msgs/status_t.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using io::Multicast;
using test::PseudoTerminal;
using test::RunningProgram;
using testing::HasSubstr;
using testing::Not;

const std::string kForeign = "=1+1\x1b]0;owned\a\n=2";  // a formula, a terminal's new title, a line that begins anew

void expect_harmless(const std::string& text, const std::string& where) {
  EXPECT_THAT(text, HasSubstr("owned")) << where << " shows the name";
  EXPECT_THAT(text, Not(HasSubstr("\n=2"))) << where;
  const auto acts = [](char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\n') || c == '\x7f'; };
  EXPECT_TRUE(std::ranges::none_of(text, acts)) << where << ": " << text;
}

/// The same for a program that draws on a terminal.
void expect_title_unchanged(const std::string& text, const std::string& where) {
  EXPECT_THAT(text, HasSubstr("owned")) << where << " shows the name";
  EXPECT_THAT(text, Not(HasSubstr("\x1b]0;"))) << where;
  EXPECT_THAT(text, Not(HasSubstr("\n=2"))) << where;
}

/// Controllers with such names, as far as operators' programs hear them.
class ForeignRobots {
 public:
  explicit ForeignRobots(int count)
      : thread_([count](const std::stop_token& stop) {
          io::LcmLink link("udpm://239.255.76.67:7667?ttl=0");
          pmg_msgs::status_t status{};
          pmg_msgs::robot_info_t info{};
          pmg_msgs::link_t counts{};
          status.driving_source = status.fault = kForeign;
          status.mode = pmg_msgs::mode_t::FAULT;
          info.model = info.software = info.policy = info.backend = info.bundle = kForeign;
          info.refused = {kForeign};
          info.refused_count = 1;
          while (!stop.stop_requested()) {
            for (int k = 0; k < count; ++k) {
              status.robot = info.robot = counts.robot = kForeign + std::to_string(k);
              status.stamp_ns += 1000;
              link.publish("STATUS", status);
              link.publish("ROBOT_INFO", info);
              link.publish("LINK", counts);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
          }
        }) {}

 private:
  std::jthread thread_;
};

class ForeignText : public testing::Test {
 protected:
  ForeignText() { fs::create_directories(folder_); }
  ~ForeignText() override { fs::remove_all(folder_); }

  test::Finished run(const std::string& name, const std::vector<std::string>& arguments) const {
    RunningProgram program(name, arguments, folder_);
    return program.finish();
  }
  std::string shown(const std::string& name, const std::vector<std::string>& arguments) const {
    const test::Finished finished = run(name, arguments);
    return finished.out + finished.err;
  }
  /// The committed log with such names; everywhere, or only where controllers' and operators' names change.
  fs::path foreign_log(bool everywhere) const {
    const fs::path log = folder_ / (everywhere ? "all.lcm" : "some.lcm");
    test::copy_log(test::kCommittedLog, log, [&](test::LogEvent& event) {
      const auto change = [&]<typename Message>(auto... texts) {
        auto message = event.as<Message>();
        ((message.*texts = kForeign), ...);
        event.set(message);
      };
      using pmg_msgs::status_t, pmg_msgs::robot_info_t;
      if (event.channel == "STATUS") change.operator()<status_t>(&status_t::driving_source, &status_t::fault);
      if (event.channel == "FAULT") change.operator()<pmg_msgs::fault_t>(&pmg_msgs::fault_t::text);
      if (event.channel == "COMMAND" && everywhere) {
        change.operator()<pmg_msgs::command_t>(&pmg_msgs::command_t::source);
      }
      if (event.channel == "MODE" && everywhere) change.operator()<pmg_msgs::mode_t>(&pmg_msgs::mode_t::source);
      if (event.channel != "ROBOT_INFO" || !everywhere) return true;
      auto info = event.as<robot_info_t>();
      for (std::string& name : info.joint_names) name.insert(0, kForeign);
      for (std::string& file : info.bundle_file) file = kForeign;
      info.refused = {kForeign};
      info.refused_count = 1;
      event.set(info);
      change.operator()<robot_info_t>(&robot_info_t::robot, &robot_info_t::model, &robot_info_t::software,
                                      &robot_info_t::policy, &robot_info_t::backend, &robot_info_t::bundle);
      return true;
    });
    if (everywhere) append_more(log);
    return log;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("pmg_foreign_text_test_" + std::to_string(getpid()));

 private:
  /// A channel with such a name, and a scenario's step.
  static void append_more(const fs::path& log) {
    const std::vector<test::LogEvent> events = test::read_events(log);
    io::LogWriter writer(log);
    pmg_msgs::scenario_step_t step{};
    step.scenario = step.text = kForeign;
    for (const test::LogEvent& event : events) {
      writer.write(event.channel, event.stamp_ns, event);
      if (event.channel != "ROBOT_INFO") continue;
      writer.write("SCENARIO", event.stamp_ns, step);
      writer.write("\x1b]0;owned\a", event.stamp_ns, step);
    }
  }
};

TEST_F(ForeignText, OperatorsProgramsShowItPlain) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    for (const int count : {1, 2}) {
      const ForeignRobots robots(count);
      const std::string of = " of " + std::to_string(count);
      expect_harmless(shown("pmg_watch", {"--once"}), "pmg_watch" + of);
      expect_harmless(shown("pmg_watch", {"--once", "--json"}), "pmg_watch --json" + of);
      expect_harmless(shown("pmg_send", {"stand", "--timeout", "0.5"}), "pmg_send stand" + of);
      expect_harmless(shown("pmg_send", {"stop", "--timeout", "0.5"}), "pmg_send stop" + of);
      expect_harmless(shown("pmg_send", {"stop", "--timeout", "0.5", "--json"}), "pmg_send --json" + of);
      for (const char* drawing : {"pmg_watch", "pmg_keyboard"}) {
        PseudoTerminal terminal(drawing, {});
        const auto shows = [&] { return terminal.text().find("owned") != std::string::npos; };
        for (int k = 0; k < 500 && !shows(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        terminal.send(SIGINT);
        terminal.wait();
        expect_title_unchanged(terminal.text(), drawing + of);
      }
    }
  });
}

TEST_F(ForeignText, ControllersShowItPlain) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    const test::Finished finished =
        run("pmg_controller", {"--hal", "sil", "--policy", "none", "--gantry", "--no-realtime", "--duration", "0.1",
                               "--json", "--name", kForeign, "--log", (folder_ / "log").string()});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    expect_harmless(finished.out, "pmg_controller --json");
    expect_harmless(finished.err, "pmg_controller");
  });
}

TEST_F(ForeignText, LogsAreShownPlain) {
  const fs::path all = foreign_log(true), some = foreign_log(false);
  for (const std::string& log : {all.string(), some.string()}) {
    expect_harmless(shown("pmg_log", {"info", log}), "pmg_log info");
    expect_harmless(shown("pmg_log", {"info", log, "--json"}), "pmg_log info --json");
    expect_harmless(shown("pmg_log", {"replay", log}), "pmg_log replay");
    const std::string page = (folder_ / "page.html").string();
    expect_harmless(shown("pmg_report", {log, "--out", page}), "pmg_report");
    expect_harmless(shown("pmg_report", {log, "--out", page, "--json"}), "pmg_report --json");
    expect_title_unchanged(test::text_of(page), "the report");  // its script has tabs of its own
  }
  expect_harmless(shown("pmg_log", {"replay", some.string(), "--json"}), "pmg_log replay --json");
}

TEST_F(ForeignText, NoExportedCellIsAFormula) {
  const fs::path tables = folder_ / "csv";
  EXPECT_EQ(run("pmg_log", {"export", foreign_log(true).string(), "--csv", tables.string()}).exit_code, 0);
  for (const char* channel : {"ROBOT_INFO", "STATUS", "FAULT", "COMMAND", "MODE", "STATE", "SCENARIO"}) {
    const std::string table = test::text_of(tables / (std::string(channel) + ".csv"));
    expect_harmless(table, channel);
    for (const char* formula : {",=", "\"=", "\n="}) EXPECT_THAT(table, Not(HasSubstr(formula))) << channel;
  }
}

}  // namespace
}  // namespace pmg
