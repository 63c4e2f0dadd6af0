// The actor's observation, element by element.
#include "policy/observation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "model/robots.hpp"

namespace pmg::policy {
namespace {

using test::z1;

/// A state in which every number shows its place: joint i of tick t is at 100 t + i.
model::RobotState state_of(int tick) {
  model::RobotState state;
  const int n = z1().joint_index.size();
  state.q = JointVector::LinSpaced(n, 100.0 * tick, 100.0 * tick + n - 1);
  state.dq = 10.0 * state.q;
  state.gyro_rad_s = Eigen::Vector3d(tick, tick + 0.25, tick + 0.5);
  return state;
}

Reference reference() {
  Reference reference;
  reference.q = JointVector::LinSpaced(z1().joint_index.size(), -1.0, 1.0);
  reference.dq = 2.0 * reference.q;
  reference.phase = 0.25;
  reference.gain = 0.5;
  return reference;
}

const ObservationTerm& term(const ObservationLayout& layout, const std::string& name, int age_ticks) {
  for (const ObservationTerm& candidate : layout.terms()) {
    if (candidate.quantity->name == name && candidate.age_ticks == age_ticks) return candidate;
  }
  throw std::out_of_range(name);
}

TEST(ObservationLayout, TermsFillTheVectorWithoutGapsAndNameEveryElement) {
  const ObservationLayout layout(z1());
  int next = 0;
  for (const ObservationTerm& part : layout.terms()) {
    EXPECT_EQ(part.offset, next) << part.quantity->name;
    EXPECT_EQ(part.element.size(), part.index.size()) << part.quantity->name;
    next += part.size();
  }
  EXPECT_EQ(layout.size(), next);
  EXPECT_EQ(layout.action_joints().size(), 12u);
  EXPECT_NE(layout.to_json().find("\"gravity_direction\""), std::string::npos);
}

TEST(Observation, ShowsEachQuantityWhereTheLayoutSays) {
  Observation observation(z1());
  Command optimised;
  optimised[kVx] = 0.3;
  optimised[kHeight] = -0.1;
  const Eigen::VectorXf seen = observation.assemble(state_of(1), reference(), optimised, Eigen::VectorXf::Ones(12));
  const ObservationLayout& layout = observation.layout();
  const JointVector stand = z1().q_stand();
  const auto at = [&](const char* name, int element) { return seen[term(layout, name, 0).offset + element]; };
  const int knee = z1().joint_index.at("left_knee");
  EXPECT_FLOAT_EQ(at("gyro", 1), 1.25F);
  EXPECT_FLOAT_EQ(at("gravity_direction", 2), -1.0F);
  EXPECT_FLOAT_EQ(at("command", kVx), 0.3F);
  EXPECT_FLOAT_EQ(at("command", kHeight), -0.1F);
  EXPECT_FLOAT_EQ(at("phase", 0), 0.5F);  // a quarter of a cycle: the sine is the gain
  EXPECT_NEAR(at("phase", 1), 0.0F, 1e-6F);
  EXPECT_FLOAT_EQ(at("phase", 2), 0.5F);
  EXPECT_FLOAT_EQ(at("q", knee), static_cast<float>(100.0 + knee - stand[knee]));
  EXPECT_FLOAT_EQ(at("dq", knee), static_cast<float>(0.1 * 10.0 * (100.0 + knee)));
  EXPECT_FLOAT_EQ(at("q_ref", knee), static_cast<float>(reference().q[knee] - stand[knee]));
  EXPECT_FLOAT_EQ(at("last_action", 3), 1.0F);
}

TEST(Observation, OlderTermsShowWhatWasSeenThenAndTheFirstFrameBeforeThat) {
  Observation observation(z1());
  for (int tick = 0; tick < 9; ++tick) {
    const Eigen::VectorXf seen = observation.assemble(state_of(tick), reference(), Command{},
                                                      Eigen::VectorXf::Constant(12, static_cast<float>(tick)));
    for (const int age : ObservationLayout::kHistoryAges_ticks) {
      const auto then = static_cast<float>(std::max(0, tick - age));
      EXPECT_FLOAT_EQ(seen[term(observation.layout(), "gyro", age).offset], then) << "tick " << tick << ", age " << age;
      EXPECT_FLOAT_EQ(seen[term(observation.layout(), "last_action", age).offset], then);
    }
  }
  observation.reset();
  const Eigen::VectorXf seen = observation.assemble(state_of(20), reference(), Command{}, Eigen::VectorXf::Zero(12));
  EXPECT_FLOAT_EQ(seen[term(observation.layout(), "gyro", 6).offset], 20.0F);
}

}  // namespace
}  // namespace pmg::policy
