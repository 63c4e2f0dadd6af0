// The drive's law, its supply and its motor: each effect acts as its name says, and does nothing when it is neutral.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorDrive, NewtonMetresAreNewtonMetresUnderEveryDriveLaw) {
  const model::ActuatorParameters::Drive position_pd{.limit = 20.0}, servo{.limit = 1.0, .torque_per_unit_Nm = 0.3},
      cascade{.limit = 10.0, .torque_per_unit_Nm = 35.0};
  const auto torque_Nm = [](const model::ActuatorParameters::Drive& drive, double supply, double wish_Nm) {
    const auto parameters = with([&](auto& p) { p.drive = drive; });
    const sim::ActuatorInput input{.kp = 5.0, .feed_forward_Nm = wish_Nm, .supply = supply};
    return sim::ActuatorModel(parameters, kActuatorStep_s).step(input, 0.0, 0.0).torque_Nm;
  };
  for (const double wish_Nm : {-2.5, 0.7, 2.6}) {
    EXPECT_NEAR(torque_Nm(position_pd, 1.0, wish_Nm), wish_Nm, 1e-12);
    EXPECT_NEAR(torque_Nm(servo, 12.0, wish_Nm), wish_Nm, 1e-12);
    EXPECT_NEAR(torque_Nm(servo, 9.0, wish_Nm), wish_Nm, 1e-12) << "the drive divides by its bus";
    EXPECT_NEAR(torque_Nm(cascade, 1.0, wish_Nm), wish_Nm, 1e-12);
  }
  EXPECT_NEAR(torque_Nm(servo, 12.0, 100.0), 0.3 * 12.0, 1e-12) << "full duty is all there is";
}

TEST(ActuatorDrive, GivesNoMoreThanItsTorqueSpeedLine) {
  const auto parameters = with([](auto& p) { p.drive.stall_torque_Nm = 10.0, p.drive.no_load_rad_s = 8.0; });
  const auto torque_Nm = [&](double wish_Nm, double dq_rad_s) {
    return sim::ActuatorModel(parameters, kActuatorStep_s).step({.feed_forward_Nm = wish_Nm}, 0.0, dq_rad_s).torque_Nm;
  };
  EXPECT_DOUBLE_EQ(torque_Nm(50.0, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(torque_Nm(50.0, 4.0), 5.0);
  EXPECT_DOUBLE_EQ(torque_Nm(50.0, 9.0), 0.0);
  EXPECT_DOUBLE_EQ(torque_Nm(-50.0, 4.0), -10.0) << "braking";
  EXPECT_DOUBLE_EQ(torque_Nm(3.0, 4.0), 3.0);
}

TEST(ActuatorDrive, LosesOfItsBusWhatTheBridgeTakesFromIt) {
  const double full_Nm = 0.3 * 12.0, sag_per_Nm = 0.2, back_emf_V_s_per_rad = 1.2;
  const auto parameters = with([&](auto& p) {
    p.drive = {.limit = 1.0, .torque_per_unit_Nm = 0.3, .back_emf_s_per_rad = back_emf_V_s_per_rad};
    p.drive.supply_sag_per_Nm = sag_per_Nm;
  });
  for (const double duty : {-1.0, 0.5, 0.05}) {
    for (const double dq_rad_s : {0.0, 3.0}) {
      const double torque_Nm = sim::ActuatorModel(parameters, kActuatorStep_s)
                                   .step({.q_rad = duty, .kp = 1.0, .supply = 12.0}, 0.0, dq_rad_s)
                                   .torque_Nm;
      const double bus_V = 12.0 * (1.0 - sag_per_Nm * duty * torque_Nm);
      EXPECT_NEAR(torque_Nm, 0.3 * (duty * bus_V - back_emf_V_s_per_rad * dq_rad_s), 1e-12 * full_Nm) << duty;
    }
  }
}

TEST(ActuatorDrive, GivesNothingWhenSwitchedOff) {
  sim::ActuatorModel actuator(with([](auto& p) { p.drive.back_emf_s_per_rad = 2.0; }), kActuatorStep_s);
  EXPECT_EQ(actuator.step({.q_rad = 1.0, .kp = 10.0, .enabled = false}, 0.0, 1.0).torque_Nm, 0.0);
}

TEST(ActuatorDrive, ActsOnCommandsAndReadingsLateByTheTimeOfItsLoop) {
  sim::ActuatorModel actuator(with([](auto& p) { p.drive.torque_delay_s = 0.007; }), kActuatorStep_s);
  const double moved_rad = 0.25;
  for (int k = 0; k < 20; ++k) {
    const double q_rad = k < 10 ? 0.0 : moved_rad;
    const double torque_Nm = actuator.step({.q_rad = 1.0, .kp = 1.0}, q_rad, 0.0).torque_Nm;
    const double of_command = k < 3 ? 0.0 : k == 3 ? 0.5 : 1.0;  // 7 ms are three steps and a half
    const double of_reading = k < 13 ? 0.0 : k == 13 ? 0.5 : 1.0;
    EXPECT_NEAR(torque_Nm, of_command - moved_rad * of_reading, 1e-9) << k;
  }
}

TEST(ActuatorDrive, HasNoTorqueLeftInItsDelayAfterAPause) {
  sim::ActuatorModel actuator(with([](auto& p) { p.drive.torque_delay_s = 0.01; }), kActuatorStep_s);
  sim::ActuatorInput input{.q_rad = 1.0, .kp = 1.0};
  for (int k = 0; k < 20; ++k) actuator.step(input, 0.0, 0.0);
  input.enabled = false;
  EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 0.0);
  input.enabled = true;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 0.0) << k;
  EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 1.0);
}

