// Gait events against feet whose events are known exactly, and the thresholds against their closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exact_gait.hpp"
#include "mocap/gait_events.hpp"

namespace pmg::mocap {
namespace {

/// Errors of one walk's events, + late. Each true event has one found event, and there is no other.
struct EventErrors {
  std::vector<double> land_s, lift_s;
};

std::vector<double> matched(const std::vector<double>& truth_s, const std::vector<double>& found_s) {
  std::vector<double> errors_s;
  EXPECT_EQ(truth_s.size(), found_s.size());
  for (std::size_t i = 0; i < std::min(truth_s.size(), found_s.size()); ++i)
    errors_s.push_back(found_s[i] - truth_s[i]);
  return errors_s;
}

EventErrors errors_of(const test::ExactWalk& walk) {
  const auto found = events_of(find_steps(test::exact_walk(walk)));
  EventErrors errors;
  for (int side = 0; side < 2; ++side) {
    std::vector<double> lift_s, land_s;
    for (int k = 0; k < walk.cycles; ++k) {
      lift_s.push_back(walk.lift_s(side, k));
      land_s.push_back(walk.land_s(side, k));
    }
    const auto& events = found[static_cast<std::size_t>(side)];
    std::ranges::copy(matched(lift_s, events.off_s), std::back_inserter(errors.lift_s));
    std::ranges::copy(matched(land_s, events.contact_s), std::back_inserter(errors.land_s));
  }
  return errors;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

struct Sizes {
  double sum_s = 0.0, worst_s = 0.0;
  int count = 0;
  void add(const std::vector<double>& errors_s) {
    for (const double e : errors_s) {
      sum_s += std::abs(e);
      worst_s = std::max(worst_s, std::abs(e));
      ++count;
    }
  }
};

TEST(ExactEvents, OfFeetThatComeToTheGroundAtSpeedAreWithin30msAnd15InTheMean) {
  // The speeds at the ground are the shares of the published thresholds, and a fifth more and less: people differ. A
  // foot that is slower there than the thresholds passes them in the air, and its path eases without acceleration, so
  // the method can't hold the two limits: 35 and 60 ms for it show that it gets no worse.
  for (const double people : {0.8, 1.0, 1.2}) {
    const double mean_limit_s = people < 1.0 ? 0.035 : 0.015, worst_limit_s = people < 1.0 ? 0.060 : 0.030;
    Sizes all;
    for (const double leg_m : {0.5, 0.85, 1.0}) {
      for (const double speed : {0.25, 0.4, 0.55}) {
        for (const double rate_hz : {60.0, 100.0, 240.0}) {
          for (const double noise_m : {0.0, 0.001}) {
            test::ExactWalk walk;
            walk.leg_m = leg_m;
            walk.froude_speed = speed;
            walk.rate_hz = rate_hz;
            walk.noise_m = noise_m;
            walk.lift_share *= people;
            walk.land_share *= people;
            const EventErrors errors = errors_of(walk);
            SCOPED_TRACE(fmt::format(
                "people {}, leg {} m, speed {:.2f} m/s, {} Hz, noise {} m: land {:.1f}, lift {:.1f} ms", people, leg_m,
                walk.speed_m_s(), rate_hz, noise_m, 1e3 * mean(errors.land_s), 1e3 * mean(errors.lift_s)));
            Sizes of_walk;
            of_walk.add(errors.land_s);
            of_walk.add(errors.lift_s);
            all.add(errors.land_s);
            all.add(errors.lift_s);
            EXPECT_LE(of_walk.worst_s, worst_limit_s + 5.0 * noise_m);  // 5 ms a mm: slow walks at 60 Hz reach 32 ms
          }
        }
      }
    }
    fmt::print("speeds at the ground {} of the published: mean {:.1f} ms, worst {:.1f} ms of {} events\n", people,
               1e3 * all.sum_s / all.count, 1e3 * all.worst_s, all.count);
    EXPECT_LE(all.sum_s / all.count, mean_limit_s);
  }
}

/// Shares of a swing, from rest to rest on minimum jerk, that pass before the lift and after the landing that the
/// thresholds find. The speed, smoothed by a Gaussian, is 30 (s^2 (1 - s)^2 + r^2 (1 - 6 s + 6 s^2)) mean speeds, with
/// r = sigma / swing; the mean speed is that of the found swing.
std::pair<double, double> found_shares(const GaitEventOptions& options, double swing_s) {
  const double r2 = std::pow(options.smoothing_s / swing_s, 2);
  const auto crossing = [r2](double threshold) {
    double low = 0.0, high = 0.3;
    for (int i = 0; i < 60; ++i) {
      const double s = 0.5 * (low + high);
      const double speed = 30.0 * (s * s * (1.0 - s) * (1.0 - s) + r2 * (1.0 - 6.0 * s + 6.0 * s * s));
      (speed < threshold ? low : high) = s;
    }
    return low;
  };
  double lift = 0.0, land = 0.0;
  for (int round = 0; round < 50; ++round) {
    const double mean_speed =
        (test::minimum_jerk(1.0 - land, 0.0, 0.0) - test::minimum_jerk(lift, 0.0, 0.0)) / (1.0 - lift - land);
    lift = crossing(options.lifting_share * options.swing_share * mean_speed);
    land = crossing(options.landing_share * options.swing_share * mean_speed);
  }
  return {lift, land};
}

TEST(ExactEvents, OfAFootThatEasesFromRestToRestAreWhereTheThresholdsLie) {
  // No threshold of speed finds the ends of a path that begins and ends with neither speed nor acceleration: lifts are
  // late and landings early, by a tenth of the swing. The published constants say by how much.
  const GaitEventOptions published{
      .landing_share = 0.78, .lifting_share = 0.66, .swing_share = 0.40, .smoothing_s = 0.0132};
  for (const double leg_m : {0.5, 1.0}) {
    for (const double speed : {0.3, 0.5}) {
      for (const double rate_hz : {100.0, 240.0}) {
        test::ExactWalk walk;
        walk.leg_m = leg_m;
        walk.froude_speed = speed;
        walk.rate_hz = rate_hz;
        walk.lift_share = walk.land_share = 0.0;
        walk.contact_s = 1e-9;
        walk.heel_lead = walk.toe_lag = 0.0;
        const EventErrors errors = errors_of(walk);
        const auto [lift, land] = found_shares(published, walk.swing_s());
        fmt::print(
            "at rest at both ends, swing {:.2f} s: lift {:.1f} ms late ({:.1f} expected), landing {:.1f} early "
            "({:.1f})\n",
            walk.swing_s(), 1e3 * mean(errors.lift_s), 1e3 * lift * walk.swing_s(), -1e3 * mean(errors.land_s),
            1e3 * land * walk.swing_s());
        // Interpolation and differences of 100 Hz samples change 0.4 ms.
        for (const double e : errors.lift_s) EXPECT_NEAR(e, lift * walk.swing_s(), 0.001);
        for (const double e : errors.land_s) EXPECT_NEAR(e, -land * walk.swing_s(), 0.001);
      }
    }
  }
}

/// One foot that makes steps of this length, standing at these heights [m] between them; the other rests.
Recording stepping(double step_m, const std::vector<double>& heights_m) {
  Recording recording;
  recording.rate_hz = 100.0;
  recording.leg_length_m = 1.0;
  const double swing_s = 0.3, stand_s = 0.7;
  recording.frames = static_cast<std::size_t>((static_cast<double>(heights_m.size()) + 1.0) * 100.0);
  for (std::size_t f = 0; f < recording.frames; ++f) {
    double x = 0.0, z = heights_m[0];
    for (std::size_t k = 1; k < heights_m.size(); ++k) {
      const double s = std::clamp(
          (static_cast<double>(f) / 100.0 - stand_s - static_cast<double>(k - 1) * (swing_s + stand_s)) / swing_s, 0.0,
          1.0);
      const double done = test::minimum_jerk(s, 0.0, 0.0);
      x += step_m * done;
      z += (heights_m[k] - heights_m[k - 1]) * done + 0.1 * std::pow(4.0 * s * (1.0 - s), 3);
    }
    for (const Side side : {Side::left, Side::right}) {
      const bool moves = side == Side::left;
      const double at = moves ? x : 0.0, height = moves ? z : 0.0;
      recording.bodies[static_cast<std::size_t>(of_side(KeyBody::left_heel, side))].position_m.emplace_back(at, 0.1,
                                                                                                            height);
      recording.bodies[static_cast<std::size_t>(of_side(KeyBody::left_toe, side))].position_m.emplace_back(at + 0.2,
                                                                                                           0.1, height);
    }
  }
  return recording;
}

TEST(ExactEvents, AFootThatIsPutRightMakesNoStep) {
  Recording shuffle = stepping(0.0, {0.0, 0.0, 0.0});
  for (const Side side : {Side::left}) {  // level, without the bump: 0.11 m of ground in 0.3 s
    for (const KeyBody key : {KeyBody::left_heel, KeyBody::left_toe}) {
      auto& p = shuffle.bodies[static_cast<std::size_t>(of_side(key, side))].position_m;
      for (std::size_t f = 0; f < p.size(); ++f) {
        p[f].z() = 0.0;
        p[f].x() +=
            0.11 * test::minimum_jerk(std::clamp((static_cast<double>(f) / 100.0 - 0.7) / 0.3, 0.0, 1.0), 0.0, 0.0);
      }
    }
  }
  // Between lift and landing it goes less than the 0.12 of the leg that a step takes.
  EXPECT_TRUE(find_steps(shuffle).empty());
}

TEST(ExactEvents, StepsOntoGroundOfOtherHeightsAreStepsOfTheirOwn) {
  EXPECT_EQ(find_steps(stepping(0.4, {0.0, 0.0, 0.0})).size(), 2U);
  EXPECT_EQ(find_steps(stepping(0.4, {0.0, 0.06, 0.0})).size(), 2U);  // a sill of 6 cm for legs of 1 m
}

TEST(ExactEvents, NeedTenFramesASecond) {
  Recording slow = stepping(0.4, {0.0, 0.0, 0.0});
  slow.rate_hz = 9.9;
  EXPECT_TRUE(find_steps(slow).empty());
}

TEST(ExactEvents, TheGroundIsUnderTheLowerSole) {
  Recording recording = stepping(0.4, {0.0, 0.0, 0.0});
  for (Body& body : recording.bodies) {
    for (Eigen::Vector3d& p : body.position_m) p.z() += 0.35;
  }
  EXPECT_NEAR(ground_height_m(recording), 0.35, 1e-9);
}

}  // namespace
}  // namespace pmg::mocap
