// Devices in hands: what a person does with a keyboard, a game controller, a page or a headset, in one vocabulary.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "gamepad/pad_command.hpp"
#include "io/clock.hpp"
#include "keyboard/key_command.hpp"
#include "live_page/page_hands.hpp"
#include "operator/joined_devices.hpp"
#include "vr/headset.hpp"
#include "vr/vr_command.hpp"

namespace pmg::gamepad {

/// A device in a hand: what the hand does, and the machine that it drives by.
class Hand {
 public:
  explicit Hand(const io::Clock& clock) : clock_(clock) {}
  virtual ~Hand() = default;
  Hand(const Hand&) = delete;
  Hand& operator=(const Hand&) = delete;
  virtual ops::Device& device() = 0;
  virtual void poll() = 0;         ///< the program looks at the device
  virtual void go(bool held) = 0;  ///< begins or ends to hold what drives forwards
  virtual void press_stop() = 0;
  virtual void ask_stand(bool held) = 0;  ///< begins or ends
  virtual void ask_reset(bool held) = 0;
  virtual void leave() = 0;      ///< unplugged, or its window is closed
  virtual void come_back() = 0;  ///< with what was held still held

 protected:
  const io::Clock& clock_;
};

class Keys : public Hand {
 public:
  using Hand::Hand;
  ops::Device& device() override { return keys_; }
  void poll() override {
    if (!there_) return;
    keys_.listen(clock_.now_ns());
    if (held_) keys_.repeat("w", true, clock_.now_ns());
  }
  void go(bool held) override {
    held_ = held;
    if (held) keys_.press("w", true, clock_.now_ns());
    if (!held) keys_.release("w", clock_.now_ns());
  }
  void press_stop() override { keys_.press("escape", false, clock_.now_ns()); }
  void ask_stand(bool held) override {
    if (held) keys_.press("enter", false, clock_.now_ns());
  }
  void ask_reset(bool held) override {
    if (held) keys_.press("r", false, clock_.now_ns());
  }
  void leave() override { there_ = false; }
  void come_back() override { there_ = true; }

 private:
  ops::KeyCommand keys_{ops::KeyReport::kPressAndRelease};
  bool held_ = false, there_ = true;
};

class Pad : public Hand {
 public:
  using Hand::Hand;
  ops::Device& device() override { return command_; }
  void poll() override {
    pad_.state.pressed = pad_.state.held & ~before_;
    before_ = pad_.state.held;
    if (there_) {
      command_.take({&pad_, 1}, clock_.now_ns());
    } else {
      command_.take({}, clock_.now_ns());
    }
    pad_.state.changed = true;
    if (pad_.state.held[kLb] && wants_) pad_.state.axes[1] = -1.0;  // the stick follows the deadman
    pad_.state.held[kB] = false;
  }
  void go(bool held) override {
    wants_ = held;
    pad_.state.held[kLb] = held;
    pad_.state.axes[1] = 0.0;
  }
  void press_stop() override { pad_.state.held[kB] = true; }
  void ask_stand(bool held) override { pad_.state.held[kRb] = pad_.state.held[kA] = held; }
  void ask_reset(bool held) override { pad_.state.held[kRb] = pad_.state.held[kX] = held; }
  void leave() override { there_ = false; }
  void come_back() override {
    there_ = true;
    ++pad_.id;
  }

 private:
  static constexpr std::size_t kA = 0, kB = 1, kX = 2, kLb = 9, kRb = 10;
  PadCommand command_{read_mapping(find_mapping("standard"))};
  PadReport pad_{.id = 1};
  Buttons before_;
  bool wants_ = false, there_ = true;
};

class Finger : public Hand {
 public:
  using Hand::Hand;
  ops::Device& device() override { return hands_; }
  void poll() override {
    const web::Page page{.id = page_, .paired_as = "phone"};
    hands_.look(std::span(&page, there_ ? 1 : 0));
    if (!there_) return;
    say(fmt::format(R"({{"n":{},"t":{},"held":{},"press":{},"forwards":{},"turn":0,"left":0}})", ++number_,
                    static_cast<double>(clock_.now_ns()) * 1e-6, held_, presses_, pushed_ ? 1 : 0));
    pushed_ = held_;  // a finger pushes after it has touched
  }
  void go(bool held) override {
    held_ = held;
    pushed_ = false;
    if (held) ++presses_;
  }
  void press_stop() override { say("stop"); }
  void ask_stand(bool held) override {
    if (held) say(R"({"request":"stand"})");
  }
  void ask_reset(bool held) override {
    if (held) say(R"({"request":"reset"})");
  }
  void leave() override { there_ = false; }
  void come_back() override {
    there_ = true;
    ++page_;
  }

 private:
  void say(const std::string& text) { hands_.take({page_, text}, clock_.now_ns()); }

  live_page::PageHands hands_;
  std::int32_t page_ = 1;
  std::int64_t number_ = 0, presses_ = 0;
  bool held_ = false, pushed_ = false, there_ = true;
};

/// A headset beside a page, as a program has them.
class Head : public Finger {
 public:
  explicit Head(const io::Clock& clock) : Finger(clock), joined_({&Finger::device(), &vr_}, vr_.manner()) {}
  ops::Device& device() override { return joined_; }
  void poll() override {
    Finger::poll();
    if (!there_) return;
    vr_.take(headset_.next(clock_.now_ns()), clock_.now_ns());
    const double step_m = std::clamp((squeezed_ ? vr::kReach_m : 0.0) - forward_m_, -0.04, 0.04);  // as a person moves
    headset_.step(step_m, 0.0);
    forward_m_ += step_m;
  }
  void go(bool held) override {
    squeezed_ = held;
    if (held) headset_.squeeze();
    if (!held) headset_.let_go();
  }
  void leave() override {
    there_ = false;
    vr_.end(clock_.now_ns());
    Finger::leave();
  }
  void come_back() override {
    there_ = true;
    vr_.begin(clock_.now_ns());
    forward_m_ = 0.0;  // it is centred anew, where it is
    Finger::come_back();
  }

 private:
  vr::VrCommand vr_ = [this] {
    vr::VrCommand vr(-1);
    vr.begin(clock_.now_ns());
    return vr;
  }();
  test::Headset headset_;
  double forward_m_ = 0.0;
  ops::JoinedDevices joined_;
  bool squeezed_ = false, there_ = true;
};

}  // namespace pmg::gamepad
