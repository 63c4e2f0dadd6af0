// A keyboard station in its own thread, for a window. A slow window does not delay the commands.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "keyboard/key_command.hpp"
#include "operator/driving_station.hpp"

namespace pmg::ops {

/// One thread at a time may call the methods. None waits longer than one step.
class KeyboardThread {
 public:
  /// Sends to this controller on this address, with the keys of this user's folder. Throws as LcmLink and
  /// seal::load_operator_seal() do.
  KeyboardThread(const std::string& url, const std::string& robot);
  ~KeyboardThread();  ///< without let_go() the commands end at once
  KeyboardThread(const KeyboardThread&) = delete;
  KeyboardThread& operator=(const KeyboardThread&) = delete;

  void press(const std::string& key, bool shift);
  void repeat(const std::string& key, bool shift);
  void release(const std::string& key);
  void release_all();
  void listen();  ///< the window has polled its keys
  void let_go();

  DrivingTable table() const;
  bool gone() const;

 private:
  using Errand = std::function<void(KeyCommand&, DrivingStation&)>;
  void tell(Errand errand);
  void run(const std::stop_token& stop);

  io::WallClock clock_;
  io::LcmLink link_;
  KeyCommand keys_{KeyReport::kPressAndRelease};  // used by the thread only, as the station is
  DrivingStation station_;
  mutable std::mutex mutex_;
  std::vector<Errand> errands_;
  DrivingTable table_;
  bool gone_ = false;
  std::jthread thread_;
};

}  // namespace pmg::ops
