#include "library_page/library_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "generator/published_gait.hpp"
#include "pmg/types.hpp"

namespace pmg::library_page {
namespace {
using retargeting::Figure;
using retargeting::Imitation;
using retargeting::LegAngles;
using retargeting::Likeness;
using retargeting::ReviewedClip;

constexpr std::size_t kStills = 10;
constexpr std::size_t kMovingStep = 4;  // samples a picture of moving figures: 25 a cycle

const char* colour_of(mocap::KeyBody body) {
  const std::string name = mocap::kKeyBodyNames[static_cast<std::size_t>(body)];
  if (name.starts_with("left_")) return pages::colour::kBlue;
  return name.starts_with("right_") ? pages::colour::kVermillion : pages::colour::kInk;
}

/// Seen from the right, so that forward is to the right; a sidestep is seen from the front, its left to the right.
pages::StickFigure drawn(const Figure& figure, Channel channel) {
  const auto across = [channel](const Eigen::Vector3d& p) { return channel == kVy ? p.y() : p.x(); };
  pages::StickFigure out;
  for (const auto& [from, to] : retargeting::figure_bones()) {
    const auto &a = figure[static_cast<std::size_t>(from)], &b = figure[static_cast<std::size_t>(to)];
    if (a && b) out.bones.push_back({across(*a), a->z(), across(*b), b->z(), colour_of(to)});
  }
  return out;
}

std::vector<pages::StickFigure> every(std::size_t step, const std::vector<Figure>& figures, Channel channel) {
  std::vector<pages::StickFigure> out;
  for (std::size_t k = 0; k < figures.size(); k += step) out.push_back(drawn(figures[k], channel));
  return out;
}

void add_figures(const ReviewedClip& clip, pages::Page& page) {
  const Channel channel = clip.recipe.channel;
  const std::string view = channel == kVy ? "from the front" : "from the right";
  std::vector<std::string> phases;
  const std::size_t step = clip.robot.size() / kStills;
  for (std::size_t k = 0; k < clip.robot.size(); k += step)
    phases.push_back(fmt::format("{:.0f} %", 100.0 * static_cast<double>(k) / static_cast<double>(clip.robot.size())));
  page.columns([&] {
    page.figures(pages::Figures{.title = fmt::format("{}, {}: left blue, right orange", clip.recipe.name, view),
                                .columns = phases,
                                .rows = {{"the person, scaled by leg length", every(step, clip.person, channel)},
                                         {"the robot", every(step, clip.robot, channel)}}});
    page.figures(pages::MovingFigures{.title = fmt::format("{}, moving at the robot's pace", clip.recipe.name),
                                      .rows = {{"the person", every(kMovingStep, clip.person, channel)},
                                               {"the robot", every(kMovingStep, clip.robot, channel)}},
                                      .period_s = clip.clip.period_s});
  });
}

/// From the leg's own initial contact on, in degrees.
std::vector<double> from_contact(const std::vector<double>& rad, Foot foot) {
  std::vector<double> deg;
  const std::size_t n = rad.size(), shift = foot == kLeft ? 0 : n / 2;
  for (std::size_t k = 0; k < n; ++k) deg.push_back(rad[(k + shift) % n] / kRadPerDegree);
  return deg;
}

struct PublishedBand {
  std::vector<double> mean, lower, upper;  // [deg]
};

PublishedBand band(const generator::PublishedCurve& curve, double minus_deg, double deviation_deg,
                   std::size_t samples) {
  PublishedBand out;
  for (std::size_t k = 0; k < samples; ++k) {
    const double phase = static_cast<double>(k) / static_cast<double>(samples);
    const double mean = curve.at_rad(phase) / kRadPerDegree - minus_deg;
    out.mean.push_back(mean);
    out.lower.push_back(mean - deviation_deg);
    out.upper.push_back(mean + deviation_deg);
  }
  return out;
}

struct Joint {
  const char* name;
  std::vector<double> LegAngles::*angles;
  Likeness Imitation::*likeness;
};
constexpr std::array<Joint, 3> kJoints = {{{"thigh", &LegAngles::thigh, &Imitation::thigh},
                                           {"knee", &LegAngles::knee, &Imitation::knee},
                                           {"ankle", &LegAngles::ankle, &Imitation::ankle}}};

std::array<PublishedBand, 3> published(std::size_t samples) {
  const generator::PublishedGait& gait = generator::published_gait();
  return {band(gait.hip_flexion, gait.pelvic_tilt_deg, gait.hip_deviation_deg, samples),
          band(gait.knee_flexion, 0.0, gait.knee_deviation_deg, samples),
          band(gait.ankle_dorsiflexion, 0.0, gait.ankle_deviation_deg, samples)};
}

void add_curves(const ReviewedClip& clip, pages::Page& page) {
  const std::size_t n = clip.robot.size();
  std::vector<double> percent;
  for (std::size_t k = 0; k < n; ++k) percent.push_back(100.0 * static_cast<double>(k) / static_cast<double>(n));
  // Published bands are of people who walk forward.
  const bool forward = clip.recipe.channel == kVx && clip.recipe.sign > 0.0;
  const std::array<PublishedBand, 3> bands = published(n);
  page.columns([&] {
    for (std::size_t j = 0; j < kJoints.size(); ++j) {
      const auto& angles = kJoints[j].angles;
      const std::array<std::vector<double>, 4> y = {
          from_contact(clip.person_legs[kLeft].*angles, kLeft), from_contact(clip.person_legs[kRight].*angles, kRight),
          from_contact(clip.robot_legs[kLeft].*angles, kLeft), from_contact(clip.robot_legs[kRight].*angles, kRight)};
      using namespace pages;
      Plot plot{.title = fmt::format("{}, {} [deg]", clip.recipe.name, kJoints[j].name),
                .x_name = "gait cycle from the foot's own contact [%]",
                .lines = {},
                .height_px = 190};
      if (forward) {
        plot.lines.push_back({.name = "published mean", .x = percent, .y = bands[j].mean, .colour = colour::kGreen});
        plot.lines.push_back({.name = "one standard deviation between people",
                              .x = percent,
                              .y = bands[j].lower,
                              .colour = colour::kGreen,
                              .width_px = 0.8,
                              .dashed = true});
        plot.lines.push_back(
            {.name = "", .x = percent, .y = bands[j].upper, .colour = colour::kGreen, .width_px = 0.8, .dashed = true});
      }
      plot.lines.push_back({.name = "person, left", .x = percent, .y = y[0], .colour = colour::kGrey, .width_px = 2.4});
      plot.lines.push_back(
          {.name = "person, right", .x = percent, .y = y[1], .colour = colour::kGrey, .width_px = 2.4, .dashed = true});
      plot.lines.push_back({.name = "robot, left", .x = percent, .y = y[2], .colour = colour::kBlue, .width_px = 1.8});
      plot.lines.push_back({.name = "robot, right",
                            .x = percent,
                            .y = y[3],
                            .colour = colour::kVermillion,
                            .width_px = 1.8,
                            .dashed = true});
      page.plot(plot);
    }
  });
}

void add_steps_of_likeness(const ReviewedClip& clip, pages::Page& page) {
  pages::Table table{.header = {"r / RMS [deg] / RMS without the means' difference", "inside the joints' limits",
                                "and feet on the ground at full gain", "and in mixtures: the clip"},
                     .rows = {}};
  const auto cell = [](const Likeness& of) {
    return fmt::format("{:.3f} / {:.1f} / {:.1f}", of.correlation, of.rms_rad / kRadPerDegree,
                       of.shape_rad / kRadPerDegree);
  };
  for (const Joint& joint : kJoints) {
    table.rows.push_back({joint.name, cell(clip.in_limits.*joint.likeness), cell(clip.on_ground.*joint.likeness),
                          cell(clip.made.*joint.likeness)});
  }
  page.table(table);
}

/// Stretches of one cycle of `period_s` from `from_s` on in which a foot with this contact carries.
std::vector<pages::Lanes::Stretch> stretches(double centre, double duty_factor, double from_s, double period_s,
                                             const char* colour) {
  std::vector<pages::Lanes::Stretch> out;
  for (const double turn : {-1.0, 0.0, 1.0}) {
    const double begin = std::max(0.0, centre - 0.5 * duty_factor + turn);
    const double end = std::min(1.0, centre + 0.5 * duty_factor + turn);
    if (end > begin) out.push_back({from_s + begin * period_s, from_s + end * period_s, "", colour});
  }
  return out;
}

void add_contacts(const ReviewedClip& clip, pages::Page& page) {
  const auto& cut = clip.human.cut;
  pages::Lanes lanes{.title = fmt::format("{}: when each foot carries", clip.recipe.name),
                     .x_name = "time in " + clip.recipe.recording.filename().string(),
                     .lanes = {}};
  // The clip lands its left foot when the person does.
  const double left_lands = cut.contact[0].center - 0.5 * cut.contact[0].duty_factor;
  for (const Foot foot : {kLeft, kRight}) {
    const char* colour = foot == kLeft ? pages::colour::kBlue : pages::colour::kVermillion;
    const char* side = foot == kLeft ? "left" : "right";
    lanes.lanes.push_back(
        {fmt::format("{}, the person by its motion", side),
         stretches(cut.contact[foot].center, cut.contact[foot].duty_factor, cut.from_s, cut.period_s(), colour)});
    lanes.lanes.push_back({fmt::format("{}, the clip", side),
                           stretches(clip.clip.contact_center[foot] + left_lands, clip.clip.duty_factor[foot],
                                     cut.from_s, cut.period_s(), pages::colour::kGrey)});
  }
  if (clip.plates) {
    for (const Foot foot : {kLeft, kRight}) {
      pages::Lanes::Lane lane{fmt::format("{}, force plate", foot == kLeft ? "left" : "right"), {}};
      for (const mocap::PlateContact& contact : clip.plates->plates.contacts[foot]) {
        const double from_s = std::max(contact.contact_s.value_or(clip.plates->plates.from_s), cut.from_s);
        const double to_s = std::min(contact.off_s.value_or(clip.plates->plates.to_s), cut.to_s);
        if (to_s > from_s) lane.stretches.push_back({from_s, to_s, "", pages::colour::kGreen});
      }
      lanes.lanes.push_back(lane);
    }
  }
  page.lanes(lanes);
}

void add_clip(const ReviewedClip& clip, const Measured& measured, const retargeting::ClipGoals& goals,
              pages::Page& page) {
  const auto& human = clip.human;
  page.heading(clip.recipe.name);
  page.paragraph(fmt::format(
      "From {}{}, {:.3f} to {:.3f} s. Lengths times {:.3f}, period and speed times {:.3f} (Froude's law). The person: "
      "{:.3f} s a cycle at vx {:.2f}, vy {:.2f} m/s, {:.2f} rad/s. Events moved by at most {:.3f} of a cycle so that "
      "all "
      "clips agree on them; the ends of the cycle were {:.1f} cm apart.",
      clip.recipe.recording.filename().string(), clip.recipe.mirrored ? ", mirrored" : "", human.cut.from_s,
      human.cut.to_s, clip.length_ratio, clip.froude_ratio, human.period_s, human.mean_velocity.x(),
      human.mean_velocity.y(), human.mean_velocity.z(), human.warp_cycles, 100.0 * human.cut.loop_error_m));
  for (const std::string& note : clip.notes) page.note(note);
  add_figures(clip, page);
  std::vector<pages::Judgement> judgements;
  for (const Judged& one : judge(clip, measured, goals)) judgements.push_back(one.shown);
  page.judgements(judgements);
  add_curves(clip, page);
  page.folded("Where likeness is lost, step by step", [&] { add_steps_of_likeness(clip, page); });
  add_contacts(clip, page);
}

}  // namespace

pages::Page page_of(const retargeting::LibraryReview& review, const Measured& measured,
                    const retargeting::ClipGoals& goals) {
  pages::Page page(fmt::format("Clips of a person on {}", review.robot));
  page.worth(worth_of(review, measured, goals));
  page.paragraph(review.source);
  std::size_t held = 0, asked = 0;
  double slowest = 1e9;
  for (const ReviewedClip& clip : review.clips) {
    slowest = std::min(slowest, clip.frames_per_s);
    for (const Judged& one : judge(clip, measured, goals)) {
      ++asked;
      if (one.shown.grade == work::Grade::kHolds) ++held;
    }
  }
  page.verdict({}, fmt::format("{} of {} figures are as asked. {} dynamic clips last {:.1f} s together.", held, asked,
                               review.clips.size(), review.dynamic_total_s));
  for (const ReviewedClip& clip : review.clips) add_clip(clip, measured, goals, page);
  page.heading("How it was measured");
  page.paragraph(
      "The clips are those on disk. Each recording was read anew, its cycle cut and warped to the clip's duty factor. "
      "r and "
      "RMS compare angles in the sagittal plane at the same phase, constant offset included, and are those of the "
      "worse "
      "leg. Slide and heights are kinematic, under the base motion that fits both feet best. Hands and feet are wrists "
      "seen "
      "from the shoulders and ankles seen from the hips, where the person's limb directions with the robot's limb "
      "lengths "
      "would put them. Published bands: adults at their own speed (Leboeuf et al. 2019).");
  page.paragraph(
      fmt::format("Retargeting up to full gain made {:.0f} samples a second of CPU time at least.", slowest));
  return page;
}

}  // namespace pmg::library_page
