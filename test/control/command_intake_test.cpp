#include "control/command_intake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pmg::control {
namespace {

using DriveVerdict = CommandIntake::DriveVerdict;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Messages enter the intake at the time of their reception; stamp_ns is their sending time.
class Intake : public testing::Test {
 protected:
  DriveVerdict drive(const char* source, std::int64_t session, std::int64_t sequence, std::int64_t now_ns,
                     double lease_s = 0.5) {
    return drive_sent(now_ns, source, session, sequence, now_ns, lease_s);
  }
  DriveVerdict drive_sent(std::int64_t stamp_ns, const char* source, std::int64_t session, std::int64_t sequence,
                          std::int64_t now_ns, double lease_s = 0.5) {
    DriveMessage message{.source = Source::make(source, session),
                         .sequence = sequence,
                         .stamp_ns = stamp_ns,
                         .received_ns = now_ns,
                         .lease_s = lease_s,
                         .command = {}};
    message.command[kVx] = 0.1 * static_cast<double>(sequence);
    return intake_.accept(message, now_ns);
  }
  CommandIntake::Judgement request(const char* source, std::int64_t session, std::int64_t sequence, Mode mode,
                                   std::int64_t now_ns, bool reset = false, bool down = false) {
    return request_sent(now_ns, source, session, sequence, mode, now_ns, reset, down);
  }
  CommandIntake::Judgement request_sent(std::int64_t stamp_ns, const char* source, std::int64_t session,
                                        std::int64_t sequence, Mode mode, std::int64_t now_ns, bool reset = false,
                                        bool down = false) {
    return intake_.judge({.source = Source::make(source, session),
                          .sequence = sequence,
                          .stamp_ns = stamp_ns,
                          .received_ns = now_ns,
                          .mode = mode,
                          .reset_fault = reset},
                         now_ns, down);
  }

