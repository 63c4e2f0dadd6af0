#include "sil/film.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "control/mode_text.hpp"

namespace pmg::sil {

Film::Film(sim::World& world, const std::filesystem::path& file)
    : world_(world),
      renderer_(world.mj_model(), {.width = 960, .height = 540}),
      writer_(file, renderer_.width(), renderer_.height(), kFramesPerSecond) {}

void Film::after_tick(const RunProgress& progress) {
  if (!failure_.empty() || ++ticks_ % kTicksPerFrame != 0) return;
  try {
    shoot(progress);
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  }
}

void Film::shoot(const RunProgress& progress) {
  const std::string text = fmt::format(
      "{:6.1f} s  {}\n{}", progress.time_s,
      control::mode_text(progress.result.mode, control::hanging(progress.result.maker)), progress.step.text);
  writer_.write(renderer_.render(world_.mj_data(), text, world_.gantry_rope()));
}

void Film::close() {
  try {
    writer_.close();
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  }
}

}  // namespace pmg::sil
