#include "teleoperation/task.hpp"

#include <algorithm>
#include <array>

#include "faults/fault.hpp"

namespace pmg::teleoperation {

namespace {

constexpr double kSteadied_s = 2.5, kSetDown_s = 1.0;  // until it stands a gantry steadies it
constexpr double kFallen = 0.5;                        // of its standing height
constexpr double kAftermath_s = 1.5;                   // shown to the observer

TaskResult play(LedRobot& robot, ScriptedOperator& person, const TaskJudge& judge, double longest_s,
                const TimeUp& time_up, const work::Progress& progress, const TaskObserver& observer) {
  robot.set_hoist(1.0);
  robot.ask_for_stand();
  TaskResult result;
  while (robot.time_s() < longest_s) {
    if (progress.interrupted_now()) return result;
    robot.set_hoist(std::clamp((kSteadied_s + kSetDown_s - robot.time_s()) / kSetDown_s, 0.0, 1.0));
    person.step(robot);
    if (observer) observer(robot, person.stage());
    result.duration_s = robot.time_s();
    result.stage = person.stage();
    result.words = robot.text();
    const std::optional<End> end = judge(result);
    if (robot.world().diverged() || robot.world().truth().p_WB.z() < kFallen * robot.model().standing_height_m) {
      result.end = End::kFell;
      return result;
    }
    if (robot.result().mode == control::Mode::kFault) {
      result.end = End::kFault;
      result.words = faults::describe(robot.result().fault, robot.model());
      return result;
    }
    if (end) {
      result.end = *end;
      return result;
    }
  }
  result.end = time_up();
  return result;
}

}  // namespace

const char* end_name(End end) noexcept {
  constexpr std::array kNames = {"done",
                                 "fell",
                                 "fault",
                                 "towel off the table",
                                 "palm not on the towel in time",
                                 "towel not wiped far enough in time",
                                 "box dropped",
                                 "box not lifted in time",
                                 "box not put down in time",
                                 "interrupted"};
  return kNames.at(static_cast<std::size_t>(end));
}

TaskResult run_task(LedRobot& robot, ScriptedOperator& person, const TaskJudge& judge, double longest_s,
                    const TimeUp& time_up, const work::Progress& progress, const TaskObserver& observer) {
  TaskResult result = play(robot, person, judge, longest_s, time_up, progress, observer);
  if (!observer || result.end == End::kInterrupted) return result;
  for (const double until_s = robot.time_s() + kAftermath_s;
       robot.time_s() < until_s && !robot.world().diverged() && !progress.interrupted_now();) {
    person.step(robot);
    observer(robot, person.stage());
  }
  return result;
}

}  // namespace pmg::teleoperation
