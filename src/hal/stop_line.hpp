// A stop by anyone: the bus brakes in its next cycle, without waiting for the control thread.
#pragma once

#include <atomic>
#include <cstdint>

namespace pmg::hal {

/// Any thread may pull it, any number of times. The bus damps until a command comes whose tick had seen every pull.
class StopLine {
 public:
  void pull() noexcept { pulls_.fetch_add(1, std::memory_order_release); }
  std::uint32_t pulls() const noexcept { return pulls_.load(std::memory_order_acquire); }

 private:
  std::atomic<std::uint32_t> pulls_{0};
};

}  // namespace pmg::hal
