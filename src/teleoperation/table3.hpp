// The paper's table of teleoperation tasks: how often a scripted operator in a headset does them.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"
#include "teleoperation/box_picking.hpp"
#include "teleoperation/wiping.hpp"

namespace pmg::teleoperation {

inline constexpr double kPaperWiping = 0.95, kPaperBoxPicking = 0.80;  ///< over 20 trials each on the real Z1

/// The trials of one task.
struct TaskTrials {
  std::string name, verb;        ///< "wiping", "wiped": of what was handled
  double paper = 0.0;            ///< share of success
  std::vector<TaskResult> runs;  ///< in the order of trials; kInterrupted: it didn't take place

  evaluation::Estimate done() const;  ///< share of success with Wilson's interval, over the trials that took place
  std::map<std::string, int> ends() const;  ///< of those, by end_name()
  bool reached() const;                     ///< at or above the paper's share
};

struct Table3 {
  std::string robot, ranges_file;
  evaluation::Case evaluated;
  std::size_t first = 0;  ///< trial; run i of each task is trial first + i
  int trials = 0;
  TaskTrials wiping{.name = "wiping", .verb = "the towel is wiped", .paper = kPaperWiping, .runs = {}};
  TaskTrials box_picking{.name = "box picking", .verb = "the box is moved", .paper = kPaperBoxPicking, .runs = {}};
  bool complete = true;
  std::vector<std::string> films{};  ///< files beside the page

  std::array<const TaskTrials*, 2> tasks() const { return {&wiping, &box_picking}; }
};

/// Trial i has the same robot and things for every policy. The result doesn't depend on the number of jobs.
void run_table3(Table3& table, const evaluation::Supervision& supervision);

/// A trial of which a film is made.
struct FilmedTrial {
  std::string task;  ///< its name
  std::size_t trial = 0;
  End end = End::kInterrupted;

  std::string file() const;  ///< "box_picking_box_dropped.mp4"
};

/// Of each task the first trial that was done, and the first of each kind of failure.
std::vector<FilmedTrial> trials_to_film(const Table3& table);

/// Plays the trial again, until the supervision interrupts. Returns the film's error in one line, or that the trial
/// ended otherwise; empty: none.
std::string film_trial(const Table3& table, const FilmedTrial& filmed, const std::filesystem::path& file,
                       const evaluation::Supervision& supervision);

/// Interrupted; missed, below the paper's share in a task.
work::Worth worth_of(const Table3& table);

nlohmann::ordered_json to_json(const Table3& table);
pages::Page page_of(const Table3& table);
std::vector<pages::Table> tables_of(const Table3& table);

}  // namespace pmg::teleoperation
