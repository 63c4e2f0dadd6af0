// Two ends of a CAN bus without a kernel: what one end sends, the other receives. Faults of the wire on demand.
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "can/link.hpp"

namespace pmg::test {

class MemoryLink final : public can::Link {
 public:
  static std::pair<std::unique_ptr<MemoryLink>, std::unique_ptr<MemoryLink>> pair() {
    auto a = std::make_unique<MemoryLink>(), b = std::make_unique<MemoryLink>();
    a->other_ = b.get();
    b->other_ = a.get();
    return {std::move(a), std::move(b)};
  }
  std::size_t send(std::span<const drives::Message> frames) noexcept override {
    if (cut) {
      counts_.not_sent += frames.size();
      return 0;
    }
    for (const drives::Message& frame : frames) {
      ++counts_.sent;
      other_->push(frame);
    }
    return frames.size();
  }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    std::size_t count = 0;
    for (; count < frames.size() && size_ > 0; ++count, --size_, first_ = (first_ + 1) % kRoom)
      frames[count] = queue_[first_];
    counts_.received += count;
    return count;
  }
  can::BusHealth health() const noexcept override { return state; }
  const can::LinkCounts& counts() const noexcept override { return counts_; }

  void push(const drives::Message& frame) noexcept {
    if (size_ == kRoom) return;
    queue_[(first_ + size_) % kRoom] = frame;
    ++size_;
  }

  bool cut = false;                              ///< the cable is off
  can::BusHealth state = can::BusHealth::kGood;  ///< as this end's controller says

 private:
  static constexpr std::size_t kRoom = 256;
  MemoryLink* other_ = nullptr;
  std::array<drives::Message, kRoom> queue_{};
  std::size_t first_ = 0, size_ = 0;
  can::LinkCounts counts_;
};

}  // namespace pmg::test
