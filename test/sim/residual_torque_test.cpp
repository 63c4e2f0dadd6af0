// Residual torques of motor.yaml: within their axes, beyond them, and what they must never do.
#include "model/residual_torque.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "files/config_error.hpp"
#include "generator_core/allocation_count.hpp"
#include "sim/actuator_model.hpp"
#include "sim/motor_file.hpp"
#include "temporary_folder.hpp"

namespace pmg::sim {
namespace {

namespace fs = std::filesystem;
using model::ResidualActs;
using model::ResidualQuantity;
using testing::AllOf;
using testing::HasSubstr;

model::ResidualTerm curve(ResidualQuantity quantity, double low, double high, const std::vector<double>& values_Nm,
                          ResidualActs acts_as = ResidualActs::kTorque) {
  model::ResidualTerm term{
      acts_as, {model::ResidualAxis{quantity, low, high, static_cast<int>(values_Nm.size())}, {}}, {}};
  std::copy(values_Nm.begin(), values_Nm.end(), term.values_Nm.begin());
  return term;
}

/// Joint of 0.02 kg m^2 with this term alone.
class Joint {
 public:
  explicit Joint(const model::ResidualTerm& term, model::ActuatorParameters parameters = {})
      : actuator_((parameters.residual_torque = {.count = 1, .terms = {term}}, parameters), kStep_s) {}
  void move(const ActuatorInput& input, double push_Nm = 0.0) {
    const ActuatorTorque torque = actuator_.step(input, q_rad, dq_rad_s);
    dq_rad_s += kStep_s * (torque.torque_Nm + push_Nm) / (kInertia_kg_m2 - kStep_s * torque.slope_Nm_s_per_rad);
    q_rad += kStep_s * dq_rad_s;
  }
  double energy_J() const { return 0.5 * kInertia_kg_m2 * dq_rad_s * dq_rad_s; }

  static constexpr double kStep_s = 0.002, kInertia_kg_m2 = 0.02;
  double q_rad = 0.0, dq_rad_s = 0.0;

