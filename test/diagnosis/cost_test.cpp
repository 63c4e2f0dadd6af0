// What a diagnosis costs, in rollouts: they don't depend on the machine.
#include "calib/simulated.hpp"
#include "diagnosis/rules_fixture.hpp"

namespace pmg::diagnosis {
namespace {

class Cost : public Rules {
 protected:
  /// Rollouts of the diagnosis of a delay, on so many times four runs, each of a trajectory of its own name.
  std::uint64_t rollouts(int fours) {
    calib::JointModel truth;
    truth.actuator = healthy_actuator();
    truth.actuator.command.delay_s = 0.015;
    std::vector<calib::SingleJoint> joints;
    for (int four = 0; four < fours; ++four) {
      for (const calib::SingleJoint& joint : test::record(bench_, truth, 4, 2e-4, 1 + static_cast<unsigned>(four))) {
        bench::BenchRun run = joint.run();
        run.trajectory = fmt::format("{} {}", run.trajectory, four);
        run.file = fmt::format("f{}_{}", four, run.file);
        joints.emplace_back(bench_, run, joint.step_s());
      }
    }
    const bench::Bench bench = written(joints);
    const std::uint64_t before = calib::simulated().rollouts;
    const Diagnosis found = diagnose(bench, given_healthy());
    EXPECT_EQ(found.verdict, evidence::Verdict::kFound);
    return calib::simulated().rollouts - before;
  }
};

TEST_F(Cost, GrowsNoFasterThanLinearlyWithRuns) {
  const std::uint64_t two = rollouts(2), four = rollouts(4), sixteen = rollouts(16);
  // The search's path may differ by a fit or two.
  constexpr double kPath = 1.25;
  EXPECT_LT(static_cast<double>(four), kPath * 2.0 * static_cast<double>(two));
  EXPECT_LT(static_cast<double>(sixteen), kPath * 4.0 * static_cast<double>(four));
}

}  // namespace
}  // namespace pmg::diagnosis
