// Makes and shows clip libraries.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "gco/make_command_inverse.hpp"
#include "generator/clip_report.hpp"
#include "generator/synthesis.hpp"
#include "model/clip_library_file.hpp"
#include "model/command_inverse_file.hpp"
#include "model/config_error.hpp"
#include "model/robot_model.hpp"
#include "program.hpp"
#include "progress_line.hpp"

namespace {

using namespace pmg;

void write_library(const std::filesystem::path& directory, const ClipLibrary& library, const model::RobotModel& robot) {
  const auto dynamic = [&](const std::string& name, const std::optional<DynamicClip>& clip) {
    if (clip) {
      model::write_dynamic_clip(directory, name, *clip, robot, generator::clip_source(name));
    }
  };
  const auto posture = [&](const std::string& name, Channel channel) {
    model::write_static_clip(directory, name, channel, library.posture[channel - kPitch], robot,
                             generator::clip_source(name));
  };
  dynamic("forward", library.positive[kVx]);
  dynamic("backward", library.negative[kVx]);
  dynamic("lateral", library.positive[kVy]);
  dynamic("turn", library.positive[kOmega]);
  posture("bend", kPitch);
  posture("lean", kRoll);
  posture("squat", kHeight);
}

struct Interrupted {};

/// Throws model::ConfigError unless the directory, or the one that it would be made in, takes new files. Makes nothing.
void require_writable(const std::filesystem::path& directory) {
  std::filesystem::path existing = std::filesystem::absolute(directory);
  std::error_code error;
  while (!std::filesystem::exists(existing, error) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  if (!std::filesystem::is_directory(existing, error) || access(existing.c_str(), W_OK | X_OK) != 0) {
    throw model::ConfigError(directory.string() +
                             ": can't be written to; expected a directory, or a place to make one in");
  }
}

/// From the clips as they are read back, so that it belongs to the files. Interrupted, the old one stays.
void write_inverse(const model::RobotModel& robot, const std::filesystem::path& clips) {
  apps::ProgressLine progress;
  const CommandInverse inverse =
      gco::make_command_inverse(robot, model::load_clip_library(clips, robot), [&progress](double share) {
        if (apps::interrupt_requested != 0) throw Interrupted{};
        progress.show(fmt::format("inverting commands {:.0f} %", 100.0 * share));
      });
  progress.clear();
  model::write_command_inverse(clips, inverse);
}

/// A folder inside the library's, in which a new one is made and from which it moves when it is whole: an interruption
/// leaves the old clips with the inverse that belongs to them.
class UnfinishedLibrary {
 public:
  explicit UnfinishedLibrary(const std::filesystem::path& library)
      : library_(library), made_(!std::filesystem::exists(library)), folder_(library / ".unfinished") {
    std::filesystem::remove_all(folder_);  // of a run that was killed
    std::filesystem::create_directories(folder_);
  }
  ~UnfinishedLibrary() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
    if (made_) std::filesystem::remove(library_, ignored);  // if it is still empty
  }
  UnfinishedLibrary(const UnfinishedLibrary&) = delete;
  UnfinishedLibrary& operator=(const UnfinishedLibrary&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  void finish() const {
    for (const std::filesystem::path& file : model::clip_library_files(folder_)) {
      std::filesystem::rename(file, library_ / file.filename());
    }
  }

 private:
  std::filesystem::path library_;
  bool made_;
  std::filesystem::path folder_;
};

int invert(const std::string& robot_name, const std::filesystem::path& clips) {
  const model::RobotModel robot = model::load_robot(model::find_robot(robot_name));
  const std::filesystem::path directory = clips.empty() ? robot.directory / "clips" : clips;
  require_writable(directory);
  write_inverse(robot, directory);
  return 0;
}

int synth(const std::string& robot_name, const std::filesystem::path& out) {
  const model::RobotModel robot = model::load_robot(model::find_robot(robot_name));
  require_writable(out);  // now, not after a minute's work
  apps::ProgressLine progress;
  const ClipLibrary library = generator::synthesize(robot, [&progress](const std::string& clip) {
    if (apps::interrupt_requested != 0) {
      throw Interrupted{};
    }
    progress.show("making " + clip);
  });
  progress.clear();
  const UnfinishedLibrary unfinished(out);
  write_library(unfinished.folder(), library, robot);
  write_inverse(robot, unfinished.folder());
  unfinished.finish();
  return 0;
}

struct ShowOptions {
  std::string robot = "z1";
  std::filesystem::path clips, norms;
  bool json = false;
};

void print_table(const std::vector<generator::ClipReport>& clips, const std::vector<generator::NormReport>& norms) {
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
              << std::setprecision(1) << norm.rms_deg << " degrees from the norm\n";
  }
}

void print_json(const std::vector<generator::ClipReport>& clips, const std::vector<generator::NormReport>& norms) {
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
    out["norms"][norm.curve] = {{"correlation", norm.correlation}, {"rms_deg", norm.rms_deg}};
  }
  std::cout << out.dump(2) << "\n";
}

int show(const ShowOptions& options) {
  const model::RobotModel robot = model::load_robot(model::find_robot(options.robot));
  const ClipLibrary library =
      model::load_clip_library(options.clips.empty() ? robot.directory / "clips" : options.clips, robot);
  const std::vector<generator::ClipReport> clips = generator::report(robot, library);
  std::vector<generator::NormReport> norms;
  if (!options.norms.empty() && library.positive[kVx]) {
    norms = generator::compare_with_norms(robot, *library.positive[kVx], options.norms);
  }
  options.json ? print_json(clips, norms) : print_table(clips, norms);
  for (const generator::ClipReport& clip : clips) {
    if (!clip.failure.empty()) {
      std::cerr << clip.name << ": " << clip.failure << "\n";
      return 1;
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes and shows clip libraries.", "pmg_clips");
  app.require_subcommand(1);
  app.footer(
      "Example: pmg_clips synth --robot z1 --out config/robots/z1/clips && pmg_clips show --robot z1\n"
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
  CLI::App* invert_command = app.add_subcommand(
      "invert", "Make inverse.csv: what to ask of the clips so that the mean optimised command is the user's");
  invert_command->add_option("--robot", robot, "robot's name, or its directory")->capture_default_str();
  invert_command->add_option("--clips", inverse_clips, "directory of the clips; the robot's own if left out");
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, "leaving the old clips as they were");
    try {
      if (invert_command->parsed()) return invert(robot, inverse_clips);
      return synth_command->parsed() ? synth(robot, out) : show(options);
    } catch (const Interrupted&) {
      return 130;
    }
  });
}
