// Files that training shares with the C++ programs, read by the programs' own readers and handed on as JSON text. Every
// function throws files::ConfigError with the line that pmg_sil would print.
#pragma once

#include <filesystem>
#include <string>

namespace pmg::training {

/// randomization.yaml => its own keys and values. Every key must be there.
std::string randomization_json(const std::filesystem::path& file);

/// (the robot's directory, motor.yaml) => {joint: {"friction.coulomb_Nm": number, ...}}: what isn't neutral.
std::string motors_json(const std::filesystem::path& robot, const std::filesystem::path& file);

/// scenario => [{"text", "for_s", "command": [vx, vy [m/s], omega [rad/s], pitch, roll [rad], height [m]],
/// "hoist_without_policy"}, ...]
std::string scenario_json(const std::filesystem::path& file);

}  // namespace pmg::training
