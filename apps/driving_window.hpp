// A window on a simulated robot whose keys drive it.
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "operator/keyboard_text.hpp"
#include "operator/keyboard_thread.hpp"
#include "runtime/simulated_robot.hpp"
#include "sim/viewer.hpp"

namespace pmg::apps {

/// For the main thread.
class DrivingWindow {
 public:
  /// Opens the window and drives the controller of this name over the network, as any operator does. Throws
  /// std::runtime_error when there is no window or no network to be had.
  DrivingWindow(const mjModel* model, const std::string& robot, const std::string& url)
      : viewer_(model, {.title = "PMG: " + robot, .on_key = [this](const sim::ViewerKey& key) { take(key); }}),
        keyboard_(url, robot) {
    for (const std::string& line : ops::key_lines(ops::KeyReport::kPressAndRelease, "Closing the window ends.")) {
      keys_ += (keys_.empty() ? "" : "\n") + line;
    }
  }

  /// One frame of where the robot is, at most thirty a second; and what was typed meanwhile.
  void draw(runtime::SimulatedRobot& robot) {
    std::this_thread::sleep_until(next_);
    next_ = std::chrono::steady_clock::now() + kFrame;
    robot.take(pose_);
    const ops::DrivingTable table = keyboard_.table();
    viewer_.set_panel({.labels = table.labels, .values = table.values, .bottom = keys_});
    if (pose_.count > 0) viewer_.show({pose_.qpos.data(), pose_.count}, "", pose_.rope);
    keyboard_.listen();
  }
  bool closed() const { return viewer_.closed(); }

  /// Velocity to zero, then Stand; returns when that is so, or after kLongestCalm.
  void let_go() {
    keyboard_.let_go();
    const auto end = std::chrono::steady_clock::now() + kLongestCalm;
    while (!keyboard_.gone() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kPoll);
  }

 private:
  static constexpr std::chrono::milliseconds kFrame{33}, kPoll{10}, kLongestCalm{2500};

  void take(const sim::ViewerKey& key) {
    using What = sim::ViewerKey::What;
    if (key.what == What::kPressed) keyboard_.press(key.name, key.shift);
    if (key.what == What::kRepeats) keyboard_.repeat(key.name, key.shift);
    if (key.what == What::kReleased) keyboard_.release(key.name);
    if (key.what == What::kUnheard) keyboard_.release_all();
  }

  sim::Viewer viewer_;
  ops::KeyboardThread keyboard_;
  runtime::PoseSample pose_;
  std::string keys_;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace pmg::apps
