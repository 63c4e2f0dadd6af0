// (one message, its time) => one more sample of a run's series.
#pragma once

#include <array>

#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "report/run_series.hpp"

namespace pmg::report {

/// t_s counts from the log's beginning. The message must have as many joints as the run, and a valid mode.
void append(const pmg_msgs::robot_state_t& message, double t_s, RunSeries& run);
void append(const pmg_msgs::reference_t& message, double t_s, RunSeries& run);
void append(const pmg_msgs::status_t& message, double t_s, RunSeries& run);
void append(const pmg_msgs::timing_t& message, double t_s, RunSeries& run);
void append(const pmg_msgs::tick_input_t& message, double t_s, RunSeries& run);

/// One tick's times [us]; a stage of 0 did not run.
void add_times(RunTiming& to, double tick_us, double generator_us, double gco_us, double policy_us);

/// measured: the robot's motion by command channel. While the gantry carries the robot, the series gets NaN.
void append(const pmg_msgs::ground_truth_t& message, const std::array<double, kChannels>& measured, double t_s,
            RunSeries& run);

/// The texts that a page shows, harmless: a log's names were chosen by other programs.
pmg_msgs::robot_info_t plain(pmg_msgs::robot_info_t info);

}  // namespace pmg::report
