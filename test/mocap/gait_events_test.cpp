// Gait events against force plates, and against made-up gaits whose events are known.
#include "mocap/gait_events.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "folders.hpp"
#include "mocap_files/force_plates.hpp"
#include "synthetic_gait.hpp"

namespace pmg::mocap {
namespace {

namespace fs = std::filesystem;

/// For each true time the error of the nearest found one [s].
void add_errors(const std::vector<double>& truth_s, const std::vector<double>& found_s, std::vector<double>& errors_s) {
  for (const double t : truth_s) {
    double nearest = 1e9;
    for (const double found : found_s) {
      if (std::abs(found - t) < std::abs(nearest)) nearest = found - t;
    }
    errors_s.push_back(nearest);
  }
}

double mean_size(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += std::abs(e);
  return sum / static_cast<double>(errors.size());
}
double largest_size(const std::vector<double>& errors) {
  double largest = 0.0;
  for (const double e : errors) largest = std::max(largest, std::abs(e));
  return largest;
}

TEST(GaitEvents, AgreeWithForcePlates) {
  const fs::path data = fs::path(pmg::test::project_folder()) / "../shared/data/mocap";
  const fs::path walk = data / "motion_capture_walk.trc", plates = data / "grf_walk.mot";
  if (!fs::exists(walk) || !fs::exists(plates)) GTEST_SKIP() << "no recording with force plates at " << data;
  const Recording recording = make_recording(walk.string(), read_motion(walk), read_name_table(default_name_table()));
  const auto found = events_of(find_steps(recording));
  std::vector<double> errors_s;
  const ForcePlates truth = read_force_plates(plates);
  for (std::size_t side = 0; side < 2; ++side) {
    for (const PlateContact& contact : truth.contacts[side]) {
      if (contact.contact_s) add_errors({*contact.contact_s}, found[side].contact_s, errors_s);
      if (contact.off_s) add_errors({*contact.off_s}, found[side].off_s, errors_s);
    }
  }
  ASSERT_EQ(errors_s.size(), 6U);  // three stances are on plates
  for (const double e : errors_s) RecordProperty("error_ms", fmt::format("{:.1f}", 1000.0 * e));
  std::string all;
  for (const double e : errors_s) all += fmt::format("{:.1f} ", 1000.0 * e);
  fmt::print("errors against force plates [ms]: {}\n", all);
  EXPECT_LE(mean_size(errors_s), 0.015) << all;
  EXPECT_LE(largest_size(errors_s), 0.030) << all;
}

/// Errors of all events of a made-up walk, the first and the last cycle left out. Contact and toe-off of mean curves
/// are at 0 and, by the data set's mean, 60 % of the cycle.
struct WalkErrors {
  std::vector<double> contact_s, off_s;
  std::size_t found = 0;
  std::string all;
};
WalkErrors errors_of(const test::Walker& walker) {
  const auto found = events_of(find_steps(test::walk(walker)));
  WalkErrors errors;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<double> contact_s, off_s;
    for (int k = 1; k < walker.cycles - 1; ++k) {
      const double begin_s = (k + 0.5 * static_cast<double>(side)) * walker.period_s;
      contact_s.push_back(begin_s);
      off_s.push_back(begin_s + 0.6 * walker.period_s);
    }
    add_errors(contact_s, found[side].contact_s, errors.contact_s);
    add_errors(off_s, found[side].off_s, errors.off_s);
    errors.found += found[side].contact_s.size();
    for (const double t : found[side].contact_s) errors.all += fmt::format("{:.3f} ", t);
  }
  return errors;
}

TEST(GaitEvents, AreThereForEverySizeSpeedRateAndNoise) {
  for (const double leg_m : {0.45, 0.65, 0.85, 1.0}) {
    for (const double rate_hz : {30.0, 60.0, 100.0, 240.0}) {
      for (const double noise_m : {0.0, 0.001, 0.002}) {
        for (const double slower : {1.0, 1.6}) {
          test::Walker walker;
          walker.leg_m = leg_m;
          walker.period_s = slower * 1.1 * std::sqrt(leg_m / 0.85);  // Froude: small bodies step faster
          walker.rate_hz = rate_hz;
          walker.noise_m = noise_m;
          walker.heading_rad = 10.0 * leg_m;
          const WalkErrors errors = errors_of(walker);
          SCOPED_TRACE(fmt::format("leg {} m, {} Hz, noise {} m, period {:.2f} s: contact {:.1f} ms, off {:.1f} ms",
                                   leg_m, rate_hz, noise_m, walker.period_s, 1e3 * mean_size(errors.contact_s),
                                   1e3 * mean_size(errors.off_s)));
          // Each contact once: five cycles have five left ones and five right ones, less those at the ends.
          EXPECT_GE(errors.found, 8U) << errors.all;
          EXPECT_LE(errors.found, 11U) << errors.all;
          // The truth is that of mean curves, which smear each person's heel strike: 4 % of a cycle, and half a frame.
          const double limit_s = 0.04 * walker.period_s + 0.5 / rate_hz;
          EXPECT_LE(mean_size(errors.contact_s), limit_s);
          EXPECT_LE(mean_size(errors.off_s), limit_s);
        }
      }
    }
  }
}

/// A person who stands still, or lifts the left foot from second 1 to 1.5, holds it up, and puts it down until
/// second 5.
Recording on_the_spot(double rate_hz, bool lifted_and_held) {
  Recording recording;
  recording.rate_hz = rate_hz;
  recording.frames = static_cast<std::size_t>(6.0 * rate_hz);
  recording.leg_length_m = 0.85;
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const double t_s = static_cast<double>(f) / rate_hz;
    const double up = std::clamp(std::min(t_s - 1.0, 5.0 - t_s) / 0.5, 0.0, 1.0),
                 z = lifted_and_held ? 0.3 * up * up * (3.0 - 2.0 * up) : 0.0;
    for (const Side side : {Side::left, Side::right}) {
      const bool moves = side == Side::left;
      recording.bodies[static_cast<std::size_t>(of_side(KeyBody::left_heel, side))].position_m.emplace_back(
          0.0, 0.1, moves ? z : 0.0);
      recording.bodies[static_cast<std::size_t>(of_side(KeyBody::left_toe, side))].position_m.emplace_back(
          0.2, 0.1, moves ? z : 0.0);
    }
  }
  return recording;
}

