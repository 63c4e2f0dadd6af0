// The robot's files, read as pmg_controller reads them, and its drives' firmware.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <map>
#include <set>

#include "doctor/checks.hpp"
#include "model/clip_library_file.hpp"

namespace pmg::doctor {

namespace {

constexpr const char* kCorrect = "correct the file where the line says (docs/reference/file-formats.md)";

/// Runs look; what it throws is the finding.
template <typename Look>
bool look(Findings& findings, const std::string& check, const std::string& remedy, Look&& look) {
  try {
    findings.push_back(ok(check, look()));
    return true;
  } catch (const std::exception& error) {
    findings.push_back(fail(check, error.what(), remedy));
    return false;
  }
}

Finding bundle_finding(const std::string& is, const std::string& expected) {
  const std::string digits = is.substr(0, 12);
  if (expected.empty()) return ok("bundle", digits + ", of all these files");
  if (is.starts_with(expected)) return ok("bundle", digits + ", as expected");
  return fail("bundle",
              fmt::format("{}; expected {}: these aren't the files that were tried", digits, expected.substr(0, 12)),
              "copy the robot's folder again, or compare file by file with a log of the other computer (pmg_log info)");
}

}  // namespace

Findings check_robot_files(const control::ControlSetup& setup, const std::string& bundle, bool drives) {
  Findings findings;
  model::RobotModel robot;
  if (!look(findings, "robot.yaml and URDF", kCorrect, [&] {
        robot = control::load_robot(setup);
        return fmt::format("{}, {} joints, {:.1f} kg", robot.name, robot.joint_index.size(), robot.total_mass_kg);
      }))
    return findings;
  if (drives) {
    look(findings, "drives", kCorrect, [&] {
      const can::DriveSetup found = can::load_drives(robot);
      return fmt::format("every joint has one that covers it, on {} buses", found.buses.size());
    });
  }
  if (!look(findings, "clips", kCorrect, [&]() -> std::string {
        const std::filesystem::path clips = control::chosen_clips(setup, robot);
        if (clips.empty()) return "none: the policy steps by itself";
        const ClipLibrary library = model::load_clip_library(clips, robot);
        const auto given = [](const auto& clip) { return clip.has_value(); };
        const auto dynamic =
            std::ranges::count_if(library.positive, given) + std::ranges::count_if(library.negative, given);
        return fmt::format("{} dynamic and {} static ones fit the robot", dynamic, library.posture.size());
      }))
    return findings;
  try {
    const control::LoadedControl loaded = control::load_control(setup);
    if (loaded.policy_name == "none") {
      findings.push_back(warn("policy", "none: nothing balances the robot",
                              "give --policy, or write `policy` into robot.yaml; else keep the robot in its gantry"));
    } else {
      findings.push_back(
          ok("policy", loaded.policy_name + (loaded.variant == Variant::kVelocity
                                                 ? " fits the robot"
                                                 : " fits robot and clips, and computes its golden actions")));
    }
    findings.push_back(bundle_finding(loaded.bundle, bundle));
  } catch (const std::exception& error) {
    findings.push_back(
        fail("policy", error.what(),
             "export it again for these clips and this robot (training/README.md), or name another: --policy"));
  }
  return findings;
}

Findings check_firmware(const std::optional<std::vector<DriveAnswer>>& answers) {
  const std::string check = "drives' firmware";
  if (!answers) return {warn(check, "not asked", "pmg_doctor --ask-drives, while no controller runs")};
  Findings findings;
  std::map<std::string, std::map<std::uint32_t, std::vector<std::string>>> by_kind;
  std::set<std::string> silent;
  for (const DriveAnswer& answer : *answers) {
    if (!answer.problem.empty()) {
      findings.push_back(fail(check, fmt::format("{}: {}", answer.motor, answer.problem), "pmg_bus scan"));
    } else if (answer.revision) {
      by_kind[answer.kind][*answer.revision].push_back(answer.motor);
    } else {
      silent.insert(answer.kind);
    }
  }
  for (const auto& [kind, revisions] : by_kind) {
    if (revisions.size() == 1) {
      findings.push_back(ok(check, fmt::format("{}: 0x{:08X} in every drive", kind, revisions.begin()->first)));
      continue;
    }
    std::vector<std::string> parts;
    for (const auto& [revision, motors] : revisions)
      parts.push_back(fmt::format("0x{:08X} in {} (first: {})", revision, motors.size(), motors.front()));
    findings.push_back(fail(check, fmt::format("{}: drives of one kind differ: {}", kind, fmt::join(parts, ", ")),
                            "bring them to one version with the maker's tool"));
  }
  if (!silent.empty()) {
    findings.push_back(warn(check,
                            fmt::format("{}: their protocol (mit) has no such question", fmt::join(silent, ", ")),
                            "compare the versions with the maker's tool"));
  }
  return findings;
}

}  // namespace pmg::doctor
