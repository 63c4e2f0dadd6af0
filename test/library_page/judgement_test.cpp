// The promises of a library's page: every figure has its limit, and nothing is green that missed it or wasn't measured.
#include "library_page/judgement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "library_page/library_page.hpp"

namespace pmg::library_page {
namespace {

using retargeting::Likeness;
using retargeting::ReviewedClip;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A clip that is as asked in everything.
ReviewedClip good() {
  ReviewedClip clip;
  clip.recipe.name = "forward";
  clip.recipe.recording = "walk.bvh";
  clip.human.mean_velocity.x() = 1.0;
  clip.human.cut.to_s = 1.0;
  clip.human.cut.contact = {{{0.3, 0.6}, {0.8, 0.6}}};
  clip.froude_ratio = 0.9;
  clip.clip.mean_velocity[kVx] = 0.9;
  clip.clip.period_s = 1.0;
  clip.clip.contact_center = {0.3, 0.8};
  clip.clip.duty_factor = {0.6, 0.6};
  constexpr std::size_t kSamples = 100;
  retargeting::Figure figure;
  figure[static_cast<std::size_t>(mocap::KeyBody::pelvis)] = Eigen::Vector3d(0.0, 0.0, 0.8);
  figure[static_cast<std::size_t>(mocap::KeyBody::neck)] = Eigen::Vector3d(0.0, 0.0, 1.3);
  clip.person = clip.robot = std::vector<retargeting::Figure>(kSamples, figure);
  for (auto* legs : {&clip.person_legs, &clip.robot_legs}) {
    for (retargeting::LegAngles& leg : *legs) leg.thigh = leg.knee = leg.ankle = std::vector<double>(kSamples, 0.1);
  }
  clip.hands_off_m = 0.01;
  clip.ground.gains.emplace_back();
  clip.ground.limit_margin_rad = 0.1;
  return clip;
}
const Measured kApart{{{"forward", {}}}};

std::vector<std::string> words(const ReviewedClip& clip, const Measured& measured, work::Grade grade) {
  std::vector<std::string> found;
  for (const Judged& one : judge(clip, measured)) {
    if (one.shown.grade == grade) found.push_back(one.word);
  }
  return found;
}

TEST(ALibrarysFigures, HoldWhereEachIsWithinItsLimit) {
  EXPECT_THAT(words(good(), kApart, work::Grade::kMissed), IsEmpty());
  EXPECT_THAT(words(good(), kApart, work::Grade::kPartial), IsEmpty());
  EXPECT_EQ(worth_of({.source = "", .robot = "z1", .clips = {good()}}, kApart).sentence(), "");
}

TEST(ALibrarysFigures, AreMissedEachByItself) {
  const std::vector<std::pair<std::string, std::function<void(ReviewedClip&)>>> breaks = {
      {"speed", [](ReviewedClip& c) { c.clip.mean_velocity[kVx] = 0.8; }},
      {"thigh", [](ReviewedClip& c) { c.made.thigh.rms_rad = 0.1; }},
      {"knee", [](ReviewedClip& c) { c.made.knee.correlation = 0.97; }},
      {"ankle", [](ReviewedClip& c) { c.made.ankle.rms_rad = 0.1; }},
      {"feet", [](ReviewedClip& c) { c.feet_off_m = 0.031; }},
      {"hands", [](ReviewedClip& c) { c.hands_off_m = 0.031; }},
      {"seam", [](ReviewedClip& c) { c.seam.angle_rad = 0.021; }},
      {"seam speed", [](ReviewedClip& c) { c.seam.speed_rad_s = 0.31; }},
      {"slide", [](ReviewedClip& c) { c.ground.gains.back().ground.slip_mean_m_s = 0.021; }},
      {"stance height", [](ReviewedClip& c) { c.ground.gains.back().ground.other_foot_height_m = 0.011; }},
      {"swing", [](ReviewedClip& c) { c.ground.gains.back().ground.lowest_swing_m = -0.011; }},
      {"gains", [](ReviewedClip& c) { c.ground.failure = "feet slip"; }},
      {"events",
       [](ReviewedClip& c) {
         c.plates = retargeting::PlateReview{{}, {0.016, -0.016}};
       }},
      {"events",
       [](ReviewedClip& c) {
         c.plates = retargeting::PlateReview{{}, {0.0, 0.0, 0.031}};
       }},
      {"joint limits", [](ReviewedClip& c) { c.ground.limit_margin_rad = -0.001; }}};
  for (const auto& [word, spoil] : breaks) {
    ReviewedClip clip = good();
    spoil(clip);
    EXPECT_THAT(words(clip, kApart, work::Grade::kMissed), ElementsAre(word));
    const work::Worth worth = worth_of({.source = "", .robot = "z1", .clips = {clip}}, kApart);
    EXPECT_EQ(worth.sentence(), "MISSED: forward: " + word);
  }
  EXPECT_THAT(words(good(), {{{"forward", {0.004, "hand and thigh"}}}}, work::Grade::kMissed),
              ElementsAre("self-collision"));
}

TEST(ALibrarysFigures, AreNotMeasuredRatherThanGoodWhereNobodyMeasuredThem) {
  ReviewedClip clip = good();
  clip.hands_off_m.reset();
  EXPECT_THAT(words(clip, {}, work::Grade::kPartial), ElementsAre("hands", "self-collision"));
  EXPECT_FALSE(worth_of({.source = "", .robot = "z1", .clips = {clip}}, {}).usable());
  clip = good();
  clip.plates.emplace();  // and no foot on them
  EXPECT_THAT(words(clip, kApart, work::Grade::kPartial), ElementsAre("events"));
}

TEST(ALibrarysFigures, CountTheLengthOfAllClipsTogether) {
  EXPECT_THAT(worth_of({.source = "", .robot = "z1", .clips = {good()}, .dynamic_total_s = 10.1}, kApart).sentence(),
              HasSubstr("10.1 s together"));
}

TEST(ALibrarysPage, ShowsPersonAndRobotAndEveryFigureWithItsWord) {
  ReviewedClip clip = good();
  clip.made.knee = Likeness{.rms_rad = 0.2, .shape_rad = 0.1, .correlation = 0.9};
  const retargeting::LibraryReview review{
      .source = "<somebody>", .robot = "z1", .clips = {clip}, .dynamic_total_s = 1.0};
  const std::string html = page_of(review, kApart).html();
  EXPECT_THAT(html, Not(HasSubstr("<somebody>")));
  EXPECT_THAT(html, HasSubstr("MISSED: forward: knee"));
  EXPECT_THAT(html, HasSubstr("the person, scaled by leg length"));
  EXPECT_THAT(html, HasSubstr("<animate"));
  EXPECT_THAT(html, HasSubstr("published mean"));
  for (const Judged& one : judge(clip, kApart)) EXPECT_THAT(html, HasSubstr(one.shown.measured)) << one.word;
  // Bands are of people who walk forward.
  clip.recipe.sign = -1.0;
  EXPECT_THAT(page_of({.source = "", .robot = "z1", .clips = {clip}}, kApart).html(), Not(HasSubstr("published mean")));
}

}  // namespace
}  // namespace pmg::library_page
