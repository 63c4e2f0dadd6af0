#include "library_page/judgement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "pmg/types.hpp"

namespace pmg::library_page {
namespace {
using retargeting::ClipGoals;
using retargeting::Likeness;
using retargeting::ReviewedClip;
using work::Grade;

Judged judged(const std::string& word, const std::string& what, const std::string& measured, const std::string& limit,
              bool holds) {
  return {word, {what, measured, limit, holds ? Grade::kHolds : Grade::kMissed, holds ? "" : "MISSED"}};
}

Judged not_measured(const std::string& word, const std::string& what, const std::string& why,
                    const std::string& limit) {
  return {word, {what, why, limit, Grade::kPartial, "not measured"}};
}

double degrees(double rad) { return rad / kRadPerDegree; }
double mm(double m) { return 1000.0 * m; }

Judged judge_likeness(const char* what, const Likeness& made, const Likeness& in_limits, const ClipGoals& goals) {
  return judged(what, fmt::format("{} against the person's", what),
                fmt::format("r {:.3f}, RMS {:.1f} deg", made.correlation, degrees(made.rms_rad)),
                fmt::format("r {}, RMS {:.0f} deg; its limits allow {:.1f}", goals.correlation, degrees(goals.rms_rad),
                            degrees(in_limits.rms_rad)),
                made.correlation >= goals.correlation && made.rms_rad <= goals.rms_rad);
}

Judged judge_speed(const ReviewedClip& clip) {
  const auto channel = static_cast<std::size_t>(clip.recipe.channel);
  const double human = clip.human.mean_velocity[static_cast<Eigen::Index>(channel)];
  const double wanted = channel == kOmega ? human / clip.froude_ratio : human * clip.froude_ratio;
  constexpr double kTolerance = 0.05;  // as generator::report has it
  const double made = clip.clip.mean_velocity[channel];
  const char* unit = channel == kOmega ? "rad/s" : "m/s";
  return judged("speed", "speed, the person's by Froude's law", fmt::format("{:.3f} {}", made, unit),
                fmt::format("{:.3f} within {}", wanted, kTolerance), std::abs(made - wanted) <= kTolerance);
}

/// A recording without plates has no such figure.
Judged judge_events(const retargeting::PlateReview& plates, const ClipGoals& goals) {
  const char* what = "gait events against force plates";
  const std::string limit =
      fmt::format("{:.0f} ms in the mean, {:.0f} at most", 1000.0 * goals.event_mean_s, 1000.0 * goals.event_largest_s);
  if (plates.errors_s.empty()) return not_measured("events", what, "no foot on a plate", limit);
  double sum_s = 0.0, largest_s = 0.0;
  for (const double error_s : plates.errors_s) {
    sum_s += std::abs(error_s);
    largest_s = std::max(largest_s, std::abs(error_s));
  }
  const double mean_s = sum_s / static_cast<double>(plates.errors_s.size());
  return judged("events", what,
                fmt::format("{:.1f} ms in the mean of {}, {:.1f} at most", 1000.0 * mean_s, plates.errors_s.size(),
                            1000.0 * largest_s),
                limit, mean_s <= goals.event_mean_s && largest_s <= goals.event_largest_s);
}

void add_ground(const ReviewedClip& clip, const ClipGoals& goals, std::vector<Judged>& list) {
  const generator::GroundMeasure& full = clip.ground.gains.back().ground;
  list.push_back(judged("slide", "stance feet slide, mean in double support",
                        fmt::format("{:.1f} cm/s", 100.0 * full.slip_mean_m_s),
                        fmt::format("{:.0f} cm/s", 100.0 * goals.slide_m_s), full.slip_mean_m_s <= goals.slide_m_s));
  list.push_back(
      judged("stance height", "stance feet apart in height", fmt::format("{:.1f} mm", mm(full.other_foot_height_m)),
             fmt::format("{:.0f} mm", mm(goals.penetration_m)), full.other_foot_height_m <= goals.penetration_m));
  const double below_m = std::max(0.0, -full.lowest_swing_m);
  list.push_back(judged("swing", "a swinging sole below the ground", fmt::format("{:.1f} mm", mm(below_m)),
                        fmt::format("{:.0f} mm", mm(goals.penetration_m)), below_m <= goals.penetration_m));
  list.push_back(judged("gains", "on the ground at gains from 0.1 to 1 (pmg_clips show)",
                        clip.ground.failure.empty() ? "passes" : clip.ground.failure, "passes",
                        clip.ground.failure.empty()));
}

}  // namespace

std::vector<Judged> judge(const ReviewedClip& clip, const Measured& measured, const ClipGoals& goals) {
  std::vector<Judged> list = {judge_speed(clip)};
  list.push_back(judge_likeness("thigh", clip.made.thigh, clip.in_limits.thigh, goals));
  list.push_back(judge_likeness("knee", clip.made.knee, clip.in_limits.knee, goals));
  list.push_back(judge_likeness("ankle", clip.made.ankle, clip.in_limits.ankle, goals));
  const std::string off = fmt::format("{:.0f} cm", 100.0 * goals.scaled_off_m);
  list.push_back(judged("feet", "feet from the person's, limbs scaled",
                        fmt::format("{:.1f} cm", 100.0 * clip.feet_off_m), off, clip.feet_off_m <= goals.scaled_off_m));
  if (clip.hands_off_m) {
    list.push_back(judged("hands", "hands from the person's, limbs scaled",
                          fmt::format("{:.1f} cm", 100.0 * *clip.hands_off_m), off,
                          *clip.hands_off_m <= goals.scaled_off_m));
  } else {
    list.push_back(
        not_measured("hands", "hands from the person's, limbs scaled", "recording or robot has no arms", off));
  }
  list.push_back(judged("seam", "seam: jump of an angle", fmt::format("{:.4f} rad", clip.seam.angle_rad),
                        fmt::format("{} rad", goals.seam_rad), clip.seam.angle_rad <= goals.seam_rad));
  list.push_back(judged("seam speed", "seam: jump of a speed", fmt::format("{:.3f} rad/s", clip.seam.speed_rad_s),
                        fmt::format("{} rad/s", goals.seam_rad_s), clip.seam.speed_rad_s <= goals.seam_rad_s));
  add_ground(clip, goals, list);
  list.push_back(judged("joint limits", "distance from the nearest joint limit",
                        fmt::format("{:.3f} rad", clip.ground.limit_margin_rad), "0 or more",
                        clip.ground.limit_margin_rad >= 0.0));
  if (clip.plates) list.push_back(judge_events(*clip.plates, goals));
  const auto self = measured.self_collision.find(clip.recipe.name);
  if (self == measured.self_collision.end()) {
    list.push_back(
        not_measured("self-collision", "links into each other", "needs a build with the simulation", "none"));
  } else {
    const bool apart = self->second.depth_m <= 0.0;
    list.push_back(judged("self-collision", "links into each other",
                          apart ? "none" : fmt::format("{:.1f} mm: {}", mm(self->second.depth_m), self->second.links),
                          "none", apart));
  }
  return list;
}

work::Worth worth_of(const retargeting::LibraryReview& review, const Measured& measured, const ClipGoals& goals) {
  work::Worth worth;
  for (const ReviewedClip& clip : review.clips) {
    std::vector<std::string> missed, unknown;
    for (const Judged& one : judge(clip, measured, goals)) {
      if (one.shown.grade == Grade::kMissed) missed.push_back(one.word);
      if (one.shown.grade == Grade::kPartial) unknown.push_back(one.word);
    }
    worth.add_if(!missed.empty(), Grade::kMissed, fmt::format("{}: {}", clip.recipe.name, fmt::join(missed, ", ")));
    worth.add_if(!unknown.empty(), Grade::kPartial,
                 fmt::format("{}: not measured: {}", clip.recipe.name, fmt::join(unknown, ", ")));
  }
  worth.add_if(review.dynamic_total_s > goals.dynamic_total_s, Grade::kMissed,
               fmt::format("dynamic clips last {:.1f} s together, {:.0f} at most", review.dynamic_total_s,
                           goals.dynamic_total_s));
  return worth;
}

}  // namespace pmg::library_page
