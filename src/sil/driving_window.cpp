#include "sil/driving_window.hpp"

#include "operator/keyboard_text.hpp"

namespace pmg::sil {

DrivingWindow::DrivingWindow(const mjModel* model, SimulatedRobot& robot, const std::string& name,
                             const std::string& url)
    : robot_(robot),
      viewer_(model, {.title = "PMG: " + name, .on_key = [this](const sim::ViewerKey& key) { take(key); }}),
      keyboard_(url, name) {}

void DrivingWindow::show() {
  viewer_.release();  // pictures are the painter's from now on
  painter_ = std::jthread([this](const std::stop_token& stop) { paint(stop); });
}

void DrivingWindow::listen() {
  viewer_.poll();
  keyboard_.listen();
}

void DrivingWindow::let_go() {
  constexpr std::chrono::milliseconds kPoll{10}, kLongestCalm{2500};
  keyboard_.listen();
  keyboard_.let_go();
  const auto end = std::chrono::steady_clock::now() + kLongestCalm;
  while (!keyboard_.gone() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kPoll);
}

void DrivingWindow::paint(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kFrame{33};
  const ops::DrivingTable keys = ops::key_table();
  PoseSample pose;
  for (auto next = std::chrono::steady_clock::now(); !stop.stop_requested();) {
    std::this_thread::sleep_until(next);
    next = std::chrono::steady_clock::now() + kFrame;
    robot_.take(pose);
    const ops::DrivingTable table = keyboard_.table();
    if (pose.count == 0) continue;
    speed_.take(pose);
    viewer_.draw({pose.qpos.data(), pose.count}, "", pose.rope,
                 {table.labels + "\nmeasured", table.values + "\n" + speed_.text(), keys.labels, keys.values});
  }
  viewer_.withdraw();
}

void DrivingWindow::take(const sim::ViewerKey& key) {
  using What = sim::ViewerKey::What;
  if (key.what == What::kPressed && key.name == "v") viewer_.look_from_the_other_side();
  if (key.what == What::kPressed) keyboard_.press(key.name, key.shift);
  if (key.what == What::kRepeats) keyboard_.repeat(key.name, key.shift);
  if (key.what == What::kReleased) keyboard_.release(key.name);
  if (key.what == What::kUnheard) keyboard_.release_all();
}

}  // namespace pmg::sil
