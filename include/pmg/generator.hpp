// The parameterized motion generator (paper III-A.2) as one class: command in, reference out, once a tick.
#pragma once

#include "pmg/clip.hpp"
#include "pmg/command.hpp"
#include "pmg/reference.hpp"

namespace pmg {

enum class Blend {
  kGain,   ///< g_i = n_i / max(1, sum n), q_d = sum g_i q_i + (1 - sum g_i) q_stand
  kPaper,  ///< the paper's w and alpha literally
};

struct GeneratorOptions {
  Blend blend = Blend::kGain;
  CommandLimits limits;
  std::array<double, kVelocityChannels> scale_positive{};  ///< u_max_i for positive commands
  std::array<double, kVelocityChannels> scale_negative{};  ///< u_max_i for negative commands, positive numbers
  double limit_margin_rad = 0.0349066;                     ///< 2 degrees
  double contact_edge_cycle = 0.04;                        ///< width of the contact weights' cosine edges
  double rest_before_freeze_s = 0.5;
};

class Generator {
 public:
  Generator(ClipLibrary library, const GeneratorOptions& options);  ///< may allocate and throw std::invalid_argument

  void reset() noexcept;  ///< rest, q_stand, phase frozen with both feet in contact
  const Reference& step(const Command& user, double dt_s) noexcept;  ///< no heap, no exception
  const Reference& reference() const noexcept;
};

}  // namespace pmg
