#include "report/run_series.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "report/measured_command.hpp"
#include "report/run_figures.hpp"
#include "small_log.hpp"
#include "temporary_folder.hpp"

namespace pmg::report {
namespace {

namespace fs = std::filesystem;
using test::SmallLog;
using testing::Contains;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

class RunSeriesTest : public testing::Test {
 protected:
  RunSeriesTest() { fs::create_directories(folder_); }

  fs::path write(const SmallLog& log, const std::string& name = "log.lcm") const {
    log.write(folder_ / name);
    return folder_ / name;
  }
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("run");
};

TEST_F(RunSeriesTest, HoldsEveryTickOfEveryChannelFromTheLogsBeginning) {
  const RunSeries run = read_run(write({}));
  EXPECT_TRUE(run.identified);
  EXPECT_EQ(run.info.robot, "tiny");
  EXPECT_THAT(run.joint_names, ElementsAre("left_joint", "right_joint"));
  for (const auto& t_s : {run.state.t_s, run.reference.t_s, run.status.t_s, run.truth.t_s}) {
    ASSERT_EQ(t_s.size(), 300U);
    EXPECT_EQ(t_s.front(), 0.0);
    EXPECT_NEAR(t_s.back(), 2.99, 1e-9);
  }
  EXPECT_NEAR(run.duration_s, 2.99, 1e-9);
  EXPECT_THAT(run.modes,
              ElementsAre(Field(&RunSeries::Stretch::text, "stand"), Field(&RunSeries::Stretch::text, "walk")));
  EXPECT_NEAR(run.modes[1].from_s, 1.0, 1e-9);
  EXPECT_THAT(run.sources, ElementsAre(Field(&RunSeries::Stretch::text, "tester")));
  EXPECT_THAT(run.faults, IsEmpty());
  EXPECT_THAT(run.problems, IsEmpty());
  EXPECT_FALSE(run.fell);
}

TEST_F(RunSeriesTest, TellsAFaultInWordsOnce) {
  const RunSeries run = read_run(write({.fault_at = 250}));
  ASSERT_EQ(run.faults.size(), 1U);
  EXPECT_THAT(run.faults[0].text, HasSubstr("leans 1.20 rad"));
  EXPECT_NEAR(run.faults[0].t_s, 2.5, 1e-9);
  EXPECT_THAT(verdict(run), testing::AllOf(HasSubstr("FAULT at 2.50 s"), HasSubstr("leans 1.20 rad")));
}

TEST_F(RunSeriesTest, TakesAFaultFromTheStatusWhenItsMessageIsLost) {
  const RunSeries run = read_run(write({.fault_at = 0, .left_out = {"FAULT"}}));
  ASSERT_EQ(run.faults.size(), 1U);
  EXPECT_THAT(run.faults[0].text, HasSubstr("leans 1.20 rad"));
}

TEST_F(RunSeriesTest, TakesAnAnnouncedFaultAtItsOwnTime) {
  const RunSeries run = read_run(write({.fault_at = 250, .announced = true}));
  ASSERT_EQ(run.faults.size(), 1U);
  EXPECT_NEAR(run.faults[0].t_s, 2.5, 1e-9);
}

TEST_F(RunSeriesTest, ClaimsNoFaultOnlyWhereALogWouldTellOne) {
  EXPECT_THAT(verdict(read_run(write({}))), HasSubstr("No fault"));
  EXPECT_THAT(verdict(read_run(write({.left_out = {"STATUS"}}))), HasSubstr("unknown"));
}

TEST_F(RunSeriesTest, SeesAFall) {
  const RunSeries run = read_run(write({.falls_at = 120}));
  EXPECT_TRUE(run.fell);
  EXPECT_NEAR(run.fell_at_s, 1.2, 1e-9);
  EXPECT_THAT(verdict(run), HasSubstr("FELL at 1.20 s"));
}

TEST_F(RunSeriesTest, FiguresMatchTheLog) {
  const RunSeries run = read_run(write({.fault_at = 290}));
  const auto& tracking = run.joint_tracking;
  ASSERT_EQ(tracking.size(), 2U);
  EXPECT_NEAR(tracking[0].error_rms_rad, 0.1, 1e-9);
  EXPECT_NEAR(tracking[1].error_rms_rad, 0.0, 1e-6);
  EXPECT_NEAR(tracking[0].torque_max_Nm, 12.5, 1e-6);
  EXPECT_NEAR(run.reference_slip.before_mean_m_s, 0.08, 1e-12) << "standing does not dilute it";
  EXPECT_NEAR(run.reference_slip.after_mean_m_s, 0.02, 1e-12);
  EXPECT_NEAR(run.truth.measured[kVx].back(), 0.5, 1e-12);
  EXPECT_NEAR(run.truth.measured[kHeight].back(), 0.0, 1e-12);
}

TEST_F(RunSeriesTest, NamesTheJointThatWasLimitedAndWhen) {
  const RunSeries run = read_run(write({}));
  ASSERT_EQ(run.limited.size(), 1U);
  EXPECT_EQ(run.joint_names[run.limited[0].joint], "right_joint");
  EXPECT_EQ(run.limited[0].reasons(), "speed in 10 ticks");
  ASSERT_EQ(run.limited[0].stretches.size(), 1U) << "ticks that follow each other are one stretch";
  EXPECT_NEAR(run.limited[0].stretches[0].from_s, 1.5, 1e-9);
  EXPECT_NEAR(run.limited[0].longest_s, 0.1, 1e-9);
  EXPECT_THAT(verdict(run), HasSubstr("Limited: right_joint by speed in 10 ticks, first at 1.50 s."));
  EXPECT_THAT(verdict(read_run(write({.left_out = {"LIMITED"}}))), testing::Not(HasSubstr("Limited:")));
}

TEST_F(RunSeriesTest, KnowsTheScenariosStepsAndTheErrorsWithinEach) {
  const RunSeries run = read_run(write({.measured_vx_m_s = 0.4}));
  EXPECT_EQ(run.scenario, "small");
  ASSERT_EQ(run.steps.size(), 3U);
  EXPECT_EQ(run.steps[1].text, "walk forward");
  EXPECT_NEAR(run.steps[1].from_s, 1.0, 1e-9);
  EXPECT_NEAR(run.steps[1].to_s, 2.0, 1e-9);
  EXPECT_NEAR(run.steps[0].tracking.lin_vel_mae_m_s, 0.4, 1e-9) << "it drifts while it should stand";
  EXPECT_NEAR(run.steps[2].tracking.lin_vel_mae_m_s, 0.1, 1e-9);
  EXPECT_NEAR(run.tracking.followed_s, 3.0, 1e-9);
  EXPECT_THAT(verdict(run), HasSubstr("Mean absolute errors over 3.0 s on its own feet: velocity 0."));
}

TEST_F(RunSeriesTest, TheAgeOfAStateIsThatAtItsTick) {
  const RunSeries run = read_run(write({}));
  EXPECT_THAT(run.timing.state_age_us.values(), Each(DoubleNear(3000.0, 1e-6)));
  EXPECT_EQ(run.timing.state_age_us.values().size(), 300U);
}

TEST_F(RunSeriesTest, AnyChannelMayBeMissing) {
  for (const char* channel : {"ROBOT_INFO", "STATE", "TICK", "REFERENCE", "STATUS", "TIMING", "GROUND_TRUTH"}) {
    const RunSeries run = read_run(write({.left_out = {channel}}));
    EXPECT_EQ(run.joint_names.size(), 2U) << channel;
    EXPECT_NEAR(run.duration_s, 2.99, 1e-9) << channel;
    run_json(run);
    verdict(run);
  }
  EXPECT_THAT(read_run(write({.left_out = {"ROBOT_INFO"}})).problems, Contains(HasSubstr("who ran what is unknown")));
}

TEST_F(RunSeriesTest, AnotherFileOfTheRunsFolderIsRefusedWithTheLogsName) {
  const fs::path log = write({}), other = log.parent_path() / "summary.json";
  if (log.filename() != "log.lcm") fs::rename(log, log.parent_path() / "log.lcm");
  std::ofstream(other) << "{}";
  try {
    read_run(other);
    FAIL() << "it has no ticks";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean " + (log.parent_path() / "log.lcm").string() + "?"));
  }
}

TEST_F(RunSeriesTest, ReadsWhatIsThereOfALogThatIsCutShort) {
  const fs::path log = write({});
  const auto whole = fs::file_size(log);
  fs::resize_file(log, whole / 2 + 13);
  const RunSeries run = read_run(log);
  EXPECT_NEAR(run.duration_s, 1.5, 0.05);
  EXPECT_THAT(run.problems, Contains(HasSubstr("its end is missing")));
}

TEST_F(RunSeriesTest, ReadsOnOverDamage) {
  const fs::path log = write({});
  std::fstream file(log, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(log) / 2));
  file << std::string(5000, '\x7f');
  file.close();
  const RunSeries run = read_run(log);
  EXPECT_NEAR(run.duration_s, 2.99, 1e-9);
  EXPECT_GT(run.status.t_s.size(), 250U);
  EXPECT_THAT(run.problems, Contains(HasSubstr("damaged")));
}

TEST_F(RunSeriesTest, RefusesWhatIsNoLogInOneLine) {
  const auto refusal = [](const fs::path& log) -> std::string {
    try {
      read_run(log);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(folder_ / "none.lcm"), HasSubstr("there is no such file"));
  EXPECT_THAT(refusal(folder_), HasSubstr("no log in this folder"));
  std::ofstream(folder_ / "text.lcm") << std::string(100000, 'x');
  EXPECT_THAT(refusal(folder_ / "text.lcm"), HasSubstr("no log of a run"));
  std::ofstream(folder_ / "empty.lcm").flush();
  EXPECT_THAT(refusal(folder_ / "empty.lcm"), HasSubstr("no log of a run"));
}

TEST_F(RunSeriesTest, TakesTheFilesOfAFolderAsOneRun) {
  write({.ticks = 100}, "log-0000.lcm");
  write({.ticks = 100, .start_ns = 6'000'000'000}, "log-0001.lcm");
  write({.ticks = 7, .start_ns = 9'000'000'000}, "fault-something.lcm");
  const RunSeries run = read_run(folder_);
  EXPECT_EQ(run.state.t_s.size(), 200U);
  EXPECT_NEAR(run.duration_s, 1.99, 1e-9);
}

TEST_F(RunSeriesTest, OfSeveralRunsTheLastOneIsShown) {
  write({.ticks = 100}, "log-0000.lcm");
  write({.robot = "other", .ticks = 50, .start_ns = 9'000'000'000}, "log-0001.lcm");
  write({.robot = "other", .ticks = 80, .start_ns = 1'000'000'000}, "log-0002.lcm");  // its clock starts again
  const RunSeries run = read_run(folder_);
  EXPECT_EQ(run.info.robot, "other");
  EXPECT_EQ(run.state.t_s.size(), 80U);
  EXPECT_NEAR(run.duration_s, 0.79, 1e-9);
  EXPECT_THAT(run.problems, ElementsAre(HasSubstr("2 earlier runs")));
}

TEST_F(RunSeriesTest, SkipsMessagesThatRunBackInTimeAndSaysSo) {
  write({.ticks = 100}, "log-0000.lcm");
  write({.ticks = 100, .left_out = {"ROBOT_INFO"}, .start_ns = 1'000'000'000}, "log-0001.lcm");
  const RunSeries run = read_run(folder_);
  EXPECT_EQ(run.state.t_s.size(), 100U);
  EXPECT_THAT(run.problems, Contains(HasSubstr("run back in time")));
}

TEST_F(RunSeriesTest, CountsTicksThatTheLogLost) {
  write({.ticks = 100}, "log-0000.lcm");
  write({.first_tick = 120, .start_ns = 6'200'000'000}, "log-0001.lcm");
  const RunSeries run = read_run(folder_);
  EXPECT_EQ(run.lost_ticks, 20);
  EXPECT_THAT(run.problems, Contains(HasSubstr("20 ticks are missing")));
}

TEST_F(RunSeriesTest, ARestartIsNoLoss) {
  write({.ticks = 100}, "log-0000.lcm");
  write({.ticks = 100, .start_ns = 6'200'000'000}, "log-0001.lcm");
  EXPECT_EQ(read_run(folder_).lost_ticks, 0);
}

TEST_F(RunSeriesTest, TakesWallTimesFromTheTableBesideALockstepLog) {
  const fs::path log = write({.left_out = {"TIMING"}});
  std::ofstream(folder_ / "timing.csv") << "time_s,tick_us,generator_us,gco_us,policy_us\n"
                                           "0.01,4.0,0.00,0.00,0.00\n0.02,9.0,1.0,5.0,0.5\nbroken,line\n";
  const RunSeries run = read_run(log);
  EXPECT_THAT(run.timing.tick_us.values(), ElementsAre(4.0, 9.0));
  EXPECT_THAT(run.timing.gco_us.values(), ElementsAre(5.0)) << "the stage did not run in the first tick";
}

TEST_F(RunSeriesTest, StopsWhenItIsToldTo) {
  double read_share = 0.0;
  const RunSeries run =
      read_run(write({.ticks = 2000}), {.report = [&](double share, std::string_view) { read_share = share; },
                                        .interrupted = [&] { return read_share >= 0.3; }});
  EXPECT_LT(run.duration_s, 15.0);
  EXPECT_GT(run.duration_s, 1.0);
  EXPECT_TRUE(run.interrupted);
}

TEST(MeasuredCommand, VelocitiesAreThoseOfTheHeadingFrame) {
  MeasuredCommand measured;
  pmg_msgs::ground_truth_t truth{};
  const double yaw_rad = 2.0;
  truth.q_WB[0] = std::cos(0.5 * yaw_rad);
  truth.q_WB[3] = std::sin(0.5 * yaw_rad);
  truth.q_WT[0] = 1.0;
  truth.p_WB_m[2] = 0.75;
  truth.omega_WB_B_rad_s[2] = 0.3;
  truth.v_WB_W_m_s[0] = std::cos(yaw_rad) * 0.4 - std::sin(yaw_rad) * 0.1;
  truth.v_WB_W_m_s[1] = std::sin(yaw_rad) * 0.4 + std::cos(yaw_rad) * 0.1;
  std::array<double, kChannels> u{};
  for (int tick = 0; tick < 10; ++tick) {
    truth.stamp_ns += 10'000'000;
    u = measured.add(truth, 0.5, 0.8);
  }
  EXPECT_NEAR(u[kVx], 0.4, 1e-12);
  EXPECT_NEAR(u[kVy], 0.1, 1e-12);
  EXPECT_NEAR(u[kOmega], 0.3, 1e-12);
  EXPECT_NEAR(u[kHeight], -0.05, 1e-12);
}

TEST(MeasuredCommand, AveragesOverOneGaitPeriod) {
  MeasuredCommand measured;
  pmg_msgs::ground_truth_t truth{};
  truth.q_WB[0] = truth.q_WT[0] = 1.0;
  double vx_m_s = 0.0;
  for (int tick = 0; tick < 200; ++tick) {
    truth.stamp_ns += 10'000'000;
    truth.v_WB_W_m_s[0] = 0.5 + 0.2 * std::sin(2.0 * M_PI * tick / 50.0);  // sways once in 0.5 s
    vx_m_s = measured.add(truth, 0.5, 0.8)[kVx];
    if (tick < 50) continue;
    EXPECT_NEAR(vx_m_s, 0.5, 0.01) << tick;  // one sample of 50 more or less
  }
}

}  // namespace
}  // namespace pmg::report
