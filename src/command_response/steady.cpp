#include "command_response/steady.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "evaluation/course.hpp"
#include "operator/command_text.hpp"

namespace pmg::command_response {

namespace {

using nlohmann::ordered_json;

constexpr double kStandBeforeWalk_s = 1.5;
constexpr std::array<const char*, kVelocityChannels> kShortNames = {"vx", "vy", "omega"};
/// Commands of so many channels: the share of the range that is asked for, and the errors that are allowed.
struct Asked {
  std::size_t channels = 0;
  double share = 0.0, limit = 0.0;
  std::optional<double> drift_limit = {};
};
constexpr std::array<Asked, 4> kAsked = {{{1, 1.0, 0.03}, {2, 0.8, 0.10}, {3, 0.6, 0.10}, {1, 0.2, 0.15, 0.05}}};

/// The command with these signs; nothing where a range has no such side.
std::optional<HeldCommand> held(const CommandLimits& limits, const Asked& asked,
                                const std::array<int, kVelocityChannels>& sign) {
  HeldCommand made{.text = "", .command = {}, .limit = asked.limit, .drift_limit = asked.drift_limit};
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    if (sign[c] == 0) continue;
    made.command.u[c] = asked.share * (sign[c] > 0 ? limits.upper[c] : limits.lower[c]);
    if (made.command.u[c] == 0.0) return std::nullopt;
    made.text +=
        fmt::format("{}{} {:+.0f} %", made.text.empty() ? "" : ", ", kShortNames[c], 100.0 * sign[c] * asked.share);
  }
  return made;
}

sil::Scenario scenario_of(const SteadyTest& test, const HeldCommand& asked) {
  sil::ScenarioStep stand;
  stand.duration_s = kStandBeforeWalk_s;
  stand.text = "stand";
  sil::ScenarioStep walk = stand;
  walk.start_s = kStandBeforeWalk_s;
  walk.duration_s = test.settle_s + test.steady_s;
  walk.text = asked.text;
  walk.mode = control::Mode::kWalk;
  walk.command = asked.command;
  return {.name = "steady", .steps = {stand, walk}};
}

HeldResult run_held(const SteadyTest& test, const HeldCommand& asked, const sim::WorldOptions& world,
                    double standing_height_m, const work::Progress& progress) {
  // The velocities of a course are means over the last gait period, so their mean over the steady part has no sway.
  evaluation::Course course;
  evaluation::CourseRecorder recorder(course, standing_height_m);
  Command admitted;
  std::size_t before = 0;  // ticks until the steady part
  const auto observer = [&](const sil::RunProgress& now, sim::World& simulated) {
    recorder.add(now, simulated.truth());
    if (now.time_s < kStandBeforeWalk_s + test.settle_s) {
      ++before;
    } else {
      const Command taken = user_command(now.result.reference);
      for (std::size_t c = 0; c < kChannels; ++c) admitted.u[c] += taken.u[c];
    }
    return now.result.mode != control::Mode::kFault;
  };
  const evaluation::TrialResult trial = evaluation::run_trial(
      test.candidate, scenario_of(test, asked), world, {.gantry = false, .progress = progress, .observer = observer});
  HeldResult result{.complete = trial.complete, .survived = trial.survived(), .did = {}, .admitted = {}};
  const std::size_t ticks = course.time_s.size();
  if (ticks <= before) return result;
  const double share = 1.0 / static_cast<double>(ticks - before);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto begin = course.did[c].begin() + static_cast<std::ptrdiff_t>(before);
    result.did.u[c] = share * std::accumulate(begin, course.did[c].end(), 0.0);
    result.admitted.u[c] = share * admitted.u[c];
  }
  return result;
}

}  // namespace

std::vector<HeldCommand> held_commands(const CommandLimits& limits) {
  std::vector<HeldCommand> commands;
  for (const Asked& asked : kAsked) {
    for (int vx = 1; vx >= -1; --vx) {
      for (int vy = 1; vy >= -1; --vy) {
        for (int omega = 1; omega >= -1; --omega) {
          const std::array<int, kVelocityChannels> sign = {vx, vy, omega};
          if (static_cast<std::size_t>(std::ranges::count_if(sign, [](int s) { return s != 0; })) != asked.channels) {
            continue;
          }
          if (const auto made = held(limits, asked, sign)) commands.push_back(*made);
        }
      }
    }
  }
  return commands;
}

double worst_error(const HeldCommand& asked, const Command& did) {
  double worst = 0.0;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    const double wanted = asked.command.u[c];
    if (wanted != 0.0) worst = std::max(worst, std::abs(did.u[c] - wanted) / std::abs(wanted));
  }
  return worst;
}

double worst_drift(const HeldCommand& asked, const Command& did, const CommandLimits& limits) {
  double worst = 0.0;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    const double end = did.u[c] < 0.0 ? -limits.lower[c] : limits.upper[c];
    if (asked.command.u[c] == 0.0 && end > 0.0) worst = std::max(worst, std::abs(did.u[c]) / end);
  }
  return worst;
}

bool SteadyTest::complete() const {
  return std::ranges::all_of(results, [](const HeldResult& result) { return result.complete; });
}

bool SteadyTest::reached(std::size_t command) const {
  const HeldCommand& asked = commands[command];
  const HeldResult& result = results[command];
  if (asked.drift_limit && worst_drift(asked, result.did, limits) > *asked.drift_limit) return false;
  return result.survived && worst_error(asked, result.did) <= asked.limit;
}

work::Worth worth_of(const SteadyTest& test) {
  if (!test.complete()) return {work::Grade::kInterrupted, "not all commands were held"};
  if (!test.all_reached()) return {work::Grade::kMissed, "a command is not realised within its limit"};
  return {};
}

bool SteadyTest::all_reached() const {
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!reached(i)) return false;
  }
  return true;
}

void run_steady(SteadyTest& test, const evaluation::Supervision& supervision) {
  const model::RobotModel robot = control::load_robot(test.candidate.control);
  test.limits = robot.command_limits;
  if (test.commands.empty()) test.commands = held_commands(test.limits);
  test.results.assign(test.commands.size(), {});
  const sim::WorldOptions world = evaluation::Plants{}.of(robot, 1);
  evaluation::for_each_piece(test.commands.size(), supervision, [&](std::size_t i) {
    test.results[i] = run_held(test, test.commands[i], world, robot.standing_height_m, supervision.progress);
  });
}

ordered_json to_json(const SteadyTest& test) {
  ordered_json json = {{"kind", "steady"},
                       {"complete", test.complete()},
                       {"robot", test.robot},
                       {"policy", test.candidate.name},
                       {"variation", nullptr},
                       {"settle_s", test.settle_s},
                       {"steady_s", test.steady_s},
                       {"all_reached", test.all_reached()},
                       {"commands", ordered_json::array()}};
  for (std::size_t i = 0; i < test.commands.size(); ++i) {
    const HeldCommand& asked = test.commands[i];
    const HeldResult& result = test.results[i];
    if (!result.complete) continue;
    json["commands"].push_back({{"text", asked.text},
                                {"command", ops::command_json(asked.command.u)},
                                {"admitted", ops::command_json(result.admitted.u)},
                                {"did", ops::command_json(result.did.u)},
                                {"error", worst_error(asked, result.did)},
                                {"drift", worst_drift(asked, result.did, test.limits)},
                                {"limit", asked.limit},
                                {"drift_limit", asked.drift_limit ? ordered_json(*asked.drift_limit) : ordered_json()},
                                {"survived", result.survived},
                                {"reached", test.reached(i)}});
  }
  return json;
}

}  // namespace pmg::command_response