 private:
  ActuatorModel actuator_;
};

TEST(ResidualTerm, IsLinearBetweenItsKnotsAndZeroOneSpacingBeyond) {
  const model::ResidualTerm term = curve(ResidualQuantity::kPosition, -1.0, 1.0, {0.4, -0.2, 0.6});
  EXPECT_DOUBLE_EQ(term.at(-1.0, 0.0).value_Nm, 0.4);
  EXPECT_DOUBLE_EQ(term.at(-0.5, 0.0).value_Nm, 0.1);
  EXPECT_DOUBLE_EQ(term.at(0.25, 0.0).value_Nm, 0.0);
  EXPECT_DOUBLE_EQ(term.at(0.25, 0.0).slope, 0.8);
  EXPECT_DOUBLE_EQ(term.at(1.5, 0.0).value_Nm, 0.3);
  for (const double q_rad : {-1e6, -2.0, 2.0, 2.5, 1e6}) {
    EXPECT_EQ(term.at(q_rad, 0.0).value_Nm, 0.0) << q_rad;
    EXPECT_EQ(term.at(q_rad, 0.0).slope, 0.0) << q_rad;
  }
}

TEST(ResidualTerm, IsBilinearOverTwoQuantitiesAndNeverAboveItsValues) {
  model::ResidualTerm term{ResidualActs::kTorque,
                           {model::ResidualAxis{ResidualQuantity::kPosition, 0.0, 1.0, 2},
                            model::ResidualAxis{ResidualQuantity::kTime, 0.0, 2.0, 3}},
                           {0.0, 1.0, 2.0, 4.0, -3.0, 6.0}};
  EXPECT_DOUBLE_EQ(term.at(0.5, 0.5).value_Nm, 0.5);  // of 0, 1, 4 and -3
  EXPECT_DOUBLE_EQ(term.at(1.0, 3.0).value_Nm, 0.0);
  for (double q_rad = -2.0; q_rad < 3.0; q_rad += 0.07) {
    for (double t_s = -2.0; t_s < 5.0; t_s += 0.07) {
      EXPECT_LE(std::abs(term.at(q_rad, t_s).value_Nm), 6.0);
      const auto weights = term.weights(q_rad, t_s);
      double sum_Nm = 0.0;
      for (int i = 0; i < term.count(); ++i)
        sum_Nm += weights[static_cast<std::size_t>(i)] * term.values_Nm[static_cast<std::size_t>(i)];
      EXPECT_NEAR(sum_Nm, term.at(q_rad, t_s).value_Nm, 1e-12);
    }
  }
}

TEST(ResidualTerm, RepeatsEveryTurnWhereItIsPeriodic) {
  model::ResidualTerm term = curve(ResidualQuantity::kPosition, -0.3, 2.0 * M_PI - 0.3, {0.5, -0.1, 0.2, 0.9, -0.4});
  term.axes[0].periodic = true;
  for (double q_rad = -4.0; q_rad < 4.0; q_rad += 0.13)
    EXPECT_NEAR(term.at(q_rad, 0.0).value_Nm, term.at(q_rad + 4.0 * M_PI, 0.0).value_Nm, 1e-9);
  EXPECT_NEAR(term.at(-0.3 - 0.1 * M_PI * 2.0, 0.0).value_Nm, 0.5 * (0.5 - 0.4), 1e-12)
      << "between the last and the first";
}

TEST(ResidualTorque, PushesTheWayItsSignSays) {
  Joint joint(curve(ResidualQuantity::kPosition, -1.0, 1.0, {0.3, 0.3}));
  joint.move({});
  EXPECT_GT(joint.dq_rad_s, 0.0);
}

TEST(ResidualTorque, DoesNothingBeyondWhatWasRecorded) {
  Joint joint(curve(ResidualQuantity::kPosition, -1.0, 1.0, {0.3, 0.3, 0.3}));
  joint.q_rad = 2.5;
  for (int k = 0; k < 50; ++k) joint.move({});
  EXPECT_EQ(joint.q_rad, 2.5);
}

TEST(ResidualFriction, NeverDrivesWhateverItsValues) {
  model::ActuatorParameters dry;
  dry.friction.coulomb_Nm = 0.1;
  for (const double value_Nm : {-5.0, -0.05, 0.2, 5.0}) {
    for (const double middle_Nm : {-value_Nm, value_Nm}) {
      Joint joint(curve(ResidualQuantity::kSpeed, 0.0, 4.0, {value_Nm, middle_Nm, value_Nm}, ResidualActs::kFriction),
                  dry);
      joint.dq_rad_s = 3.0;
      for (int k = 0; k < 2000; ++k) {
        const double before_J = joint.energy_J();
        joint.move({});
        // At rest the bristle, a stiff spring, gives back what it took: half its limit times its bend.
        EXPECT_LE(joint.energy_J(), before_J + 0.5 * 5.1 * 1e-3) << value_Nm << ", step " << k;
      }
    }
  }
}

TEST(ResidualFriction, BringsAJointToRest) {
  Joint joint(curve(ResidualQuantity::kPosition, -10.0, 10.0, {0.2, 0.2}, ResidualActs::kFriction));
  joint.dq_rad_s = 3.0;
  for (int k = 0; k < 1000; ++k) joint.move({});
  EXPECT_LT(std::abs(joint.dq_rad_s), 1e-3);
}

TEST(ResidualTorque, OfABristleTakesEnergyInEveryCycle) {
  Joint joint(curve(ResidualQuantity::kBend, -0.1, 0.1, {0.5, 0.0, -0.5}));
  double work_J = 0.0;
  for (int k = 0; k < 3000; ++k) {  // pushed to and fro by 1.2 Nm, more than the bristle holds
    const double push_Nm = (k / 250) % 2 == 0 ? 1.2 : -1.2;
    joint.move({}, push_Nm);
    work_J += push_Nm * joint.dq_rad_s * Joint::kStep_s;
  }
  EXPECT_GT(work_J - joint.energy_J(), 0.5);
}

TEST(ResidualTorque, IsStableHoweverSteep) {
  // h^2 stiffness / inertia is 10: an explicit step bears 4. With the slope it is 10 / 11, which swings by a seventh
  // more than it began with.
  Joint joint(curve(ResidualQuantity::kPosition, -0.05, 0.05, {2500.0, -2500.0}));
  joint.q_rad = 0.009;
  for (int k = 0; k < 500; ++k) {
    joint.move({});
    EXPECT_LT(std::abs(joint.q_rad), 0.011) << "step " << k;
  }
}

TEST(ResidualTorque, OfAnIntegralPushesOnWhileAnErrorStays) {
  Joint joint(curve(ResidualQuantity::kIntegral, -10.0, 10.0, {-10.0, 10.0}));
  for (int k = 0; k < 4000; ++k) joint.move({.q_rad = 0.3, .kp = 5.0, .kd = 0.4}, -1.0);
  EXPECT_NEAR(joint.q_rad, 0.3, 0.01) << "a PD alone would stay 0.2 rad behind";
}

TEST(ResidualTorque, OfTheCommandsChangeMakesItActLate) {
  model::ResidualTerm late = curve(ResidualQuantity::kCommandChange, -10.0, 10.0, {10.0, -10.0});
  late.axes[0].lag_s = 0.1;
  Joint joint(late), prompt(curve(ResidualQuantity::kPosition, 0.0, 1.0, {0.0, 0.0}));
  const ActuatorInput before{.q_rad = 0.0, .kp = 20.0, .kd = 1.0}, after{.q_rad = 0.3, .kp = 20.0, .kd = 1.0};
  for (int k = 0; k < 50; ++k) joint.move(before), prompt.move(before);
  EXPECT_EQ(joint.q_rad, 0.0);
  for (int k = 0; k < 25; ++k) joint.move(after), prompt.move(after);
  EXPECT_LT(joint.q_rad, 0.6 * prompt.q_rad) << "after half of the lag";
  for (int k = 0; k < 600; ++k) joint.move(after);
  EXPECT_NEAR(joint.q_rad, 0.3, 1e-3) << "in the end it is there";
}

class ResidualTorqueFile : public testing::Test {
 protected:
  ~ResidualTorqueFile() override { fs::remove(file_); }
  std::string refusal(const std::string& residual) const {
    std::ofstream(file_) << "joints:\n  knee:\n    residual_torque: " << residual << "\n";
    try {
      read_motor_file(file_);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }
  const test::TemporaryFolder folder_;
  const fs::path file_ = folder_.file("motor.yaml");
};

TEST_F(ResidualTorqueFile, HoldsEveryNumberExactly) {
  model::ActuatorParameters actuator;
  model::ResidualTerm round = curve(ResidualQuantity::kPosition, -0.3, -0.3 + 2.0 * M_PI, {0.1, 1.0 / 3.0, -2e-9});
  round.axes[0].periodic = true;
  const model::ResidualTerm map{ResidualActs::kFriction,
                                {model::ResidualAxis{ResidualQuantity::kSpeed, 0.0, 1.0 / 7.0, 2},
                                 model::ResidualAxis{ResidualQuantity::kTemperature, 20.0, 60.0, 3}},
                                {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}};
  actuator.residual_torque = {.count = 2, .terms = {round, map}};
  std::ofstream(file_) << motor_yaml({{"knee", actuator}});
  EXPECT_EQ(read_motor_file(file_).at("knee"), actuator);
}

TEST_F(ResidualTorqueFile, IsRefusedWithPlaceAndReason) {
  const auto term = [](const std::string& acts_as, const std::string& over, const std::string& values) {
    return "{terms: [{acts_as: " + acts_as + ", over: [" + over + "], values_Nm: [" + values + "]}]}";
  };
  const std::string axis = "{quantity: position_rad, from: 0, to: 1, knots: 2}";
  EXPECT_EQ(refusal(term("torque", axis, "1, 2")), "accepted");
  EXPECT_THAT(refusal(term("torque", axis, "1, 2, 3")), AllOf(HasSubstr("motor.yaml:3"), HasSubstr("values_Nm")));
  EXPECT_THAT(refusal(term("brake", axis, "1, 2")), AllOf(HasSubstr("acts_as"), HasSubstr("friction")));
  EXPECT_THAT(refusal(term("torque", "{quantity: weather, from: 0, to: 1, knots: 2}", "1, 2")),
              AllOf(HasSubstr("quantity"), HasSubstr("position_rad")));
  EXPECT_THAT(refusal(term("torque", "{quantity: position_rad, from: 1, to: 0, knots: 2}", "1, 2")),
              HasSubstr("empty"));
  EXPECT_THAT(refusal(term("torque", "{quantity: speed_rad_s, from: 0, to: 1, knots: 2}", "1, 2")),
              HasSubstr("drive the joint"));
  EXPECT_THAT(refusal(term("torque", "{quantity: drive_Nm, periodic: true, from: 0, to: 1, knots: 2}", "1, 2")),
              HasSubstr("periodic"));
  EXPECT_THAT(refusal(term("torque", axis + ", " + axis + ", " + axis, "1, 2")), HasSubstr("one or two"));
  EXPECT_THAT(refusal(term("torque", "{quantity: bend_rad, from: -0.1, to: 0.1, knots: 3}", "0.5, -0.5, -0.4")),
              HasSubstr("would drive the joint"));
  EXPECT_THAT(refusal(term("torque", axis + ", {quantity: bend_rad, from: -0.1, to: 0.1, knots: 2}", "1, 0, 0, 1")),
              HasSubstr("would drive the joint"));
  EXPECT_EQ(refusal(term("friction", "{quantity: bend_rad, from: -0.1, to: 0.1, knots: 2}", "0, 1")), "accepted");
  EXPECT_THAT(refusal(term("torque", "{quantity: integral_Nm_s, from: -1, to: 1, knots: 2}", "0.3, -0.3")),
              HasSubstr("away from the command"));
  EXPECT_THAT(refusal(term("torque", axis + ", " + axis, "1, 2, 3, 4")), HasSubstr("both axes"));
  EXPECT_THAT(refusal(term("torque", "{quantity: command_change_Nm, from: -1, to: 1, knots: 2, lag_s: 0.02}", "-1, 1")),
              HasSubstr("before the command"));
  EXPECT_THAT(refusal(term("torque", "{quantity: command_change_Nm, from: -1, to: 1, knots: 2, lag_s: 0}", "1, -1")),
              HasSubstr("lag_s"));
  EXPECT_THAT(refusal(term("torque", "{quantity: command_change_Nm, from: -1, to: 1, knots: 2}", "1, -1")),
              HasSubstr("lag_s"));
  EXPECT_THAT(refusal(term("torque", axis, ".nan, 1")), HasSubstr("finite"));
  EXPECT_THAT(refusal("{terms: []}"), HasSubstr("terms"));
  EXPECT_THAT(refusal("{terms: [], more: 1}"), HasSubstr("motor.yaml:3"));
}

TEST(ResidualTorque, CostsNoHeap) {
  PMG_SKIP_IF_HEAP_IS_NOT_COUNTED();
  Joint joint(curve(ResidualQuantity::kBend, -0.1, 0.1, {0.5, 0.0, -0.5}));
  const long before = test::allocation_count();
  for (int k = 0; k < 20; ++k) joint.move({.q_rad = 0.3, .kp = 5.0});
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace pmg::sim
