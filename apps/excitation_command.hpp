// pmg_calibrate_motor --make-excitation: its options and its work.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/excitation.hpp"
#include "files/csv_table.hpp"
#include "files/nearest_name.hpp"
#include "model/robot_model.hpp"
#include "option_checks.hpp"

namespace pmg::apps {

class ExcitationCommand {
 public:
  void declare(CLI::App& app) {
    CLI::Option* make = app.add_flag("--make-excitation", wanted_,
                                     "write what to record instead of fitting: DIR is a bench without recordings");
    const auto needing = [make](CLI::Option* option) { return option->needs(make); };
    needing(app.add_option("--robot", robot_, "limits and gains of --joint come from this robot"));
    needing(app.add_option("--angle", angle_, "LOWER:UPPER [rad]; with --robot, within its range if not given"));
    needing(app.add_option("--speed", speed_rad_s_, "of smooth segments [rad/s]; with --robot, a third of the joint's"))
        ->check(apps::positive());
    needing(app.add_option("--gains", gains_,
                           "KP,KD pairs [Nm/rad, Nm s/rad]; with --robot, its own, half its kp, half "
                           "of both"));
    needing(app.add_option("--rate", limits_.rate_hz, "commands a second"))
        ->check(apps::positive())
        ->capture_default_str();
    needing(app.add_option("--seconds", limits_.seconds, "of one trajectory"))
        ->check(apps::positive())
        ->capture_default_str();
    needing(app.add_option("--repeats", repeats_, "of the whole"))
        ->check(apps::in_range(1, 100))
        ->capture_default_str();
  }

  bool wanted() const { return wanted_; }

  /// Writes the bench and returns its description. Throws std::invalid_argument, files::ConfigError or
  /// std::runtime_error.
  std::string run(const std::string& joint, const std::filesystem::path& out, unsigned seed) const {
    bench::ExcitationLimits limits = limits_;
    std::vector<bench::ExcitationGains> gains;
    const std::optional<model::Joint> of_robot = robots_joint(joint);
    if (of_robot) {
      limits = bench::excitation_limits(*of_robot, limits);
      gains = bench::excitation_gains(*of_robot);
    }
    if (!angle_.empty()) take_angle(limits, of_robot);
    if (robot_.empty() && angle_.empty()) missing("--angle");
    if (speed_rad_s_ > 0.0) limits.speed_rad_s = speed_rad_s_;
    if (robot_.empty() && speed_rad_s_ <= 0.0) missing("--speed");
    if (!gains_.empty()) gains.clear();
    for (const std::string& text : gains_) {
      const auto [kp, kd] = pair(text, ',', "--gains", "KP,KD");
      gains.push_back({kp, kd});
    }
    if (gains.empty()) missing("--gains");
    const bench::Excitation excitation = bench::make_excitation(limits, gains, repeats_, seed);
    bench::write_excitation(out, excitation,
                            fmt::format("{} trajectories x {} pairs of gains x {} repeats, {:g} s each",
                                        excitation.trajectories.size(), gains.size(), repeats_, limits.seconds));
    return fmt::format("{} runs of {:g} s between {:.3f} and {:.3f} rad, at most {:.3g} rad/s in smooth segments: {}",
                       excitation.rows.size(), limits.seconds, limits.lower_rad, limits.upper_rad, limits.speed_rad_s,
                       out.string());
  }

 private:
  void take_angle(bench::ExcitationLimits& limits, const std::optional<model::Joint>& joint) const {
    std::tie(limits.lower_rad, limits.upper_rad) = pair(angle_, ':', "--angle", "LOWER:UPPER");
    if (!joint || (limits.lower_rad >= joint->lower_rad && limits.upper_rad <= joint->upper_rad)) return;
    const bool degrees = limits.upper_rad - limits.lower_rad > 6.3;
    throw std::invalid_argument(fmt::format("--angle {}: {} moves from {:.3f} to {:.3f} rad{}", angle_, joint->name,
                                            joint->lower_rad, joint->upper_rad, degrees ? "; are these degrees?" : ""));
  }

  std::optional<model::Joint> robots_joint(const std::string& name) const {
    if (robot_.empty()) return std::nullopt;
    const model::RobotModel robot = model::load_robot(model::find_robot(robot_));
    const auto index = robot.joint_index.find(name);
    if (!index)
      throw std::invalid_argument(fmt::format("--joint {}: {} has no such joint; {}", name, robot.name,
                                              files::expected_name(name, robot.joint_index.names())));
    return robot.joints[static_cast<std::size_t>(*index)];
  }

  static std::pair<double, double> pair(const std::string& text, char between, const char* option, const char* form) {
    const std::size_t at = text.find(between);
    const auto first = files::to_number(text.substr(0, at));
    const auto second = at == std::string::npos ? std::nullopt : files::to_number(text.substr(at + 1));
    if (!first || !second) throw std::invalid_argument(fmt::format("{} {}; expected {}", option, text, form));
    return {*first, *second};
  }

  [[noreturn]] static void missing(const char* option) {
    throw std::invalid_argument(fmt::format("--make-excitation needs {}, or --robot and --joint", option));
  }

  bool wanted_ = false;
  std::string robot_, angle_;
  std::vector<std::string> gains_;
  double speed_rad_s_ = 0.0;
  int repeats_ = 2;
  bench::ExcitationLimits limits_;
};

}  // namespace pmg::apps
