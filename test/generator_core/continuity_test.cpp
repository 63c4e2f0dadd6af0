// q_ref is continuous and dq_ref is its derivative, whatever the user commands.
#include <gtest/gtest.h>

#include <limits>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

/// Largest speed of each joint in a library [rad/s]: clips' slopes at the fastest phase rate, gains at their fastest
/// change, posture slopes at their rates.
JointVector speed_bound(const ClipLibrary& library, const GeneratorOptions& options) {
  const auto joints = library.q_stand.size();
  JointVector slope = JointVector::Zero(joints), excursion = JointVector::Zero(joints),
              posture = JointVector::Zero(joints);
  double shortest_s = 1e9;
  for (const auto* side : {&library.positive, &library.negative}) {
    for (const auto& clip : *side) {
      if (!clip) continue;
      shortest_s = std::min(shortest_s, clip->period_s);
      const DynamicClip reflected = mirrored(library.mirror, *clip);
      for (const DynamicClip* c : {&*clip, &reflected}) {
        for (std::size_t k = 0; k < c->q.size(); ++k) {
          slope = slope.cwiseMax(c->dq_dphi[k].cwiseAbs());
          excursion = excursion.cwiseMax((c->q[k] - library.q_stand).cwiseAbs());
        }
      }
    }
  }
  double gain_rate =
      0.0;  // a stop takes 0.45 s; sharing one whole gait at most doubles it, since d(n/S) = dn/S - n dS/S^2
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    const double scale = std::min(options.scale_positive[c], options.scale_negative[c]);
    const double full = std::max(options.limits.upper[c], -options.limits.lower[c]) / options.stop_within_s;
    gain_rate += 2.0 * std::max(options.limits.rate_per_s[c], full) / scale;
  }
  for (std::size_t i = 0; i < kPostureChannels; ++i) {
    const StaticClip& clip = library.posture[i];
    JointVector steepest = JointVector::Zero(joints);
    for (std::size_t row = 1; row < clip.q.size(); ++row) {
      steepest =
          steepest.cwiseMax((clip.q[row] - clip.q[row - 1]).cwiseAbs() / (clip.command[row] - clip.command[row - 1]));
    }
    posture += options.limits.rate_per_s[kVelocityChannels + i] * steepest;
  }
  // 1 %: between samples, slopes and excursions are a little larger than at the samples.
  return 1.01 * (slope / shortest_s + gain_rate * excursion) + posture;
}

TEST(Generator, ReferenceIsContinuousUnderArbitraryCommands) {
  for (const int joints : {3, 31}) {
    for (const Blend blend : {Blend::kGain, Blend::kPaper, Blend::kCorners}) {
      const ClipLibrary library = make_library(joints, 11);
      GeneratorOptions options = make_options();
      options.blend = blend;
      // The paper's weights are shares of the summed speeds. Near zero they change completely within 1e-6 m/s, but
      // there the amplitudes are just as small; elsewhere w_i alpha_i changes at most three times as fast as alpha_i. A
      // corner's superposition is at most as fast as its three directions and the two subtracted lifts together.
      const JointVector bound = (blend == Blend::kGain    ? 1.0
                                 : blend == Blend::kPaper ? 3.0
                                                          : 5.0) *
                                speed_bound(library, options);
      Generator generator(library, options);
      std::mt19937_64 random(23);
      std::uniform_real_distribution<double> any(-1.0, 1.0), toss(0.0, 1.0);
      Command user;
      JointVector previous = generator.reference().q;
      for (int tick = 0; tick < 30000; ++tick) {
        for (double& u : user.u) {
          if (toss(random) < 0.01) u = any(random);
          if (toss(random) < 0.005) u = 0.0;
          if (toss(random) < 0.001) u = std::numeric_limits<double>::quiet_NaN();
        }
        if (toss(random) < 0.003) user = Command{};
        const Reference& r = generator.step(user, kDt_s);
        ASSERT_LE(((r.q - previous).cwiseAbs() - bound * kDt_s).maxCoeff(), 0.0) << "tick " << tick;
        ASSERT_LE((r.dq.cwiseAbs() - bound).maxCoeff(), 0.0) << "tick " << tick;
        previous = r.q;
      }
    }
  }
}

TEST(Generator, JointVelocityIsTheTimeDerivativeOfTheReference) {
  const ClipLibrary library = make_library(31, 2);
  constexpr double kFine_s = 1e-4;
  Generator generator(library, make_options());
  std::mt19937_64 random(29);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Command user;
  JointVector q_before = generator.reference().q, q_here = q_before, dq_here = generator.reference().dq;
  Command command_before, command_here, rate_here;
  int smooth = 0, moving_gains = 0;
  for (int tick = 0; tick < 60000; ++tick) {
    if (tick % 6000 == 0) {
      for (double& u : user.u) u = 0.6 * any(random);
    }
    const Reference& r = generator.step(user, kFine_s);
    // Smooth ticks have the same rates before and after: no limiter starts or ends a ramp, and no contact edge slows
    // one.
    double jump = 0.0, moving = 0.0;
    bool turns = false;
    for (std::size_t c = 0; c < kChannels; ++c) {
      jump = std::max(jump, std::abs(r.command_rate.u[c] - rate_here.u[c]));
      moving = std::max(moving, std::abs(rate_here.u[c]));
      turns = turns || std::signbit(r.command.u[c]) != std::signbit(command_before.u[c]);  // kink: another clip
    }
    if (jump < 1e-3 && !turns && tick > 2) {
      ++smooth;
      moving_gains += moving > 0.1 ? 1 : 0;
      const JointVector central = (r.q - q_before) / (2.0 * kFine_s);
      // At knots the second derivatives jump by up to 50 rad/s^2: 50 dt / 2 = 2.5e-3 rad/s. Other errors are smaller:
      // third derivatives times dt^2 / 6, and rates that differ by up to 1e-3 between ticks times an excursion of 0.5
      // rad.
      ASSERT_LT((central - dq_here).cwiseAbs().maxCoeff(), 5e-3) << tick;
    }
    q_before = q_here;
    q_here = r.q;
    dq_here = r.dq;
    command_before = command_here;
    command_here = r.command;
    rate_here = r.command_rate;
  }
  EXPECT_GT(smooth, 30000);
  EXPECT_GT(moving_gains, 5000);  // ticks in which gains or posture move
}

TEST(Generator, CommandRateIsTheDifferenceOfTheReportedCommands) {
  Generator generator(make_library(7), make_options());
  Command previous;
  for (int tick = 0; tick < 300; ++tick) {
    const Reference& r = generator.step(make_command(0.6, 0.3, -0.5, 0.3, 0.1, -0.1), kDt_s);
    for (std::size_t c = 0; c < kChannels; ++c) {
      ASSERT_NEAR(r.command_rate.u[c], (r.command.u[c] - previous.u[c]) / kDt_s, 1e-9);
    }
    previous = r.command;
  }
}

}  // namespace
}  // namespace pmg::test
