// Between the thread that hears operators and the control thread: bounded, wait-free queues.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>

#include "control/arms_message.hpp"
#include "control/mode.hpp"
#include "hal/stop_line.hpp"

namespace pmg::control {

/// One writer (whoever hears operators) and one reader (the control cycle). A full queue refuses: the writer counts.
class OperatorInbox {
 public:
  explicit OperatorInbox(hal::StopLine& stop) : stop_(stop) {}

  bool put(const DriveMessage& drive) { return drives_.push(drive); }
  bool put(const ArmsMessage& arms) { return arms_.push(arms); }
  /// A stop reaches the bus in its next cycle, even when the queue is full or the control thread doesn't answer.
  bool put(const ModeRequest& request) {
    const bool queued = requests_.push(request);
    if (request.stops()) stop_.pull();  // after the push: who sees the pull finds the request
    return queued;
  }

  /// A stop that nobody waits to see acknowledged.
  void stop() noexcept { stop_.pull(); }

  bool take(DriveMessage& drive) noexcept { return drives_.pop(drive); }
  bool take(ModeRequest& request) noexcept { return requests_.pop(request); }
  bool take(ArmsMessage& arms) noexcept { return arms_.pop(arms); }

 private:
  hal::StopLine& stop_;
  boost::lockfree::spsc_queue<DriveMessage, boost::lockfree::capacity<64>> drives_;
  boost::lockfree::spsc_queue<ModeRequest, boost::lockfree::capacity<32>> requests_;
  boost::lockfree::spsc_queue<ArmsMessage, boost::lockfree::capacity<48>> arms_;
};

}  // namespace pmg::control
