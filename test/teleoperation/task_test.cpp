// How a trial ends, and what an observer sees of it.
#include "teleoperation/task.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace pmg::teleoperation {
namespace {

/// Does nothing.
class Idle : public ScriptedOperator {
 public:
  const char* stage() const noexcept override { return "idle"; }

 private:
  bool look(double) override { return true; }
  void act(LedRobot&, double) override {}
};

TEST(Task, AnObserverSeesWhatComesOfTheEndAndTheResultIsOfTheEndItself) {
  control::LoadedControl loaded = control::load_control({});
  LedRobot robot(loaded, {});
  Idle person;
  const auto judge = [&](TaskResult& result) {
    result.moved_m = robot.time_s();
    return robot.time_s() > 0.195 ? std::optional(End::kDropped) : std::nullopt;
  };
  double seen_until_s = 0.0;
  const TaskResult result = run_task(
      robot, person, judge, 10.0, [] { return End::kNotLifted; }, {},
      [&](const LedRobot& led, const std::string&) { seen_until_s = led.time_s(); });
  EXPECT_EQ(result.end, End::kDropped);
  EXPECT_DOUBLE_EQ(result.duration_s, 0.2);
  EXPECT_DOUBLE_EQ(result.moved_m, 0.2);
  EXPECT_NEAR(seen_until_s, 1.7, 0.015);
}

}  // namespace
}  // namespace pmg::teleoperation
