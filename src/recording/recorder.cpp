#include "recording/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "io/log_series.hpp"

namespace pmg::recording {

namespace {

namespace fs = std::filesystem;

/// Flushed at least so often: fewer records than fill the writer's buffer, so that a refusal's losses can be counted.
constexpr std::int64_t kRecordsAFlush = 50;

fs::path made(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (!fs::is_directory(directory))
    throw std::runtime_error(directory.string() + (fs::exists(directory)
                                                       ? ": a file has this name; expected a folder, or a new name"
                                                       : ": the log's folder can't be made: " + error.message()));
  return directory;
}

}  // namespace

Recorder::Recorder(control::ControllerOutbox& outbox, const model::RobotModel& robot, const RunInfo& run,
                   const io::Clock& clock, const RecorderOptions& options, Say say)
    : outbox_(outbox),
      robot_(robot),
      run_(run),
      clock_(clock),
      options_(options),
      say_(std::move(say)),
      flight_(made(options.directory), robot, run, options.control_rate_Hz, clock, options.flight,
              [this](const std::string& text) { this->say(text); }),
      bus_cycles_(outbox) {
  const auto earlier = io::rotated_log_files(options_.directory);
  if (!earlier.empty()) next_number_ = earlier.rbegin()->first + 1;
  if (options_.log) begin_file_in(options_.directory, clock_.now_ns());
}

Recorder::~Recorder() { close(); }

void Recorder::say(const std::string& text) noexcept {
  try {
    if (say_) say_(text);
  } catch (...) {  // a console that is gone must not end the log
  }
}

/// Nothing that goes wrong here may end the thread: at worst this pass is lost.
template <typename Action>
void Recorder::guarded(Action&& action) noexcept {
  try {
    action();
  } catch (const std::exception& error) {
    try {
      say(std::string("log: ") + error.what());
    } catch (...) {  // no memory for a sentence either
    }
  } catch (...) {
  }
}

void Recorder::drain() noexcept {
  guarded([this] { notice_deletion(); });
  guarded([this] { take_records(); });
  guarded([this] { flush(); });
  guarded([this] { flight_.pass(); });
}

void Recorder::close() noexcept {
  if (std::exchange(closed_, true)) return;
  drain();
  guarded([this] { flight_.close(); });
  guarded([this] {
    if (writer_) writer_->sync();
  });
  guarded([this] { notice_deletion(); });
  writer_.reset();
  if (lost() > 0) say(fmt::format("log: {} ticks are missing in it", lost()));
}

void Recorder::take_records() {
  note_queue_losses();
  // Bounded: a disk slower than the ticks must not keep this pass for ever.
  for (std::size_t taken = 0; taken < control::ControllerOutbox::kRecords && outbox_.records.pop(record_); ++taken) {
    bus_cycles_.take_until(record_.timing.woke_ns, bus_);
    guarded([this] { flight_.add(record_, bus_, dropped()); });
    if (options_.log) log_record();
    bus_.start_anew();
    if (after_record) guarded([this] { after_record(record_); });
  }
}

control::DroppedItems Recorder::dropped() const {
  control::DroppedItems dropped = outbox_.dropped();
  dropped.records = lost();
  return dropped;
}

void Recorder::note_queue_losses() {
  const std::int64_t dropped = outbox_.dropped().records;
  if (dropped == queue_lost_) return;
  say(fmt::format("log: the log's thread stood still for too long; {} ticks are missing in the log",
                  dropped - queue_lost_));
  queue_lost_ = dropped;
}

void Recorder::log_record() {
  if (!writer_) try_again();
  if (!writer_) {
    ++disk_lost_;
    return;
  }
  ++unflushed_;
  try {
    log_->write(record_);
    log_->write_timing(record_, bus_, dropped());
    if (unflushed_ >= kRecordsAFlush) flush();
    begin_next_file_if_due();
  } catch (const std::exception& error) {
    give_up_file(error.what());
  }
}

void Recorder::flush() {
  if (!writer_) return;
  try {
    writer_->flush();
    in_file_ += unflushed_;
    written_ += std::exchange(unflushed_, 0);
  } catch (const std::exception& error) {
    give_up_file(error.what());
  }
}

void Recorder::begin_next_file_if_due() {
  if (!writer_ || writer_->bytes() < options_.file_bytes) return;
  writer_->sync();
  written_ += std::exchange(unflushed_, 0);
  begin_file_in(file_.parent_path(), record_.now_ns);
}

/// In the log's folder, or else elsewhere. Throws when neither takes it.
void Recorder::begin_file(std::int64_t stamp_ns) {
  try {
    begin_file_in(options_.directory, stamp_ns);
  } catch (const std::exception& error) {
    const fs::path other = other_log_folder(run_);
    try {
      begin_file_in(other, stamp_ns);
    } catch (const std::exception&) {
      std::error_code ignored;
      fs::remove(other, ignored);  // only if it is empty
      throw std::runtime_error(error.what());
    }
  }
}

/// Throws when the disk refuses it; the old file stays in use then.
void Recorder::begin_file_in(const fs::path& folder, std::int64_t stamp_ns) {
  made(folder);
  if (writer_ == nullptr && log_ && fs::space(folder).available < static_cast<std::uintmax_t>(options_.spare_bytes)) {
    throw std::runtime_error(folder.string() + ": no room");
  }
  const fs::path path = folder / fmt::format("log-{:04d}.lcm", next_number_);
  auto writer = std::make_unique<io::LogWriter>(path);
  try {
    if (log_) {
      log_->continue_in(*writer, stamp_ns);
    } else {
      log_.emplace(*writer, robot_, run_, options_.control_rate_Hz, stamp_ns);
    }
    writer->flush();
  } catch (const std::exception&) {
    writer.reset();
    std::error_code ignored;
    fs::remove(path, ignored);  // or a full disk would fill up with empty files
    throw;
  }
  writer_ = std::move(writer);
  file_ = path;
  in_file_ = 0;
  ++next_number_;
  guarded([&] { remove_oldest(folder, options_.files); });
}

void Recorder::try_again() {
  if (clock_.now_ns() < try_ns_) return;
  try_ns_ = clock_.now_ns() + io::nanoseconds(options_.retry_s);
  try {
    begin_file(record_.now_ns);
  } catch (const std::exception&) {  // was told when it began
    return;
  }
  say(fmt::format("log: writing again, into {}; {} ticks are missing before it", file_.string(),
                  disk_lost_ - lost_before_refusal_));
}

/// What was written into a file that is gone is lost; the next record begins a new one.
void Recorder::notice_deletion() {
  if (!writer_ || writer_->in_place()) return;
  written_ -= in_file_;
  const std::int64_t before = disk_lost_;
  disk_lost_ += std::exchange(in_file_, 0);
  give_up_file(file_.string() + " was deleted or replaced");
  lost_before_refusal_ = before;
  try_ns_ = clock_.now_ns();
}

void Recorder::give_up_file(const std::string& why) {
  lost_before_refusal_ = disk_lost_;
  disk_lost_ += std::exchange(unflushed_, 0);
  writer_.reset();
  try_ns_ = clock_.now_ns();  // another folder may take it at once
  say(fmt::format("LOG STOPPED: {}. The robot is controlled as before; the log goes on as soon as a folder takes it",
                  why));
}

void Recorder::remove_oldest(const fs::path& folder, int most) {
  auto files = io::rotated_log_files(folder);
  while (std::ssize(files) > std::max(most, 1)) {
    fs::remove(files.begin()->second);
    files.erase(files.begin());
  }
}

void Recorder::write_truth(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted) noexcept {
  guarded([&] {
    if (!writer_) return;
    try {
      log_->write_truth(stamp_ns, truth, hoisted);
    } catch (const std::exception& error) {
      give_up_file(error.what());
    }
  });
}

}  // namespace pmg::recording
