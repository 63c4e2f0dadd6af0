// The catalogue's effects by family, and what their rows share. A further effect is a row of its family.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "effects/catalogue.hpp"

namespace pmg::effects {

std::vector<Effect> friction_effects();
std::vector<Effect> transmission_effects();
std::vector<Effect> command_effects();
std::vector<Effect> drive_effects();
std::vector<Effect> sensor_effects();
std::vector<Effect> warmth_and_load_effects();

using Against = Demonstration::Against;
using Size = double (*)(const StartsFrom&);

/// Commands [rad] that show an effect.
namespace shown {
double big_step(double t_s);
double sine(double t_s);
double slow_sine(double t_s);
double triangle(double t_s);
double slow_ramp(double t_s);
}  // namespace shown

/// Multiples of what is usual for each parameter on this bench, or of the sizes given: all combinations, the first
/// parameter's slowest.
Starts grid(Values multiples, std::vector<Size> sizes = {});
Starts each(std::vector<double> multiples, Size size = nullptr);
/// So many times the usual more than the model has; not below zero.
Starts more_or_less(std::vector<double> multiples);
Starts these(Values values);
Starts where(bool (*possible)(const StartsFrom&), Starts starts);

/// 1: a start's multiple is its value.
double by_itself(const StartsFrom&);

/// The drive has a position loop of its own.
bool closes_loop(const StartsFrom& from);

/// The drive is off in some of the recordings' samples.
bool switches_off(const StartsFrom& from);

/// A check's value as it is.
std::vector<double> itself(const Measured& measured);
/// The balance is drive = load + friction - constant torque. With a reading r = q + z gravity G sin(r - z) is
/// G sin r - z G cos r.
std::vector<double> opposite(const Measured& measured);

inline Form law(std::string name, std::string title, std::vector<std::string> parameters, std::string source,
                Starts starts, std::vector<FixedValue> fixed = {}) {
  return {std::move(name),   std::move(title),  std::move(parameters),
          std::move(source), std::move(starts), std::move(fixed)};
}

/// The form, in a workshop's words of its own.
inline Form called(WorkshopWords words, Form form) {
  form.workshop = std::move(words);
  return form;
}

}  // namespace pmg::effects
