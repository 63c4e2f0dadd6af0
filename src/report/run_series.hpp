// (a run's log) => plain arrays over time, for pictures.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gco/slip_statistics.hpp"
#include "pmg/command.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "report/limited_joints.hpp"
#include "report/thinning.hpp"
#include "sil/command_cut.hpp"
#include "sil/metrics.hpp"
#include "work/progress.hpp"

namespace pmg::report {

inline constexpr double kLongestGap_s = 0.1;  ///< ten ticks; a longer gap interrupts a line

/// How well a joint followed.
struct JointTracking {
  double error_rms_rad = 0.0;  ///< RMS of q_ref - q while the drives follow; 0 without such a tick
  double torque_max_Nm = 0.0;  ///< largest |torque|
};

/// Times by the wall clock.
struct RunTiming {
  std::int64_t ticks = 0;
  Sampled wake_us, tick_us, generator_us, gco_us, policy_us;
  Sampled bus_wake_us, bus_exchange_us;  ///< largest value of the bus cycles since the last tick
  Sampled state_age_us;                  ///< of the oldest motor's part of the state that a tick started from
  std::int64_t missed_ticks = 0, bus_missed_cycles = 0, dropped_records = 0;
  struct Delay {
    double t_s, late_us;
    const char* thread;
  };
  std::vector<Delay> delays;  ///< the first that were longer than a bus cycle
  std::int64_t delay_count = 0;
};

/// One sample for each tick and channel, thinned in runs of more than five minutes (thinning.hpp), so that memory stays
/// bounded; figures count every tick. t_s counts from the log's beginning. Channels without a message are empty. The
/// first index of a per-joint array is the joint.
struct RunSeries {
  using Samples = std::vector<double>;
  using JointSamples = std::vector<std::vector<float>>;

  std::string name;  ///< short name of the log
  bool identified = false;
  pmg_msgs::robot_info_t info{};  ///< if identified
  std::vector<std::string> joint_names;
  double duration_s = 0.0;

  struct {
    Samples t_s;
    JointSamples q_rad, torque_Nm, temperature_degC;
  } state;
  std::vector<JointTracking> joint_tracking;  ///< one for each joint
  double longest_gap_s = kLongestGap_s;       ///< more where samples are thinned

  struct {
    Samples t_s;
    JointSamples q_ref_rad;
    std::array<Samples, kChannels> user, command, optimised;
    std::array<Samples, 2> slip_before_m_s, slip_after_m_s;
    std::array<Intervals, 2> contact;
    std::int64_t not_converged = 0, command_limited = 0, joint_clamped = 0;  ///< ticks
  } reference;

  struct {
    Samples t_s, limited_position, limited_rate, limited_torque;
    std::int64_t ticks = 0, position_ticks = 0, rate_ticks = 0, torque_ticks = 0;  ///< all; with a limited target
  } status;

  struct {
    Samples t_s;
    std::array<Samples, kChannels> measured;
    std::array<Samples, 2> foot_slip_m_s;
    std::array<Intervals, 2> loaded;  ///< a foot carries load
  } truth;                            ///< of a simulation

  RunTiming timing;

  struct Stretch {
    double from_s, to_s;
    std::string text;
  };
  std::vector<Stretch> modes, sources, hoisted;
  std::vector<Stretch> hanging;  ///< the feet carried nothing, so the policy did not run

  struct Event {
    double t_s;
    std::string text;
  };
  std::vector<Event> faults;  ///< in order of time, in words
  std::vector<Event> guard_trips, stops;

  /// A scenario's step in the log.
  struct Step {
    double from_s, to_s;
    int number;
    std::string text;
    std::array<double, kChannels> asked;
    sil::TrackingSummary tracking;  ///< within the step
  };
  std::string scenario;
  std::vector<Step> steps;

  sil::TrackingSummary tracking;      ///< followed_s is 0 without a simulation's truth
  gco::SlipSummary reference_slip;    ///< as in summary.json
  sil::CommandCut cut;                ///< likewise
  std::vector<LimitedJoint> limited;  ///< most often limited first

  bool fell = false;
  double fell_at_s = -1.0;
  std::int64_t lost_ticks = 0;        ///< tick numbers that are missing in the log
  bool interrupted = false;           ///< the rest of the log was not read
  std::vector<std::string> problems;  ///< problems while reading, one sentence each
};

/// log: a .lcm file, or a run's folder with log.lcm or log-NNNN.lcm, which count as one log. If the log holds several
/// runs, the last one is read. Wall times come from the log, or from a timing.csv beside it. Skips damaged parts.
/// Throws std::runtime_error if it finds no part of a run. Where progress is over, it keeps the part so far.
RunSeries read_run(const std::filesystem::path& log, const work::Progress& progress = {});

}  // namespace pmg::report