TEST(ActuatorDrive, LimitsTheRateOfItsOutput) {
  sim::ActuatorModel actuator(with([](auto& p) { p.drive.output_rate_limit_per_s = 50.0; }), kActuatorStep_s);
  for (int k = 1; k <= 15; ++k) {
    EXPECT_NEAR(actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.0).torque_Nm, std::min(1.0, 0.1 * k), 1e-12);
  }
}

TEST(ActuatorDrive, LosesOfEachOutputWhatTheDeadTimeTakes) {
  const auto parameters = with([](auto& p) { p.drive.output_dead_band = 0.3, p.drive.limit = 2.0; });
  const auto torque_Nm = [&](double error_rad, double wish_Nm) {
    return first_torque_Nm(parameters, {.q_rad = error_rad, .kp = 1.0, .feed_forward_Nm = wish_Nm});
  };
  EXPECT_EQ(torque_Nm(0.2, 0.0), 0.0);
  EXPECT_NEAR(torque_Nm(1.0, 0.0), 0.7, 1e-12);
  EXPECT_NEAR(torque_Nm(-1.0, 0.0), -0.7, 1e-12);
  EXPECT_NEAR(torque_Nm(0.2, 0.2), 0.1, 1e-12) << "of the whole output, feed-forward too";
  EXPECT_EQ(torque_Nm(5.0, 0.0), 2.0) << "before the limit";
}

TEST(ActuatorDrive, ReducesErrorsBeyondItsDeadBandByAShareOfIt) {
  for (const double subtracts : {0.0, 0.5, 1.0}) {
    const auto parameters =
        with([&](auto& p) { p.drive.dead_band_rad = 0.1, p.drive.dead_band_subtracts = subtracts; });
    EXPECT_EQ(first_torque_Nm(parameters, {.q_rad = 0.05, .kp = 10.0}), 0.0);
    EXPECT_NEAR(first_torque_Nm(parameters, {.q_rad = 0.3, .kp = 10.0}), 3.0 - subtracts, 1e-12);
    EXPECT_NEAR(first_torque_Nm(parameters, {.q_rad = -0.3, .kp = 10.0}), -3.0 + subtracts, 1e-12);
  }
}

TEST(ActuatorDrive, WakesUpAtALargerErrorThanItFallsAsleepAt) {
  sim::ActuatorModel actuator(with([](auto& p) { p.drive.dead_band_rad = 0.02, p.drive.dead_band_wake_rad = 0.03; }),
                              kActuatorStep_s);
  const auto torque_Nm = [&](double error_rad) {
    return actuator.step({.q_rad = error_rad, .kp = 1.0}, 0.0, 0.0).torque_Nm;
  };
  EXPECT_EQ(torque_Nm(0.03), 0.03) << "awake at first";
  EXPECT_EQ(torque_Nm(0.01), 0.0);
  EXPECT_EQ(torque_Nm(0.03), 0.0) << "asleep";
  EXPECT_EQ(torque_Nm(-0.045), 0.0);
  EXPECT_EQ(torque_Nm(-0.06), -0.06);
  EXPECT_EQ(torque_Nm(0.03), 0.03) << "awake";
}

