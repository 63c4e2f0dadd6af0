// A window on a simulated robot whose keys drive it.
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "hal/backend.hpp"
#include "keyboard/keyboard_thread.hpp"
#include "sil/shown_speed.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/viewer.hpp"

namespace pmg::sil {

/// For the main thread; a thread of its own draws the pictures.
class DrivingWindow final : public hal::Window {
 public:
  /// Opens the window and drives the controller of this name over the network, as any operator does. Keeps a reference
  /// to robot. Throws std::runtime_error when there is no window or no network to be had.
  DrivingWindow(const mjModel* model, SimulatedRobot& robot, const std::string& name, const std::string& url);

  /// At most thirty pictures a second.
  void show() override;
  /// However slow a picture is.
  void listen() override;
  bool closed() const override { return viewer_.closed(); }
  void let_go() override;

 private:
  void paint(const std::stop_token& stop);
  void take(const sim::ViewerKey& key);

  SimulatedRobot& robot_;
  sim::Viewer viewer_;
  ops::KeyboardThread keyboard_;
  ShownSpeed speed_;      // the painter's
  std::jthread painter_;  // after what it uses
};

}  // namespace pmg::sil
