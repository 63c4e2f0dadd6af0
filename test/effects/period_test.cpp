// Periods of holds: rollouts with a wrong one are out of step with the recording after a while.
#include "effects/period.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/synthetic_bench.hpp"
#include "effects/catalogue.hpp"
#include "effects/extension.hpp"
#include "effects/start_screen.hpp"

namespace pmg::effects {
namespace {

calib::JointModel prompt_joint() { return test::plain_joint(0.05); }

NestedFit recorded_with(double update_s) {
  calib::JointModel truth = prompt_joint();
  truth.actuator.command.update_s = update_s;
  return {test::record(test::pd_bench(true), truth, 6, 1e-4), 1};
}

TEST(Period, IsFoundBetweenTheStartsOfTheCatalogue) {
  for (const double update_s : {0.036, 0.046, 0.09}) {
    const NestedFit fit = recorded_with(update_s);
    const std::vector<double> periods_s = promising_periods_s(fit, prompt_joint(), "command.update_s", 0.02, 0.1);
    ASSERT_FALSE(periods_s.empty());
    bool found = false;  // runs of 3 s are out of step by a quarter of a period where it is off by P / 12 s
    for (const double period_s : periods_s) found = found || std::abs(period_s - update_s) < update_s * update_s / 12.0;
    EXPECT_TRUE(found) << update_s << " s; the best is " << periods_s.front() << " s";
  }
}

/// Of commands that jump every 0.55 s, a wrong period may be in step at each jump of a beginning.
TEST(Period, IsFoundWhereCommandsJump) {
  const bench::Bench bench = test::pd_bench(true);
  for (const double update_s : {0.0538, 0.0671}) {
    calib::JointModel truth = prompt_joint();
    truth.actuator.command.update_s = update_s;
    std::vector<calib::SingleJoint> runs;
    for (const calib::SingleJoint& joint : test::record(bench, truth, 6)) {
      bench::BenchRun run = joint.run();
      run.recording = {};
      for (int k = 0; k < 500; ++k) {
        const double t_s = 0.01 * k, jump = std::floor((t_s - 0.3) / 0.55);
        run.recording.t_s.push_back(t_s);
        run.recording.q_cmd_rad.push_back(t_s < 0.3 ? 0.0 : std::sin(2.0 * jump + static_cast<double>(runs.size())));
        run.recording.q_rad.push_back(0.0);
        run.recording.valid.push_back(true);
      }
      run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(truth);
      runs.emplace_back(bench, run, joint.step_s());
    }
    const NestedFit fit(runs, 1);
    double nearest_s = 1.0;
    for (const double period_s : promising_periods_s(fit, prompt_joint(), "command.update_s", 0.02, 0.1))
      nearest_s = std::min(nearest_s, std::abs(period_s - update_s));
    EXPECT_LT(nearest_s, update_s * update_s / 20.0) << update_s << " s: a quarter out of step after 5 s";
  }
}

TEST(Period, OfAHoldIsInStepWithItsStart) {
  const NestedFit fit = recorded_with(0.046);
  NestedModel current = fit.fit(prompt_joint(), {}, 0);
  fit.linearise(current);
  const StartScreen screen(fit, current);
  const Effect& hold = effect("hold");
  const auto commands = std::find_if(hold.forms.begin(), hold.forms.end(),
                                     [](const Form& form) { return form.name == std::string("commands"); });
  const std::vector<ScreenedStart> starts = screen.best(hold, static_cast<std::size_t>(commands - hold.forms.begin()),
                                                        scale_of(test::pd_bench(true), fit.runs(), prompt_joint()));
  ASSERT_FALSE(starts.empty());
  EXPECT_LT(starts.front().squares, 0.05 * current.squares) << "the nearest periods of the catalogue leave more";
}

/// A reading that is held for less than a sample is late, as one of a joint whose commands are delayed.
TEST(Period, ReachesAsFarAsADelayMakesUpForIt) {
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel truth = prompt_joint();
  truth.actuator.sensor.hold_s = 0.004;
  truth.actuator.command.delay_s = 0.01;
  const NestedFit fit(test::record(bench, truth, 6, 3e-3), 1);
  const BenchScale scale = scale_of(bench, fit.runs(), truth);
  const auto shortest_s = [&](const calib::Unknowns& unknowns) {
    return period_range(fit, fit.fit(truth, unknowns, 10), "sensor.hold_s", 9e-6, 2.0).low_s;
  };
  const double alone_s = shortest_s({unknown("friction.coulomb_Nm", bench, scale)});
  EXPECT_LT(shortest_s({unknown("friction.coulomb_Nm", bench, scale), unknown("command.delay_s", bench, scale)}),
            0.95 * alone_s);
}

TEST(Period, CountsAsANumberAsOtherParametersDo) {
  Extension hold{{"hold"}, {}, {}, {}, {}}, lag{{"sensor_lag"}, {}, {}, {}, {}};
  const bench::Bench bench = test::pd_bench(true);
  const BenchScale scale = scale_of(bench, recorded_with(0.05).runs(), prompt_joint());
  lag.fitted.unknowns.push_back(unknown("sensor.lag_s", bench, scale));
  EXPECT_EQ(hold.numbers(), 1U) << "it is searched and no unknown of the fit";
  EXPECT_EQ(lag.numbers(), 1U);
}

TEST(BenchScale, KnowsTheTemperaturesOfRows) {
  const bench::Bench bench = test::pd_bench(true);
  std::vector<calib::SingleJoint> runs = test::record(bench, prompt_joint(), 2);
  EXPECT_FALSE(scale_of(bench, runs, prompt_joint()).temperature_recorded);
  for (calib::SingleJoint& joint : runs) {
    bench::BenchRun run = joint.run();
    run.temp_C = 40.0;
    joint = calib::SingleJoint(bench, run, joint.step_s());
  }
  EXPECT_TRUE(scale_of(bench, runs, prompt_joint()).temperature_recorded);
}

}  // namespace
}  // namespace pmg::effects
