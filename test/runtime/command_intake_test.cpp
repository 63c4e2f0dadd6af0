#include "runtime/command_intake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pmg::runtime {
namespace {

using DriveVerdict = CommandIntake::DriveVerdict;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

DriveMessage message(const char* source, std::int64_t session, std::int64_t sequence, double lease_s = 0.5) {
  DriveMessage drive;
  drive.source = Source::make(source, session);
  drive.sequence = sequence;
  drive.lease_s = lease_s;
  drive.command[kVx] = 0.1 * static_cast<double>(sequence);
  return drive;
}

ModeRequest request(const char* source, std::int64_t session, Mode mode, bool reset = false) {
  ModeRequest request;
  request.source = Source::make(source, session);
  request.mode = mode;
  request.reset_fault = reset;
  return request;
}

TEST(CommandIntake, OneSourceDrivesUntilItsLeaseEnds) {
  CommandIntake intake;
  EXPECT_EQ(intake.accept(message("gamepad", 1, 1), 0), DriveVerdict::kAccepted);
  EXPECT_EQ(intake.accept(message("vr", 1, 1), kSecond_ns / 2 - 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(intake.driving(0), Source::make("gamepad", 1));
  EXPECT_EQ(intake.accept(message("vr", 1, 1), kSecond_ns / 2), DriveVerdict::kAccepted);
  EXPECT_EQ(intake.accept(message("gamepad", 1, 2), kSecond_ns / 2 + 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(intake.driving(2 * kSecond_ns), Source{});
}

TEST(CommandIntake, ARestartedSourceIsAnotherSource) {
  CommandIntake intake;
  intake.accept(message("gamepad", 1, 50), 0);
  EXPECT_EQ(intake.accept(message("gamepad", 2, 1), 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(intake.accept(message("gamepad", 2, 1), kSecond_ns), DriveVerdict::kAccepted);
}

TEST(CommandIntake, RepeatedAndOvertakenMessagesAreRefused) {
  CommandIntake intake;
  intake.accept(message("gamepad", 1, 5), 0);
  EXPECT_EQ(intake.accept(message("gamepad", 1, 5), 10), DriveVerdict::kOutOfOrder);
  EXPECT_EQ(intake.accept(message("gamepad", 1, 4), 10), DriveVerdict::kOutOfOrder);
  EXPECT_DOUBLE_EQ(intake.command()[kVx], 0.5);
  EXPECT_DOUBLE_EQ(intake.age_s(kSecond_ns), 1.0) << "a refused message is no sign of life";
}

TEST(CommandIntake, CommandsThatAreNotFiniteAreRefused) {
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      CommandIntake intake;
      DriveMessage drive = message("gamepad", 1, 1);
      drive.command.u[channel] = bad;
      EXPECT_EQ(intake.accept(drive, 0), DriveVerdict::kNotFinite);
      EXPECT_EQ(intake.command(), Command{});
    }
  }
}

TEST(CommandIntake, LeasesArePositiveAndAtMostTwoSeconds) {
  CommandIntake intake;
  EXPECT_EQ(intake.accept(message("gamepad", 1, 1, 0.0), 0), DriveVerdict::kNoLease);
  EXPECT_EQ(intake.accept(message("gamepad", 1, 1, std::nan("")), 0), DriveVerdict::kNoLease);
  EXPECT_EQ(intake.accept(message("gamepad", 1, 1, 1e9), 0), DriveVerdict::kAccepted);
  EXPECT_EQ(intake.accept(message("vr", 1, 1), 2 * kSecond_ns), DriveVerdict::kAccepted);
}

TEST(CommandIntake, AgeIsInfiniteBeforeTheFirstCommand) {
  CommandIntake intake;
  EXPECT_TRUE(std::isinf(intake.age_s(kSecond_ns)));
}

TEST(CommandIntake, AnySourceMayStopButOnlyTheDrivingOneMayClimbOrReset) {
  CommandIntake intake;
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kWalk), 0), Verdict::kTaken) << "nobody drives";
  intake.accept(message("gamepad", 1, 1), 0);
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kDamping), 1), Verdict::kTaken);
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kPassive), 1), Verdict::kTaken);
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kStand), 1), Verdict::kNotYours);
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kWalk), 1), Verdict::kNotYours);
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kDamping, true), 1), Verdict::kNotYours) << "a reset is no stop";
  EXPECT_EQ(intake.judge(request("gamepad", 1, Mode::kWalk), 1), Verdict::kTaken);
  EXPECT_EQ(intake.judge(request("vr", 1, Mode::kWalk), kSecond_ns), Verdict::kTaken);
}

TEST(Source, LongNamesAreCutAndStayTerminated) {
  const Source source = Source::make("a name that is longer than any source has", 1);
  EXPECT_EQ(source.name.back(), '\0');
  EXPECT_EQ(std::string(source.name.data()).size(), source.name.size() - 1);
}

}  // namespace
}  // namespace pmg::runtime