  CommandIntake intake_;
};

TEST_F(Intake, OneSourceDrivesUntilItsLeaseEnds) {
  EXPECT_EQ(drive("gamepad", 1, 1, 0), DriveVerdict::kAccepted);
  EXPECT_EQ(drive("vr", 1, 1, kSecond_ns / 2 - 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(intake_.driving(0), Source::make("gamepad", 1));
  EXPECT_EQ(drive("vr", 1, 2, kSecond_ns / 2), DriveVerdict::kAccepted);
  EXPECT_EQ(drive("gamepad", 1, 2, kSecond_ns / 2 + 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(intake_.driving(2 * kSecond_ns), Source{});
}

TEST_F(Intake, ARestartedSourceIsAnotherSourceAndEndsItsPredecessor) {
  drive("gamepad", 1, 50, 0);
  EXPECT_EQ(drive("gamepad", 2, 1, 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(drive("gamepad", 1, 51, 2), DriveVerdict::kAccepted) << "a successor that waits takes nothing away";
  EXPECT_EQ(drive("gamepad", 2, 2, kSecond_ns), DriveVerdict::kAccepted);
  EXPECT_EQ(drive("gamepad", 1, 52, 10 * kSecond_ns), DriveVerdict::kOutOfOrder) << "somebody plays a recording";
}

TEST_F(Intake, RepeatedAndOvertakenCommandsAreRefused) {
  drive("gamepad", 1, 5, 0);
  EXPECT_EQ(drive("gamepad", 1, 5, 10), DriveVerdict::kOutOfOrder);
  EXPECT_EQ(drive("gamepad", 1, 4, 10), DriveVerdict::kOutOfOrder);
  EXPECT_DOUBLE_EQ(intake_.command()[kVx], 0.5);
  EXPECT_DOUBLE_EQ(intake_.age_s(kSecond_ns), 1.0) << "a refused message is no sign of life";
}

TEST_F(Intake, WhatASourceSentIsRememberedWhileAnotherOneDrives) {
  drive("gamepad", 7, 100, 0);
  drive("vr", 3, 1, kSecond_ns);
  EXPECT_EQ(drive("gamepad", 7, 100, 3 * kSecond_ns), DriveVerdict::kOutOfOrder);
  EXPECT_EQ(drive("gamepad", 7, 101, 3 * kSecond_ns), DriveVerdict::kAccepted);
}

TEST_F(Intake, AgeCountsFromTheReceptionNotFromTheTick) {
  DriveMessage waited{.source = Source::make("gamepad", 1), .sequence = 1, .lease_s = 0.5, .command = {}};
  waited.received_ns = kSecond_ns;
  EXPECT_EQ(intake_.accept(waited, kSecond_ns + kSecond_ns / 10), DriveVerdict::kAccepted);
  EXPECT_DOUBLE_EQ(intake_.age_s(kSecond_ns + kSecond_ns / 10), 0.1);
  EXPECT_EQ(intake_.driving(kSecond_ns + kSecond_ns / 2), Source{}) << "and so does the lease";
}

TEST_F(Intake, CommandsThatTravelledTooLongAreLateWhateverTheSendersClock) {
  for (const std::int64_t clocks_apart_ns : {std::int64_t{0}, 1'700'000'000 * kSecond_ns, -900 * kSecond_ns}) {
    intake_ = CommandIntake();
    const auto sent = [&](std::int64_t sequence, std::int64_t sent_ns, std::int64_t travel_ns) {
      return drive_sent(sent_ns + clocks_apart_ns, "vr", 1, sequence, sent_ns + travel_ns);
    };
    EXPECT_EQ(sent(1, kSecond_ns, 5'000'000), DriveVerdict::kAccepted);
    EXPECT_EQ(sent(2, 2 * kSecond_ns, 1'000'000), DriveVerdict::kAccepted);
    EXPECT_EQ(sent(3, 3 * kSecond_ns, 199'000'000), DriveVerdict::kAccepted) << "slow, not late";
    EXPECT_EQ(sent(4, 4 * kSecond_ns, 210'000'000), DriveVerdict::kLate);
    EXPECT_EQ(intake_.ignored().late, 1);
    EXPECT_EQ(sent(5, 5 * kSecond_ns, 1'000'000), DriveVerdict::kAccepted);
  }
}

TEST_F(Intake, ClocksThatDriftApartMakeNoMessageLate) {
  // An hour at 50 ms, the sender's clock slow or fast by 1 ms a second: 3.6 s difference at the end.
  for (const std::int64_t per : {-1000, 1000}) {
    intake_ = CommandIntake();
    for (std::int64_t k = 1; k <= 72'000; ++k) {
      const std::int64_t now_ns = k * 50'000'000;
      ASSERT_EQ(drive_sent(now_ns + now_ns / per, "vr", 1, k, now_ns), DriveVerdict::kAccepted) << k;
    }
  }
}

TEST_F(Intake, StampsMayBeAnything) {
  constexpr auto kLowest = std::numeric_limits<std::int64_t>::min(),
                 kHighest = std::numeric_limits<std::int64_t>::max();
  std::int64_t sequence = 0;
  for (const std::int64_t stamp_ns : {kLowest, kHighest, std::int64_t{0}, kHighest, kLowest}) {
    drive_sent(stamp_ns, "vr", 1, ++sequence, kSecond_ns);
    request_sent(stamp_ns, "vr", 1, sequence, Mode::kStand, kSecond_ns);
  }
  EXPECT_EQ(drive_sent(kHighest, "vr", 1, ++sequence, kSecond_ns), DriveVerdict::kAccepted);
}

TEST_F(Intake, CommandsThatAreNotFiniteAreRefused) {
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      CommandIntake intake;
      DriveMessage message{.source = Source::make("gamepad", 1), .sequence = 1, .lease_s = 0.5, .command = {}};
      message.command.u[channel] = bad;
      EXPECT_EQ(intake.accept(message, 0), DriveVerdict::kNotFinite);
      EXPECT_EQ(intake.command(), Command{});
      EXPECT_EQ(intake.ignored().not_finite, 1);
    }
  }
}

TEST_F(Intake, LeasesArePositiveAndAtMostTwoSeconds) {
  EXPECT_EQ(drive("gamepad", 1, 1, 0, 0.0), DriveVerdict::kNoLease);
  EXPECT_EQ(drive("gamepad", 1, 2, 0, std::nan("")), DriveVerdict::kNoLease);
  EXPECT_EQ(drive("gamepad", 1, 3, 0, 1e9), DriveVerdict::kAccepted);
  EXPECT_EQ(drive("vr", 1, 1, 2 * kSecond_ns - 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(drive("vr", 1, 2, 2 * kSecond_ns), DriveVerdict::kAccepted);
}

TEST_F(Intake, AgeIsInfiniteBeforeTheFirstCommand) { EXPECT_TRUE(std::isinf(intake_.age_s(kSecond_ns))); }

TEST_F(Intake, EveryMessageIsCountedOnce) {
  drive("gamepad", 1, 1, 0);
  drive("gamepad", 1, 1, 1);
  drive("vr", 1, 1, 2);
  drive("gamepad", 1, 2, 3, -1.0);
  request("vr", 1, 1, Mode::kWalk, 4);
  request("gamepad", 1, 1, Mode::kWalk, 5);
  const IgnoredCommands& counts = intake_.ignored();
  EXPECT_EQ(counts.accepted, 2);
  EXPECT_EQ(counts.out_of_order, 1);
  EXPECT_EQ(counts.other_source, 2);
  EXPECT_EQ(counts.no_lease, 1);
  EXPECT_EQ(counts.late + counts.not_finite, 0);
}

TEST_F(Intake, AnySourceMayStopButOnlyTheDrivingOneMayClimbOrReset) {
  EXPECT_EQ(request("vr", 1, 1, Mode::kWalk, 0).verdict, Verdict::kTaken) << "nobody drives";
  drive("gamepad", 1, 1, 0);
  EXPECT_EQ(request("vr", 1, 2, Mode::kDamping, 1).verdict, Verdict::kTaken);
  EXPECT_EQ(request("vr", 1, 3, Mode::kPassive, 1).verdict, Verdict::kTaken);
  EXPECT_EQ(request("vr", 1, 4, Mode::kStand, 2).verdict, Verdict::kNotYours);
  EXPECT_EQ(request("vr", 1, 5, Mode::kWalk, 2).verdict, Verdict::kNotYours);
  EXPECT_EQ(request("vr", 1, 6, Mode::kDamping, 2, true).verdict, Verdict::kNotYours) << "a reset is no stop";
  EXPECT_EQ(request("gamepad", 1, 1, Mode::kWalk, 2).verdict, Verdict::kTaken);
  EXPECT_EQ(request("vr", 1, 7, Mode::kWalk, kSecond_ns).verdict, Verdict::kTaken);
}

TEST_F(Intake, ARepeatedRequestIsAcknowledgedAgainButCarriedOutOnce) {
  EXPECT_TRUE(request("vr", 1, 5, Mode::kStand, 0).fresh);
  for (int k = 1; k < 5; ++k) {
    const auto again = request("vr", 1, 5, Mode::kStand, k * kSecond_ns / 10);
    EXPECT_EQ(again.verdict, Verdict::kTaken);
    EXPECT_FALSE(again.fresh);
  }
  EXPECT_EQ(request("vr", 1, 4, Mode::kStand, kSecond_ns).verdict, Verdict::kOutOfOrder);
  EXPECT_TRUE(request("vr", 1, 6, Mode::kStand, kSecond_ns).fresh);
}

TEST_F(Intake, ARequestThatWasRefusedStaysRefused) {
  drive("gamepad", 1, 1, 0);
  request("pendant", 1, 1, Mode::kDamping, 1);
  EXPECT_EQ(request("vr", 1, 1, Mode::kWalk, 2).verdict, Verdict::kNotYours);
  EXPECT_EQ(request("gamepad", 1, 1, Mode::kStand, 1).verdict, Verdict::kLate);
  for (int k = 1; k < 4; ++k) {  // nobody drives any more, and nobody stops it
    const std::int64_t now_ns = k * kSecond_ns;
    const auto not_yours = request("vr", 1, 1, Mode::kWalk, now_ns);
    EXPECT_EQ(not_yours.verdict, Verdict::kNotYours) << "as its sender was told";
    EXPECT_FALSE(not_yours.fresh);
    const auto late = request("gamepad", 1, 1, Mode::kStand, now_ns);
    EXPECT_EQ(late.verdict, Verdict::kLate);
    EXPECT_FALSE(late.fresh);
  }
  EXPECT_TRUE(request("vr", 1, 2, Mode::kWalk, 4 * kSecond_ns).fresh) << "asked anew";
}

TEST_F(Intake, ARequestWhoseSenderCouldNotKnowOfTheLastStopIsLate) {
  request("pendant", 1, 1, Mode::kDamping, kSecond_ns);
  std::int64_t number = 0;
  const auto asked = [&](std::int64_t heard_ns, bool reset) {
    return intake_.judge({.source = Source::make("vr", 1),
                          .sequence = ++number,
                          .stamp_ns = 2 * kSecond_ns,
                          .received_ns = 2 * kSecond_ns,
                          .heard_ns = heard_ns,
                          .mode = reset ? Mode::kDamping : Mode::kStand,
                          .reset_fault = reset},
                         2 * kSecond_ns);
  };
  for (const bool reset : {false, true}) {
    EXPECT_EQ(asked(kSecond_ns - 1, reset).verdict, Verdict::kLate);
    EXPECT_TRUE(asked(kSecond_ns, reset).fresh) << "it heard the tick that took the stop";
  }
}

TEST_F(Intake, ANumberStandsForOneRequest) {
  EXPECT_TRUE(request("vr", 1, 5, Mode::kStand, 0).fresh);
  EXPECT_EQ(request("vr", 1, 5, Mode::kWalk, 1).verdict, Verdict::kOutOfOrder) << "Stand was taken, not this";
  EXPECT_EQ(request("vr", 1, 5, Mode::kStand, 1, true).verdict, Verdict::kOutOfOrder);
  EXPECT_EQ(request("vr", 1, 5, Mode::kStand, 2).verdict, Verdict::kTaken);
}

TEST_F(Intake, ACommandThatWasRefusedIsNotTakenLater) {
  drive("gamepad", 1, 1, 0);
  EXPECT_EQ(drive("vr", 1, 1, 1), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(drive("vr", 1, 1, kSecond_ns), DriveVerdict::kOutOfOrder);
  EXPECT_EQ(drive("vr", 1, 2, kSecond_ns), DriveVerdict::kAccepted);
}

TEST_F(Intake, LateRequestsAreRefused) {
  EXPECT_TRUE(request_sent(0, "vr", 1, 1, Mode::kStand, kSecond_ns).fresh);
  EXPECT_EQ(request_sent(kSecond_ns, "vr", 1, 2, Mode::kWalk, 2 * kSecond_ns + 210'000'000).verdict, Verdict::kLate);
  EXPECT_EQ(request_sent(3 * kSecond_ns, "vr", 1, 2, Mode::kWalk, 3 * kSecond_ns).verdict, Verdict::kLate) << "as told";
  EXPECT_EQ(request_sent(3 * kSecond_ns, "vr", 1, 3, Mode::kWalk, 4 * kSecond_ns).verdict, Verdict::kTaken);
}

TEST_F(Intake, ALyingRobotIsNotAskedToRiseAndARepetitionGetsTheSameAnswer) {
  const auto ask = [&](std::int64_t sequence, Mode mode, bool down, bool reset = false) {
    return request("gamepad", 1, sequence, mode, sequence, reset, down);
  };
  for (const auto& [sequence, mode] : {std::pair{1, Mode::kStand}, std::pair{2, Mode::kWalk}}) {
    EXPECT_EQ(ask(sequence, mode, true).verdict, Verdict::kTilted);
    EXPECT_FALSE(ask(sequence, mode, false).fresh) << "a repetition raises no robot that was lifted meanwhile";
    EXPECT_EQ(ask(sequence, mode, false).verdict, Verdict::kTilted);
  }
  EXPECT_TRUE(ask(3, Mode::kStand, false).fresh);
  EXPECT_TRUE(ask(4, Mode::kPassive, true).fresh);
  EXPECT_TRUE(ask(5, Mode::kDamping, true).fresh);
  EXPECT_TRUE(ask(6, Mode::kDamping, true, true).fresh) << "a reset";
  drive("vr", 1, 1, 7);
  EXPECT_EQ(ask(8, Mode::kStand, true).verdict, Verdict::kNotYours) << "whose robot it is comes first";
}

TEST_F(Intake, AStopIsTakenHoweverOldRepeatedOrForeignItIs) {
  drive("gamepad", 5, 100, kSecond_ns, 2.0);
  request("gamepad", 5, 100, Mode::kWalk, kSecond_ns);
  for (const Mode mode : {Mode::kDamping, Mode::kPassive}) {
    const std::int64_t now_ns = 2 * kSecond_ns;
    EXPECT_EQ(request("gamepad", 5, 100, mode, now_ns).verdict, Verdict::kTaken) << "a sequence that was used";
    EXPECT_EQ(request("gamepad", 5, 3, mode, now_ns).verdict, Verdict::kTaken) << "overtaken";
    EXPECT_EQ(request("gamepad", 4, 1, mode, now_ns).verdict, Verdict::kTaken) << "of an earlier session";
    EXPECT_EQ(request_sent(0, "gamepad", 5, 101, mode, now_ns).verdict, Verdict::kTaken) << "late";
    EXPECT_EQ(request("stranger", 1, mode == Mode::kDamping ? 1 : 2, mode, now_ns).verdict, Verdict::kTaken);
    EXPECT_FALSE(request("gamepad", 5, 3, mode, now_ns).fresh) << "but it is no second wish for limp drives";
  }
  EXPECT_EQ(intake_.driving(2 * kSecond_ns), Source::make("gamepad", 5)) << "a stop takes the lease from nobody";
}

TEST_F(Intake, WhatWasAskedBeforeAStopIsOvertakenByIt) {
  request("vr", 1, 1, Mode::kDamping, kSecond_ns);
  EXPECT_EQ(request("gamepad", 1, 1, Mode::kStand, kSecond_ns).verdict, Verdict::kLate);
  EXPECT_TRUE(request("gamepad", 1, 2, Mode::kStand, kSecond_ns + 1).fresh);
  intake_.stop(2 * kSecond_ns);
  EXPECT_EQ(request("gamepad", 1, 3, Mode::kWalk, 2 * kSecond_ns).verdict, Verdict::kLate);
  EXPECT_EQ(request("gamepad", 1, 4, Mode::kDamping, 2 * kSecond_ns, true).verdict, Verdict::kLate);
  EXPECT_EQ(request("gamepad", 1, 5, Mode::kPassive, 2 * kSecond_ns).verdict, Verdict::kTaken);
}

TEST_F(Intake, WhatIsNoModeIsRefused) {
  EXPECT_EQ(request("vr", 1, 1, Mode::kFault, 0).verdict, Verdict::kNoMode);
  EXPECT_EQ(request("vr", 1, 2, static_cast<Mode>(77), 0).verdict, Verdict::kNoMode);
}

using Table = SourceTable<SourceRecord>;

TEST_F(Intake, NoNewNameDisplacesWhoSpokeInTheLastSecond) {
  EXPECT_TRUE(request("anna.1", 1, 1, Mode::kStand, 0).fresh);
  for (int k = 0; k < 1000; ++k) {  // another operator's, who stops, each name for the first time
    const std::string name = "bob." + std::to_string(k);
    const auto stop = request(name.c_str(), 1, 1, Mode::kPassive, 1 + k);
    EXPECT_EQ(stop.verdict, Verdict::kTaken) << "it stops all the same";
    EXPECT_EQ(stop.fresh, k < static_cast<int>(Table::kOfOneOperator)) << "but is no wish for limp drives";
  }
  EXPECT_EQ(drive("bob.d", 1, 1, 1001), DriveVerdict::kOutOfOrder) << "no room";
  for (std::size_t k = 0; k < Table::kSources; ++k) {  // and other operators'
    request(("c" + std::to_string(k)).c_str(), 1, 1, Mode::kDamping, 2000);
  }
  const auto again = request("anna.1", 1, 1, Mode::kStand, kSecond_ns);
  EXPECT_EQ(again.verdict, Verdict::kTaken);
  EXPECT_FALSE(again.fresh) << "carried out once";
}

TEST_F(Intake, WhoIsSilentForASecondMakesRoomButNeverTheDriver) {
  drive("driver", 1, 10, 0, 2.0);
  request("anna", 1, 1, Mode::kDamping, 1);
  const std::int64_t later_ns = kSecond_ns + 2;
  for (std::size_t k = 0; k + 1 < Table::kSources; ++k) {
    EXPECT_TRUE(request(("c" + std::to_string(k)).c_str(), 1, 1, Mode::kDamping, later_ns).fresh) << k;
  }
  EXPECT_EQ(drive("driver", 1, 10, later_ns), DriveVerdict::kOutOfOrder) << "still remembered";
  EXPECT_FALSE(request("anna", 1, 1, Mode::kDamping, later_ns).fresh) << "there is no room";
  EXPECT_TRUE(request("anna", 1, 1, Mode::kDamping, later_ns + kSecond_ns + 1).fresh) << "forgotten";
}

TEST_F(Intake, AStopInTheDriversNameWithTheLargestSessionLocksNobodyOut) {
  constexpr auto kHighest = std::numeric_limits<std::int64_t>::max();
  drive("gamepad", 7, 1, 0);
  EXPECT_EQ(request("gamepad", kHighest, kHighest, Mode::kDamping, 1).verdict, Verdict::kTaken);
  EXPECT_FALSE(request("gamepad", kHighest, kHighest, Mode::kPassive, 1).fresh);
  EXPECT_EQ(drive("gamepad", 7, 2, 2), DriveVerdict::kAccepted);
  EXPECT_EQ(request("gamepad", 7, 1, Mode::kStand, 3).verdict, Verdict::kTaken);
}

TEST_F(Intake, ASessionBlocksItsNameForTenSecondsAtMost) {
  constexpr auto kHighest = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(drive("gamepad", kHighest, kHighest, 0, 0.1), DriveVerdict::kAccepted);
  EXPECT_EQ(drive("gamepad", 7, 1, 10 * kSecond_ns), DriveVerdict::kOutOfOrder);
  EXPECT_EQ(drive("gamepad", 7, 1, 10 * kSecond_ns + 1), DriveVerdict::kAccepted);
}

TEST_F(Intake, ARefusedMessageChangesNothingThatIsRemembered) {
  constexpr auto kHighest = std::numeric_limits<std::int64_t>::max();
  drive("gamepad", 7, 5, kSecond_ns, 2.0);
  request("gamepad", 7, 5, Mode::kStand, kSecond_ns);
  const std::int64_t now_ns = kSecond_ns + 100'000'000;
  EXPECT_EQ(drive_sent(kHighest, "gamepad", 7, 5, now_ns), DriveVerdict::kOutOfOrder) << "a stamp in the far future";
  request_sent(kHighest, "gamepad", 7, 5, Mode::kStand, now_ns);
  request_sent(kHighest, "gamepad", 7, 4, Mode::kWalk, now_ns);
  request_sent(kHighest, "gamepad", 7, 4, Mode::kDamping, now_ns);
  EXPECT_EQ(drive("gamepad", 7, 6, now_ns + 1), DriveVerdict::kAccepted) << "is not late";
  EXPECT_TRUE(request("gamepad", 7, 6, Mode::kStand, now_ns + 2).fresh);
}

TEST_F(Intake, AStopWithoutASealStopsAndIsForgotten) {
  const auto stop = [&](std::int64_t stamp_ns, Mode mode) {
    return intake_.judge({.source = Source::make("gamepad", std::numeric_limits<std::int64_t>::max()),
                          .sequence = std::numeric_limits<std::int64_t>::max(),
                          .stamp_ns = stamp_ns,
                          .received_ns = 1,
                          .mode = mode,
                          .sealed = false},
                         1);
  };
  for (const Mode mode : {Mode::kDamping, Mode::kPassive}) {
    EXPECT_EQ(stop(kSecond_ns, mode).verdict, Verdict::kTaken);
    EXPECT_FALSE(stop(kSecond_ns, mode).fresh) << "no wish for limp drives";
  }
  EXPECT_EQ(request("vr", 1, 1, Mode::kStand, 1).verdict, Verdict::kLate) << "it overtakes what was asked before";
  EXPECT_EQ(stop(0, Mode::kWalk).verdict, Verdict::kLate) << "received with the stop";
  EXPECT_EQ(drive("gamepad", 7, 1, 2), DriveVerdict::kAccepted);
  EXPECT_TRUE(request("gamepad", 7, 1, Mode::kStand, 3).fresh);
}

TEST_F(Intake, ARequestTakesOverFromADriverThatOnlyRenewsItsLease) {
  std::int64_t sequence = 0;
  const auto renew = [&](std::int64_t now_ns, double vx_m_s) {
    DriveMessage message{.source = Source::make("gamepad", 1),
                         .sequence = ++sequence,
                         .stamp_ns = now_ns,
                         .received_ns = now_ns,
                         .lease_s = 0.5,
                         .command = {}};
    message.command[kVx] = vx_m_s;
    message.command[kHeight] = -0.1;  // a posture that is held
    return intake_.accept(message, now_ns);
  };
  std::int64_t now_ns = 0;
  renew(now_ns, 0.0);
  for (; now_ns < kSecond_ns; now_ns += kSecond_ns / 5) renew(now_ns, 0.2);
  const std::int64_t moved_ns = now_ns - kSecond_ns / 5;
  for (; now_ns < moved_ns + 3 * kSecond_ns; now_ns += kSecond_ns / 5) {
    renew(now_ns, 0.0);
    EXPECT_EQ(request("vr", 1, 1, Mode::kWalk, now_ns).verdict, Verdict::kNotYours);
  }
  renew(now_ns, 0.0);  // the step from 0.2 m/s to 0 was the last motion
  now_ns += kSecond_ns / 5;
  EXPECT_EQ(drive("vr", 1, 1, now_ns), DriveVerdict::kOtherSourceDrives) << "commands alone take nothing over";
  EXPECT_TRUE(request("vr", 1, 2, Mode::kWalk, now_ns).fresh);
  EXPECT_EQ(intake_.driving(now_ns + kSecond_ns / 2 - 1), Source::make("vr", 1));
  EXPECT_EQ(intake_.driving(now_ns + kSecond_ns / 2), Source{}) << "unless it sends a command";
  EXPECT_EQ(renew(now_ns + 1, 0.0), DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(drive("vr", 1, 3, now_ns + 2), DriveVerdict::kAccepted);
  EXPECT_EQ(request("gamepad", 1, 1, Mode::kStand, now_ns + 3).verdict, Verdict::kNotYours) << "not back at once";
}

TEST(Source, LongNamesAreCutAndStayTerminated) {
  const Source source = Source::make("a name that is longer than any source has", 1);
  EXPECT_EQ(source.name.back(), '\0');
  EXPECT_EQ(std::string(source.name.data()).size(), source.name.size() - 1);
}

}  // namespace
}  // namespace pmg::control
