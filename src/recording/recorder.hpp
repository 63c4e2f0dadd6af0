// (controller's outbox) => (files): every tick in a rotated log, and the flight recorder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "control/controller_outbox.hpp"
#include "io/clock.hpp"
#include "io/log_writer.hpp"
#include "model/ground_truth.hpp"
#include "model/robot_model.hpp"
#include "recording/flight_recorder.hpp"
#include "recording/run_info.hpp"
#include "recording/tick_log.hpp"

namespace pmg::recording {

struct RecorderOptions {
  std::filesystem::path directory;      ///< made if absent
  bool log = true;                      ///< false: the flight recorder alone
  std::int64_t file_bytes = 256 << 20;  ///< size at which the next file begins: some ten minutes of 31 joints
  int files = 8;                        ///< log-NNNN.lcm in the folder at most, earlier ones included
  std::int64_t spare_bytes = 64 << 20;  ///< room that the disk must have before writing resumes after a refusal
  double retry_s = 1.0;                 ///< pause between two tries after a refusal
  double control_rate_Hz = 100.0;
  FlightRecorderOptions flight{};
};

/// One consumer thread. Takes every record of the outbox and writes DIRECTORY/log-NNNN.lcm, numbered on from what is
/// there; each file begins with ROBOT_INFO and stands alone. Whatever the disk does, drain() returns and the control
/// thread never waits. A folder that is deleted, or made read-only, in mid-run is said at once; the log goes on in the
/// folder made anew, or else in the system's folder for temporary files. TIMING.dropped_records counts lost ticks.
class Recorder {
 public:
  /// Sentences for people about a failure and its end. Called from the threads that call the recorder.
  using Say = std::function<void(const std::string&)>;

  /// Keeps references to outbox, robot and clock, which is the one that stamps the records. Throws std::runtime_error
  /// when the folder or the first file can't be made.
  Recorder(control::ControllerOutbox& outbox, const model::RobotModel& robot, const RunInfo& run,
           const io::Clock& clock, const RecorderOptions& options, Say say);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();  ///< closes

  /// Called with every record, in order, after it was logged; in drain().
  std::function<void(const control::TickRecord&)> after_record;

  /// One pass, every 20 ms or so: writes all waiting records so that they survive the end of this process.
  void drain() noexcept;
  /// Writes a simulation's truth after the record that it belongs to; into the log, not the flight recorder.
  void write_truth(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted) noexcept;
  /// The last pass, after the real-time threads have ended. Once more does nothing.
  void close() noexcept;

  /// Nothing was lost: neither a tick that belongs in the log nor the records of a fault.
  bool complete() const { return (!options_.log || lost() == 0) && flight_.lost() == 0 && flight_.waiting() == 0; }
  std::int64_t written() const { return written_; }               ///< records on the disk
  std::int64_t lost() const { return queue_lost_ + disk_lost_; }  ///< records that the log doesn't have
  const std::filesystem::path& file() const { return file_; }     ///< the newest log file; empty: none yet
  const FlightRecorder& flight() const { return flight_; }

 private:
  void take_records();
  void note_queue_losses();
  control::DroppedItems dropped() const;  // the disk's losses included
  void log_record();
  void flush();
  void begin_file(std::int64_t stamp_ns);
  void begin_file_in(const std::filesystem::path& folder, std::int64_t stamp_ns);
  void notice_deletion();
  void begin_next_file_if_due();
  void try_again();
  void give_up_file(const std::string& why);
  static void remove_oldest(const std::filesystem::path& folder, int files);
  void say(const std::string& text) noexcept;
  template <typename Action>
  void guarded(Action&& action) noexcept;

  control::ControllerOutbox& outbox_;
  const model::RobotModel& robot_;
  RunInfo run_;
  const io::Clock& clock_;
  RecorderOptions options_;
  Say say_;
  std::filesystem::path file_;
  int next_number_ = 0;
  std::unique_ptr<io::LogWriter> writer_;  // null: no log wanted, or the disk refused
  std::optional<TickLog> log_;
  FlightRecorder flight_;
  control::TickRecord record_;
  BusTiming bus_;
  BusCycleReader bus_cycles_;
  std::int64_t in_file_ = 0;  // records on the disk in the file that is open
  std::int64_t unflushed_ = 0, written_ = 0, queue_lost_ = 0, disk_lost_ = 0;
  std::int64_t told_lost_ = 0, lost_before_refusal_ = 0;
  std::int64_t try_ns_ = 0;
  bool closed_ = false;
};

}  // namespace pmg::recording
