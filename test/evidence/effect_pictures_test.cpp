// One picture an effect for docs/reference/effects.md: the same joint without it and with it. To draw them anew:
//   PMG_EFFECT_PICTURES=docs/images/effects build/release/bin/test_evidence --gtest_filter='EffectPictures.*'
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

#include "calib/single_joint.hpp"
#include "effects/catalogue.hpp"
#include "folders.hpp"
#include "pages/plot_picture.hpp"

namespace pmg::evidence {
namespace {

namespace fs = std::filesystem;
using Command = std::function<double(double t_s)>;

constexpr std::size_t kLargestPicture_bytes = 30000;

double steps(double t_s) { return t_s < 0.2 ? 0.0 : t_s < 1.4 ? 0.8 : t_s < 2.4 ? 0.3 : -0.4; }
double big_step(double t_s) { return t_s < 0.2 ? 0.0 : t_s < 1.6 ? 1.5 : 0.0; }
double sine(double t_s) { return 0.6 * std::sin(2.0 * std::numbers::pi * 0.6 * t_s); }
double slow_sine(double t_s) { return 0.25 * std::sin(2.0 * std::numbers::pi * 0.3 * t_s); }
double triangle(double t_s) { return 0.3 * std::asin(std::sin(2.0 * std::numbers::pi * 0.4 * t_s)); }
double slow_ramp(double t_s) { return std::min(0.6 * t_s, 1.8); }

/// What shows an effect best.
struct Demonstration {
  Command command;
  std::function<void(model::ActuatorParameters&)> effect;                       ///< what it changes
  std::function<void(model::ActuatorParameters&)> both = [](auto&) {};          ///< what both joints have
  enum class Against { kTime, kPosition, kVelocity } against = Against::kTime;  ///< of the lower picture
  double kp = 25.0, gravity_Nm = 1.5, inertia_scale = 1.0;
};

using Against = Demonstration::Against;

/// Full voltage from 0.4 rad of error; 3.6 Nm at rest, none at 10 rad/s.
void hobby_servo(model::ActuatorParameters& p) {
  p.drive.limit = 1.0;
  p.drive.kp_scale = 0.1;
  p.drive.kd_scale = 0.0;
  p.drive.torque_per_unit_Nm = 3.6;
  p.drive.back_emf_s_per_rad = 0.1;
}

const std::map<std::string, Demonstration>& demonstrations() {
  using P = model::ActuatorParameters;
  static const std::map<std::string, Demonstration> kAll = {
      {"coulomb", {steps, [](P& p) { p.friction.coulomb_Nm = 0.8; }}},
      {"viscous", {steps, [](P& p) { p.friction.viscous_Nm_s_per_rad = 0.8; }, [](P&) {}, Against::kVelocity}},
      {"stribeck",
       {slow_sine,
        [](P& p) {
          p.friction.stribeck_Nm = 0.7;
          p.friction.stribeck_rad_s = 0.1;
        },
        [](P&) {}, Against::kTime, 8.0}},
      {"load_friction", {steps, [](P& p) { p.friction.load_driving = p.friction.load_backdriving = 0.4; }}},
      {"direction_friction",
       {triangle, [](P& p) { p.friction.asymmetry = 0.7; }, [](P& p) { p.friction.coulomb_Nm = 0.6; }, Against::kTime}},
      {"offset", {steps, [](P& p) { p.ripple.offset_Nm = 1.0; }}},
      {"backlash",
       {triangle, [](P& p) { p.transmission.backlash_rad = 0.06; },
        [](P& p) {
          p.transmission.stiffness_Nm_per_rad = 2000.0;
          p.transmission.damping_Nm_s_per_rad = 2.0;
        },
        Against::kTime, 25.0, 0.2}},
      {"compliance",
       {steps,
        [](P& p) {
          p.transmission.stiffness_Nm_per_rad = 40.0;
          p.transmission.damping_Nm_s_per_rad = 0.1;
        }}},
      {"delay", {steps, [](P& p) { p.command.delay_s = 0.06; }}},
      {"rate_limit", {steps, [](P& p) { p.command.rate_limit_rad_s = 1.5; }}},
      {"hold", {sine, [](P& p) { p.command.hold_s = 0.06; }}},
      {"torque_speed",
       {big_step,
        [](P& p) {
          p.drive.stall_torque_Nm = 8.0;
          p.drive.no_load_rad_s = 3.5;
        }}},
      {"supply_sag", {big_step, [](P& p) { p.drive.supply_sag_per_Nm = 0.2; }, hobby_servo}},
      {"gain", {steps, [](P& p) { p.drive.kp_scale = 0.6; }}},
      {"dead_band", {steps, [](P& p) { p.drive.dead_band_rad = 0.08; }}},
      {"sensor_lag", {steps, [](P& p) { p.sensor.lag_s = 0.03; }}},
      {"quantisation", {slow_sine, [](P& p) { p.sensor.quantum_rad = 0.02; }}},
      {"zero_offset", {steps, [](P& p) { p.sensor.zero_offset_rad = 0.3; }}},
      {"cogging",
       {slow_ramp,
        [](P& p) {
          p.ripple.amplitude_Nm = 0.5;
          p.ripple.order = 12.0;
        },
        [](P&) {}, Against::kPosition}},
      {"hysteresis", {triangle, [](P& p) { p.sensor.hysteresis_rad = 0.06; }}},
      {"eccentricity", {slow_ramp, [](P& p) { p.sensor.eccentricity_rad = 0.15; }, [](P&) {}, Against::kPosition}},
      {"thermal_drift",
       {sine, [](P& p) { p.thermal.friction_per_K = 0.04; }, [](P& p) { p.friction.coulomb_Nm = 0.3; }}},
      {"self_heating",
       {sine, [](P& p) { p.thermal.friction_per_Nm2_s = 0.3; }, [](P& p) { p.friction.coulomb_Nm = 0.3; }}},
      {"load", {steps, [](P&) {}, [](P&) {}, Against::kTime, 25.0, 1.5, 1.8}},
  };
  return kAll;
}

/// 3.4 s at 100 Hz; temperature rises from 25 to 59 degC.
calib::SingleJoint joint(const Demonstration& shown) {
  bench::Bench bench;
  bench::BenchRun run;
  run.kp = shown.kp;
  run.kd = 0.05 * shown.kp;
  run.load = {0.05, shown.gravity_Nm};
  bench::Recording& r = run.recording;
  for (int k = 0; k < 340; ++k) {
    r.t_s.push_back(0.01 * k);
    r.q_cmd_rad.push_back(shown.command(r.t_s.back()));
    r.temp_C.push_back(25.0 + 0.1 * k);
  }
  r.q_rad.assign(r.t_s.size(), shown.command(0.0));
  r.valid.assign(r.t_s.size(), true);
  return {bench, run, 0.001};
}

struct Pair {
  std::vector<double> t_s, command_rad, without_rad, with_rad, apart_mrad;
};

Pair simulate(const Demonstration& shown) {
  calib::JointModel without;
  without.actuator.transmission.armature_kg_m2 = 0.01;
  without.actuator.friction.coulomb_Nm = 0.03;
  without.actuator.friction.viscous_Nm_s_per_rad = 0.05;
  shown.both(without.actuator);
  calib::JointModel with = without;
  shown.effect(with.actuator);
  with.inertia_scale = shown.inertia_scale;
  const calib::SingleJoint one = joint(shown);
  Pair pair{one.run().recording.t_s, one.run().recording.q_cmd_rad, one.rollout(without), one.rollout(with), {}};
  for (std::size_t k = 0; k < pair.t_s.size(); ++k) {
    pair.apart_mrad.push_back(1e3 * (pair.without_rad[k] - pair.with_rad[k]));
  }
  return pair;
}

std::string picture(const std::string& name, const Demonstration& shown) {
  const Pair pair = simulate(shown);
  const pages::Plot upper{
      .title = effects::effect(name).title + ": position [rad]",
      .x_name = "time [s]",
      .lines =
          {{.name = "command", .x = pair.t_s, .y = pair.command_rad, .colour = pages::colour::kGrey, .stepped = true},
           {.name = "simulated without it", .x = pair.t_s, .y = pair.without_rad, .colour = pages::colour::kBlue},
           {.name = "measured with it", .x = pair.t_s, .y = pair.with_rad, .colour = pages::colour::kVermillion}},
      .height_px = 150};
  std::vector<double> velocity_rad_s(pair.t_s.size(), 0.0);
  for (std::size_t k = 1; k + 1 < pair.t_s.size(); ++k)
    velocity_rad_s[k] = (pair.with_rad[k + 1] - pair.with_rad[k - 1]) / 0.02;
  const bool over_time = shown.against == Against::kTime;
  std::vector<double> x, y;
  for (std::size_t k = 0; k < pair.t_s.size(); k += over_time ? 1 : 2) {  // dots take more text than a line
    x.push_back(over_time ? pair.t_s[k] : shown.against == Against::kPosition ? pair.with_rad[k] : velocity_rad_s[k]);
    y.push_back(pair.apart_mrad[k]);
  }
  const pages::Plot lower{
      .title = "simulated minus measured [mrad]",
      .x_name = over_time                             ? "time [s]"
                : shown.against == Against::kPosition ? "position [rad]"
                                                      : "velocity [rad/s]",
      .lines = {{.name = "", .x = x, .y = y, .colour = pages::colour::kInk, .points = !over_time, .joined = over_time}},
      .show_zero = true,
      .height_px = 110};
  return pages::svg_file({upper, lower});
}

TEST(EffectPictures, ShowEveryEffectOfTheCatalogue) {
  for (const effects::Effect& effect : effects::catalogue()) {
    const auto shown = demonstrations().find(effect.name);
    ASSERT_NE(shown, demonstrations().end()) << effect.name << " has no picture";
    const Pair pair = simulate(shown->second);
    double squares_mrad2 = 0.0;
    for (const double apart_mrad : pair.apart_mrad) squares_mrad2 += apart_mrad * apart_mrad;
    EXPECT_GT(std::sqrt(squares_mrad2 / static_cast<double>(pair.t_s.size())), 3.0) << effect.name << " can't be seen";
    EXPECT_LT(picture(effect.name, shown->second).size(), kLargestPicture_bytes) << effect.name;
  }
}

TEST(EffectPictures, AreInTheDocumentation) {
  const fs::path root = pmg::test::project_folder();
  std::ifstream in(root / "docs/reference/effects.md");
  std::ostringstream text;
  text << in.rdbuf();
  for (const effects::Effect& effect : effects::catalogue()) {
    EXPECT_NE(text.str().find("images/effects/" + effect.name + ".svg"), std::string::npos) << effect.name;
    EXPECT_TRUE(fs::exists(root / "docs/images/effects" / (effect.name + ".svg"))) << effect.name;
  }
}

TEST(EffectPictures, AreWrittenWhereAsked) {
  const char* folder = std::getenv("PMG_EFFECT_PICTURES");
  if (folder == nullptr) GTEST_SKIP() << "PMG_EFFECT_PICTURES names no folder";
  fs::create_directories(folder);
  for (const effects::Effect& effect : effects::catalogue()) {
    std::ofstream out(fs::path(folder) / (effect.name + ".svg"), std::ios::binary);
    out << picture(effect.name, demonstrations().at(effect.name));
    EXPECT_TRUE(out.flush()) << effect.name;
  }
}

}  // namespace
}  // namespace pmg::evidence
