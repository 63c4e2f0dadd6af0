#include "sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pmg::literature {
namespace {

/// Readings while the angle goes from 0 to 0.2 rad and back in steps of 1 ms.
std::vector<double> there_and_back(Sensor& sensor) {
  sensor.reset(0.0);
  std::vector<double> readings;
  for (int k = 1; k <= 400; ++k) {
    const double angle_rad = k <= 200 ? 1e-3 * k : 0.4 - 1e-3 * k;
    sensor.follow(1e-3 * k, angle_rad, k <= 200 ? 1.0 : -1.0);
    sensor.seen(1e-3 * k);
    readings.push_back(sensor.reading_rad(0.0));
  }
  return readings;
}

TEST(LiteratureSensor, EveryPlayIsAsWideAsPlantedOnceTheJointHasMovedFar) {
  for (const SensorPlay form : {SensorPlay::kPlay, SensorPlay::kSmooth, SensorPlay::kRelay}) {
    Machine::Sensor s;
    s.play_form = form;
    s.play_rad = 0.02;
    Sensor sensor(s);
    const std::vector<double> readings = there_and_back(sensor);
    EXPECT_NEAR(readings[199], 0.2 - 0.01, 1e-4);  // behind on the way there
    EXPECT_NEAR(readings[399], 0.0 + 0.01, 1e-4);  // and on the way back
  }
}

TEST(LiteratureSensor, PlaysDifferInHowTheyTurn) {
  const auto after_turn = [](SensorPlay form) {
    Machine::Sensor s;
    s.play_form = form;
    s.play_rad = 0.02;
    Sensor sensor(s);
    return there_and_back(sensor)[205];  // 6 mrad after the turn
  };
  EXPECT_NEAR(after_turn(SensorPlay::kPlay), 0.19, 1e-4);    // waits
  EXPECT_NEAR(after_turn(SensorPlay::kRelay), 0.204, 1e-4);  // has jumped
  EXPECT_LT(after_turn(SensorPlay::kSmooth), 0.204);
  EXPECT_GT(after_turn(SensorPlay::kSmooth), 0.1901);
}

TEST(LiteratureSensor, EveryLagIsLateByItsLagOnARamp) {
  for (const LagForm form : {LagForm::kFirstOrder, LagForm::kMovingAverage, LagForm::kTracking}) {
    Machine::Sensor s;
    s.lag_form = form;
    s.lag_s = 0.02;
    Sensor sensor(s);
    sensor.reset(0.0);
    Sensor::Seen seen;
    for (int k = 1; k <= 1000; ++k) {
      sensor.follow(5e-4 * k, 5e-4 * k, 1.0);
      seen = sensor.seen(5e-4 * k);
    }
    EXPECT_NEAR(seen.q_rad, 0.5 - 0.02, 1.5e-3);  // a tick or two of its discrete form
    EXPECT_NEAR(seen.dq_rad_s, 1.0, 1e-2);
  }
}

TEST(LiteratureSensor, QuantaRoundTruncateOrWait) {
  const auto reading = [](QuantumForm form, double angle_rad) {
    Machine::Sensor s;
    s.quantum_form = form;
    s.quantum_rad = 0.1;
    Sensor sensor(s);
    sensor.reset(0.0);
    sensor.follow(1e-3, angle_rad, 0.0);
    return sensor.reading_rad(0.0);
  };
  EXPECT_NEAR(reading(QuantumForm::kRound, 0.06), 0.1, 1e-12);
  EXPECT_NEAR(reading(QuantumForm::kFloor, 0.06), 0.0, 1e-12);
  EXPECT_NEAR(reading(QuantumForm::kFloor, -0.01), -0.1, 1e-12);
  EXPECT_NEAR(reading(QuantumForm::kHysteresis, 0.06), 0.0, 1e-12);
  EXPECT_NEAR(reading(QuantumForm::kHysteresis, 0.08), 0.1, 1e-12);
}

}  // namespace
}  // namespace pmg::literature
