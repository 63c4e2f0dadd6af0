// Keeps the last seconds in memory. When a fault latches, writes them as a log of its own, and beside it a page of text
// for the operator.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "control/tick_record.hpp"
#include "io/clock.hpp"
#include "model/robot_model.hpp"
#include "recording/run_info.hpp"
#include "recording/tick_messages.hpp"

namespace pmg::recording {

struct FlightRecorderOptions {
  double before_s = 30.0;  ///< span of the written records before the fault
  double after_s = 1.0;    ///< and after it
  int files = 16;          ///< pairs of log and text in the folder at most; older ones are removed
  double retry_s = 1.0;    ///< pause after the disk refused a pair
};

/// The constructor allocates the memory of all records, some 9 kB for each. Writes
/// DIRECTORY/fault-<UTC time>-<code>.lcm and .txt; names sort by time. Not for a real-time thread, no thread of its
/// own.
class FlightRecorder {
 public:
  using Say = std::function<void(const std::string&)>;

  /// Keeps references to robot and clock, which is the one that stamps the records. say takes sentences for people.
  FlightRecorder(std::filesystem::path directory, const model::RobotModel& robot, const RunInfo& run,
                 double control_rate_Hz, const io::Clock& clock, const FlightRecorderOptions& options, Say say);

  void add(const control::TickRecord& record, const BusTiming& bus, const control::DroppedItems& dropped);

  /// Writes the incidents that are due. It keeps those that the disk refuses, and tries again in a later pass.
  void pass();
  /// Tries once more to write every incident that waits, complete or not.
  void close();

  int written() const { return written_; }
  int lost() const { return lost_; }  ///< faults whose records are nowhere
  int waiting() const { return static_cast<int>(waiting_.size()); }

 private:
  struct Row {
    control::TickRecord record;
    BusTiming bus;
    control::DroppedItems dropped;
  };
  /// A fault that is not on the disk yet.
  struct Incident {
    control::TickRecord record;  // of the tick that latched it
    control::Mode mode_before = control::Mode::kPassive;
    std::int64_t utc_ns = 0;
    std::int64_t try_ns = 0;   // not before, by the clock
    std::vector<Row> rescued;  // after a refusal: the ring moves on
    bool refused = false;
  };

  const Row& row(std::size_t age) const;  // 0: the newest
  void note_fault(const control::TickRecord& record);
  bool complete(const Incident& incident) const;
  bool try_writing(Incident& incident);
  void write(const Incident& incident, const std::filesystem::path& stem) const;
  std::vector<const Row*> rows_of(const Incident& incident) const;
  std::string text(const Incident& incident, const std::vector<const Row*>& rows,
                   const std::filesystem::path& stem) const;
  static std::filesystem::path stem(const Incident& incident, const std::filesystem::path& folder);
  void write_in(const std::filesystem::path& folder, const Incident& incident);
  void remove_oldest(const std::filesystem::path& folder) const;

  std::filesystem::path directory_;
  const model::RobotModel& robot_;
  RunInfo run_;
  double control_rate_Hz_;
  const io::Clock& clock_;
  FlightRecorderOptions options_;
  Say say_;
  std::vector<Row> ring_;
  std::size_t next_ = 0, held_ = 0;
  faults::Fault last_fault_;
  control::Mode last_mode_ = control::Mode::kPassive;
  std::vector<Incident> waiting_;
  std::int64_t last_utc_ns_ = 0;  // of the newest incident
  int written_ = 0, lost_ = 0;
};

}  // namespace pmg::recording
