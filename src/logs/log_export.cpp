#include "logs/log_export.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "io/log_series.hpp"
#include "io/mcap_writer.hpp"
#include "io/plain_text.hpp"
#include "logs/message_fields.hpp"
#include "pmg_msgs/robot_info_t.hpp"

namespace pmg::logs {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::int64_t kEventsAProgress = 500;

/// One decoded message.
struct Row {
  const io::LogReader& event;
  double time_s;  // since the first event
  const std::optional<pmg_msgs::robot_info_t>& info;
  std::int64_t first_ns;
  const std::vector<Field>& fields;
};

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
  if (count == 0) throw std::runtime_error(files.front().string() + ": no LCM event in it; expected a log");
  return report;
}

/// Numbers as they are, also negative ones; text that another program chose made harmless.
std::string cell(const Field::Value& value) {
  const bool number = std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value) ||
                      std::holds_alternative<bool>(value);
  return number ? to_text(value) : io::csv_text(to_text(value));
}

/// One channel's file.
class CsvFile {
 public:
  CsvFile(const fs::path& path, const std::vector<Field>& fields) : path_(path), file_(path) {
    std::string header = "time_s";
    for (const Field& field : fields) header += "," + io::csv_text(field.path());
    columns_ = fields.size();
    file_ << header << '\n';
  }
  void write(const Row& row) {
    if (row.fields.size() != columns_)
      throw std::runtime_error(path_.string() +
                               ": the logs are of robots with different joints; name those of one run");
    std::string line = fmt::format("{:.6f}", row.time_s);
    for (const Field& field : row.fields) line.append(",").append(cell(field.value));
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

struct ToJson {
  ordered_json operator()(double value) const {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
  }
  template <typename T>
  ordered_json operator()(const T& value) const {
    return value;
  }
};

struct SchemaType {
  const char* operator()(std::int64_t) const { return "integer"; }
  const char* operator()(double) const { return "number"; }
  const char* operator()(bool) const { return "boolean"; }
  const char* operator()(const std::string&) const { return "string"; }
  const char* operator()(const std::vector<std::string>&) const { return "array"; }
};

ordered_json message_json(const std::vector<Field>& fields) {
  ordered_json json = ordered_json::object();
  for (const Field& field : fields) {
    ordered_json value = std::visit(ToJson{}, field.value);
    if (field.element.empty()) {
      json[field.name] = std::move(value);
    } else {
      json[field.name][field.element] = std::move(value);
    }
  }
  return json;
}

ordered_json schema_json(const std::vector<Field>& fields) {
  ordered_json properties = ordered_json::object();
  for (const Field& field : fields) {
    ordered_json type = {{"type", std::visit(SchemaType{}, field.value)}};
    if (type["type"] == "array") type["items"] = {{"type", "string"}};
    if (field.element.empty()) {
      properties[field.name] = std::move(type);
    } else {
      properties[field.name]["type"] = "object";
      properties[field.name]["properties"][field.element] = std::move(type);
    }
  }
  return {{"type", "object"}, {"properties", properties}};
}

}  // namespace

ExportReport export_csv(const std::vector<fs::path>& files, const fs::path& folder, const work::Progress& progress) {
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

ExportReport export_mcap(const std::vector<fs::path>& files, const fs::path& file, const work::Progress& progress) {
  io::McapWriter writer(file);
  std::map<std::string, io::McapWriter::Id> channels;
  ExportReport report = for_each_message(files, progress, [&](const Row& row) {
    const std::string& channel = row.event.channel();
    auto known = channels.find(channel);
    if (known == channels.end()) {
      const auto schema = writer.add_schema("pmg." + channel, "jsonschema", schema_json(row.fields).dump());
      known = channels.emplace(channel, writer.add_channel(schema, channel, "json")).first;
    }
    // The session is the wall clock at the start, close to the first event's; lockstep has none.
    const std::int64_t started_ns = row.info && row.info->session > 0 ? row.info->session - row.first_ns : 0;
    const ordered_json json = message_json(row.fields);
    writer.write(known->second, row.event.stamp_ns() + started_ns,
                 json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  });
  writer.close();
  return report;
}

}  // namespace pmg::logs
