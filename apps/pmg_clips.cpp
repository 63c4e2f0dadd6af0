// Makes and shows clip libraries.
#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "generator/synthesis.hpp"
#include "model/clip_library_file.hpp"
#include "model/config_error.hpp"
#include "model/robot_model.hpp"

namespace {

using namespace pmg;

void write_library(const std::filesystem::path& directory, const ClipLibrary& library, const model::RobotModel& robot) {
  const auto dynamic = [&](const std::string& name, const std::optional<DynamicClip>& clip) {
    if (clip) {
      model::write_dynamic_clip(directory, name, *clip, robot, generator::clip_source(name));
    }
  };
  const auto posture = [&](const std::string& name, Channel channel) {
    model::write_static_clip(directory, name, channel, library.posture[channel - kPitch], robot, generator::clip_source(name));
  };
  dynamic("forward", library.positive[kVx]);
  dynamic("backward", library.negative[kVx]);
  dynamic("lateral", library.positive[kVy]);
  dynamic("turn", library.positive[kOmega]);
  posture("bend", kPitch);
  posture("lean", kRoll);
  posture("squat", kHeight);
}

int synth(const std::string& robot_name, const std::filesystem::path& out) {
  const model::RobotModel robot = model::load_robot(model::find_robot(robot_name));
  std::filesystem::create_directories(out);
  const ClipLibrary library = generator::synthesize(robot, [](const std::string& clip) { std::cerr << clip << "\n"; });
  write_library(out, library, robot);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes and shows clip libraries."};
  app.require_subcommand(1);
  std::string robot = "z1";
  std::filesystem::path out;
  CLI::App* synth_command = app.add_subcommand("synth", "Make a clip library from published gait figures");
  synth_command->add_option("--robot", robot, "robot's name, or its directory")->capture_default_str();
  synth_command->add_option("--out", out, "directory for the clips")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return synth(robot, out);
  } catch (const model::ConfigError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
