#include "recording/flight_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "io/log_writer.hpp"
#include "recording/tick_log.hpp"

namespace pmg::recording {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWaiting = 4;           // incidents that wait for the disk; each holds half a minute of records
constexpr std::size_t kMessagesInText = 5;    // of each kind
constexpr double kRoomForLatePasses_s = 2.0;  // the ring goes on while an incident's last second is awaited

double seconds(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-9; }

std::int64_t utc_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string utc(std::int64_t utc_ns, const char* format) {
  const std::time_t time = static_cast<std::time_t>(utc_ns / 1'000'000'000);
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[40];
  std::strftime(text, sizeof text, format, &parts);
  return fmt::format("{}.{:03d}", text, utc_ns / 1'000'000 % 1000);
}

/// A request's mode is whatever came in.
std::string mode_name(control::Mode mode) {
  return mode <= control::Mode::kFault ? to_string(mode) : fmt::format("mode {}", static_cast<int>(mode));
}

}  // namespace

FlightRecorder::FlightRecorder(fs::path directory, const model::RobotModel& robot, const RunInfo& run,
                               double control_rate_Hz, const io::Clock& clock, const FlightRecorderOptions& options,
                               Say say)
    : directory_(std::move(directory)),
      robot_(robot),
      run_(run),
      control_rate_Hz_(control_rate_Hz),
      clock_(clock),
      options_(options),
      say_(std::move(say)) {
  const double held_s = options.before_s + options.after_s + kRoomForLatePasses_s;
  ring_.resize(static_cast<std::size_t>(std::ceil(held_s * control_rate_Hz)));
  waiting_.reserve(kWaiting);
}

const FlightRecorder::Row& FlightRecorder::row(std::size_t age) const {
  return ring_[(next_ + ring_.size() - 1 - age) % ring_.size()];
}

void FlightRecorder::add(const control::TickRecord& record, const BusTiming& bus,
                         const control::DroppedItems& dropped) {
  Row& row = ring_[next_];
  row.record = record;
  row.bus = bus;
  row.dropped = dropped;
  next_ = (next_ + 1) % ring_.size();
  held_ = std::min(held_ + 1, ring_.size());
  note_fault(record);
}

void FlightRecorder::note_fault(const control::TickRecord& record) {
  const faults::Fault& fault = record.result.fault;
  const bool latched = fault.code != faults::FaultCode::kNone && !faults::same_incident(fault, last_fault_);
  last_fault_ = fault;
  const control::Mode mode_before = std::exchange(last_mode_, record.result.mode);
  if (!latched) return;
  if (waiting_.size() == kWaiting) {
    ++lost_;
    say_(fmt::format("flight recorder: {} incidents wait for the disk; this fault's records are not kept: {}", kWaiting,
                     describe(fault, robot_)));
    return;
  }
  Incident incident;
  incident.record = record;
  incident.mode_before = mode_before;
  incident.utc_ns = utc_now_ns() - (clock_.now_ns() - record.now_ns);
  // Files sort by it, and the oldest are removed: of two in one millisecond the later one is the newer.
  constexpr std::int64_t kMillisecond_ns = 1'000'000, kSecond_ns = 1'000'000'000;
  const std::int64_t next_ns = (last_utc_ns_ / kMillisecond_ns + 1) * kMillisecond_ns;
  if (incident.utc_ns < next_ns && next_ns - incident.utc_ns < kSecond_ns) incident.utc_ns = next_ns;
  last_utc_ns_ = incident.utc_ns;
  waiting_.push_back(std::move(incident));
}

bool FlightRecorder::complete(const Incident& incident) const {
  return held_ > 0 && row(0).record.now_ns >= incident.record.now_ns + io::nanoseconds(options_.after_s);
}

void FlightRecorder::pass() {
  if (waiting_.empty()) return;
  const std::int64_t now_ns = clock_.now_ns();
  std::erase_if(waiting_, [&](Incident& incident) {
    const bool due = complete(incident) || now_ns > incident.record.now_ns + 2 * io::nanoseconds(options_.after_s);
    return due && now_ns >= incident.try_ns && try_writing(incident);
  });
}

void FlightRecorder::close() {
  std::erase_if(waiting_, [&](Incident& incident) { return try_writing(incident); });
}

bool FlightRecorder::try_writing(Incident& incident) {
  if (rows_of(incident).empty()) {  // no memory to rescue them, and the ring moved on
    ++lost_;
    say_("flight recorder: the records of a fault are lost: " + describe(incident.record.result.fault, robot_));
    return true;
  }
  try {
    try {
      write_in(directory_, incident);
    } catch (const std::exception& error) {
      const fs::path other = other_log_folder(run_);
      try {
        write_in(other, incident);
      } catch (const std::exception&) {
        std::error_code ignored;
        fs::remove(other, ignored);  // only if it is empty
        throw std::runtime_error(error.what());
      }
    }
  } catch (const std::exception& error) {
    incident.try_ns = clock_.now_ns() + io::nanoseconds(options_.retry_s);
    if (!std::exchange(incident.refused, true)) {
      say_(fmt::format("flight recorder: {}; kept in memory and tried again", error.what()));
      for (const Row* held : rows_of(incident)) incident.rescued.push_back(*held);
    }
    return false;
  }
  return true;
}

/// Makes the folder if it is gone. Throws when the disk refuses; then nothing is left there.
void FlightRecorder::write_in(const fs::path& folder, const Incident& incident) {
  fs::create_directories(folder);
  remove_oldest(folder);
  const fs::path file = stem(incident, folder);
  try {
    write(incident, file);
  } catch (const std::exception&) {
    std::error_code ignored;
    fs::remove(file.string() + ".txt", ignored);
    throw;
  }
  ++written_;
  say_(fmt::format("flight recorder: {}.lcm and .txt written", file.string()));
}

std::vector<const FlightRecorder::Row*> FlightRecorder::rows_of(const Incident& incident) const {
  std::vector<const Row*> rows;
  if (!incident.rescued.empty()) {
    for (const Row& row : incident.rescued) rows.push_back(&row);
    return rows;
  }
  const std::int64_t fault_ns = incident.record.now_ns;
  for (std::size_t age = held_; age-- > 0;) {
    const Row& candidate = row(age);
    const std::int64_t since_ns = candidate.record.now_ns - fault_ns;
    if (since_ns >= -io::nanoseconds(options_.before_s) && since_ns <= io::nanoseconds(options_.after_s))
      rows.push_back(&candidate);
  }
  return rows;
}

void FlightRecorder::write(const Incident& incident, const fs::path& file) const {
  const std::vector<const Row*> rows = rows_of(incident);
  const auto named = [&](const char* extension) { return fs::path(file.string() + extension); };
  {  // the words first: they fit where the records don't
    std::ofstream out(named(".txt"));
    out << text(incident, rows, named(".lcm"));
    if (!out.flush()) throw std::runtime_error(named(".txt").string() + ": can't be written");
  }
  const fs::path part = named(".part");  // a log that is there is whole
  try {
    io::LogWriter writer(part);
    TickLog log(writer, robot_, run_, control_rate_Hz_, rows.front()->record.now_ns);
    log.announce_fault(rows.front()->record.now_ns, incident.record);
    for (const Row* held : rows) {
      log.write(held->record);
      log.write_timing(held->record, held->bus, held->dropped);
    }
    writer.sync();
  } catch (const std::exception&) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
  fs::rename(part, named(".lcm"));
}

fs::path FlightRecorder::stem(const Incident& incident, const fs::path& folder) {
  const std::string name =
      fmt::format("fault-{}Z-{}", utc(incident.utc_ns, "%Y%m%dT%H%M%S"), to_string(incident.record.result.fault.code));
  fs::path stem = folder / name;
  // A computer whose clock was set back.
  for (int again = 2; fs::exists(stem.string() + ".lcm"); ++again) stem = folder / fmt::format("{}-{}", name, again);
  return stem;
}

void FlightRecorder::remove_oldest(const fs::path& folder) const {
  std::vector<fs::path> logs;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("fault-") && entry.path().extension() == ".lcm") logs.push_back(entry.path());
  }
  std::ranges::sort(logs);
  for (std::size_t i = 0; i + static_cast<std::size_t>(options_.files) <= logs.size(); ++i) {
    fs::remove(logs[i]);
    fs::remove(fs::path(logs[i]).replace_extension(".txt"));
  }
}