TEST(ActuatorDrive, ReportsTheTorqueThatItBelievesInAndGivesAnother) {
  for (const bool saturates : {false, true}) {
    sim::ActuatorModel actuator(with([&](auto& p) {
                                  p.drive.torque_scale = 0.8;
                                  p.drive.saturation_per_Nm = saturates ? 0.1 : 0.0;
                                }),
                                kActuatorStep_s);
    for (const double wish_Nm : {5.0, -2.0}) {
      const double scaled_Nm = 0.8 * wish_Nm;
      EXPECT_NEAR(actuator.step({.feed_forward_Nm = wish_Nm}, 0.0, 0.0).torque_Nm,
                  saturates ? scaled_Nm / (1.0 + 0.1 * std::abs(scaled_Nm)) : scaled_Nm, 1e-12);
      EXPECT_NEAR(actuator.drive_torque_Nm(), wish_Nm, 1e-12);
    }
  }
}

/// The torque constant of a motor differs with its angle: T (1 + share sin(order q + phase)).
TEST(ActuatorDrive, RipplesInProportionToItsTorque) {
  const auto parameters = with([](auto& p) {
    p.ripple.torque_share = 0.3;
    p.ripple.order = 5.0;
    p.ripple.phase_rad = 0.4;
    p.drive.back_emf_s_per_rad = 0.5;
  });
  for (const double q_rad : {0.0, 0.3, -1.1}) {
    sim::ActuatorModel actuator(parameters, kActuatorStep_s);
    actuator.reset(q_rad);
    for (const double wish_Nm : {2.0, -0.7}) {
      const double factor = 1.0 + 0.3 * std::sin(5.0 * q_rad + 0.4);
      const auto given = actuator.step({.feed_forward_Nm = wish_Nm}, q_rad, 1.0);
      EXPECT_NEAR(given.torque_Nm, factor * (wish_Nm - 0.5), 1e-12);
      EXPECT_NEAR(given.slope_Nm_s_per_rad, factor * -0.5, 1e-12) << "back-EMF ripples, too";
    }
  }
}

TEST(ActuatorDrive, RipplesTwiceAsOftenBySecondHarmonic) {
  const auto parameters = with([](auto& p) {
    p.ripple.order = 5.0;
    p.ripple.second_Nm = 0.3;
    p.ripple.second_phase_rad = 0.4;
  });
  for (const double q_rad : {0.0, 0.3, -1.1}) {
    sim::ActuatorModel actuator(parameters, kActuatorStep_s);
    actuator.reset(q_rad);
    EXPECT_NEAR(actuator.step({.feed_forward_Nm = 2.0}, q_rad, 1.0).torque_Nm, 2.0 + 0.3 * std::sin(10.0 * q_rad + 0.4),
                1e-12);
  }
}

TEST(ActuatorDrive, ASpringPullsToWhereItsPreloadIsZero) {
  const auto parameters = with([](auto& p) {
    p.ripple.offset_Nm = 0.6;
    p.ripple.spring_Nm_per_rad = 1.5;
  });
  for (const double q_rad : {0.0, 0.4, -1.1}) {
    sim::ActuatorModel actuator(parameters, kActuatorStep_s);
    actuator.reset(q_rad);
    EXPECT_NEAR(actuator.step({.feed_forward_Nm = 2.0}, q_rad, 1.0).torque_Nm, 2.0 - 1.5 * (q_rad - 0.4), 1e-12);
  }
}

TEST(ActuatorDrive, NeverDrivesWithMoreThanItsPower) {
  const double most_W = 20.0;
  const auto parameters = with([&](auto& p) { p.drive.most_power_W = most_W; });
  for (const double dq_rad_s : {0.0, 0.1, 3.0, 4.0, 40.0, -4.0}) {
    for (const double wish_Nm : {3.0, 50.0, -50.0}) {
      const sim::ActuatorTorque torque =
          sim::ActuatorModel(parameters, kActuatorStep_s).step({.feed_forward_Nm = wish_Nm}, 0.0, dq_rad_s);
      const bool drives = wish_Nm * dq_rad_s > most_W;
      EXPECT_NEAR(torque.torque_Nm, drives ? most_W / dq_rad_s : wish_Nm, 1e-12) << dq_rad_s << " rad/s";
      if (!drives) continue;
      for (const double change : {0.9, 1.1}) {  // at the step's end, where the slope acts
        const double end_Nm = torque.torque_Nm + torque.slope_Nm_s_per_rad * (change - 1.0) * dq_rad_s;
        EXPECT_LE(end_Nm * change * dq_rad_s, most_W * (1.0 + 1e-12));
      }
    }
  }
}

