// Least squares over rollouts that are compared with coarse readings.
#include "effects/nested_fit.hpp"

#include <gtest/gtest.h>

#include <string>

#include "calib/synthetic_bench.hpp"

namespace pmg::effects {
namespace {

// With the steps of a fine sensor it takes off one percent.
TEST(NestedFit, DoesNotStopWhereItBeganBecauseTheEncoderIsCoarse) {
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel truth = test::plain_joint(0.2);
  truth.actuator.sensor.quantum_rad = 0.025;
  const NestedFit fit(test::record(bench, truth, 12), 1);
  calib::JointModel start = truth;
  calib::Unknowns numbers;
  for (const std::string name : {"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "transmission.armature_kg_m2",
                                 "drive.kp_scale", "drive.kd_scale"}) {
    numbers.push_back(unknown(name, bench, scale_of(bench, fit.runs(), truth)));
    calib::set(start, name, 1.1 * calib::value(truth, name));
  }
  const double before = fitting::sum_of_squares(fit.residuals(start));
  EXPECT_LT(fit.fit(start, numbers, 15).squares, 0.7 * before);
}

}  // namespace
}  // namespace pmg::effects
