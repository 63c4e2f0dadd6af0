#include "evaluation/push.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "control/control_cycle.hpp"

namespace pmg::evaluation {

namespace {

using nlohmann::ordered_json;

constexpr double kStandBeforePush_s = 1.5, kEarliestPush_s = 4.0;
constexpr double kPushWindow_s = 1.0;  // about a gait period, so that every phase occurs
constexpr double kAfterPush_s = 4.0, kWalking_m_s = 0.5;

double heading_rad(const model::GroundTruth& truth) {
  const Eigen::Vector3d forward_W = truth.q_WB * Eigen::Vector3d::UnitX();
  return std::atan2(forward_W.y(), forward_W.x());
}

ordered_json share_json(const Estimate& share) {
  ordered_json json = to_json(share);
  json["share"] = json["mean"];
  json.erase("mean");
  return json;
}

/// Number of trials by their end: the first fault's code, "fell" without a fault, or "survived".
std::map<std::string, int> ends(const PushTrials& at) {
  std::map<std::string, int> count;
  for (const TrialResult& run : at.runs) {
    if (!run.complete) continue;
    const std::string fault = run.faults.empty() ? "" : run.faults.front();
    ++count[!fault.empty() ? fault.substr(0, fault.find(':')) : run.fell ? "fell" : "survived"];
  }
  return count;
}

}  // namespace

PushPlan PushPlan::of(int trial) {
  std::mt19937_64 random(static_cast<std::uint64_t>(trial) + 1);
  const double share = static_cast<double>(random() >> 11) * 0x1p-53;
  return {.direction = trial % kPushDirections,
          .walking = trial / kPushDirections % 2 == 1,
          .at_s = kEarliestPush_s + share * kPushWindow_s};
}

double PushPlan::direction_rad() const { return direction * 2.0 * std::numbers::pi / kPushDirections; }

sil::Scenario push_scenario(const PushPlan& plan) {
  sil::Scenario scenario{.name = "push", .steps = {}};
  sil::ScenarioStep step{.start_s = 0.0,
                         .duration_s = kStandBeforePush_s,
                         .text = "stand",
                         .mode = control::Mode::kStand,
                         .command = {},
                         .hoist_without_policy = false};
  scenario.steps.push_back(step);
  step.start_s = kStandBeforePush_s;
  step.duration_s = plan.at_s + kAfterPush_s - kStandBeforePush_s;
  if (plan.walking) {
    step.text = "walk";
    step.mode = control::Mode::kWalk;
    step.command[kVx] = kWalking_m_s;
  }
  scenario.steps.push_back(step);
  return scenario;
}

// Whole physics steps fit into a tick, so the push lasts exactly kPush_s.
bool Pusher::operator()(const sil::RunProgress& now, sim::World& world) {
  const bool pushing =
      now.time_s >= plan_.at_s && ticks_pushed_ < std::lround(kPush_s / control::ControlCycle::kPeriod_s);
  if (pushing) {
    if (ticks_pushed_++ == 0) {
      const double towards_rad = heading_rad(world.truth()) + plan_.direction_rad();
      world.set_push(force_N_ * Eigen::Vector3d(std::cos(towards_rad), std::sin(towards_rad), 0.0));
    }
  } else if (ticks_pushed_ > 0) {
    world.set_push(Eigen::Vector3d::Zero());
  }
  return now.result.mode != control::Mode::kFault;
}

work::Worth worth_of(const PushTest& test) {
  work::Worth worth;
  worth.add_if(!test.complete, work::Grade::kInterrupted, "not all trials ran");
  const std::optional<bool> reached = test.reached();
  worth.add_if(!reached.has_value(), work::Grade::kOpen,
               fmt::format("pushes of {:.0f} N s are judged, and none of them was tried", kJudgedPush_N_s));
  worth.add_if(test.complete && !reached.value_or(true), work::Grade::kMissed,
               fmt::format("less than {:.0f} % of the pushes of {:.0f} N s are survived", 100.0 * kPushSurvival,
                           kJudgedPush_N_s));
  return worth;
}

std::optional<bool> PushTest::reached() const {
  for (const PushTrials& at : strengths) {
    if (at.impulse_N_s == kJudgedPush_N_s) return survival(at).mean >= kPushSurvival;
  }
  return std::nullopt;
}

void run_pushes(PushTest& test, const std::vector<double>& impulses_N_s, const Supervision& supervision) {
  const model::RobotModel robot = control::load_robot(test.evaluated.candidate.control);
  const auto trials = static_cast<std::size_t>(test.trials);
  test.strengths.clear();
  for (const double impulse_N_s : impulses_N_s) {
    test.strengths.push_back({impulse_N_s, std::vector<TrialResult>(trials)});
  }
  // Trial by trial, so that an interruption leaves equally many for every strength.
  for_each_piece(test.strengths.size() * trials, supervision, [&](std::size_t piece) {
    PushTrials& at = test.strengths[piece % test.strengths.size()];
    const std::size_t trial = piece / test.strengths.size();
    const PushPlan plan = PushPlan::of(static_cast<int>(trial));
    at.runs[trial] =
        run_trial(test.evaluated.candidate, push_scenario(plan), test.evaluated.plants.of(robot, trial + 1),
                  {.gantry = false, .progress = supervision.progress, .observer = Pusher(plan, at.impulse_N_s)});
  });
  test.complete = true;
  for (const PushTrials& at : test.strengths) {
    for (const TrialResult& run : at.runs) test.complete = test.complete && run.complete;
  }
}

ordered_json to_json(const PushTest& test) {
  ordered_json json = {{"kind", "push"},
                       {"complete", test.complete},
                       {"robot", test.robot},
                       {"policy", test.evaluated.name},
                       {"variation", test.ranges_file.empty() ? ordered_json(nullptr) : ordered_json(test.ranges_file)},
                       {"trials_a_strength", test.trials},
                       {"push_s", kPush_s},
                       {"limit", {{"impulse_N_s", kJudgedPush_N_s}, {"share", kPushSurvival}, {"reached", nullptr}}},
                       {"strengths", ordered_json::array()}};
  if (const auto reached = test.reached()) json["limit"]["reached"] = *reached;
  for (const PushTrials& at : test.strengths) {
    ordered_json entry = {{"impulse_N_s", at.impulse_N_s}, {"survived", share_json(test.survival(at))}};
    int trials = 0;
    for (const TrialResult& run : at.runs) trials += run.complete ? 1 : 0;
    entry["trials"] = trials;
    entry["standing"] = share_json(test.survival(at, [](const PushPlan& plan) { return !plan.walking; }));
    entry["walking"] = share_json(test.survival(at, [](const PushPlan& plan) { return plan.walking; }));
    for (int d = 0; d < kPushDirections; ++d) {
      ordered_json direction = {{"direction", kPushDirectionNames[static_cast<std::size_t>(d)]},
                                {"direction_deg", 360 / kPushDirections * d}};
      direction.update(share_json(test.survival(at, [d](const PushPlan& plan) { return plan.direction == d; })));
      entry["directions"].push_back(direction);
    }
    entry["ends"] = ends(at);
    json["strengths"].push_back(entry);
  }
  return json;
}

}  // namespace pmg::evaluation
