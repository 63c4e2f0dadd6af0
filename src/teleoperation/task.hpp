// One trial of a task: a simulated robot led by a scripted operator, and a judge who sees everything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "teleoperation/led_robot.hpp"
#include "teleoperation/scripted_operator.hpp"
#include "work/progress.hpp"

namespace pmg::teleoperation {

/// How a trial ends. Names in words: end_name().
enum class End : std::uint8_t {
  kDone,         ///< the task's criterion holds
  kFell,         ///< the robot fell, or the simulation diverged
  kFault,        ///< the controller latched a fault
  kOffTable,     ///< the towel left the table
  kNotReached,   ///< time was up while the palm was off the towel: before it was there, or gripping anew
  kNotWiped,     ///< time was up while the palm still moved the towel
  kDropped,      ///< the box fell or tipped over
  kNotLifted,    ///< time was up, and the box had not been lifted far enough
  kNotPutDown,   ///< time was up before the lifted box stood on the other table
  kInterrupted,  ///< the evaluation was; counts as no trial
};
const char* end_name(End end) noexcept;

struct TaskResult {
  std::size_t trial = 0;  ///< its number: the robot and the places of things
  End end = End::kInterrupted;
  double moved_m = 0.0;   ///< of the towel along the table, of the box horizontally, from where it was
  double lifted_m = 0.0;  ///< of the box, at most; 0 where nothing is to be lifted
  double duration_s = 0.0;
  std::string words{};  ///< a fault's, or what the operator was last told
  std::string stage{};  ///< what the operator was doing at the end
};

/// Called after each tick, for pictures and tests, and for a moment after the end: a box that was dropped is seen to
/// fall. May be empty.
using TaskObserver = std::function<void(LedRobot& robot, const std::string& stage)>;

/// Called after each tick with the result so far, where it writes what moved: how the trial ends; nothing: go on.
using TaskJudge = std::function<std::optional<End>(TaskResult& result)>;

/// Called when time is up.
using TimeUp = std::function<End()>;

/// The robot stands up, steadied by a gantry, and the operator does the task until the judge says how it ended, the
/// robot falls or faults, or after longest_s.
TaskResult run_task(LedRobot& robot, ScriptedOperator& person, const TaskJudge& judge, double longest_s,
                    const TimeUp& time_up, const work::Progress& progress = {}, const TaskObserver& observer = {});

}  // namespace pmg::teleoperation