TEST(GaitEvents, AFootThatIsHeldUpHasOneSwing) {
  const auto steps = find_steps(on_the_spot(100.0, true));
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NEAR(*steps[0].lift_s, 1.0, 0.15);  // it starts and ends slowly
  EXPECT_NEAR(*steps[0].land_s, 5.0, 0.15);
}

TEST(GaitEvents, AStandingPersonHasNone) { EXPECT_TRUE(find_steps(on_the_spot(100.0, false)).empty()); }

TEST(GaitEvents, AWalkBackwardsInTimeHasItsContactsWhereTheOtherHasItsToeOffs) {
  Recording forward = test::walk({});
  Recording backward = forward;
  for (Body& body : backward.bodies) std::ranges::reverse(body.position_m);
  const auto a = events_of(find_steps(forward)), b = events_of(find_steps(backward));
  const double end_s = static_cast<double>(forward.frames - 1) / forward.rate_hz;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<double> turned_s, errors_s;
    for (const double off_s : b[side].off_s) turned_s.push_back(end_s - off_s);
    for (const double contact_s : a[side].contact_s) {
      if (contact_s > 0.5 && contact_s < end_s - 0.5) add_errors({contact_s}, turned_s, errors_s);
    }
    ASSERT_GE(errors_s.size(), 4U);
    // The thresholds of landing and lifting differ by a fifth of them, which a foot passes within 30 ms.
    EXPECT_LE(largest_size(errors_s), 0.03);
  }
}

}  // namespace
}  // namespace pmg::mocap
