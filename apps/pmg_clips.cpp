// pmg_clips: makes and shows clip libraries, and recordings of people that libraries are made from.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "clips_build.hpp"
#include "clips_inspect.hpp"
#include "clips_report.hpp"
#include "files/config_error.hpp"
#include "gco/make_command_inverse.hpp"
#include "gco/steady_walk.hpp"
#include "generator/clip_report.hpp"
#include "generator/synthesis.hpp"
#include "json_output.hpp"
#include "model/clip_library_file.hpp"
#include "model/clip_library_writer.hpp"
#include "model/command_inverse_file.hpp"
#include "model/robot_model.hpp"
#include "model/standing_posture.hpp"
#include "option_checks.hpp"
#include "pmg/blending.hpp"
#include "program.hpp"
#include "shown_progress.hpp"

namespace {

using namespace pmg;

/// Makes the command inverse from the clips as read back, so that it belongs to the files. After an interruption the
/// old one stays.
void write_inverse(const model::RobotModel& robot, const std::filesystem::path& clips, const std::string& blend) {
  apps::ProgressLine progress;
  ClipLibrary library = model::load_clip_library(clips, robot);
  const auto named = std::ranges::find(kBlendNames, blend);
  if (named != kBlendNames.end()) library.blend = static_cast<Blend>(named - kBlendNames.begin());
  const CommandInverse inverse = gco::make_command_inverse(robot, library, apps::shown(progress, "inverting commands"));
  progress.clear();
  model::write_command_inverse(clips, inverse);
  if (named != kBlendNames.end()) model::write_rules(clips, library);
}

int invert(const std::string& robot_name, const std::filesystem::path& clips, const std::string& blend) {
  const model::RobotModel robot = model::load_robot_standing_as(robot_name, clips);
  const std::filesystem::path directory = clips.empty() ? robot.directory / "clips" : clips;
  model::require_writable(directory);
  write_inverse(robot, directory, blend);
  return 0;
}

int synth(const std::string& robot_name, const std::filesystem::path& out, const std::string& blend) {
  const model::RobotModel robot = model::load_robot(model::find_robot(robot_name));
  model::require_writable(out);  // before a minute of work, not after it
  apps::ProgressLine progress;
  const ClipLibrary library = generator::synthesize(robot, blend == "corners", apps::shown(progress));
  progress.clear();
  const model::UnfinishedLibrary unfinished(out);
  model::write_clips(unfinished.folder(), library, robot, generator::clip_source);
  write_inverse(robot, unfinished.folder(), blend);
  unfinished.finish();
  return 0;
}

struct ShowOptions {
  std::string robot = "z1";
  std::filesystem::path clips, norms;
  bool json = false;
};

void print_table(const std::vector<generator::ClipReport>& clips, const std::vector<generator::NormReport>& norms,
                 const generator::SoleReport& sole) {
  std::cout << "clip       gain   vx m/s   vy m/s  omega r/s  error   slip cm/s (p95)  feet mm  clearance mm  gap mm\n"
            << std::fixed;
  for (const generator::ClipReport& clip : clips) {
    for (const generator::GainReport& at : clip.gains) {
      const generator::GroundMeasure& g = at.ground;
      std::cout << std::left << std::setw(10) << clip.name << std::right << std::setprecision(1) << std::setw(5)
                << at.gain << std::setprecision(3) << std::setw(9) << g.mean_velocity.x() << std::setw(9)
                << g.mean_velocity.y() << std::setw(11) << g.mean_velocity.z() << std::setw(7)
                << at.velocity_error.cwiseAbs().maxCoeff() << std::setprecision(1) << std::setw(10)
                << 100.0 * g.slip_mean_m_s << " (" << 100.0 * g.slip_p95_m_s << ")" << std::setw(9)
                << 1000.0 * g.other_foot_height_m << std::setw(14) << 1000.0 * g.clearance_m << std::setw(8)
                << 1000.0 * g.foot_gap_m << "\n";
    }
    std::cout << "           T " << std::setprecision(2) << clip.period_s << " s, r " << clip.duty_factor
              << ", joint speed " << std::setprecision(0) << 100.0 * clip.joint_speed_share << " % of limits, "
              << std::setprecision(3) << clip.limit_margin_rad
              << " rad from limits: " << (clip.failure.empty() ? "ok" : clip.failure) << "\n";
  }
  for (const generator::NormReport& norm : norms) {
    std::cout << "forward " << norm.curve << ": correlation " << std::setprecision(3) << norm.correlation << ", RMS "
              << std::setprecision(1) << norm.rms_deg << " degrees from the norm, at contact " << norm.at_contact_deg
              << "\n";
  }
  if (norms.empty()) return;
  std::cout << "forward sole from 10 to 30 % of the cycle: toes up by " << sole.toes_up_deg << " degrees, the norm "
            << sole.published_toes_up_deg << "\n";
}

void print_json(const std::vector<generator::ClipReport>& clips, const std::vector<generator::NormReport>& norms,
                const generator::SoleReport& sole) {
  nlohmann::json out;
  for (const generator::ClipReport& clip : clips) {
    nlohmann::json& entry = out["clips"][clip.name];
    entry = {{"period_s", clip.period_s},
             {"duty_factor", clip.duty_factor},
             {"joint_speed_share", clip.joint_speed_share},
             {"limit_margin_rad", clip.limit_margin_rad},
             {"failure", clip.failure}};
    for (const generator::GainReport& at : clip.gains) {
      const generator::GroundMeasure& g = at.ground;
      entry["gains"].push_back({{"gain", at.gain},
                                {"vx_m_s", g.mean_velocity.x()},
                                {"vy_m_s", g.mean_velocity.y()},
                                {"omega_rad_s", g.mean_velocity.z()},
                                {"velocity_error", at.velocity_error.cwiseAbs().maxCoeff()},
                                {"slip_mean_m_s", g.slip_mean_m_s},
                                {"slip_p95_m_s", g.slip_p95_m_s},
                                {"other_foot_height_m", g.other_foot_height_m},
                                {"clearance_m", g.clearance_m},
                                {"lowest_swing_m", g.lowest_swing_m},
                                {"foot_gap_m", g.foot_gap_m}});
    }
  }
  for (const generator::NormReport& norm : norms) {
    out["norms"][norm.curve] = {
        {"correlation", norm.correlation}, {"rms_deg", norm.rms_deg}, {"contact_deg", norm.at_contact_deg}};
  }
  if (!norms.empty()) {
    out["sole"] = {{"toes_up_deg", sole.toes_up_deg}, {"published_toes_up_deg", sole.published_toes_up_deg}};
  }
  apps::print_json(out);
}

int show(const ShowOptions& options) {
  const model::RobotModel robot = model::load_robot_standing_as(options.robot, options.clips);
  const ClipLibrary library =
      model::load_clip_library(options.clips.empty() ? robot.directory / "clips" : options.clips, robot);
  const std::vector<generator::ClipReport> clips = generator::report(robot, library);
  std::vector<generator::NormReport> norms;
  generator::SoleReport sole;
  if (library.positive[kVx]) {
    norms = generator::compare_with_norms(robot, *library.positive[kVx], options.norms);
    sole = generator::compare_sole_with_norms(robot, *library.positive[kVx], options.norms);
  }
  options.json ? print_json(clips, norms, sole) : print_table(clips, norms, sole);
  for (const generator::ClipReport& clip : clips) {
    if (!clip.failure.empty()) {
      std::cerr << clip.name << ": " << clip.failure << "\n";
      return 1;
    }
  }
  return 0;
}

struct WalkOptions {
  std::string robot = "z1";
  std::string blend = "library";
  std::filesystem::path clips;
  int commands = 100;
  std::uint64_t seed = 1;
  double posture_share = 0.0;
  bool list = false;
};

/// The double-support limits of docs/explanation/method.md hold for the mean over all commands, the other limits for
/// each command.
int walk(const WalkOptions& options) {
  const model::RobotModel robot = model::load_robot_standing_as(options.robot, options.clips);
  ClipLibrary library =
      model::load_clip_library(options.clips.empty() ? robot.directory / "clips" : options.clips, robot);
  const auto named = std::ranges::find(kBlendNames, options.blend);
  if (named != kBlendNames.end()) library.blend = static_cast<Blend>(named - kBlendNames.begin());
  apps::ProgressLine progress;
  gco::SteadyWalk worst;
  worst.lowest_swing_m = worst.clearance_m = worst.foot_gap_m = 1.0;
  Command missed, missed_at_most;
  double slip_m_s = 0.0, slip_p95_m_s = 0.0, slip_worst_m_s = 0.0, clamped = 0.0, cut = 0.0;
  const auto commands = gco::commands_over_the_box(robot, options.commands, options.seed, options.posture_share);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (apps::interrupt_requested != 0) throw work::Interrupted();
    progress.show(fmt::format("walking {} of {}", i + 1, commands.size()));
    const gco::SteadyWalk one = gco::walk_steadily(robot, library, commands[i]);
    const auto n = static_cast<double>(commands.size());
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double error = std::abs(one.mean.u[c] - one.admissible.u[c]);
      missed.u[c] += error / n;
      missed_at_most.u[c] = std::max(missed_at_most.u[c], error);
    }
    slip_m_s += one.slip.double_support_mean_m_s / n;
    slip_p95_m_s += one.slip.double_support_p95_m_s / n;
    slip_worst_m_s = std::max(slip_worst_m_s, one.slip.double_support_mean_m_s);
    clamped += one.clamped ? 1.0 : 0.0;
    cut += one.limited ? 1.0 : 0.0;
    worst.pure_single_support_m_s = std::max(worst.pure_single_support_m_s, one.pure_single_support_m_s);
    worst.slip.other_foot_height_max_m = std::max(worst.slip.other_foot_height_max_m, one.slip.other_foot_height_max_m);
    worst.slip.lower_foot_height_max_m = std::max(worst.slip.lower_foot_height_max_m, one.slip.lower_foot_height_max_m);
    worst.lowest_swing_m = std::min(worst.lowest_swing_m, one.lowest_swing_m);
    worst.clearance_m = std::min(worst.clearance_m, one.clearance_m);
    worst.foot_gap_m = std::min(worst.foot_gap_m, one.foot_gap_m);
    if (!options.list) continue;
    progress.clear();
    const auto& u = commands[i].u;
    fmt::print(
        "asked {:6.3f} {:6.3f} {:6.3f} {:6.3f} {:6.3f} {:6.3f} admitted {:6.3f} {:6.3f} {:6.3f} did {:6.3f} {:6.3f} "
        "{:6.3f} "
        "{:6.3f} slip {:4.1f} ({:4.1f}) cm/s feet {:4.1f} mm clearance {:5.1f} mm swing {:5.1f} mm gap {:4.0f} mm\n",
        u[0], u[1], u[2], u[3], u[4], u[5], one.admissible[kVx], one.admissible[kVy], one.admissible[kOmega],
        one.mean[kVx], one.mean[kVy], one.mean[kOmega], one.mean[kHeight], 100.0 * one.slip.double_support_mean_m_s,
        100.0 * one.slip.double_support_p95_m_s, 1000.0 * one.slip.other_foot_height_max_m, 1000.0 * one.clearance_m,
        1000.0 * one.lowest_swing_m, 1000.0 * one.foot_gap_m);
  }
  progress.clear();
  fmt::print("{} steady commands over the box, {:.0f} of them cut to what the clips reach\n", commands.size(), cut);
  for (const Channel c : {kVx, kVy, kOmega, kHeight}) {
    fmt::print("mean u' against the admissible command, {}: {:.4f} in the mean, {:.4f} at most\n", kChannelNames[c],
               missed[c], missed_at_most[c]);
  }
  fmt::print("single support slip at most {:.3f} mm/s\n", 1000.0 * worst.pure_single_support_m_s);
  fmt::print(
      "double support slip {:.1f} cm/s in the mean over commands (95th percentiles: {:.1f}), worst command {:.1f}\n",
      100.0 * slip_m_s, 100.0 * slip_p95_m_s, 100.0 * slip_worst_m_s);
  fmt::print("stance feet off the ground at most {:.2f} / {:.1f} mm (lower / other)\n",
             1000.0 * worst.slip.lower_foot_height_max_m, 1000.0 * worst.slip.other_foot_height_max_m);
  fmt::print("swing clearance at least {:.1f} mm in mid-swing, {:.1f} mm anywhere; soles {:.0f} mm apart\n",
             1000.0 * worst.clearance_m, 1000.0 * worst.lowest_swing_m, 1000.0 * worst.foot_gap_m);
  fmt::print("{:.0f} commands with clamped joints\n", clamped);
  const bool good = worst.pure_single_support_m_s <= 0.001 && slip_m_s <= 0.03 && slip_p95_m_s <= 0.10 &&
                    worst.slip.other_foot_height_max_m <= 0.010 && clamped == 0.0;
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes and shows clip libraries.", "pmg_clips");
  app.require_subcommand(1);
  app.footer(
      "Examples: pmg_clips inspect walk.bvh; pmg_clips build library.yaml --robot z1 --out clips; pmg_clips synth "
      "--robot z1 --out config/robots/z1/clips && pmg_clips show "
      "--robot z1\n"
      "Exit codes: 0 ok, 1 a check failed, 2 bad input, 130 interrupted (nothing is written: the old clips stay "
      "whole).");
  std::string robot = "z1";
  std::filesystem::path out;
  CLI::App* synth_command = app.add_subcommand("synth", "Make a clip library from published gait figures");
  synth_command->add_option("--robot", robot, "robot's name, or its directory")->capture_default_str();
  synth_command->add_option("--out", out, "directory for the clips")->required();
  ShowOptions options;
  CLI::App* show_command =
      app.add_subcommand("show", "Check a library's clips against the ground at gains from 0.1 to 1");
  show_command->add_option("--robot", options.robot, "robot's name, or its directory")->capture_default_str();
  show_command->add_option("--clips", options.clips, "directory of the clips; the robot's own if left out");
  show_command->add_option("--norms", options.norms, "CSV of published means to compare the forward clip with");
  show_command->add_flag("--json", options.json, "for machines");
  std::filesystem::path inverse_clips;
  std::string blend = "library";
  const auto add_blend = [&blend](CLI::App* command) {
    command
        ->add_option("--blend", blend, "how the clips shall be mixed; library: as library.yaml says, or gain without")
        ->check(apps::one_of({"library", "gain", "paper", "corners"}))
        ->capture_default_str();
  };
  add_blend(synth_command);
  CLI::App* invert_command = app.add_subcommand(
      "invert", "Make inverse.csv: what to ask of the clips so that the mean optimised command is the user's");
  invert_command->add_option("--robot", robot, "robot's name, or its directory")->capture_default_str();
  invert_command->add_option("--clips", inverse_clips, "directory of the clips; the robot's own if left out");
  add_blend(invert_command);
  WalkOptions walking;
  CLI::App* walk_command = app.add_subcommand(
      "walk", "Walk steadily at random commands over the whole box: velocities against the command, slip, clearance");
  walk_command->add_option("--robot", walking.robot, "robot's name, or its directory")->capture_default_str();
  walk_command->add_option("--clips", walking.clips, "directory of the clips; the robot's own if left out");
  walk_command->add_option("--blend", walking.blend, "as for invert")
      ->check(apps::one_of({"library", "gain", "paper", "corners"}))
      ->capture_default_str();
  walk_command->add_option("--commands", walking.commands, "how many")->check(apps::positive())->capture_default_str();
  walk_command->add_option("--seed", walking.seed, "of the commands")->capture_default_str();
  walk_command->add_option("--postures", walking.posture_share, "share of the posture ranges, for half of the commands")
      ->check(apps::in_range(0.0, 1.0))
      ->capture_default_str();
  walk_command->add_flag("--list", walking.list, "print every command's figures");
  apps::InspectOptions inspecting;
  CLI::App* inspect_command = apps::add_inspect(app, inspecting);
  apps::BuildOptions building;
  CLI::App* build_command = apps::add_build(app, building);
  apps::ReportOptions reporting, previewing;
  CLI::App* report_command = apps::add_report(app, reporting);
  CLI::App* preview_command = apps::add_preview(app, previewing);
  return apps::run_program(app, argc, argv, [&]() -> int {
    if (inspect_command->parsed()) return apps::inspect(inspecting);
    apps::notice({SIGINT, SIGTERM}, "leaving the old clips as they were");
    try {
      if (walk_command->parsed()) return walk(walking);
      if (report_command->parsed()) return apps::report(reporting);
      if (preview_command != nullptr && preview_command->parsed()) return apps::preview(previewing);
      if (build_command->parsed()) {
        return apps::build(building, [](const auto& of, const auto& clips) { write_inverse(of, clips, "library"); });
      }
      if (invert_command->parsed()) return invert(robot, inverse_clips, blend);
      return synth_command->parsed() ? synth(robot, out, blend) : show(options);
    } catch (const work::Interrupted&) {
      return 130;
    }
  });
}
