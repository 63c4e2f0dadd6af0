#include "gamepad/sdl_pads.hpp"

#include <SDL.h>

#include <algorithm>
#include <stdexcept>

namespace pmg::gamepad {

namespace {

struct Shown {
  Uint8 red, green, blue;
  Uint16 rumble;
  Uint32 rumble_ms;
};

constexpr std::array<Shown, 5> kShown = {{{0, 0, 64, 0, 0},            // rest
                                          {0, 160, 0, 0, 0},           // driving
                                          {160, 120, 0, 0x4000, 100},  // limited
                                          {120, 0, 160, 0x9000, 300},  // link lost
                                          {255, 0, 0, 0xffff, 800}}};  // fault

constexpr const char* kRemedy = "set SDL_GAMECONTROLLERCONFIG to SDL's mapping of this GUID; start again";

}  // namespace

SdlPads::SdlPads() {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // the program's own bring the robot to rest
  SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
  if (SDL_Init(SDL_INIT_GAMECONTROLLER) != 0)
    throw std::runtime_error(std::string("SDL doesn't start: ") + SDL_GetError());
}

SdlPads::~SdlPads() {
  for (const auto& [id, pad] : open_) SDL_GameControllerClose(pad);
  SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

const std::vector<PadReport>& SdlPads::poll() {
  std::erase_if(pads_, [](const auto& entry) { return entry.second.gone; });
  for (auto& [id, report] : pads_) {
    report.state.pressed.reset();
    report.state.changed = false;
  }
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) take(event);
  reports_.clear();
  for (auto& [id, report] : pads_) {
    if (const auto pad = open_.find(id); pad != open_.end()) {
      for (std::size_t b = 0; b < kButtons; ++b)
        report.state.held[b] = SDL_GameControllerGetButton(pad->second, static_cast<SDL_GameControllerButton>(b)) != 0;
      for (std::size_t a = 0; a < kAxes; ++a) {
        const double raw = SDL_GameControllerGetAxis(pad->second, static_cast<SDL_GameControllerAxis>(a));
        report.state.axes[a] = std::max(raw / 32767.0, -1.0);
      }
    }
    reports_.push_back(report);
  }
  return reports_;
}

void SdlPads::take(const SDL_Event& event) {
  if (event.type == SDL_CONTROLLERDEVICEADDED) {
    open(event.cdevice.which);
  } else if (event.type == SDL_JOYDEVICEADDED) {
    if (SDL_IsGameController(event.jdevice.which) == SDL_FALSE)
      refuse(event.jdevice.which, "SDL doesn't know its buttons", kRemedy);
  } else if (event.type == SDL_JOYDEVICEREMOVED) {
    useless_.erase(event.jdevice.which);
  } else if (event.type == SDL_CONTROLLERDEVICEREMOVED && open_.contains(event.cdevice.which)) {
    SDL_GameControllerClose(open_.at(event.cdevice.which));
    open_.erase(event.cdevice.which);
    pads_[event.cdevice.which].gone = true;
  } else if (event.type == SDL_CONTROLLERBUTTONDOWN || event.type == SDL_CONTROLLERBUTTONUP) {
    const auto found = pads_.find(event.cbutton.which);
    if (found == pads_.end()) return;
    found->second.state.changed = true;
    if (event.type == SDL_CONTROLLERBUTTONDOWN && event.cbutton.button < kButtons)
      found->second.state.pressed.set(event.cbutton.button);
  } else if (event.type == SDL_CONTROLLERAXISMOTION && pads_.contains(event.caxis.which)) {
    pads_.at(event.caxis.which).state.changed = true;
  } else if (event.type == SDL_CONTROLLERSENSORUPDATE && pads_.contains(event.csensor.which)) {
    pads_.at(event.csensor.which).state.changed = true;
  }
}

void SdlPads::open(int index) {
  SDL_GameController* pad = SDL_GameControllerOpen(index);
  if (pad == nullptr) return refuse(index, "SDL can't open it", SDL_GetError());
  const std::int32_t id = SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(pad));
  if (!open_.emplace(id, pad).second) return SDL_GameControllerClose(pad);  // counted twice: SDL counts its users
  const char* name = SDL_GameControllerName(pad);
  PadReport report{.id = id, .name = name == nullptr ? "game controller" : name};
  for (std::size_t b = 0; b < kButtons; ++b)
    report.missing[b] = SDL_GameControllerHasButton(pad, static_cast<SDL_GameControllerButton>(b)) == SDL_FALSE;
  pads_.try_emplace(id, std::move(report));
  // A gyroscope is never silent: its readings tell that the pad is still there.
  if (SDL_GameControllerHasSensor(pad, SDL_SENSOR_GYRO) == SDL_TRUE)
    SDL_GameControllerSetSensorEnabled(pad, SDL_SENSOR_GYRO, SDL_TRUE);
  shown_ = Sign::kRest;
}

void SdlPads::refuse(int index, std::string why, std::string remedy) {
  const std::int32_t id = SDL_JoystickGetDeviceInstanceID(index);
  if (id < 0) return;  // it is already unplugged
  std::array<char, 33> guid{};
  SDL_JoystickGetGUIDString(SDL_JoystickGetDeviceGUID(index), guid.data(), static_cast<int>(guid.size()));
  const char* name = SDL_JoystickNameForIndex(index);
  useless_[id] = {.name = name == nullptr ? "joystick" : name,
                  .guid = guid.data(),
                  .why = std::move(why),
                  .remedy = std::move(remedy)};
}

std::vector<UselessPad> SdlPads::useless() const {
  std::vector<UselessPad> pads;
  for (const auto& [id, pad] : useless_) pads.push_back(pad);
  return pads;
}

void SdlPads::show(Sign sign) {
  if (sign == shown_) return;
  shown_ = sign;
  const Shown& look = kShown[static_cast<std::size_t>(sign)];
  for (const auto& [id, pad] : open_) {
    SDL_GameControllerSetLED(pad, look.red, look.green, look.blue);
    if (look.rumble_ms > 0) SDL_GameControllerRumble(pad, look.rumble, look.rumble, look.rumble_ms);
  }
}

}  // namespace pmg::gamepad
