#include "sil/film.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "control/mode_text.hpp"
#include "sil/film_view.hpp"

namespace pmg::sil {

Film::Film(sim::World& world, const std::filesystem::path& file, double elevation_deg)
    : world_(world),
      renderer_(world.mj_model(), {.width = 960, .height = 540, .elevation_deg = elevation_deg}),
      writer_(file, renderer_.width(), renderer_.height(), kFramesPerSecond) {}

bool Film::due() noexcept { return failure_.empty() && ++ticks_ % kTicksPerFrame == 0; }

void Film::after_tick(const RunProgress& progress) {
  if (!due()) return;
  if (&progress.step != step_) face(progress.step);
  shoot(progress.time_s,
        fmt::format("{}\n{}", control::mode_text(progress.result.mode, control::hanging(progress.result.maker)),
                    progress.step.text));
}

void Film::after_tick(const std::string& words) {
  if (due()) shoot(world_.time_s(), words);
}

void Film::face(const ScenarioStep& step) {
  step_ = &step;
  const auto from_deg = shown_from_deg(step.command);
  if (!from_deg) return;
  const Eigen::Vector3d ahead = world_.truth().q_WB * Eigen::Vector3d::UnitX();
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  renderer_.look_from(kDegrees * std::atan2(ahead.y(), ahead.x()) + *from_deg);
}

void Film::shoot(double time_s, const std::string& words) {
  try {
    writer_.write(
        renderer_.render(world_.mj_data(), fmt::format("{:6.1f} s  {}", time_s, words), world_.gantry_rope()));
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  }
}

void Film::close() {
  try {
    writer_.close();
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  }
}

}  // namespace pmg::sil
