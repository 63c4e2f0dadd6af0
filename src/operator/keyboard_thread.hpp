// A keyboard station in a thread of its own, for a window: however slowly that draws, commands are sent in time.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/keyboard_station.hpp"

namespace pmg::ops {

/// Everything but construction from any one thread; nothing here waits for longer than a step takes.
class KeyboardThread {
 public:
  /// Speaks on this address to this controller. Throws as LcmLink does.
  KeyboardThread(const std::string& url, const std::string& robot);
  ~KeyboardThread();  ///< without let_go() commands simply end
  KeyboardThread(const KeyboardThread&) = delete;
  KeyboardThread& operator=(const KeyboardThread&) = delete;

  void press(const std::string& key, bool shift);
  void repeat(const std::string& key, bool shift);
  void release(const std::string& key);
  void release_all();
  void listen();  ///< the window looked at its keys
  void let_go();

  DrivingTable table() const;
  bool gone() const;

 private:
  using Errand = std::function<void(KeyboardStation&)>;
  void tell(Errand errand);
  void run(const std::stop_token& stop);

  io::WallClock clock_;
  io::LcmLink link_;
  KeyboardStation station_;  // the thread's
  mutable std::mutex mutex_;
  std::vector<Errand> errands_;
  DrivingTable table_;
  bool gone_ = false;
  std::jthread thread_;
};

}  // namespace pmg::ops
