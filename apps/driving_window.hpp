// A window on a simulated robot whose keys drive it.
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "operator/keyboard_text.hpp"
#include "operator/keyboard_thread.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/viewer.hpp"

namespace pmg::apps {

/// For the main thread; pictures are drawn in one of its own.
class DrivingWindow {
 public:
  /// Opens the window and drives the controller of this name over the network, as any operator does. Throws
  /// std::runtime_error when there is no window or no network to be had.
  DrivingWindow(const mjModel* model, const std::string& robot, const std::string& url)
      : viewer_(model, {.title = "PMG: " + robot, .on_key = [this](const sim::ViewerKey& key) { take(key); }}),
        keyboard_(url, robot) {}

  /// From now on the window shows where the robot is, at most thirty times a second. Keeps a reference.
  void show(sil::SimulatedRobot& robot) {
    viewer_.release();  // pictures are the painter's from now on
    painter_ = std::jthread([this, &robot](const std::stop_token& stop) { paint(robot, stop); });
  }
  /// What was typed meanwhile; to be called every 10 ms or so, however slow a picture is.
  void listen() {
    viewer_.poll();
    keyboard_.listen();
  }
  bool closed() const { return viewer_.closed(); }

  /// Velocity to zero, then Stand; returns when that is so, or after kLongestCalm.
  void let_go() {
    keyboard_.listen();
    keyboard_.let_go();
    const auto end = std::chrono::steady_clock::now() + kLongestCalm;
    while (!keyboard_.gone() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kPoll);
  }

 private:
  static constexpr std::chrono::milliseconds kFrame{33}, kPoll{10}, kLongestCalm{2500};

  void paint(sil::SimulatedRobot& robot, const std::stop_token& stop) {
    const ops::DrivingTable keys = ops::key_table();
    sil::PoseSample pose;
    for (auto next = std::chrono::steady_clock::now(); !stop.stop_requested();) {
      std::this_thread::sleep_until(next);
      next = std::chrono::steady_clock::now() + kFrame;
      robot.take(pose);
      const ops::DrivingTable table = keyboard_.table();
      if (pose.count == 0) continue;
      viewer_.draw({pose.qpos.data(), pose.count}, "", pose.rope,
                   {table.labels, table.values, keys.labels, keys.values});
    }
    viewer_.withdraw();
  }
  void take(const sim::ViewerKey& key) {
    using What = sim::ViewerKey::What;
    if (key.what == What::kPressed) keyboard_.press(key.name, key.shift);
    if (key.what == What::kRepeats) keyboard_.repeat(key.name, key.shift);
    if (key.what == What::kReleased) keyboard_.release(key.name);
    if (key.what == What::kUnheard) keyboard_.release_all();
  }

  sim::Viewer viewer_;
  ops::KeyboardThread keyboard_;
  std::jthread painter_;  // after what it uses
};

}  // namespace pmg::apps
