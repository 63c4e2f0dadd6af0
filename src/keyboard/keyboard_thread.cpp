#include "keyboard/keyboard_thread.hpp"

#include <utility>

namespace pmg::ops {

namespace {

constexpr int kWait_ms = 5;

}  // namespace

KeyboardThread::KeyboardThread(const std::string& url, const std::string& robot)
    : link_(url),
      station_(link_, keys_, robot, session_number(), clock_, seal::load_operator_seal("", url)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

KeyboardThread::~KeyboardThread() = default;

void KeyboardThread::press(const std::string& key, bool shift) {
  tell([this, key, shift](KeyCommand& keys, DrivingStation&) { keys.press(key, shift, clock_.now_ns()); });
}

void KeyboardThread::repeat(const std::string& key, bool shift) {
  tell([this, key, shift](KeyCommand& keys, DrivingStation&) { keys.repeat(key, shift, clock_.now_ns()); });
}

void KeyboardThread::release(const std::string& key) {
  tell([this, key](KeyCommand& keys, DrivingStation&) { keys.release(key, clock_.now_ns()); });
}

void KeyboardThread::release_all() {
  tell([](KeyCommand& keys, DrivingStation&) { keys.release_all(); });
}

void KeyboardThread::listen() {
  tell([this](KeyCommand& keys, DrivingStation&) { keys.listen(clock_.now_ns()); });
}

void KeyboardThread::let_go() {
  tell([](KeyCommand&, DrivingStation& station) { station.let_go(); });
}

DrivingTable KeyboardThread::table() const {
  const std::lock_guard lock(mutex_);
  return table_;
}

bool KeyboardThread::gone() const {
  const std::lock_guard lock(mutex_);
  return gone_;
}

void KeyboardThread::tell(Errand errand) {
  const std::lock_guard lock(mutex_);
  errands_.push_back(std::move(errand));
}

void KeyboardThread::run(const std::stop_token& stop) {
  std::vector<Errand> errands;
  while (!stop.stop_requested()) {
    errands.clear();
    {
      const std::lock_guard lock(mutex_);
      errands.swap(errands_);
    }
    for (const Errand& errand : errands) errand(keys_, station_);
    station_.step(kWait_ms);
    DrivingTable table = station_.table();
    const std::lock_guard lock(mutex_);
    table_ = std::move(table);
    gone_ = station_.gone();
  }
}

}  // namespace pmg::ops
