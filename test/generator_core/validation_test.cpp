// Libraries and options that would move the robot wrongly are refused at load, with the reason in the message.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

struct Defect {
  const char* name;
  const char* says;  ///< part of the message
  std::function<void(ClipLibrary&, GeneratorOptions&)> make;
};

void PrintTo(const Defect& defect, std::ostream* out) { *out << defect.name; }

class Refused : public ::testing::TestWithParam<Defect> {};

TEST_P(Refused, WithAMessageThatSaysWhatWasExpected) {
  ClipLibrary library = make_library(5);
  GeneratorOptions options = make_options();
  ASSERT_NO_THROW(Generator(library, options));
  GetParam().make(library, options);
  try {
    Generator generator(library, options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Generator, Refused,
    ::testing::Values(
        Defect{"EmptyStand", "q_stand", [](ClipLibrary& l, auto&) { l.q_stand.resize(0); }},
        Defect{"JointCountOfLimits", "q_lower", [](ClipLibrary& l, auto&) { l.q_lower.setConstant(4, -3.0); }},
        Defect{"JointCountOfAClip", "vy_m_s > 0", [](ClipLibrary& l, auto&) { l.positive[kVy]->q[3].setZero(6); }},
        Defect{"JointCountOfSlopes", "dq_dphi", [](ClipLibrary& l, auto&) { l.positive[kVy]->dq_dphi[3].setZero(6); }},
        Defect{"NotANumberInAClip", "vx_m_s < 0: q[2]",
               [](ClipLibrary& l, auto&) { l.negative[kVx]->q[2][1] = kNotANumber; }},
        Defect{"StandOutsideLimits", "q_stand[2]", [](ClipLibrary& l, auto&) { l.q_upper[2] = l.q_stand[2] - 0.1; }},
        Defect{"StandWithinTheMargin", "q_stand[2]", [](ClipLibrary& l, auto&) { l.q_lower[2] = l.q_stand[2] - 0.01; }},
        Defect{"TooFewSamples", "samples",
               [](ClipLibrary& l, auto&) {
                 l.positive[kVx]->q.resize(7);
                 l.positive[kVx]->dq_dphi.resize(7);
               }},
        Defect{"SlopeMissing", "dq_dphi", [](ClipLibrary& l, auto&) { l.positive[kVx]->dq_dphi.pop_back(); }},
        Defect{"PeriodZero", "period_s", [](ClipLibrary& l, auto&) { l.positive[kOmega]->period_s = 0.0; }},
        Defect{"DutyFactorZero", "duty_factor",
               [](ClipLibrary& l, auto&) { l.positive[kVx]->duty_factor[kRight] = 0.0; }},
        Defect{"DutyFactorAboveOne", "duty_factor",
               [](ClipLibrary& l, auto&) { l.positive[kVx]->duty_factor[kLeft] = 1.01; }},
        Defect{"ContactCenterOne", "contact_center",
               [](ClipLibrary& l, auto&) { l.positive[kVx]->contact_center[kLeft] = 1.0; }},
        Defect{"ContactCentersApart", "contact centres",
               [](ClipLibrary& l, auto&) { l.positive[kVx]->contact_center[kLeft] += 0.17; }},
        Defect{"ContactCentersOfAMirroredClipApart", "vy_m_s < 0",
               [](ClipLibrary& l, auto&) {
                 // Each side alone is within 0.15 of the others, but its mirror image is not.
                 l.positive[kVy]->contact_center = {0.21, 0.93};
               }},
        Defect{"PostureRangeWithoutZero", "contain 0",
               [](ClipLibrary& l, auto&) {
                 for (double& u : l.posture[0].command) u += 1.0;
               }},
        Defect{"PostureCommandsNotIncreasing", "increase",
               [](ClipLibrary& l, auto&) { l.posture[1].command[5] = l.posture[1].command[4]; }},
        Defect{"PostureRowMissing", "postures", [](ClipLibrary& l, auto&) { l.posture[2].q.pop_back(); }},
        Defect{"PostureOfAnotherStand", "standing posture",
               [](ClipLibrary& l, auto&) {
                 for (JointVector& q : l.posture[2].q) q[0] += 0.05;
               }},
        Defect{"MirrorMissing", "mirror", [](ClipLibrary& l, auto&) { l.mirror = MirrorMap{}; }},
        Defect{"MirrorOneWay", "paired both ways", [](ClipLibrary& l, auto&) { l.mirror.partner[0] = 2; }},
        Defect{"MirrorSign", "sign", [](ClipLibrary& l, auto&) { l.mirror.sign[1] = 0.5; }},
        Defect{"ScaleZero", "scale of omega_rad_s", [](auto&, GeneratorOptions& o) { o.scale_negative[kOmega] = 0.0; }},
        Defect{"RangeWithoutZero", "vx_m_s", [](auto&, GeneratorOptions& o) { o.limits.lower[kVx] = 0.1; }},
        Defect{"RateNegative", "rate", [](auto&, GeneratorOptions& o) { o.limits.rate_per_s[kRoll] = -1.0; }},
        Defect{"DoubleSupportRateZero", "double_support_rate",
               [](auto&, GeneratorOptions& o) { o.double_support_rate = 0.0; }},
        Defect{"StopTimeZero", "stop_within_s", [](auto&, GeneratorOptions& o) { o.stop_within_s = 0.0; }},
        Defect{"EdgeZero", "contact_edge_cycle", [](auto&, GeneratorOptions& o) { o.contact_edge_cycle = 0.0; }}),
    [](const ::testing::TestParamInfo<Defect>& test) { return test.param.name; });

TEST(Generator, AcceptsALibraryWithoutVelocityClipsAsOneThatOnlyStands) {
  ClipLibrary library = make_library(5);
  library.positive = {};
  library.negative = {};
  Generator generator(library, make_options());
  const Reference r = run(generator, make_command(0.5, 0, 0, 0.2), 2.0);
  EXPECT_EQ(r.gain, 0.0);
  EXPECT_NEAR(r.command[kPitch], 0.2, 1e-12);
}

}  // namespace
}  // namespace pmg::test
