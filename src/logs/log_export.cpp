#include "logs/log_export.hpp"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "io/log_series.hpp"
#include "io/plain_text.hpp"
#include "logs/mcap_writer.hpp"
#include "logs/replay_setup.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "topics/foxglove_topics.hpp"
#include "topics/message_fields.hpp"
#include "topics/message_topics.hpp"

namespace pmg::logs {

namespace {

namespace fs = std::filesystem;
using topics::Field;

constexpr std::int64_t kEventsAProgress = 500;

/// One decoded message.
struct Row {
  const io::LogReader& event;
  double time_s;  // since the first event
  const std::optional<pmg_msgs::robot_info_t>& info;
  std::int64_t first_ns;
  const std::vector<Field>& fields;
};

/// Before anything is written.
void expect_an_event(const std::vector<fs::path>& files) {
  if (!io::LogSeries(files).next())
    throw std::runtime_error(files.front().string() + ": no LCM event in it; expected a log");
}

/// Reads every message of these files and calls write with it.
template <typename Write>
ExportReport for_each_message(const std::vector<fs::path>& files, const work::Progress& progress, Write&& write) {
  ExportReport report;
  io::LogSeries events(files);
  std::optional<std::int64_t> first_ns;
  std::optional<pmg_msgs::robot_info_t> info;
  const std::vector<std::string> nameless;
  std::vector<Field> fields;
  std::int64_t count = 0;
  while (events.next()) {
    const io::LogReader& event = events.event();
    if (!first_ns) first_ns = event.stamp_ns();
    const double time_s = static_cast<double>(event.stamp_ns() - *first_ns) * 1e-9;
    if (++count % kEventsAProgress == 0 && !progress(work::kUnknownShare, fmt::format("{:8.1f} s exported", time_s)))
      break;
    if (event.channel() == "ROBOT_INFO") info = event.decode<pmg_msgs::robot_info_t>();
    if (!read_fields(event.channel(), event.data(), info ? info->joint_names : nameless, fields)) {
      ++report.unknown;
      continue;
    }
    ++report.messages[event.channel()];
    write(Row{event, time_s, info, *first_ns, fields});
  }
  return report;
}

/// Numbers as they are, also negative ones; text that another program chose made harmless.
std::string cell(const Field::Value& value) {
  const bool number = std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value) ||
                      std::holds_alternative<bool>(value);
  return number ? topics::to_text(value) : io::csv_text(topics::to_text(value));
}

/// One channel's file.
class CsvFile {
 public:
  CsvFile(const fs::path& path, const std::vector<Field>& fields) : path_(path), file_(path) {
    std::string header = "time_s";
    for (const Field& field : fields) {
      header += "," + io::csv_text(field.path());
      if (!field.constants.empty()) header += "," + io::csv_text(field.path() + "_name");
    }
    columns_ = fields.size();
    file_ << header << '\n';
  }
  void write(const Row& row) {
    if (row.fields.size() != columns_)
      throw std::runtime_error(path_.string() +
                               ": the logs are of robots with different joints; name those of one run");
    std::string line = fmt::format("{:.6f}", row.time_s);
    for (const Field& field : row.fields) {
      line.append(",").append(cell(field.value));
      if (!field.constants.empty()) line.append(",").append(field.constant());
    }
    file_ << line << '\n';
    if (!file_) throw std::runtime_error(path_.string() + ": can't be written");
  }
  void close() {
    file_.flush();
    if (!file_) throw std::runtime_error(path_.string() + ": can't be written");
  }

 private:
  fs::path path_;
  std::ofstream file_;
  std::size_t columns_ = 0;
};

/// The robot of a log, if it is here: as the log names it, or named by the caller.
std::optional<model::RobotModel> robot_of(const std::optional<pmg_msgs::robot_info_t>& info, const std::string& named,
                                          ExportReport& report) {
  if (!named.empty()) return model::load_robot(model::find_robot(named));
  if (!info) {
    report.notes.push_back(
        "no ROBOT_INFO before the first message: no transforms and no URDF (--robot names the robot)");
    return {};
  }
  const auto options = nlohmann::ordered_json::parse(info->options, nullptr, false);
  const control::ControlSetup setup = replay_setup(*info, options, {});
  try {
    return control::load_robot(setup);
  } catch (const std::exception& error) {
    report.notes.push_back(fmt::format("no transforms and no URDF: {}", error.what()));
    return {};
  }
}

/// What one MCAP file is made of.
class McapExport {
 public:
  McapExport(const fs::path& file, const std::string& robot) : writer_(file), named_(robot) {}

  void write(const Row& row, ExportReport& report) {
    // The session is the wall clock at the start, close to the first event's; lockstep has none.
    const std::int64_t started_ns = row.info && row.info->session > 0 ? row.info->session - row.first_ns : 0;
    const std::int64_t time_ns = row.event.stamp_ns() + started_ns;
    if (!foxglove_) {
      robot_ = robot_of(row.info, named_, report);
      foxglove_.emplace(writer_, robot_ ? &*robot_ : nullptr);
    }
    foxglove_->take(row.event.channel(), row.event.data(), time_ns, row.info ? row.info->joint_names : nameless_);
    messages_.write(row.event.channel(), time_ns, row.fields);
  }
  void close() {
    if (foxglove_) foxglove_->finish();
    writer_.close();
  }

 private:
  McapWriter writer_;
  std::string named_;
  std::optional<model::RobotModel> robot_;
  std::optional<topics::FoxgloveTopics> foxglove_;
  topics::MessageTopics messages_{writer_};
  const std::vector<std::string> nameless_;
};

}  // namespace

ExportReport export_csv(const std::vector<fs::path>& files, const fs::path& folder, const work::Progress& progress) {
  expect_an_event(files);
  fs::create_directories(folder);
  std::map<std::string, CsvFile> tables;
  ExportReport report = for_each_message(files, progress, [&](const Row& row) {
    const std::string& channel = row.event.channel();
    auto table = tables.find(channel);
    if (table == tables.end()) table = tables.try_emplace(channel, folder / (channel + ".csv"), row.fields).first;
    table->second.write(row);
  });
  for (auto& [channel, table] : tables) table.close();
  return report;
}

ExportReport export_mcap(const std::vector<fs::path>& files, const fs::path& file, const std::string& robot,
                         const work::Progress& progress) {
  expect_an_event(files);
  McapExport mcap(file, robot);
  ExportReport report;
  const ExportReport counts = for_each_message(files, progress, [&](const Row& row) { mcap.write(row, report); });
  report.messages = counts.messages;
  report.unknown = counts.unknown;
  mcap.close();
  return report;
}

}  // namespace pmg::logs
