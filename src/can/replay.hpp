// A recording of a robot's buses through the backend: what it would have said of the drives.
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "can/can_hal.hpp"
#include "can/candump.hpp"
#include "io/clock.hpp"

namespace pmg::can {

/// Frames that drives and IMU sent are received anew, cycle by cycle. A cycle begins where the recording has the first
/// command (or SYNC) again; where it has none, every 2 ms. What comes before the first of them is left out. Nothing is
/// asked of the drives where the recording has a hole of 10 ms or more, in which frames of both ways are missing; it is
/// told. The recorded commands themselves are not acted on: drives count as told to be limp, so that one doesn't follow
/// its commands is not said.
class Replay {
 public:
  using Tell = std::function<void(double t_s, const std::string& text)>;

  /// tell: gets each trouble that begins, and its end, with the time since the first frame. Keeps references.
  Replay(const DriveSetup& setup, const model::RobotModel& robot, Tell tell);
  ~Replay();

  /// In the order of the recording. Frames of other interfaces, remote frames and error reports are counted.
  void take(const RecordedFrame& recorded);
  void end();  ///< the recording is over: so is its last cycle

  const CanHal& hal() const noexcept { return *hal_; }
  std::uint64_t frames() const noexcept { return frames_; }      ///< of the robot's buses
  std::uint64_t left_out() const noexcept { return left_out_; }  ///< the others
  std::uint64_t cycles() const noexcept { return cycles_; }
  std::uint64_t troubles() const noexcept { return troubles_; }

 private:
  class RecordedLink;
  bool asks(std::size_t bus, const drives::Message& frame) const;
  void begin(std::int64_t stamp_ns);

  const DriveSetup& setup_;
  Tell tell_;
  io::SimulationClock clock_;
  std::vector<RecordedLink*> links_;
  std::vector<std::unique_ptr<drives::Network>> networks_;  // of each bus; null: there is none
  std::unique_ptr<CanHal> hal_;
  std::optional<std::pair<std::size_t, std::uint32_t>> marker_;  // bus and identifier that begin a cycle
  std::optional<std::int64_t> first_ns_;
  std::int64_t begin_ns_ = 0, stamp_ns_ = 0;
  bool running_ = false;  // a cycle
  model::JointCommand limp_;
  model::RobotState state_;
  std::uint64_t frames_ = 0, left_out_ = 0, cycles_ = 0, troubles_ = 0;
};

/// All lines of a recording into the replay. Throws std::runtime_error with name and line where one isn't candump's, or
/// when the recording has no frame of the robot's buses.
void feed(Replay& replay, std::istream& recording, const std::string& name);

}  // namespace pmg::can
