// The measures of a run, by step of its scenario.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/trial.hpp"
#include "sil/run_measure.hpp"
#include "sil/scenario.hpp"

namespace pmg::evaluation {

/// A run's measure; also by step of the scenario, and separately for steps beyond the clips' reach.
class StepMeasure {
 public:
  StepMeasure(const model::RobotModel& robot, const sil::Scenario& scenario)
      : measure_(robot.standing_height_m), scenario_(scenario) {}

  void add(double time_s, const control::TickResult& result, const model::GroundTruth& truth, bool hoisted,
           const sil::ScenarioStep& step);

  /// Completes a run whose simulation diverged: for the rest of the scenario the robot counts as fallen.
  void count_as_fallen(double from_s, const control::TickResult& result, model::GroundTruth last);

  sil::RunOutcome outcome() const { return measure_.outcome(); }

  /// Fills judged_s and all errors of a result.
  void report(TrialResult& result);

 private:
  /// Sums over ticks: errors times seconds.
  struct Sums {
    Errors errors{}, raw{};
    double seconds = 0.0;
  };
  Sums total() const;
  void close_step();

  sil::RunMeasure measure_;
  const sil::Scenario& scenario_;
  const sil::ScenarioStep* step_ = nullptr;
  Sums before_, within_, beyond_;
  std::vector<Errors> step_errors_;
};

}  // namespace pmg::evaluation