TEST(ActuatorDrive, HasNoTorqueAlongItsMotionBeyondTheCutSpeed) {
  for (const bool limited : {true, false}) {
    const auto parameters = with([&](auto& p) {
      p.drive.cut_speed_rad_s = 5.0;
      if (limited) p.drive.limit = 10.0;
    });
    const auto torque_Nm = [&](double dq_rad_s, double wish_Nm) {
      return first_torque_Nm(parameters, {.feed_forward_Nm = wish_Nm}, dq_rad_s);
    };
    EXPECT_EQ(torque_Nm(4.0, 8.0), 8.0);
    EXPECT_NEAR(torque_Nm(4.75, 8.0), limited ? 5.0 : 4.0, 1e-9) << "half of its limit, or of its torque, is left";
    EXPECT_EQ(torque_Nm(5.1, 8.0), 0.0);
    EXPECT_EQ(torque_Nm(-5.1, -8.0), 0.0);
    EXPECT_EQ(torque_Nm(-6.0, 8.0), 8.0) << "braking";
  }
}

TEST(ActuatorDrive, TakesNoMoreFromItsSupplyThanThatGives) {
  const auto parameters = with([](auto& p) {
    p.drive.limit = 1.0, p.drive.torque_per_unit_Nm = 0.3, p.drive.back_emf_s_per_rad = 1.0;
    p.drive.supply_limit_Nm = 1.2;
  });
  const auto torque_Nm = [&](double duty, double dq_rad_s) {
    return first_torque_Nm(parameters, {.q_rad = duty, .kp = 1.0, .supply = 12.0}, dq_rad_s);
  };
  EXPECT_NEAR(torque_Nm(1.0, 0.0), 1.2, 1e-12);
  EXPECT_NEAR(torque_Nm(-0.7, 0.0), -1.2 / 0.7, 1e-12) << "at a part of the duty the motor's current is larger";
  EXPECT_NEAR(torque_Nm(0.5, 0.0), 0.3 * 12.0 * 0.5, 1e-12) << "below the limit";
  EXPECT_NEAR(torque_Nm(0.2, 40.0), 0.3 * (12.0 * 0.2 - 40.0), 1e-12) << "a braking motor feeds the supply";
}

TEST(ActuatorDrive, SagsAtOnceAndThroughABatterysCapacitance) {
  const double sag_per_Nm = 0.1, slow = 0.6, time_s = 0.5, full_Nm = 0.3 * 12.0;
  sim::ActuatorModel actuator(with([&](auto& p) {
                                p.drive.limit = 1.0, p.drive.torque_per_unit_Nm = 0.3;
                                p.drive.supply_sag_per_Nm = sag_per_Nm;
                                p.drive.supply_sag_time_s = time_s, p.drive.supply_sag_slow_share = slow;
                              }),
                              kActuatorStep_s);
  const auto torque_Nm = [&] { return actuator.step({.q_rad = 1.0, .kp = 1.0, .supply = 12.0}, 0.0, 0.0).torque_Nm; };
  const double at_once_Nm = full_Nm / (1.0 + (1.0 - slow) * sag_per_Nm * full_Nm);
  const double at_last_Nm = full_Nm / (1.0 + sag_per_Nm * full_Nm);
  EXPECT_NEAR(torque_Nm(), at_once_Nm, 1e-12);
  // The falling torque takes less from the battery: this shortens its time constant.
  const double falls_s = time_s / (1.0 + slow * sag_per_Nm * at_once_Nm);
  double now_Nm = 0.0;
  for (int k = 0; k < std::lround(falls_s / kActuatorStep_s); ++k) now_Nm = torque_Nm();
  EXPECT_NEAR(now_Nm, at_last_Nm + (at_once_Nm - at_last_Nm) / std::exp(1.0), 0.01 * (at_once_Nm - at_last_Nm));
  for (int k = 0; k < 5000; ++k) now_Nm = torque_Nm();
  EXPECT_NEAR(now_Nm, at_last_Nm, 1e-9);
}

}  // namespace
}  // namespace pmg::test
