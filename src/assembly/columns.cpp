#include "assembly/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace pmg::assembly {

namespace {

using Labels = std::vector<std::string>;  // one for each run

/// Set by the software or measured, or the run's own name.
bool is_of_the_experiment(const std::string& column) {
  constexpr std::array kNames = {"file", "trajectory", "repeat", "temp_C"};
  return std::find(kNames.begin(), kNames.end(), column) != kNames.end() || column.starts_with("kp_") ||
         column.starts_with("kd_");
}

std::size_t values_of(const Labels& labels) {
  Labels sorted = labels;
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

/// True if all runs with one value of `from` have one value of `what`, and `from` groups the runs: at least two runs a
/// value on average. (A name of its own for each run decides everything and says nothing.)
bool follows(const Labels& what, const Labels& from) {
  if (2 * values_of(from) > from.size()) return false;
  std::map<std::string, std::string> value_of;
  for (std::size_t i = 0; i < what.size(); ++i) {
    if (value_of.try_emplace(from[i], what[i]).first->second != what[i]) return false;
  }
  return true;
}

/// True if both part the runs in the same way.
bool change_together(const Labels& one, const Labels& other) {
  std::map<std::string, std::string> forth, back;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (forth.try_emplace(one[i], other[i]).first->second != other[i]) return false;
    if (back.try_emplace(other[i], one[i]).first->second != one[i]) return false;
  }
  return true;
}

struct Column {
  std::vector<std::string> names, from;
  Labels labels;
};

class Grouper {
 public:
  Grouper(const bench::Bench& bench, const std::vector<const bench::BenchRun*>& runs, std::size_t fewest_runs,
          std::size_t most_levels)
      : runs_(runs), fewest_runs_(fewest_runs), most_levels_(most_levels) {
    for (const bench::BenchRun* run : runs) {
      trajectory_.push_back(run->trajectory);
      gains_.push_back(fmt::format("{} {}", run->kp, run->kd));
      program_.push_back(trajectory_.back() + " " + gains_.back());
      load_.push_back(fmt::format("{} {}", run->load.inertia_kg_m2, run->load.gravity_Nm));
    }
    for (const std::string& name : bench.runs.header) {
      if (is_of_the_experiment(name)) continue;
      Column column{{name}, {name}, {}};
      for (const bench::BenchRun* run : runs) column.labels.push_back(level_name(bench, *run, column.from));
      consider(std::move(column));
    }
    consider_whole_loads();
  }

  Groupings found() && { return std::move(found_); }

 private:
  void consider(Column column) {
    const std::string why = against(column.labels);
    if (!why.empty()) {
      found_.unused.push_back({column.names.front(), why});
      return;
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!change_together(columns_[i].labels, column.labels)) continue;
      found_.usable[i].columns.push_back(column.names.front());
      return;
    }
    add(std::move(column));
  }

  void consider_whole_loads() {
    Column whole;
    whole.labels.resize(runs_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!found_.usable[i].follows_load) continue;
      if (change_together(columns_[i].labels, load_)) return;
      whole.names.push_back(fmt::format("{}", fmt::join(found_.usable[i].columns, " or ")));
      whole.from.push_back(columns_[i].from.front());
      for (std::size_t r = 0; r < runs_.size(); ++r)
        whole.labels[r] += (whole.labels[r].empty() ? "" : ", ") + columns_[i].labels[r];
    }
    if (whole.names.size() < 2 || !against(whole.labels).empty()) return;
    whole.names = {fmt::format("{}", fmt::join(whole.names, " and "))};
    add(std::move(whole));
  }

  std::string against(const Labels& labels) const {
    if (values_of(labels) < 2) return "has one value in all runs";
    const Grouping grouping = grouped({{}, {}, labels});
    if (grouping.levels.size() < 2) return fmt::format("has fewer than two values with {} runs or more", fewest_runs_);
    if (grouping.levels.size() > most_levels_) return fmt::format("has more than {} values", most_levels_);
    if (follows(labels, trajectory_)) return "follows the trajectory: the runs don't tell it from the motion";
    if (follows(labels, gains_)) return "follows the gains: the runs don't tell it from them";
    if (follows(labels, program_)) return "follows trajectory and gains: the runs don't tell it from them";
    return "";
  }

  Grouping grouped(const Column& column) const {
    Grouping grouping{column.names, column.from, {}, std::vector<int>(runs_.size(), -1), false};
    std::map<std::string, std::size_t> count;
    for (const std::string& label : column.labels) ++count[label];
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      const std::string& label = column.labels[i];
      if (count[label] < fewest_runs_) continue;
      auto place = std::find(grouping.levels.begin(), grouping.levels.end(), label);
      if (place == grouping.levels.end()) place = grouping.levels.insert(grouping.levels.end(), label);
      grouping.level_of_run[i] = static_cast<int>(place - grouping.levels.begin());
    }
    return grouping;
  }

  void add(Column column) {
    Grouping grouping = grouped(column);
    grouping.follows_load = follows(column.labels, load_);
    found_.usable.push_back(std::move(grouping));
    columns_.push_back(std::move(column));
  }

  const std::vector<const bench::BenchRun*>& runs_;
  std::size_t fewest_runs_, most_levels_;
  Labels trajectory_, gains_, program_, load_;
  std::vector<Column> columns_;  // of the usable groupings, in their order
  Groupings found_;
};

}  // namespace

std::string level_name(const bench::Bench& bench, const bench::BenchRun& run, const std::vector<std::string>& columns) {
  const auto file = bench.runs.find("file");
  if (!file) return "";
  const auto row = std::find_if(bench.runs.rows.begin(), bench.runs.rows.end(),
                                [&](const std::vector<std::string>& cells) { return cells[*file] == run.file; });
  std::string name;
  for (const std::string& column : columns) {
    const auto c = bench.runs.find(column);
    if (row == bench.runs.rows.end() || !c) return "";
    name += (name.empty() ? "" : ", ") + (*row)[*c];
  }
  return name;
}

std::size_t Grouping::runs_of(int level) const {
  return static_cast<std::size_t>(std::count(level_of_run.begin(), level_of_run.end(), level));
}

Groupings groupings(const bench::Bench& bench, const std::vector<const bench::BenchRun*>& runs, std::size_t fewest_runs,
                    std::size_t most_levels) {
  return Grouper(bench, runs, fewest_runs, most_levels).found();
}

}  // namespace pmg::assembly
