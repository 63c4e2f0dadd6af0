#include "teleoperation/table3.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "sil/film.hpp"

namespace pmg::teleoperation {

namespace {

using evaluation::percent_with_interval;
using nlohmann::ordered_json;

bool took_place(const TaskResult& run) { return run.end != End::kInterrupted; }

ordered_json to_json(const TaskTrials& task, int trials) {
  const evaluation::Estimate done = task.done();
  ordered_json json = {{"task", task.name},
                       {"trials", trials},
                       {"success", {{"share", done.mean}, {"ci95", {done.lower, done.upper}}}},
                       {"paper", task.paper},
                       {"ends", task.ends()},
                       {"runs", ordered_json::array()}};
  for (const TaskResult& run : task.runs) {
    json["runs"].push_back({{"trial", run.trial},
                            {"end", end_name(run.end)},
                            {"moved_m", run.moved_m},
                            {"lifted_m", run.lifted_m},
                            {"duration_s", run.duration_s},
                            {"stage", run.stage},
                            {"words", run.words}});
  }
  return json;
}

void add_trials(const TaskTrials& task, pages::Page& page) {
  page.heading(fmt::format("Trials of {}", task.name));
  const bool lifts = std::ranges::any_of(task.runs, [](const TaskResult& run) { return run.lifted_m > 0.0; });
  pages::Table runs{.header = {"trial", "end", "moved [m]", "after [s]", "what the operator did", "what it was told"},
                    .rows = {}};
  if (lifts) runs.header.insert(runs.header.begin() + 3, "lifted [m]");
  for (const TaskResult& run : task.runs) {
    runs.rows.push_back({std::to_string(run.trial), end_name(run.end), fmt::format("{:.2f}", run.moved_m),
                         fmt::format("{:.0f}", run.duration_s), run.stage, run.words});
    auto& row = runs.rows.back();
    if (lifts) row.insert(row.begin() + 3, fmt::format("{:.2f}", run.lifted_m));
  }
  page.table(runs);
}

TaskResult run_trial(const Table3& table, const std::string& task, const model::RobotModel& robot, std::size_t trial,
                     const work::Progress& progress, const TaskObserver& observer) {
  const sim::WorldOptions world = table.evaluated.plants.of(robot, trial + 1);
  const evaluation::Candidate& candidate = table.evaluated.candidate;
  TaskResult result = task == table.wiping.name
                          ? run_wiping(candidate, world, WipingPlan::of(trial), progress, observer)
                          : run_box_picking(candidate, world, BoxPlan::of(trial), progress, observer);
  result.trial = trial;
  return result;
}

std::string operator_text(const Table3& table) {
  return fmt::format(
      "A scripted operator in a headset sends head and hands through the code behind pmg_web's socket; nothing else "
      "moves the robot ({}). It sees things, its palms and the tables as the head's camera shows them: 30 pictures a "
      "second, 0.12 s late, places within 5 mm and turns within 2 degrees (standard deviations), and nothing outside "
      "the picture. It feels no force. Intervals are Wilson's, 95 %.",
      table.ranges_file.empty() ? "as the model says" : table.ranges_file);
}

std::string wiping_text() {
  return fmt::format(
      "Wiping is done when the towel, a stiff patch of {} kg, moved along the table by more than {} m within {:.0f} s "
      "and lay on it all the time, and the robot stood. The table is {} m high, the towel's friction on it {}, the "
      "palm's on the towel 0.8.",
      WipingPlan::kTowelMass_kg, WipingPlan::kMoved_m, WipingPlan::kLongest_s, WipingPlan::kTableTop_m,
      WipingPlan::kTowelFriction);
}

std::string box_text() {
  return fmt::format(
      "Box picking is done when the box, {} m wide and of {} kg, was lifted from a table of {} m by at least {} m and "
      "stands on another one of {} m within {:.0f} s: upright, at rest for {:.0f} s, at least {} m from where it was, "
      "touched by no palm, and never fallen faster than {} m/s. The two palms are boxes whose friction is 0.8.",
      BoxPlan::kWidth_m, BoxPlan::kMass_kg, BoxPlan::kLowTop_m, BoxJudge::kLifted_m, BoxPlan::kHighTop_m,
      BoxPlan::kLongest_s, BoxJudge::kRest_s, BoxJudge::kMoved_m, BoxJudge::kFall_m_s);
}

}  // namespace

evaluation::Estimate TaskTrials::done() const {
  return evaluation::share_interval(std::ranges::count(runs, End::kDone, &TaskResult::end),
                                    std::ranges::count_if(runs, took_place));
}

std::map<std::string, int> TaskTrials::ends() const {
  std::map<std::string, int> ends;
  for (const TaskResult& run : runs)
    if (took_place(run)) ++ends[end_name(run.end)];
  return ends;
}

bool TaskTrials::reached() const { return done().mean >= paper; }

work::Worth worth_of(const Table3& table) {
  work::Worth worth;
  worth.add_if(!table.complete, work::Grade::kInterrupted, "not all trials ran");
  for (const TaskTrials* task : table.tasks())
    worth.add_if(table.complete && !task->reached(), work::Grade::kMissed,
                 fmt::format("{} in less than {:.0f} % of the trials", task->verb, 100.0 * task->paper));
  return worth;
}

void run_table3(Table3& table, const evaluation::Supervision& supervision) {
  const model::RobotModel robot = control::load_robot(table.evaluated.candidate.control);
  const auto trials = static_cast<std::size_t>(table.trials);
  for (TaskTrials* task : {&table.wiping, &table.box_picking}) {
    task->runs.assign(trials, {});
    for (std::size_t i = 0; i < trials; ++i) task->runs[i].trial = table.first + i;
  }
  evaluation::for_each_piece(2 * trials, supervision, [&](std::size_t piece) {
    TaskTrials& task = piece % 2 == 0 ? table.wiping : table.box_picking;  // an interrupted evaluation has some of both
    TaskResult& run = task.runs[piece / 2];
    run = run_trial(table, task.name, robot, run.trial, supervision.progress, {});
  });
  table.complete = std::ranges::all_of(
      table.tasks(), [](const TaskTrials* task) { return std::ranges::all_of(task->runs, took_place); });
}

std::string FilmedTrial::file() const {
  std::string name = fmt::format("{} {}.mp4", task, end_name(end));
  std::ranges::replace(name, ' ', '_');
  return name;
}

std::vector<FilmedTrial> trials_to_film(const Table3& table) {
  std::vector<FilmedTrial> filmed;
  for (const TaskTrials* task : table.tasks()) {
    std::set<End> ends{End::kInterrupted};
    for (const TaskResult& run : task->runs)
      if (ends.insert(run.end).second) filmed.push_back({.task = task->name, .trial = run.trial, .end = run.end});
  }
  return filmed;
}

std::string film_trial(const Table3& table, const FilmedTrial& filmed, const std::filesystem::path& file,
                       const evaluation::Supervision& supervision) {
  constexpr double kFromAbove_deg = -20.0;  // onto a table
  const model::RobotModel robot = model::load_robot(model::find_robot(table.evaluated.candidate.control.robot));
  std::optional<sil::Film> film;
  const auto shoot = [&](LedRobot& led, const std::string& stage) {
    if (!film) film.emplace(led.world(), file, kFromAbove_deg);
    film->after_tick(
        fmt::format("{}, trial {}: {}\n{}\n{}", filmed.task, filmed.trial, end_name(filmed.end), stage, led.text()));
  };
  TaskResult result;
  try {
    result = run_trial(table, filmed.task, robot, filmed.trial, supervision.progress, shoot);
  } catch (const std::runtime_error& error) {  // no OSMesa
    return error.what();
  }
  if (!film) return "";  // interrupted before its first picture
  film->close();
  if (!film->failure().empty() || result.end == End::kInterrupted || result.end == filmed.end) return film->failure();
  return fmt::format("{}: trial {} ended otherwise when it was played again: {}", file.filename().string(),
                     filmed.trial, end_name(result.end));
}

ordered_json to_json(const Table3& table) {
  ordered_json json = {
      {"kind", "table3"},
      {"complete", table.complete},
      {"robot", table.robot},
      {"policy", table.evaluated.name},
      {"first_trial", table.first},
      {"variation", table.ranges_file.empty() ? ordered_json(nullptr) : ordered_json(table.ranges_file)},
      {"films", table.films},
      {"tasks", ordered_json::array()}};
  for (const TaskTrials* task : table.tasks()) json["tasks"].push_back(to_json(*task, table.trials));
  return json;
}

std::vector<pages::Table> tables_of(const Table3& table) {
  pages::Table done{.header = {"task", "done [%]", "the paper [%]", "trials"}, .rows = {}},
      ends{.header = {"task", "end", "trials"}, .rows = {}};
  for (const TaskTrials* task : table.tasks()) {
    done.rows.push_back({task->name, percent_with_interval(task->done()), fmt::format("{:.0f}", 100.0 * task->paper),
                         std::to_string(table.trials)});
    for (const auto& [name, count] : task->ends()) ends.rows.push_back({task->name, name, std::to_string(count)});
  }
  return {done, ends};
}

pages::Page page_of(const Table3& table) {
  pages::Page page(fmt::format("Teleoperation: {} on {}", table.evaluated.name, table.robot));
  page.worth(worth_of(table));
  for (const TaskTrials* task : table.tasks())
    page.verdict(task->reached() ? work::Worth() : work::Worth(work::Grade::kMissed, "too few trials succeeded"),
                 fmt::format("{} in {} % of trials; the paper has {:.0f} % of 20 on the real robot", task->verb,
                             percent_with_interval(task->done()), 100.0 * task->paper));
  if (!table.films.empty())
    page.paragraph(
        fmt::format("Films of each task's first trial of each end lie beside this page: {}. A film of trial N: "
                    "pmg_eval table3 --first N --trials 1 --video.",
                    fmt::join(table.films, ", ")));
  for (const pages::Table& one : tables_of(table)) page.table(one);
  for (const TaskTrials* task : table.tasks()) add_trials(*task, page);
  page.heading("How it was measured");
  for (const std::string& text : {operator_text(table), wiping_text(), box_text()}) page.paragraph(text);
  return page;
}

}  // namespace pmg::teleoperation
