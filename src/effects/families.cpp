#include "effects/families.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/unknown.hpp"

namespace pmg::effects {

double shown::steps(double t_s) { return t_s < 0.2 ? 0.0 : t_s < 1.4 ? 0.8 : t_s < 2.4 ? 0.3 : -0.4; }
double shown::big_step(double t_s) { return t_s < 0.2 ? 0.0 : t_s < 1.6 ? 1.5 : 0.0; }
double shown::sine(double t_s) { return 0.6 * std::sin(2.0 * std::numbers::pi * 0.6 * t_s); }
double shown::slow_sine(double t_s) { return 0.25 * std::sin(2.0 * std::numbers::pi * 0.3 * t_s); }
double shown::triangle(double t_s) { return 0.3 * std::asin(std::sin(2.0 * std::numbers::pi * 0.4 * t_s)); }
double shown::slow_ramp(double t_s) { return std::min(0.6 * t_s, 1.8); }

Starts grid(Values multiples, std::vector<Size> sizes) {
  return [multiples = std::move(multiples), sizes = std::move(sizes)](const StartsFrom& from) {
    Values found(1);
    for (std::size_t p = 0; p < multiples.size(); ++p) {
      const double size =
          sizes.empty() ? usual(calib::quantity(from.form.parameters[p]), from.scale).start : sizes[p](from);
      Values longer;
      for (const std::vector<double>& first : found) {
        for (const double multiple : multiples[p]) {
          longer.push_back(first);
          longer.back().push_back(multiple * size);
        }
      }
      found = std::move(longer);
    }
    return found;
  };
}

Starts each(std::vector<double> multiples, Size size) {
  return grid({std::move(multiples)}, size == nullptr ? std::vector<Size>{} : std::vector{size});
}

Starts more_or_less(std::vector<double> multiples) {
  return [more = each(std::move(multiples))](const StartsFrom& from) {
    Values found = more(from);
    for (std::vector<double>& one : found)
      one.front() += model::actuator_parameter(from.form.parameters.front()).value(from.actuator);
    std::erase_if(found, [](const std::vector<double>& one) { return one.front() < 0.0; });
    return found;
  };
}

Starts these(Values values) {
  return [values = std::move(values)](const StartsFrom&) { return values; };
}

Starts where(bool (*possible)(const StartsFrom&), Starts starts) {
  return [possible, starts = std::move(starts)](const StartsFrom& from) {
    return possible(from) ? starts(from) : Values{};
  };
}

double by_itself(const StartsFrom&) { return 1.0; }

bool closes_loop(const StartsFrom& from) { return from.scale.law != bench::DriveLaw::kTorque; }

bool switches_off(const StartsFrom& from) { return from.scale.switches_off; }

std::vector<double> itself(const Measured& measured) { return {measured.value}; }

std::vector<double> opposite(const Measured& measured) { return {-measured.torque_Nm}; }

}  // namespace pmg::effects
