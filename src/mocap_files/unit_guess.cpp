#include "mocap_files/unit_guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "files/config_error.hpp"
#include "fitting/statistics.hpp"

namespace pmg::mocap {
namespace {

Eigen::Vector3d mean_position(const Recording& recording, std::initializer_list<KeyBody> keys, bool& known) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const KeyBody key : keys) {
    for (const Eigen::Vector3d& p : recording.body(key).position_m) {
      sum += p;
      count += 1.0;
    }
  }
  known = count > 0.0;
  return known ? Eigen::Vector3d(sum / count) : sum;
}

struct NamedUnit {
  const char* name;
  double metres;
  double rarity;  ///< in standard deviations
};

}  // namespace

double median_leg_length(const Recording& recording) {
  double sum = 0.0;
  int legs = 0;
  for (const Side side : {Side::left, Side::right}) {
    const Body &hip = recording.body(of_side(KeyBody::left_hip, side)),
               &knee = recording.body(of_side(KeyBody::left_knee, side)),
               &ankle = recording.body(of_side(KeyBody::left_ankle, side));
    if (!hip.known() || !knee.known() || !ankle.known()) continue;
    std::vector<double> length;
    for (std::size_t f = 0; f < recording.frames; ++f) {
      length.push_back((hip.position_m[f] - knee.position_m[f]).norm() +
                       (knee.position_m[f] - ankle.position_m[f]).norm());
    }
    sum += fitting::median(std::move(length));
    ++legs;
  }
  return legs == 0 ? 0.0 : sum / legs;
}

bool plausible_leg(double length_m) { return length_m >= 0.25 && length_m <= 1.2; }

UnitGuess guess_unit(double leg_length) {
  constexpr std::array<NamedUnit, 7> kUnits = {{{"m", 1.0, 0.0},
                                                {"cm", 0.01, 0.0},
                                                {"mm", 0.001, 0.0},
                                                {"inch", 0.0254, 1.5},
                                                {"feet", 0.3048, 1.5},
                                                {"dm", 0.1, 1.5},
                                                {"CMU's unit, inch / 0.45", 0.0254 / 0.45, 1.5}}};
  constexpr double kAdultLeg_m = 0.85, kSpread = 0.35;
  const auto surprise = [&](const NamedUnit& unit) {
    return unit.rarity + std::abs(std::log(leg_length * unit.metres / kAdultLeg_m)) / kSpread;
  };
  const NamedUnit* best = std::ranges::min_element(kUnits, {}, surprise);
  const std::string because = fmt::format("guessed: the legs are {:.4g} long", leg_length);
  if (!plausible_leg(leg_length * best->metres)) return {1.0, because + ", and no unit makes that a leg: m assumed"};
  std::string others;
  for (const NamedUnit& unit : kUnits) {
    if (&unit != best && surprise(unit) < surprise(*best) + 1.0)
      others += fmt::format("{}{}", others.empty() ? "; it could be " : " or ", unit.name);
  }
  return {best->metres, fmt::format("{}, so the unit is {}{}", because, best->name, others)};
}

Eigen::Matrix3d rotation_to_z_up(Recording& recording, const std::string& up) {
  int axis = 2;
  double sign = 1.0;
  if (!up.empty()) {
    const bool good = up.size() == 2 && (up[0] == '+' || up[0] == '-') && up[1] >= 'x' && up[1] <= 'z';
    if (!good) files::raise({"--up"}, "", fmt::format("is '{}'", up), "+x, -x, +y, -y, +z or -z");
    axis = up[1] - 'x';
    sign = up[0] == '-' ? -1.0 : 1.0;
  } else {
    bool has_top = false, has_bottom = false;
    const Eigen::Vector3d top = mean_position(recording, {KeyBody::neck, KeyBody::head, KeyBody::pelvis}, has_top);
    const Eigen::Vector3d bottom = mean_position(
        recording, {KeyBody::left_ankle, KeyBody::right_ankle, KeyBody::left_toe, KeyBody::right_toe}, has_bottom);
    if (has_top && has_bottom) {
      const Eigen::Vector3d above = top - bottom;
      above.cwiseAbs().maxCoeff(&axis);
      sign = above[axis] < 0.0 ? -1.0 : 1.0;
      if (std::abs(above[axis]) < 0.8 * above.norm())
        recording.notes.emplace_back("it isn't clear which axis points up: --up sets it");
    } else {
      recording.notes.emplace_back("without a trunk and feet the z axis is taken for up: --up sets it");
    }
  }
  recording.up = fmt::format("{}{}", sign < 0.0 ? '-' : '+', static_cast<char>('x' + axis));
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();  // the axes in cyclic order: a proper rotation
  turn(2, axis) = 1.0;
  turn(0, (axis + 1) % 3) = 1.0;
  turn(1, (axis + 2) % 3) = 1.0;
  if (sign < 0.0) turn = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal() * turn;
  return turn;
}

}  // namespace pmg::mocap
