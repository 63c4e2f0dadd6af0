// Next to none of an effect does what none of it does: past a jump, a search would not find from the one to the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>

#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "effects/nested_fit.hpp"
#include "effects/strengths.hpp"

namespace pmg::effects {
namespace {

struct Known {
  const char* name;
  void (*set)(model::ActuatorParameters&);
};

std::ostream& operator<<(std::ostream& out, const Known& known) { return out << known.name; }

class NextToNone : public testing::TestWithParam<Known> {};

/// The joint with a millionth of a start of this form in place of none of it; nothing if the joint has it already, or
/// if none is infinite.
std::optional<calib::JointModel> with_little(const calib::JointModel& joint, const Effect& effect, const Form& form,
                                             const BenchScale& scale) {
  constexpr double kShare = 1e-6;
  const Values starts = form.starts_at(joint, scale);
  if (starts.empty()) return std::nullopt;
  calib::JointModel little = joint;
  for (const FixedValue& fixed : form.fixed) calib::set(little, fixed.parameter, fixed.value);
  const std::vector<std::string> names = strengths(effect, form);
  for (std::size_t p = 0; p < form.parameters.size(); ++p) {
    const std::string& name = form.parameters[p];
    const double none = calib::value(joint, name), there = starts.front()[p];
    if (!std::isfinite(none) || none != calib::value({}, name)) return std::nullopt;
    calib::set(little, name, contains(names, name) ? none + kShare * (there - none) : there);
  }
  return little;
}

/// Runs whose load pulls from the beginning: nothing is balanced to the last digit.
std::vector<calib::SingleJoint> pulled(const bench::Bench& bench, const calib::JointModel& truth) {
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(bench, truth, 2)) {
    bench::BenchRun run = joint.run();
    run.load.hangs_at_rad = 0.3;
    run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(truth);
    joints.emplace_back(bench, run, joint.step_s());
  }
  return joints;
}

// Of joints with what a calibration may know, each with another part that an effect could meet.
TEST_P(NextToNone, OfAnyEffectMovesAJointAsNoneOfIt) {
  constexpr double kMost_rad = 1e-3;
  calib::JointModel joint = test::plain_joint(0.1);
  GetParam().set(joint.actuator);
  const bench::Bench bench = test::pd_bench(true);
  const NestedFit fit(pulled(bench, joint), 1);
  const BenchScale scale = scale_of(bench, fit.runs(), joint);
  std::size_t compared = 0;
  for (const Effect& effect : catalogue()) {
    for (const Form& form : effect.forms) {
      const std::optional<calib::JointModel> little = with_little(joint, effect, form, scale);
      if (!little) continue;
      const fitting::Residuals moved = fit.residuals(*little);
      ASSERT_FALSE(moved.empty()) << effect.name << ' ' << form.name;
      double most_rad = 0.0;
      for (const Eigen::VectorXd& run : moved) most_rad = std::max(most_rad, run.cwiseAbs().maxCoeff());
      EXPECT_LT(most_rad, kMost_rad) << effect.name << ' ' << form.name;
      ++compared;
    }
  }
  EXPECT_GE(compared, 40U);
}

const Known kKnown[] = {
    {"Nothing", [](auto&) {}},
    {"ACoarseSensor", [](auto& p) { p.sensor.quantum_rad = 5e-4; }},
    {"AHeldOutput", [](auto& p) { p.command.hold_s = 0.004; }},
    {"ADelay", [](auto& p) { p.command.delay_s = 0.006; }},
    {"LateReadings", [](auto& p) { p.sensor.delay_s = 0.006; }},
    {"ASoftShaft",
     [](auto& p) { p.transmission.stiffness_Nm_per_rad = 100.0, p.transmission.damping_Nm_s_per_rad = 0.2; }},
    {"Play",
     [](auto& p) {
       p.transmission.stiffness_Nm_per_rad = 300.0;
       p.transmission.damping_Nm_s_per_rad = 0.5;
       p.transmission.backlash_rad = 0.02;
     }},
};

INSTANTIATE_TEST_SUITE_P(Effects, NextToNone, testing::ValuesIn(kKnown),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace pmg::effects
