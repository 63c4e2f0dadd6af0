// One picture an effect for docs/reference/effects.md: the same joint without it and with it. To draw them anew:
//   PMG_EFFECT_PICTURES=docs/images/effects build/release/bin/test_evidence --gtest_filter='EffectPictures.*'
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "calib/single_joint.hpp"
#include "effects/examples.hpp"
#include "folders.hpp"
#include "pages/plot_picture.hpp"

namespace pmg::evidence {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestPicture_bytes = 30000;

using effects::Demonstration;
using Against = Demonstration::Against;

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

Pair simulate(const effects::Effect& effect) {
  const calib::JointModel without = test::without_effect(effect),
                          with = test::with_effect(effect, effect.forms.front());
  const calib::SingleJoint one = joint(effect.demonstration);
  Pair pair{one.run().recording.t_s, one.run().recording.q_cmd_rad, one.rollout(without), one.rollout(with), {}};
  for (std::size_t k = 0; k < pair.t_s.size(); ++k) {
    pair.apart_mrad.push_back(1e3 * (pair.without_rad[k] - pair.with_rad[k]));
  }
  return pair;
}

std::string picture(const effects::Effect& effect) {
  const Demonstration& shown = effect.demonstration;
  const Pair pair = simulate(effect);
  const pages::Plot upper{
      .title = effect.title + ": position [rad]",
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
    const Pair pair = simulate(effect);
    double squares_mrad2 = 0.0;
    for (const double apart_mrad : pair.apart_mrad) squares_mrad2 += apart_mrad * apart_mrad;
    EXPECT_GT(std::sqrt(squares_mrad2 / static_cast<double>(pair.t_s.size())), 3.0) << effect.name << " can't be seen";
    EXPECT_LT(picture(effect).size(), kLargestPicture_bytes) << effect.name;
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
    out << picture(effect);
    EXPECT_TRUE(out.flush()) << effect.name;
  }
}

}  // namespace
}  // namespace pmg::evidence
