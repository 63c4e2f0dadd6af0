// SDL's virtual game controller, plugged in for as long as the object lives.
#pragma once

#include <SDL.h>

namespace pmg::gamepad {

class VirtualPad {
 public:
  /// SDL maps the first `buttons` buttons of a game controller; of any other type it maps none.
  explicit VirtualPad(SDL_JoystickType type = SDL_JOYSTICK_TYPE_GAMECONTROLLER, int buttons = 15)
      : index_(SDL_JoystickAttachVirtual(type, 6, buttons, 0)) {
    joystick_ = SDL_JoystickOpen(index_);
    id_ = SDL_JoystickInstanceID(joystick_);
  }
  ~VirtualPad() { unplug(); }
  VirtualPad(const VirtualPad&) = delete;
  VirtualPad& operator=(const VirtualPad&) = delete;
  void unplug() {
    if (joystick_ == nullptr) return;
    SDL_JoystickClose(joystick_);
    joystick_ = nullptr;
    for (int i = 0; i < SDL_NumJoysticks(); ++i)
      if (SDL_JoystickGetDeviceInstanceID(i) == id_) SDL_JoystickDetachVirtual(i);
  }
  void button(int button, bool down) { SDL_JoystickSetVirtualButton(joystick_, button, down ? 1 : 0); }
  void axis(int axis, double value) { SDL_JoystickSetVirtualAxis(joystick_, axis, static_cast<Sint16>(value * 32767)); }
  SDL_JoystickID id() const { return id_; }

 private:
  int index_;
  SDL_Joystick* joystick_ = nullptr;
  SDL_JoystickID id_ = -1;
};

}  // namespace pmg::gamepad
