// One CAN bus and its drives as a computer sees them whose interface has queues, in simulated time: frames wait in the
// interface's queue for the wire, answers wait for the computer to take them, and nothing is lost but what a full queue
// refuses.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "can/link.hpp"
#include "can/mit_emulator.hpp"

namespace pmg::test {

class QueuedBus final : public can::Link {
 public:
  static constexpr std::int64_t kFrame_ns = 125'000;  ///< 8 bytes at 1 Mbit/s with some stuff bits
  static constexpr std::int64_t kReply_ns = 60'000;   ///< from a command's end until the drive has its answer ready

  /// MIT drives. room: of the interface's queue [frames].
  QueuedBus(const can::BusSetup& bus, std::size_t room) : room_(room) {
    for (const drives::MotorSetup& motor : bus.motors) drives_.push_back({std::make_unique<MitEmulator>(motor), {}});
  }

  std::size_t send(std::span<const drives::Message> frames) noexcept override {
    std::size_t taken = 0;
    for (; taken < frames.size() && out_.size() < room_; ++taken) out_.push_back(frames[taken]);
    counts_.sent += taken;
    counts_.not_sent += frames.size() - taken;
    return taken;
  }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    std::size_t count = 0;
    while (count < frames.size() && !in_.empty() && now_ns_ >= held_until_ns && in_.front().due_ns <= now_ns_) {
      frames[count++] = in_.front().frame;
      in_.pop_front();
    }
    counts_.received += count;
    return count;
  }
  can::BusHealth health() const noexcept override { return can::BusHealth::kGood; }
  const can::LinkCounts& counts() const noexcept override { return counts_; }

  /// The wire carries what it can until then. A reply wins over a command: its identifier is the smaller one.
  void run_to(std::int64_t end_ns) {
    while (free_ns_ < end_ns) {
      Drive* replying = nullptr;
      for (Drive& drive : drives_) {
        if (!drive.replies.empty() && drive.replies.front().due_ns <= free_ns_) replying = &drive;
      }
      if (replying != nullptr) {
        const drives::Message frame = replying->replies.front().frame;
        replying->replies.pop_front();
        free_ns_ += kFrame_ns;
        if (!cut) in_.push_back({frame, free_ns_ + answers_late_ns});
      } else if (!cut && !out_.empty()) {
        const drives::Message frame = out_.front();
        out_.pop_front();
        free_ns_ += kFrame_ns;
        hear(frame);
      } else {
        free_ns_ += kReply_ns / 4;
      }
    }
    now_ns_ = end_ns;
  }
  DriveEmulator& drive(std::size_t motor) { return *drives_[motor].drive; }
  std::size_t motors() const { return drives_.size(); }
  std::size_t waiting() const { return out_.size(); }  ///< frames in the interface's queue

  bool cut = false;                  ///< the cable between this computer and the drives is out: frames wait
  std::int64_t held_until_ns = 0;    ///< until then the computer is given nothing that has arrived
  std::int64_t answers_late_ns = 0;  ///< each answer waits so long on its way to the computer

 private:
  struct Timed {
    drives::Message frame;
    std::int64_t due_ns;
  };
  struct Drive {
    std::unique_ptr<MitEmulator> drive;
    std::deque<Timed> replies;
  };
  void hear(const drives::Message& frame) {
    for (Drive& drive : drives_) {
      Replies replies;
      const int count = drive.drive->hear(frame, replies);
      for (int i = 0; i < count; ++i)
        drive.replies.push_back({replies[static_cast<std::size_t>(i)], free_ns_ + kReply_ns});
    }
  }

  std::size_t room_;
  std::vector<Drive> drives_;
  std::deque<drives::Message> out_;
  std::deque<Timed> in_;
  std::int64_t now_ns_ = 0, free_ns_ = 0;  // free_ns_: the wire's
  can::LinkCounts counts_;
};

}  // namespace pmg::test
