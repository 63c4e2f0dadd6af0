// Pushes at the torso: survival by strength and direction of the impulse, standing and walking.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

inline constexpr int kPushDirections = 8;
inline constexpr std::array<const char*, kPushDirections> kPushDirectionNames = {
    "forward", "forward left", "left", "backward left", "backward", "backward right", "right", "forward right"};
inline constexpr double kPush_s = 0.1;                                 ///< duration of an impulse
inline constexpr double kJudgedPush_N_s = 35.0, kPushSurvival = 0.95;  ///< required of a policy

/// One push without its strength: trial i has the same robot, moment and direction for every strength.
struct PushPlan {
  int direction = 0;  ///< multiples of 45 degrees, counter-clockwise from the pelvis' heading
  bool walking = false;
  double at_s = 0.0;  ///< in the scenario; a random moment of the gait cycle

  static PushPlan of(int trial);
  double direction_rad() const;
};

/// Stands, walks at 0.5 m/s if the plan says so, and lasts until 4 s after the push.
sil::Scenario push_scenario(const PushPlan& plan);

/// Applies the impulse at the torso's centre of mass, and ends a trial at its first fault.
class Pusher {
 public:
  Pusher(const PushPlan& plan, double impulse_N_s) : plan_(plan), force_N_(impulse_N_s / kPush_s) {}
  bool operator()(const sil::RunProgress& now, sim::World& world);

 private:
  PushPlan plan_;
  double force_N_;
  int ticks_pushed_ = 0;
};

struct PushTrials {
  double impulse_N_s = 0.0;
  std::vector<TrialResult> runs;  ///< by trial
};

struct PushTest {
  std::string robot, ranges_file;
  Case evaluated;
  int trials = 0;  ///< per strength
  std::vector<PushTrials> strengths;
  bool complete = true;

  /// Share of survivors among the complete trials that keep() selects.
  template <typename Keep>
  Estimate survival(const PushTrials& at, Keep&& keep) const {
    std::int64_t survived = 0, count = 0;
    for (std::size_t trial = 0; trial < at.runs.size(); ++trial) {
      if (!at.runs[trial].complete || !keep(PushPlan::of(static_cast<int>(trial)))) continue;
      ++count;
      survived += at.runs[trial].survived() ? 1 : 0;
    }
    return share_interval(survived, count);
  }
  Estimate survival(const PushTrials& at) const {
    return survival(at, [](const PushPlan&) { return true; });
  }
  /// Whether the judged push is survived as often as required; nullopt if it was not tried.
  std::optional<bool> reached() const;
};

/// Interrupted; missed at the judged strength; open where that strength was not tried.
work::Worth worth_of(const PushTest& test);

/// Runs all trials of every strength. The result doesn't depend on the number of jobs.
void run_pushes(PushTest& test, const std::vector<double>& impulses_N_s, const Supervision& supervision);

nlohmann::ordered_json to_json(const PushTest& test);
pages::Page page_of(const PushTest& test);
std::vector<pages::Table> tables_of(const PushTest& test);

}  // namespace pmg::evaluation
