// The paper's Table II: distance between simulation and robot for four ways to fit one to the other.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "evaluation/table2_plant.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

/// The paper's four configurations (IV-C). The same policy walks in all of them.
enum Configuration {
  kBaseline,            ///< the simulation is the model; the robot is uncalibrated
  kPhysicallyInformed,  ///< gains from the rotor's inertia, in simulation and robot
  kDynamicCalibration,  ///< the simulation has the calibrated motors
  kFullCalibration,     ///< the robot's firmware also has the calibrated zero points
  kConfigurations
};
inline constexpr std::array<const char*, kConfigurations> kConfigurationNames = {
    "baseline", "physically informed gains", "dynamic calibration", "dynamic and zero-point calibration"};

/// kp = I omega^2, kd = 2 zeta I omega for the rotor inertia I at the joint, with omega = 2 pi 10 Hz and zeta = 2 from
/// Liao et al., BeyondMimic (arXiv:2508.08241).
inline constexpr double kNaturalFrequency_Hz = 10.0, kDampingRatio = 2.0;
Gains informed_gains(const model::RobotModel& robot, const Gains& otherwise);

/// Mean joint angles over the gait cycle, by step of the scenario: walks become comparable once their phases are
/// aligned. The reference is the same in every run, so its phase is the common clock.
class WalkCurves {
 public:
  static constexpr std::size_t kBins = 40;
  static constexpr double kSettle_s = 1.5;  ///< omitted from each step until the speed has settled

  WalkCurves() = default;
  WalkCurves(std::size_t steps, std::size_t joints);
  void add(std::size_t step, double phase, const JointVector& q_rad, const JointVector& q_ref_rad);
  void add(const WalkCurves& other);  ///< adds the other's samples

  double imitation_rad() const;  ///< RMS of q - q_ref over joints and ticks; NaN without samples
  /// RMS of the difference over joints, phases and steps that both have; NaN without any.
  static double difference_rad(const WalkCurves& a, const WalkCurves& b);
  std::vector<double> curve(std::size_t step, std::size_t joint) const;  ///< by phase; NaN without samples

 private:
  std::size_t index(std::size_t step, std::size_t bin, std::size_t joint) const {
    return (step * kBins + bin) * joints_ + joint;
  }
  std::size_t steps_ = 0, joints_ = 0;
  std::vector<double> sum_rad_, count_;  // of steps x bins x joints
  double squares_rad2_ = 0.0, samples_ = 0.0;
};

struct Walk {
  WalkCurves curves;
  bool complete = false, fell = false;
};

struct ConfigurationResult {
  Estimate imitation_rad = mean_interval({}), sim_to_real_rad = mean_interval({});  ///< over the plants that have both
  std::vector<double> imitation_of_plant_rad, sim_to_real_of_plant_rad;
  std::size_t robots_without_errors = 0;  ///< they, or their simulations, fell before there was a step to compare
  int robot_falls = 0, simulation_falls = 0;
  void add(double imitation_rad, double sim_to_real_rad);  ///< a plant's errors; NaN: not measured
  bool measured() const { return !imitation_of_plant_rad.empty(); }
  bool fell_on_the_way() const { return robot_falls > static_cast<int>(robots_without_errors); }
  std::size_t robots() const { return imitation_of_plant_rad.size() + robots_without_errors; }
};

/// One plant and its calibration.
struct CalibratedPlant {
  sim::ActuatorsByJoint truth, motors;
  std::vector<FoundOffset> offsets;
  double worst_offset_rad = 0.0;  ///< after correction
};

/// Zero points of all plants, by how well their calibration knows them.
struct ZeroPoints {
  std::size_t well = 0, roughly = 0;  ///< applied
  std::size_t untold = 0;             ///< left as they are
  double worst_left_rad = 0.0;        ///< over all, after correction
};
ZeroPoints zero_points(const std::vector<CalibratedPlant>& plants);

struct Table2 {
  std::string robot, policy, plants_file, scenario_file;
  sil::Scenario scenario;
  PlantRanges ranges;
  int simulation_seeds = 2;
  bool complete = true;
  std::vector<CalibratedPlant> plants;
  std::vector<std::string> joints;  ///< compared joints
  std::array<ConfigurationResult, kConfigurations> results;
  std::array<std::vector<double>, kConfigurations> shown_robot, shown_simulation;  ///< left knee of plant 1
  double ratio() const;      ///< sim-to-real error: full calibration over baseline; NaN where one has none
  bool all_reached() const;  ///< the result holds, and nothing of it is missing
};
inline constexpr double kAskedRatio = 0.53;  ///< the paper's 0.0414 / 0.0781

/// The paper's figures [rad]: imitation error, sim-to-real error.
std::array<double, 2> published(Configuration configuration);

work::Worth worth_of(const Table2& table);

/// Calibrates the plants below folder/plants, then runs all walks. The result doesn't depend on the number of jobs.
void run_table2(Table2& table, const std::filesystem::path& folder, const Supervision& supervision);

nlohmann::ordered_json to_json(const Table2& table);
pages::Page page_of(const Table2& table);
std::vector<pages::Table> tables_of(const Table2& table);

}  // namespace pmg::evaluation