std::string FlightRecorder::text(const Incident& incident, const std::vector<const Row*>& rows,
                                 const fs::path& log) const {
  const control::TickRecord& record = incident.record;
  const faults::Fault& fault = record.result.fault;
  std::string text = describe(fault, robot_) + "\n\n";
  text += fmt::format("When         {} UTC, tick {}, {:.3f} s by the controller's clock\n",
                      utc(incident.utc_ns, "%Y-%m-%d %H:%M:%S"), record.tick, seconds(record.now_ns));
  text += fmt::format("Robot        {} (model {}), backend {}, policy {}\n", run_.robot, robot_.name, run_.backend,
                      run_.policy);
  text += fmt::format("Software     {}, bundle {}\n", software_version(), run_.bundle.empty() ? "-" : run_.bundle);
  text += fmt::format("Mode before  {}\n", to_string(incident.mode_before));
  const char* driving = record.result.driving.name.data();
  text += fmt::format("Driven by    {}\n", *driving == '\0' ? "nobody" : driving);

  std::string commands, requests;
  std::size_t command_count = 0, request_count = 0;
  for (auto held = rows.rbegin(); held != rows.rend(); ++held) {
    const control::TickRecord& earlier = (*held)->record;
    if (earlier.now_ns > record.now_ns) continue;
    const double ago_s = seconds(record.now_ns - earlier.now_ns);
    const control::TickInput input = earlier.input();
    for (auto drive = input.drives.rbegin(); drive != input.drives.rend() && command_count < kMessagesInText; ++drive) {
      const Command& u = drive->command;
      commands += fmt::format(
          "  {:7.2f} s before  {} #{}: vx {:.2f} m/s, vy {:.2f} m/s, omega {:.2f} rad/s, pitch {:.2f} rad, roll {:.2f} "
          "rad, height {:.3f} m\n",
          ago_s, drive->source.name.data(), drive->sequence, u[kVx], u[kVy], u[kOmega], u[kPitch], u[kRoll],
          u[kHeight]);
      ++command_count;
    }
    for (auto asked = input.requests.rbegin(); asked != input.requests.rend() && request_count < kMessagesInText;
         ++asked) {
      requests += fmt::format("  {:7.2f} s before  {} #{}: {}{}\n", ago_s, asked->source.name.data(), asked->sequence,
                              mode_name(asked->mode), asked->reset_fault ? ", reset" : "");
      ++request_count;
    }
  }
  text += "\nLast commands, newest first\n" + (commands.empty() ? "  none\n" : commands);
  text += "\nLast requests for a mode, newest first\n" + (requests.empty() ? "  none\n" : requests);
  text += fmt::format(
      "\nWhat you can do\n  {}\n  The drives are damping and stay so. When the cause is gone, reset the fault (the "
      "mode "
      "is then Damping) and ask\n  for Stand.\n",
      faults::advice(fault.code));
  text += fmt::format("\nRecords      {}: {} ticks, from {:.2f} s before the fault to {:.2f} s after\n",
                      log.filename().string(), rows.size(), seconds(record.now_ns - rows.front()->record.now_ns),
                      seconds(rows.back()->record.now_ns - record.now_ns));
  if (const std::int64_t lost = rows.back()->dropped.records; lost > 0) {
    text += fmt::format("             {} ticks were lost before they could be recorded\n", lost);
  }
  return text;
}

}  // namespace pmg::recording
