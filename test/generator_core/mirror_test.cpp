#include "pmg/mirror.hpp"

#include <gtest/gtest.h>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

TEST(Mirror, ReflectedClipIsTheOtherSidesMotionHalfACycleLater) {
  const ClipLibrary library = make_library(31);
  const DynamicClip& clip = *library.positive[kVy];  // 96 samples: phi + 0.5 is also a sample
  const DynamicClip reflected = mirrored(library.mirror, clip);
  for (std::size_t k = 0; k < 96; ++k) {
    for (std::size_t i = 0; i < 31; ++i) {
      const int partner = library.mirror.partner[i];
      EXPECT_NEAR(reflected.q[k][static_cast<int>(i)], library.mirror.sign[i] * clip.q[(k + 48) % 96][partner], 1e-12);
      EXPECT_NEAR(reflected.dq_dphi[k][static_cast<int>(i)],
                  library.mirror.sign[i] * clip.dq_dphi[(k + 48) % 96][partner], 1e-10);
    }
  }
}

TEST(Mirror, ContactsSwapSidesAndSidewaysVelocitiesChangeSign) {
  ClipLibrary library = make_library(4);
  DynamicClip clip = *library.positive[kOmega];
  clip.contact_center = {0.31, 0.84};
  clip.duty_factor = {0.6, 0.65};
  clip.mean_velocity = {0.1, 0.2, 0.3};
  const DynamicClip reflected = mirrored(library.mirror, clip);
  EXPECT_NEAR(reflected.contact_center[kLeft], 0.34, 1e-15);
  EXPECT_NEAR(reflected.contact_center[kRight], 0.81, 1e-15);
  EXPECT_EQ(reflected.duty_factor, (PerFoot<double>{0.65, 0.6}));
  EXPECT_EQ(reflected.mean_velocity, (std::array<double, 3>{0.1, -0.2, -0.3}));
  EXPECT_EQ(reflected.period_s, clip.period_s);
}

TEST(Mirror, MirroringTwiceGivesTheClipBackAndASymmetricClipIsItsOwnImage) {
  const ClipLibrary library = make_library(31);
  const DynamicClip twice = mirrored(library.mirror, mirrored(library.mirror, *library.positive[kVy]));
  const DynamicClip own = mirrored(library.mirror, *library.positive[kVx]);
  for (std::size_t k = 0; k < twice.q.size(); ++k) {
    EXPECT_LT((twice.q[k] - library.positive[kVy]->q[k]).cwiseAbs().maxCoeff(), 1e-12);
  }
  for (std::size_t k = 0; k < own.q.size(); ++k) {
    EXPECT_LT((own.q[k] - library.positive[kVx]->q[k]).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// A library with clips of one side only, all of 1 s: half a cycle is 50 ticks of the control loop.
ClipLibrary one_second_library() {
  ClipLibrary library = LibraryMaker(31, 7).library();
  library.positive[kOmega] = LibraryMaker(31, 8).dynamic_clip(library.q_stand, 100, 1.0, 0.62, false);
  for (auto* side : {&library.positive, &library.negative}) {
    for (auto& clip : *side) {
      if (clip) clip->period_s = 1.0;
    }
  }
  return library;
}

TEST(Mirror, MirroredCommandGivesTheMirroredReferenceHalfACycleLater) {
  const ClipLibrary library = one_second_library();
  Generator left(library, make_options()), right(library, make_options());
  const Command to_left = make_command(0.2, 0.1, 0.2, 0.2, 0.1, -0.05);
  const Command to_right = make_command(0.2, -0.1, -0.2, 0.2, -0.1, -0.05);
  run(left, to_left, 4.0);
  run(right, to_right, 4.5);
  for (int tick = 0; tick < 100; ++tick) {
    const Reference& a = left.step(to_left, kDt_s);
    const Reference& b = right.step(to_right, kDt_s);
    ASSERT_NEAR(wrap_half_cycle(a.phase + 0.5 - b.phase), 0.0, 1e-9);
    // 1e-7: mirrored samples are the clip's own, phases differ by rounding, static clips are symmetric by construction.
    ASSERT_LT((mirrored(library.mirror, a.q) - b.q).cwiseAbs().maxCoeff(), 1e-7) << tick;
    ASSERT_LT((mirrored(library.mirror, a.dq) - b.dq).cwiseAbs().maxCoeff(), 1e-6) << tick;
    ASSERT_NEAR(a.contact_weight[kLeft], b.contact_weight[kRight], 1e-6) << tick;
    ASSERT_NEAR(a.contact_weight[kRight], b.contact_weight[kLeft], 1e-6) << tick;
    ASSERT_NEAR(a.command[kVy], -b.command[kVy], 1e-12);
    ASSERT_NEAR(a.command[kOmega], -b.command[kOmega], 1e-12);
  }
}

TEST(Mirror, NegativeCommandUsesItsOwnClipWhereThereIsOne) {
  ClipLibrary library = make_library(4);
  library.negative[kVy] = LibraryMaker(4, 99).dynamic_clip(library.q_stand, 64, 1.3, 0.6, false);
  Generator generator(library, make_options());
  const Reference reference = run(generator, make_command(0, -0.35, 0), 3.0);
  JointVector q(4), dq(4);
  ClipCurve(*library.negative[kVy]).sample(reference.phase, q, dq);
  EXPECT_LT((reference.q - q).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace pmg::test
